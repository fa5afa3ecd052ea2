//! Spheres that stay or keep to their paths break no guard, and guards name the others.

use phase::dem::DemSimulation;
use phase::document::Problem;
use phase::record::Guard;
use phase::scene::{Integrator, Scene};
use std::path::Path;

/// Spheres of 1 cm at these places, with more tables.
fn text(places: &[&str], tables: &str, integrator: Integrator) -> String {
    let spheres = places.iter().map(|it| format!("{{ {it} }}"));
    format!(
        "spheres = {{ count = {}, radius = 0.01, density = 2500.0 }}
        contact = {{ law = 'hertz', young_modulus = 1e6, poisson_ratio = 0.3, restitution = 0.5 }}
        friction = {{ law = 'mindlin', coefficient = 0.3 }}
        start = {{ kind = 'list', spheres = [{}] }}
        time = {{ dt = 1e-5, duration = 0.2, frame_interval = 0.01, integrator = '{}' }}
        {tables}",
        places.len(),
        spheres.collect::<Vec<_>>().join(", "),
        integrator.name()
    )
}

fn scene(places: &[&str], tables: &str, integrator: Integrator) -> Scene {
    let text = text(places, tables, integrator);
    let scene = Scene::from_toml(&text, Path::new("scene.toml"));
    scene.unwrap_or_else(|error| panic!("{error}"))
}

const BOX: &str = "tank = { width = 0.2, depth = 0.2, floor = 0.0 }
    gravity = { acceleration = 9.81 }\n";

/// Symptom: a run was ended by its first step. Cause: the bounds counted fixed spheres, which may
/// stand around a tank.
#[test]
fn fixed_spheres_may_stand_beyond_the_bounds() {
    let fixed = "geometry = { kind = 'list', walls = [
        { position = [0.9, 0.0, 0.1], radius = 0.02 },
        { position = [0.0, 0.0, 0.0], radius = 0.02 },
    ] }\n";
    for integrator in Integrator::ALL {
        for bounds in ["", "guards = { horizontal = 0.15, vertical = 0.09 }\n"] {
            let tables = format!("{BOX}{fixed}{bounds}");
            let scene = scene(&["position = [0.0, 0.0, 0.04]"], &tables, integrator);
            let mut simulation = DemSimulation::new(&scene).unwrap();
            simulation.advance(20_000).unwrap();
            let ended = simulation.state().into_owned();
            DemSimulation::new(&scene).unwrap().restore(ended).unwrap();
        }
    }
}

/// Symptom: runs were ended by the overlap guard, or the bounds, where a driven sphere went through
/// a wall, a fixed sphere or another driven one. Cause: the guards counted contacts in which nothing
/// yields.
#[test]
fn a_driven_sphere_passes_walls_and_others_that_are_prescribed() {
    let tables = format!(
        "{BOX}
        geometry = {{ kind = 'list', walls = [{{ position = [0.04, 0.0, 0.05], radius = 0.02 }}] }}
        driven = [
            {{ sphere = 0, velocity = [4.0, 0.0, 0.0] }},
            {{ sphere = 2, velocity = [-4.0, 0.0, 0.0] }},
            {{ sphere = 3, velocity = [0.0, 0.0, -4.0] }},
        ]"
    );
    let places = [
        "position = [-0.02, 0.0, 0.05]",
        "position = [-0.07, -0.05, 0.01]",
        "position = [0.08, 0.0, 0.05]",
        "position = [0.0, 0.05, 0.05]",
    ];
    for integrator in Integrator::ALL {
        let mut simulation = DemSimulation::new(&scene(&places, &tables, integrator)).unwrap();
        let advanced = simulation.advance(20_000);
        advanced.unwrap_or_else(|error| panic!("{integrator:?}: {error}"));
        let particles = simulation.particles();
        let [one, free, other, down] = [1, 2, 3, 4].map(|i| particles.position[i]);
        let ends = [one.x - 0.78, other.x + 0.72, down.z + 0.75];
        assert!(ends.iter().all(|off| off.abs() < 1e-9), "{ends:?}");
        assert!((free.x + 0.07).abs() < 1e-9, "{integrator:?}: {free:?}");
    }
}

