//! Drainages of both models, through the built program.

use crate::support::{Workplace, drainage_file};
use phase::record::{Outcome, RunRecord};
use phase::store::read_record;

fn record(place: &Workplace, name: &str) -> RunRecord {
    read_record(&place.path(name)).unwrap()
}

/// A box of discrete elements with rough spheres, which are all out after some seconds.
const ELEMENTS: &str = r#"
    spheres = { count = 12, radius = 0.5, density = 1.9 }
    contact = { law = "silbert", stiffness = 2e4, damping = 50.0 }
    friction = { law = "silbert", coefficient = 0.2, stiffness = 6e3, damping = 25.0 }
    gravity = { acceleration = 1.0 }
    tank = { width = 4.0, depth = 4.0, floor = 0.0, slit_width = 3.9 }
    start = { kind = "packing" }
    time = { dt = 1e-3, duration = 20.0, frame_interval = 0.1 }
    output = { snapshot_interval = 1.0 }
"#;

/// Symptom: after a run with its floor at -5 m the same box at 0 m hung 5 m below its floor, and the
/// other way round. Cause: the packing that is kept held heights above one floor.
#[test]
fn a_packing_lies_on_the_floor_of_its_scene() {
    let place = Workplace::new();
    place.write("scene.toml", &drainage_file());
    let lowest = |floor: &str, out: &str| {
        let set = format!("tank.floor={floor}");
        let arguments = ["run", "scene.toml", "--set", &set, "--out", out];
        place.phase(&arguments).code(0);
        let start = &record(&place, out).snapshots[0].position;
        let heights = start.column(2).iter().copied().collect::<Vec<f64>>();
        heights.into_iter().fold(f64::INFINITY, f64::min)
    };
    for (floor, out) in [(-5.0, "low.h5"), (0.0, "zero.h5"), (0.5, "high.h5")] {
        let above = lowest(&floor.to_string(), out) - floor;
        assert!((0.49..0.52).contains(&above), "{above} m above {floor} m");
    }
    let left = |name: &str| record(&place, name).observations.discharged.last().copied();
    assert_eq!(left("low.h5"), left("zero.h5"));
}

/// Symptom: no record of a box of which all spheres had left: "`spin` has shape (0, 3)". Cause: of no
/// spheres it was not known whether they have spins.
#[test]
fn a_box_of_elements_that_is_empty_has_a_record() {
    let place = Workplace::new();
    place.write("scene.toml", ELEMENTS);
    for trajectory in [&[][..], &["--trajectory"]] {
        let arguments = [&["run", "scene.toml", "--out", "run.h5"], trajectory].concat();
        place.phase(&arguments).code(0).says("run.h5");
        let record = record(&place, "run.h5");
        assert_eq!(record.outcome, Outcome::Completed);
        let end = record.snapshots.last().unwrap();
        assert_eq!(end.spin.dim(), (12, 3));
        assert!(end.position.iter().all(|it| it.is_nan()));
    }
}

/// Symptom: a run by elements to the record of a run by spots was refused, as the table beside it was
/// not known. Cause: the tables of both models begin differently.
#[test]
fn a_run_replaces_the_table_of_the_other_model() {
    let place = Workplace::new();
    place.write("spots.toml", &drainage_file());
    place.write("elements.toml", ELEMENTS);
    for name in ["spots.toml", "elements.toml", "spots.toml"] {
        place.phase(&["run", name, "--out", "run.h5"]).code(0);
    }
}

/// Symptom: dashes for all numbers, or states that were not asked for; a vortex tank was measured as
/// a drainage. Cause: neither times nor the opening were checked.
#[test]
fn what_is_no_drainage_within_the_times_is_refused() {
    let place = Workplace::new();
    place.write("spots.toml", &drainage_file());
    place
        .phase(&["run", "spots.toml", "--out", "run.h5"])
        .code(0);
    for command in [
        &["compare", "run.h5", "--times", "100,200"][..],
        &["fit", "run.h5", "--times", "100,200"],
        &[
            "plot", "run.h5", "--figure", "outflow", "--times", "100,200",
        ],
    ] {
        let answer = place.phase(command).code(2);
        answer.complains("within the requested times");
    }
    let tank = r#"
        spheres = { count = 2, radius = 0.004, density = 1e3 }
        start = { kind = "list", spheres = [{ position = [0, 0, 0.1] }, { position = [0.02, 0, 0.1] }] }
        tank = { radius = 0.06, floor = 0.0 }
        time = { dt = 1e-4, duration = 0.1, frame_interval = 1e-2 }
        output = { snapshot_interval = 0.05 }
    "#;
    place.write("tank.toml", tank);
    place
        .phase(&["run", "tank.toml", "--out", "tank.h5"])
        .code(0);
    let answer = place.phase(&["fit", "tank.h5"]).code(2);
    answer.complains("a box with an opening");
}

/// Symptom: figures that look at no states took `--times`, and records `--point` or `--scene`, and
/// drew what they would have drawn without.
#[test]
fn options_that_nothing_reads_are_refused() {
    let place = Workplace::new();
    place.write("scene.toml", &drainage_file());
    let run = ["run", "scene.toml", "--trajectory", "--out", "run.h5"];
    place.phase(&run).code(0);
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/results/theoretical-9x9");
    let times = ["--times", "1,4"];
    let (of_point, of_scene) = (["--point", "radius=0.5"], ["--scene", "scene.toml"]);
    for (command, options, complaint) in [
        (
            &["plot", "run.h5", "--figure", "tracks"][..],
            times,
            "takes no times",
        ),
        (
            &["plot", folder, "--figure", "phase", "--out", "."],
            times,
            "takes no times",
        ),
        (
            &["plot", folder, "--out", "."],
            times,
            "name one with --figure",
        ),
        (
            &["plot", "run.h5", "--figure", "outflow"],
            of_point,
            "is for a results folder",
        ),
        (
            &["plot", "run.h5", "--figure", "outflow"],
            of_scene,
            "none is given",
        ),
        (
            &["plot", folder, "--out", "."],
            of_scene,
            "a results folder has its own scene",
        ),
        (&["compare", "run.h5"], of_scene, "none is given"),
        (
            &["compare", folder, folder],
            of_scene,
            "folders are compared by their labels",
        ),
        (
            &["compare", folder, folder],
            times,
            "folders are compared by their labels",
        ),
    ] {
        place.phase(command).code(0);
        place
            .phase(&[command, &options[..]].concat())
            .code(2)
            .complains(complaint);
    }
}
