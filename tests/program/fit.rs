//! Drainages by discrete elements, and the parameters of the spot model that a drainage follows,
//! through the built program.

use crate::support::{Workplace, drainage_file};
use phase::compare::{MeasuredDrainage, outflow};
use phase::store::{content_digest, read_record};
use serde_json::Value;
use std::ops::Range;

/// A box of 400 spheres whose orifice opens after a second.
pub(crate) const ELEMENTS: &str = r#"
spheres = { count = 400, radius = 0.5, density = 1.909859317102744 }
start = { kind = "packing" }
tank = { width = 9.0, depth = 6.0, floor = 0.0, orifice_radius = 2.0, friction_coefficient = 0.3 }
contact = { law = "silbert", stiffness = 2e5, damping = 50.0 }
friction = { law = "silbert", coefficient = 0.5, stiffness = 57142.86, damping = 25.0 }
gravity = { acceleration = 1.0 }
door = { opens = 1.0 }
time = { dt = 2e-4, duration = 6.0, frame_interval = 0.1 }
output = { snapshot_interval = 0.5 }
"#;

#[test]
#[ignore = "takes ten seconds"]
fn a_silo_of_discrete_elements_opens_and_drains() {
    let place = Workplace::new();
    place.write("elements.toml", ELEMENTS);
    let run = place.phase(&["run", "elements.toml", "--out", "run.h5", "--verbose"]);
    run.code(0);
    let record = read_record(place.path("run.h5").as_ref()).unwrap();
    let drainage = MeasuredDrainage::new(&record, None).unwrap();
    assert_eq!(drainage.duration(), 5.0);
    let [time, left] = drainage.left();
    assert_eq!((time[0], left[0]), (0.0, 0.0));
    let gone = left.last().unwrap();
    assert!((20.0..300.0).contains(gone), "{gone} of 400 left");
    assert_eq!(drainage.since_opening(drainage.start().time), 0.0);
    // So small a scene does not use the two threads: the content is the same.
    place
        .phase(&[
            "run",
            "elements.toml",
            "--out",
            "again.h5",
            "--threads",
            "2",
        ])
        .code(0);
    let again = read_record(place.path("again.h5").as_ref()).unwrap();
    assert_eq!(content_digest(&record), content_digest(&again));
    // Compared with itself it differs by nothing.
    let compared = place
        .phase(&["compare", "run.h5", "again.h5", "--json"])
        .code(0);
    let compared: Value = serde_json::from_str(&compared.stdout).unwrap();
    for row in compared["rows"].as_array().unwrap() {
        let is_time = row["quantity"] == "processor time";
        let same = row["difference"].is_null() || row["difference"] == 0.0;
        assert!(is_time || same, "{row}");
    }
    // Pictures count from the opening, a second after the start, if they are asked to.
    place
        .phase(&["view", "run.h5", "--time", "3", "--since-opening"])
        .code(0)
        .complains("shows t = 3 τ");
    place
        .phase(&["view", "run.h5", "--time", "60", "--since-opening"])
        .code(2)
        .complains("no state at t = 60 τ: the record holds states from -1 to 5 τ");
    let drawn = place.phase(&["plot", "run.h5", "--figure", "outflow,velocity-correlation"]);
    drawn.code(0);
}

#[test]
fn a_door_that_stays_closed_leaves_no_drainage() {
    let place = Workplace::new();
    let text = ELEMENTS
        .replace("opens = 1.0", "opens = 1.0e9")
        .replace("duration = 6.0", "duration = 0.5");
    place.write("closed.toml", &text);
    let refused = place.phase(&["run", "closed.toml"]).code(2);
    assert!(
        refused.stderr.contains("the door would open"),
        "{}",
        refused.stderr
    );
}

/// A drainage that is large enough for its flow to be fitted.
fn wide() -> String {
    drainage_file()
        .replace("count = 400", "count = 4500")
        .replace("width = 9.0, depth = 6.0", "width = 18.0, depth = 8.0")
        .replace("orifice_radius = 2.0", "orifice_radius = 3.0")
        .replace(
            "duration = 4.0, frame_interval = 0.5",
            "duration = 15.0, frame_interval = 0.25",
        )
        .replace("snapshot_interval = 1.0", "snapshot_interval = 0.5")
        + "relaxation.method = \"global\"\n"
}

