//! Every time that a scene states limits the time step, or there is a reason why it does not.

use phase::dem::timestep::limits;
use phase::scene::Scene;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// What becomes of a key whose unit holds a second.
enum Row {
    /// The limit of this name follows from it, in a scene of these laws.
    Limit(&'static str, &'static str),
    /// Why it needs no limit.
    None(&'static str),
}
use Row::{Limit, None};

const ROWS: [(&str, Row); 68] = [
    ("start.random.speed", Limit("displacement", HERTZ)),
    ("start.random.spin", Limit("Magnus lift", HERTZ)),
    ("start.list.spheres.velocity", Limit("displacement", LISTED)),
    ("start.list.spheres.spin", Limit("Magnus lift", LISTED)),
    ("start.feed.velocity", Limit("displacement", FED)),
    (
        "start.feed.interval",
        None("a whole number of steps, which the check asks for"),
    ),
    ("contact.hertz.young_modulus", Limit("contact", HERTZ)),
    (
        "contact.hertz.dissipation_time",
        Limit("damped contact", HERTZ),
    ),
    (
        "contact.hertz.restitution_speed",
        Limit("damped contact", LISTED),
    ),
    ("contact.linear.stiffness", Limit("contact", FED)),
    ("contact.linear.damping", Limit("damped contact", FED)),
    ("contact.silbert.stiffness", Limit("contact", SILBERT)),
    ("contact.silbert.damping", Limit("damped contact", SILBERT)),
    ("contact.tsuji.young_modulus", Limit("contact", TSUJI)),
    // No second in its unit, but the damping follows from it.
    ("contact.tsuji.restitution", Limit("damped contact", TSUJI)),
    ("contact.hooke.stiffness", Limit("contact", HOOKE)),
    ("contact.hooke.damping_rate", Limit("damped contact", HOOKE)),
    (
        "friction.coulomb.regularisation",
        Limit("regularised friction", HERTZ),
    ),
    (
        "friction.cundall-strack.stiffness",
        Limit("sticking contact", FED),
    ),
    (
        "friction.cundall-strack.damping",
        Limit("sticking contact", FED),
    ),
    (
        "friction.silbert.stiffness",
        Limit("sticking contact", SILBERT),
    ),
    (
        "friction.silbert.damping",
        Limit("sticking contact", SILBERT),
    ),
    ("friction.hooke.stiffness", Limit("sticking contact", HOOKE)),
    (
        "friction.hooke.damping_rate",
        Limit("sticking contact", HOOKE),
    ),
    (
        "door.opens",
        None("an event between two steps, without a force of its own"),
    ),
    (
        "rest.kinetic_energy",
        None("a threshold of what is measured; it ends the run"),
    ),
    (
        "rest.hold",
        None("the run is looked at more often than the least that is allowed"),
    ),
    ("driven.velocity", Limit("displacement", LISTED)),
    ("driven.angular_frequency", Limit("driven period", LISTED)),
    ("wall.velocity", Limit("displacement", BELT)),
    ("wall.angular_velocity", Limit("displacement", TURNING_DISC)),
    ("gravity.acceleration", Limit("displacement", HERTZ)),
    ("shaking.frequency", Limit("shaking period", HERTZ)),
    ("drag.linear", Limit("drag", HERTZ)),
    ("drag.viscosity", Limit("drag", LISTED)),
    ("swirl.omega", Limit("drag", HERTZ)),
    ("updraught.speed", Limit("displacement", HERTZ)),
    ("updraught.reference_omega", Limit("drag", HERTZ)),
    ("spin_damping.coefficient", Limit("spin damping", HERTZ)),
    ("spot.insertion_rate", None(SPOT)),
    ("spot.move_rate", None(SPOT)),
    ("time.dt", None("the step itself")),
    ("time.duration", None("a whole number of frames")),
    ("time.frame_interval", None("a whole number of steps")),
    (
        "steady.window",
        None("a mean over frames, which are whole numbers of steps"),
    ),
    ("steady.check_interval", None("a whole number of frames")),
    ("output.snapshot_interval", None("a whole number of frames")),
    (
        "program.time_limit",
        None("another program has its own steps"),
    ),
    ("label.over.last", None(RULES)),
    ("label.over.from", None(RULES)),
    ("label.over.to", None(RULES)),
    ("label.over.any", None(RULES)),
    ("measure.over.last", None(RULES)),
    ("measure.over.from", None(RULES)),
    ("measure.over.to", None(RULES)),
    ("measure.over.any", None(RULES)),
    ("output.rise_speeds", None("thresholds of what is measured")),
    // No second in these, but fields that decay with height and so are springs.
    ("updraught.decay", Limit("drag", HERTZ)),
    ("updraught.origin", Limit("drag", HERTZ)),
    ("buoyancy.density", Limit("drag", TURNING)),
    ("added_mass.density", Limit("drag", TURNING)),
    // The same key beside other laws.
    ("swirl.omega", Limit("drag", TURNING)),
    ("gravity.tilt", Limit("displacement", HERTZ)),
    ("driven.amplitude", Limit("displacement", LISTED)),
    ("shaking.gamma", Limit("shaking period", FED)),
    ("shaking.amplitude", Limit("shaking period", FED)),
    ("shaking.amplitude", Limit("displacement", HERTZ)),
    ("spheres.density", Limit("drag", TURNING)),
];

const RULES: &str = "a part of the frames, which a rule looks at after the run";
const SPOT: &str = "the spot model draws the times of its moves; it has no forces and no steps";

const HERTZ: &str = "
    contact = { law = 'hertz', young_modulus = 2e6, poisson_ratio = 0.3, dissipation_time = 1e-3 }
    friction = { law = 'coulomb', coefficient = 0.3, regularisation = 1.0 }
    spheres = { count = 2, density = 1e4, radius = 0.004 }
    tank = { radius = 0.06, floor = 0.0 }
    start = { kind = 'random', z_min = 0.1, z_max = 0.2, speed = 9.0, spin = 9e4 }
    gravity = { acceleration = 9e3, tilt = 0.2 }
    shaking = { amplitude = 1e-2, frequency = 9e3 }
    drag = { law = 'diameter', linear = 9.0, quadratic = 0.2 }
    swirl = { omega = 200.0 }
    updraught = { speed = 9.0, decay = 25.0, origin = 0.0, alpha = 0.5, reference_omega = 1e3 }
    magnus = { density = 1.0 }
    spin_damping = { coefficient = 1e-8 }";

const LISTED: &str = "
    contact = { law = 'hertz', young_modulus = 2e6, poisson_ratio = 0.3, restitution = 0.5 }
    friction = { law = 'mindlin', coefficient = 0.3 }
    spheres = { count = 2, density = 1e4, radius = 0.004 }
    start.kind = 'list'
    start.spheres = [
        { position = [0, 0, 1], velocity = [9.0, 0, 0], spin = [0, 9e4, 0] },
        { position = [1, 0, 1] },
    ]
    driven = [{ sphere = 1, velocity = [0, 0, 5.0], amplitude = [0.02, 0, 0], \
     angular_frequency = 100.0 }]
    drag = { law = 'schiller-naumann', viscosity = 1.0, density = 1.0 }
    swirl = { omega = 0.0 }
    magnus = { density = 1.0 }";

const FED: &str = "
    contact = { law = 'linear', stiffness = 1e3, damping = 1.0 }
    friction = { law = 'cundall-strack', coefficient = 0.3, stiffness = 800.0, damping = 0.5 }
    spheres = { count = 2, density = 1e4, radius = 0.004 }
    tank = { radius = 0.06, floor = 0.0 }
    start = { kind = 'feed', position = [0, 0, 1], velocity = [0, 0, -1.0], interval = 0.1 }
    gravity = { acceleration = 9.8 }
    shaking = { amplitude = 1e-3, gamma = 3.0 }";

const SILBERT: &str = "
    contact = { law = 'silbert', stiffness = 2e6, damping = 1e4 }
    friction = { law = 'silbert', coefficient = 0.3, stiffness = 6e5, damping = 5e3 }
    spheres = { count = 2, density = 1e4, radius = 0.004 }
    tank = { radius = 0.06, floor = 0.0 }
    start = { kind = 'random', z_min = 0.1, z_max = 0.2 }
    gravity = { acceleration = 9.8 }";

const TSUJI: &str = "
    contact = { law = 'tsuji', young_modulus = 2e6, poisson_ratio = 0.3, restitution = 5e-4 }
    friction = { law = 'mindlin', coefficient = 0.3 }
    spheres = { count = 2, density = 1e4, radius = 0.004 }
    tank = { radius = 0.06, floor = 0.0 }
    start = { kind = 'random', z_min = 0.1, z_max = 0.2 }
    gravity = { acceleration = 9.8 }";

const HOOKE: &str = "
    contact = { law = 'hooke', stiffness = 1e3, damping_rate = 100.0 }
    friction = { law = 'hooke', coefficient = 0.3, stiffness = 300.0, damping_rate = 50.0 }
    spheres = { count = 2, density = 1e4, radius = 0.004 }
    tank = { radius = 0.06, floor = 0.0 }
    start = { kind = 'random', z_min = 0.1, z_max = 0.2 }
    gravity = { acceleration = 9.8 }";

const BELT: &str = "
    spheres = { count = 1, density = 1e3, radius = 0.004 }
    contact = { law = 'linear', stiffness = 1e3, damping = 0.0 }
    friction = { law = 'coulomb', coefficient = 0.3, regularisation = 1.0 }
    start = { kind = 'list', spheres = [{ position = [0, 0, 0.005] }] }
    wall = [{ plane = { point = [0, 0, 0], normal = [0, 0, 1] }, velocity = [9.0, 0, 0] }]";

const TURNING_DISC: &str = "
    spheres = { count = 1, density = 1e3, radius = 0.004 }
    contact = { law = 'linear', stiffness = 1e3, damping = 0.0 }
    friction = { law = 'coulomb', coefficient = 0.3, regularisation = 1.0 }
    start = { kind = 'list', spheres = [{ position = [0, 0, 0.005] }] }
    wall = [{ disc = { centre = [0, 0, 0], radius = 0.1 }, angular_velocity = 90.0 }]";

/// A fluid that turns so fast that its pressure is stiffer than its drag.
const TURNING: &str = "
    spheres = { count = 1, density = 1e3, radius = 0.004 }
    contact = { law = 'linear', stiffness = 1e3, damping = 0.0 }
    tank = { radius = 0.06, floor = 0.0 }
    start = { kind = 'random', z_min = 0.1, z_max = 0.2 }
    gravity = { acceleration = 9.8 }
    buoyancy = { density = 2e3 }
    added_mass = { density = 2e3 }
    drag = { law = 'constant', linear = 1e-6 }
    swirl = { omega = 500.0 }";

/// Units that hold a second, written out or not.
fn holds_a_second(unit: &str) -> bool {
    let parts = unit.split(|it: char| !it.is_alphabetic());
    parts
        .into_iter()
        .any(|it| ["s", "N", "Pa", "J", "W", "Hz"].contains(&it))
}

/// The keys of a schema with their units; of tables with a law or kind, its word is in the path.
fn visit(schema: &Value, path: &str, units: &mut BTreeMap<String, Vec<String>>) {
    if let Some(quantity) = schema.get("quantity") {
        let others = quantity["other_units"].as_array().into_iter().flatten();
        let others = others.map(|it| it["unit"].as_str().unwrap().to_owned());
        let unit = quantity["unit"].as_str().unwrap().to_owned();
        units
            .entry(path.to_owned())
            .or_default()
            .extend(others.chain([unit]));
    }
    for (name, property) in schema["properties"].as_object().into_iter().flatten() {
        let dot = if path.is_empty() { "" } else { "." };
        visit(property, &format!("{path}{dot}{name}"), units);
    }
    visit_items(schema, path, units);
    for variant in schema["oneOf"].as_array().into_iter().flatten() {
        let properties = variant["properties"].as_object().into_iter().flatten();
        let mut words = properties.filter_map(|(_, property)| property["const"].as_str());
        let word = words.next().unwrap();
        visit(variant, &format!("{path}.{word}"), units);
    }
    for variant in schema["anyOf"].as_array().into_iter().flatten() {
        visit(variant, path, units);
    }
}

fn visit_items(schema: &Value, path: &str, units: &mut BTreeMap<String, Vec<String>>) {
    if schema["items"].is_object() {
        visit(&schema["items"], path, units);
    }
}

#[test]
fn every_key_whose_unit_holds_a_second_is_known() {
    let text = std::fs::read_to_string("docs/schema/scene.json").unwrap();
    let mut units = BTreeMap::new();
    visit(&serde_json::from_str(&text).unwrap(), "", &mut units);
    assert!(units.len() > 80, "{units:?}");
    units.retain(|_, units| units.iter().any(|unit| holds_a_second(unit)));
    for (key, unit) in &units {
        let is_known = ROWS.iter().any(|(known, _)| known == key);
        assert!(
            is_known,
            "{key} ({unit:?}) needs a limit of the time step, or a reason for none"
        );
    }
    for (key, row) in &ROWS {
        if let None(reason) = row {
            assert!(units.contains_key(*key) && reason.len() > 10, "{key}");
        }
    }
}

/// The value at a key, without the word of a law or kind in its path.
fn value<'a>(table: &'a mut toml::Value, key: &str) -> &'a mut toml::Value {
    key.split('.').fold(table, |value, name| {
        let value = match value {
            toml::Value::Array(entries) => &mut entries[0],
            other => other,
        };
        match value.get(name).is_some() {
            true => value.get_mut(name).unwrap(),
            false => value,
        }
    })
}