/// Symptom: two driven spheres in each other were refused, as the overlap guard would end the run.
#[test]
fn driven_spheres_may_form_one_body() {
    let driven = |velocity: &str| {
        format!("driven = [{{ sphere = 0, {velocity} }}, {{ sphere = 1, {velocity} }}]\n")
    };
    let places = [
        "position = [0.0, 0.0, 0.002]",
        "position = [0.002, 0.0, 0.002]",
        "position = [0.035, 0.0, 0.01]",
    ];
    for integrator in Integrator::ALL {
        let tables = format!("{BOX}{}", driven("velocity = [0.1, 0.0, 0.0]"));
        let body = scene(&places, &tables, integrator);
        let mut simulation = DemSimulation::new(&body).unwrap();
        simulation.advance(20_000).unwrap();
        let particles = simulation.particles();
        assert!((particles.position[1].x - 0.022).abs() < 1e-9);
        // It pushes what it meets.
        assert!(particles.position[2].x > 0.036, "{integrator:?}");
        // A free one so deep in them is refused, and ends the run.
        let mut free = body.clone();
        free.dem.driven.pop();
        assert!(free.problems()[0].message.contains("guards.overlap"));
        let broken = DemSimulation::new(&free).unwrap().advance(10).unwrap_err();
        assert_eq!((broken.guard, broken.sphere), (Guard::Overlap, 1));
    }
}

/// Symptom: the reports of broken guards named a sphere that the scene did not list. Cause: fixed
/// spheres were counted first.
#[test]
fn a_guard_names_the_sphere_as_the_scene_lists_it() {
    let fixed = "geometry = { kind = 'list', walls = [
        { position = [0.05, 0.0, 0.05], radius = 0.02 },
        { position = [0.09, 0.0, 0.05], radius = 0.02 },
    ] }
    guards = { horizontal = 0.5, vertical = 0.5 }\n";
    let rest = "rest = { kinetic_energy = 1e-12, hold = 0.1 }\n";
    let cases = [
        ("velocity = [0.0, 0.0, 1e4]", Guard::Displacement),
        ("velocity = [0.0, 0.0, 5.0]", Guard::OutOfBounds),
        ("spin = [0.0, 0.0, 1e200]", Guard::NotANumber),
    ];
    for integrator in Integrator::ALL {
        for (start, guard) in cases {
            for flow in ["", rest] {
                let tables = format!("{BOX}{fixed}{flow}");
                let moving = format!("position = [-0.05, 0.0, 0.05], {start}");
                let places = ["position = [0.0, 0.05, 0.01]", &moving];
                // The check would refuse the step for such speeds.
                let scene: Scene = toml::from_str(&text(&places, &tables, integrator)).unwrap();
                let mut simulation = DemSimulation::new(&scene).unwrap();
                let broken = simulation.advance(20_000).unwrap_err();
                assert_eq!((broken.guard, broken.sphere), (guard, 1), "{integrator:?}");
                assert!(broken.to_string().contains("sphere 1:"), "{broken}");
            }
        }
    }
}

/// A feed at 5 cm whose second sphere is driven.
fn fed(path: &str, more: &str) -> Vec<Problem> {
    let text = format!(
        "spheres = {{ count = 4, radius = 0.01, density = 2500.0 }}
        contact = {{ law = 'hertz', young_modulus = 1e6, poisson_ratio = 0.3, restitution = 0.5 }}
        start = {{ kind = 'feed', position = [0.0, 0.0, 0.05], interval = 0.1 {more} }}
        time = {{ dt = 1e-5, duration = 0.9, frame_interval = 0.1 }}
        driven = [{{ {path} }}]
        {BOX}"
    );
    toml::from_str::<Scene>(&text).unwrap().problems()
}