/// Spots of the fitted parameters drain two thirds to three quarters as fast as the drainage that
/// they are fitted to: they remove all overlaps, which holds spheres back. One seed; of seeds 1 to 4
/// the ratios of the outflow were .69, .68, .72 and .74.
#[test]
#[ignore = "the packing of 4,500 spheres: half a minute"]
fn fitted_spots_drain_two_thirds_as_fast() {
    let place = Workplace::new();
    place.write("wide.toml", &wide());
    place
        .phase(&["run", "wide.toml", "--out", "wide.h5"])
        .code(0);
    let arguments = [
        "fit",
        "wide.h5",
        "--times",
        "4,14",
        "--out",
        "fitted.toml",
        "--json",
    ];
    let answer = place.phase(&arguments).code(0);
    let answer: Value = serde_json::from_str(&answer.stdout).unwrap();
    let value = |key: &str| {
        let parameters = answer["parameters"].as_array().unwrap();
        let own = parameters.iter().find(|it| it["key"] == key).unwrap();
        own["value"].as_f64().unwrap()
    };
    for (key, range) in [
        // Between walls this near the flow is nearly as wide at all heights.
        ("spot.diffusion_length", 0.6..2.6),
        ("spot.displacement_ratio", 150.0..500.0),
        ("spot.radius", 1.8..3.9),
        ("spot.insertion_rate", 60.0..450.0),
        ("spot.move_rate", 24.0..34.0),
    ] {
        assert!(range.contains(&value(key)), "{key}: {}", value(key));
    }
    place.phase(&["check", "fitted.toml"]).code(0);
    place
        .phase(&["run", "fitted.toml", "--out", "fitted.h5"])
        .code(0);
    let rate = |name: &str| {
        let record = read_record(place.path(name).as_ref()).unwrap();
        outflow(&MeasuredDrainage::new(&record, Some([4.0, 14.0])).unwrap())
            .unwrap()
            .value
    };
    let ratio = rate("fitted.h5") / rate("wide.h5");
    assert!((0.6..0.85).contains(&ratio), "{ratio}");
    // A second time it does not replace another file.
    place.write("other.toml", "title = \"mine\"\n");
    let refused = place
        .phase(&["fit", "wide.h5", "--out", "other.toml"])
        .code(2);
    assert!(refused.stderr.contains("other.toml"), "{}", refused.stderr);
}

/// Symptom: the scene that a fit wrote was refused by `phase run`, and nothing had said so: spots
/// of the fitted radius were wider than the box. The numbers of the paper stood in units of the
/// spheres beside those in SI units. The seed of the record, and with it its packing, was lost.
#[test]
#[ignore = "5,500 spheres: a minute"]
fn a_fit_of_discrete_elements_says_if_its_spots_are_too_wide_for_the_box() {
    let place = Workplace::new();
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/sweeps/scenes/dem-small.toml");
    let run = [
        "run",
        scene,
        "--set",
        "time.dt=4e-4",
        "--set",
        "time.duration=25",
        "--seed",
        "2",
    ];
    place
        .phase(&[&run[..], &["--out", "run.h5"]].concat())
        .code(0);
    let fit = ["fit", "run.h5", "--times", "5,20", "--out", "fitted.toml"];
    let fitted = place.phase(&fit).code(0);
    let warns = fitted.stderr.contains("cannot be run in this box");
    let check = place.phase(&["check", "fitted.toml", "--no-trial"]);
    assert_eq!(
        check.code,
        Some(if warns { 2 } else { 0 }),
        "{}",
        fitted.stderr
    );
    assert!(place.read("fitted.toml").contains("seed = 2"));
    for (key, fit, paper) in FITTED {
        let line = fitted.stdout.lines().find(|line| line.starts_with(key));
        let words: Vec<&str> = line.unwrap().split_whitespace().collect();
        let found: f64 = words[2].parse().unwrap();
        assert!(fit.contains(&found), "{key}: {found}");
        assert!(words.contains(&paper), "{words:?}");
    }
}

/// What the shorter box of discrete elements asks for, about (seeds 1 and 2 at 5 to 30 tau), and
/// the paper's numbers.
const FITTED: [(&str, Range<f64>, &str); 3] = [
    ("spot.diffusion_length", 0.6..1.2, "2.28"),
    ("spot.radius", 3.4..5.0, "2.6"),
    ("spot.move_rate", 25.0..65.0, "28"),
];

#[test]
fn what_does_not_flow_is_not_fitted() {
    let place = Workplace::new();
    let text = drainage_file().replace("insertion_rate = 375.0", "insertion_rate = 1e-6");
    place.write("still.toml", &text);
    place
        .phase(&["run", "still.toml", "--out", "still.h5"])
        .code(0);
    let refused = place.phase(&["fit", "still.h5"]).code(2);
    assert!(
        refused.stderr.contains("still.h5: a fit needs a flow"),
        "{}",
        refused.stderr
    );
}
