//! Drainage by spots, through the built program.

use crate::support::{Workplace, drainage_file};
use phase::measure::{CellGrid, Centres};
use phase::record::RunRecord;
use phase::store::{content_digest, read_record};

fn record(place: &Workplace, name: &str) -> RunRecord {
    read_record(&place.path(name)).unwrap()
}

/// The least distance of two centres at the start (m).
fn least_distance(record: &RunRecord) -> f64 {
    let centres = Centres::of(&record.snapshots[0]);
    let grid = CellGrid::new(&centres.place, 1.0);
    let mut least = f64::INFINITY;
    for (own, place) in centres.place.iter().enumerate() {
        grid.within(*place, 1.5, |other, away| {
            if other != own {
                least = least.min(away.norm());
            }
        });
    }
    least
}

#[test]
fn a_box_drains_with_the_same_bits_for_any_number_of_threads() {
    let place = Workplace::new();
    let text = drainage_file();
    place.write("events.toml", &text);
    place.write(
        "steps.toml",
        &format!("{text}schedule = \"steps-random\"\n"),
    );
    for name in ["events", "steps"] {
        let run = |threads: &str| {
            let (file, out) = (format!("{name}.toml"), format!("{name}-{threads}.h5"));
            let arguments = ["run", &file, "--threads", threads, "--out", &out];
            place.phase(&arguments).code(0).says("spot-moves/s");
            record(&place, &out)
        };
        let [one, two] = ["1", "2"].map(run);
        assert_eq!(
            content_digest(&one).unwrap(),
            content_digest(&two).unwrap(),
            "{name}"
        );
        let left = one.observations.discharged.last().copied().unwrap();
        assert!((20.0..300.0).contains(&left), "{name}: {left}");
        // Neither energies nor contacts are observed.
        let scalars = one.observations.scalars();
        for absent in ["kinetic", "gravitational", "elastic", "coordination"] {
            assert!(scalars.iter().all(|it| it.name != absent), "{absent}");
        }
    }
}

/// Symptom: a second run to the same record was refused. Cause: its table of observables has no
/// energies, and counted as somebody else's.
#[test]
fn a_run_replaces_its_own_table() {
    let place = Workplace::new();
    let short = drainage_file().replace("duration = 4.0", "duration = 1.0");
    place.write("scene.toml", &short);
    for _ in 0..2 {
        place
            .phase(&["run", "scene.toml", "--out", "run.h5"])
            .code(0)
            .says("run-observations.csv");
    }
    place
        .phase(&["plot", "run.h5"])
        .code(0)
        .says("run-surface-angle.png")
        .says("run-radial-distribution.png");
    place.write("run-observations.csv", "time,place\n");
    place
        .phase(&["run", "scene.toml", "--out", "run.h5"])
        .code(2)
        .complains("not a table of observables");
}

/// The start packing is dense and without overlap, is kept, and serves both models.
#[test]
fn both_models_start_with_the_same_packing() {
    let place = Workplace::new();
    let text = drainage_file();
    place.write("spots.toml", &text);
    let (shared, _) = text.split_once("[spot]").unwrap();
    let grains = shared.replace(", orifice_radius = 2.0", "").replace(
        "duration = 4.0, frame_interval = 0.5",
        "dt = 1e-4, duration = 0.01, frame_interval = 0.01",
    );
    let grains = grains.replace("snapshot_interval = 1.0", "snapshot_interval = 0.01");
    let laws = "contact = { law = \"silbert\", stiffness = 2e5, damping = 50.0 }\n\
                gravity = { acceleration = 1.0 }\n";
    place.write("grains.toml", &format!("{laws}{grains}"));
    for name in ["spots", "grains"] {
        let (file, out) = (format!("{name}.toml"), format!("{name}.h5"));
        place.phase(&["run", &file, "--out", &out]).code(0);
    }
    let [spots, grains] = ["spots.h5", "grains.h5"].map(|name| record(&place, name));
    assert_eq!(spots.snapshots[0].position, grains.snapshots[0].position);
    assert!(least_distance(&spots) >= 1.0 - 1e-9);
    let kept = std::fs::read_dir(place.path("cache/phase/packings")).unwrap();
    assert_eq!(kept.count(), 1);

    // Another seed has another one; a damaged file is made again.
    let other = text.replace("start =", "seed = 2\nstart =");
    place.write("other.toml", &other);
    place
        .phase(&["run", "other.toml", "--out", "other.h5"])
        .code(0);
    let other = record(&place, "other.h5");
    assert_ne!(spots.snapshots[0].position, other.snapshots[0].position);
    for file in std::fs::read_dir(place.path("cache/phase/packings")).unwrap() {
        crate::support::damage(&file.unwrap().path());
    }
    place
        .phase(&["run", "spots.toml", "--out", "again.h5"])
        .code(0);
    let again = record(&place, "again.h5");
    assert_eq!(
        content_digest(&spots).unwrap(),
        content_digest(&again).unwrap()
    );
}

/// A sweep has labels, measures, and the figures of its family.
#[test]
fn a_sweep_over_the_orifice_is_labelled_and_drawn() {
    let place = Workplace::new();
    let scene = drainage_file().replace("duration = 4.0", "duration = 8.0");
    place.write("scene.toml", &scene);
    let sweep = "scene = \"scene.toml\"\n\
                 [[axis]]\nkey = \"tank.orifice_radius\"\nvalues = [0.5, 2.0]\n";
    place.write("sweep.toml", sweep);
    place
        .phase(&["sweep", "sweep.toml", "--out", "results"])
        .code(0);
    let labels = place.read("results/labels.csv");
    let row = |index: usize| labels.lines().nth(index).unwrap().to_owned();
    assert!(row(0).contains("outflow_rate") && row(0).contains("surface_angle"));
    assert!(row(1).contains("blocked"), "{labels}");
    assert!(!row(2).contains("blocked"), "{labels}");
    for figure in [
        "phase",
        "outflow-rate",
        "surface-angle",
        "radial-distribution",
    ] {
        let arguments = ["plot", "results", "--figure", figure, "--out", "figures"];
        place.phase(&arguments).code(0);
        let svg = place.read(&format!("figures/{figure}.svg"));
        assert!(svg.contains("<title>"), "{figure}");
    }
}

#[test]
fn what_new_writes_runs() {
    let place = Workplace::new();
    place.phase(&["new", "spot", "mine"]).code(0);
    place.phase(&["check", "mine.toml"]).code(0).says("spots");
}