/// Symptom: a driven sphere that stood where it had come in held back all later ones for ever, and
/// the check said nothing.
#[test]
fn a_driven_sphere_that_stays_at_the_feed_is_refused() {
    let swing = "amplitude = [0.0, 0.0, 0.004], angular_frequency = 9.0";
    for path in ["", "velocity = [0.02, 0.0, 0.0]", swing] {
        let problems = fed(&format!("sphere = 1, {path}"), "");
        assert_eq!(problems.len(), 1, "{path}");
        assert_eq!(problems[0].path, "driven[0]");
        let message = &problems[0].message;
        assert!(
            message.contains("sphere 1 stays where sphere 2 is"),
            "{message}"
        );
        assert_eq!(fed(&format!("sphere = 3, {path}"), ""), []);
    }
    assert_eq!(fed("sphere = 1, velocity = [0.03, 0.0, 0.0]", ""), []);
    let wide = "amplitude = [0.0, 0.0, 0.04], angular_frequency = 9.0";
    assert_eq!(fed(&format!("sphere = 1, {wide}"), ""), []);
}

/// Symptom: the check accepted a feed that touches a fixed sphere, and nothing came in. Cause: the
/// sum of the radii had its last digit rounded up, and the run allowed for no rounding.
#[test]
fn a_feed_may_touch_a_fixed_sphere() {
    for (k, radius) in [0.01, 0.03, 0.07, 0.013, 0.29].into_iter().enumerate() {
        let reach = 0.01 + radius;
        let (sine, cosine) = libm::sincos(0.3 + k as f64);
        let text = format!(
            "spheres = {{ count = 2, radius = 0.01, density = 2500.0 }}
            contact = {{ law = 'hertz', young_modulus = 1e6, poisson_ratio = 0.3, \
             restitution = 0.5 }}
            geometry = {{ kind = 'list', walls = [
                {{ position = [{}, 0.1, {}], radius = {radius} }},
            ] }}
            start = {{ kind = 'feed', position = [0.0, 0.1, 0.7], interval = 0.1, \
             velocity = [{}, 0.0, {}] }}
            time = {{ dt = 1e-4, duration = 0.3, frame_interval = 0.1 }}",
            reach * cosine,
            0.7 + reach * sine,
            -cosine,
            -sine
        );
        let mut scene: Scene = toml::from_str(&text).unwrap();
        assert_eq!(scene.problems(), []);
        let mut simulation = DemSimulation::new(&scene).unwrap();
        simulation.advance(1500).unwrap();
        assert_eq!(simulation.counts().unwrap().released, 2, "{radius}");
        // Deeper by a millionth it is refused, and what the help says is accepted.
        let position = format!(
            "position = [{:?}, 0.1, 0.7]",
            1e-6 * reach * cosine.signum()
        );
        scene = toml::from_str(&text.replace("position = [0.0, 0.1, 0.7]", &position)).unwrap();
        let problems = scene.problems();
        let help = problems[0].help.as_deref().unwrap();
        let (_, typed) = help.split_once('`').unwrap();
        let typed = typed.split_once('`').unwrap().0;
        scene = toml::from_str(&text.replace("position = [0.0, 0.1, 0.7]", typed)).unwrap();
        assert_eq!(scene.problems(), [], "{help}");
    }
}

/// Symptom: the first sphere of a high feed ended the run. Cause: the default of `guards.vertical`
/// knew only the spheres that are in from the start.
#[test]
fn a_feed_may_be_high_above_its_tank() {
    let text = "spheres = { count = 1, radius = 0.01, density = 2500.0 }
        contact = { law = 'hertz', young_modulus = 1e6, poisson_ratio = 0.3, restitution = 0.5 }
        tank = { radius = 0.05, floor = 0.0 }
        gravity = { acceleration = 9.81 }
        start = { kind = 'feed', position = [0.0, 0.0, 0.8], interval = 0.1 }
        time = { dt = 1e-5, duration = 0.2, frame_interval = 0.1 }";
    let scene = Scene::from_toml(text, Path::new("feed.toml")).unwrap();
    DemSimulation::new(&scene).unwrap().advance(20_000).unwrap();
}