/// Makes a value so much larger that it prevails where the largest of several counts.
fn enlarge(value: &mut toml::Value) {
    match value {
        toml::Value::Array(entries) => entries.iter_mut().for_each(enlarge),
        toml::Value::Integer(number) => assert_eq!(*number, 0),
        toml::Value::Float(number) => *number = 1e3 * *number + f64::from(*number == 0.0),
        other => panic!("{other} is no number"),
    }
}

/// The limit of that name (s) in the scene of a table.
fn seconds(table: &toml::Value, name: &str) -> f64 {
    let text = toml::to_string(table).unwrap();
    let scene = Scene::from_toml(&text, Path::new("scene.toml"));
    let scene = scene.unwrap_or_else(|error| panic!("{error}"));
    let all = limits(&scene);
    let found = all.iter().find(|it| it.name == name);
    found
        .unwrap_or_else(|| panic!("no {name} limit in {text}"))
        .seconds
}

#[test]
fn each_of_these_keys_moves_its_limit() {
    for (key, row) in &ROWS {
        let Limit(name, base) = row else { continue };
        let text =
            format!("time = {{ dt = 1e-12, duration = 1.0, frame_interval = 1e-3 }}\n{base}");
        let mut table: toml::Value = toml::from_str::<toml::Table>(&text).unwrap().into();
        // The restitution holds at 1 m/s, which the file need not say.
        if key.ends_with("restitution_speed") {
            let contact = table.get_mut("contact").unwrap().as_table_mut().unwrap();
            contact.insert("restitution_speed".to_owned(), 1.0.into());
        }
        let before = seconds(&table, name);
        enlarge(value(&mut table, key));
        let after = seconds(&table, name);
        assert!(
            (after / before - 1.0).abs() > 1e-4,
            "{key}: {name} stays at {before:e} s"
        );
    }
}
