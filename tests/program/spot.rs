//! Drainage by spots, through the built program.

use crate::support::{Workplace, drainage_file};
use phase::compare::{MeasuredDrainage, mixing_of_kinematic_flow, mixing_of_voids};
use phase::measure::{CellGrid, Centres};
use phase::record::{Outcome, RunRecord};
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
#[ignore = "takes twenty seconds"]
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
        .says("run-radial-distribution.png");
    // Spots have no energies. Symptom: a figure of them without a line.
    place
        .phase(&["plot", "run.h5", "--figure", "energies"])
        .code(2)
        .complains("`energies` is not a figure of a record");
    place
        .phase(&["run", "scene.toml", "--ledger", "--out", "ledger.h5"])
        .code(2)
        .complains("`output.ledger` means nothing in a scene of spots");
    place.write("run-observations.csv", "time,place\n");
    place
        .phase(&["run", "scene.toml", "--out", "run.h5"])
        .code(2)
        .complains("not a table of observables");
}

/// The start packing is dense and without overlap, is kept, and serves both models.
#[test]
#[ignore = "takes a quarter of a minute"]
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
    let kept = std::fs::read_dir(place.path("cache/phase/packings-above-floor")).unwrap();
    assert_eq!(kept.count(), 1);

    // Another seed has another one; a damaged file is made again.
    let other = text.replace("start =", "seed = 2\nstart =");
    place.write("other.toml", &other);
    place
        .phase(&["run", "other.toml", "--out", "other.h5"])
        .code(0);
    let other = record(&place, "other.h5");
    assert_ne!(spots.snapshots[0].position, other.snapshots[0].position);
    for file in std::fs::read_dir(place.path("cache/phase/packings-above-floor")).unwrap() {
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
#[ignore = "takes a quarter of a minute"]
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
    assert!(row(0).contains("outflow_rate") && row(0).contains("surface_slope"));
    assert!(row(1).contains("blocked"), "{labels}");
    assert!(!row(2).contains("blocked"), "{labels}");
    for figure in ["phase", "outflow-rate", "radial-distribution"] {
        let arguments = ["plot", "results", "--figure", figure, "--out", "figures"];
        place.phase(&arguments).code(0);
        let svg = place.read(&format!("figures/{figure}.svg"));
        assert!(svg.contains("<title>"), "{figure}");
    }
}

#[test]
#[ignore = "takes ten seconds"]
fn what_new_writes_runs() {
    let place = Workplace::new();
    place.phase(&["new", "spot", "mine"]).code(0);
    place.phase(&["check", "mine.toml"]).code(0).says("spots");
}

/// Symptom: runs in which spots go 1.5 diameters behind walls, as in the paper's figure 8, ended as
/// unstable by the guard `empty-spot`: behind the edge of two walls a spot reaches no sphere.
#[test]
fn spots_behind_the_edge_of_two_walls_may_be_empty() {
    let place = Workplace::new();
    place.write("scene.toml", &drainage_file());
    place
        .phase(&[
            "run",
            "scene.toml",
            "--set",
            "spot.wall_distance=-1.5",
            "--out",
            "behind.h5",
        ])
        .code(0);
    assert_eq!(record(&place, "behind.h5").outcome, Outcome::Completed);
}

/// Two runs of a box that differ in one table.
fn two_runs() -> Workplace {
    let place = Workplace::new();
    let scene = drainage_file().replace("duration = 4.0", "duration = 8.0");
    place.write("scene.toml", &scene);
    place
        .phase(&["run", "scene.toml", "--out", "full.h5"])
        .code(0);
    let off = ["--set", "spot.relaxation.method=off", "--out", "off.h5"];
    place
        .phase(&[&["run", "scene.toml"], &off[..]].concat())
        .code(0);
    place
}

/// Several records share a figure, in which what differs names them.
#[test]
#[ignore = "takes ten seconds"]
fn records_are_drawn_beside_each_other() {
    let place = two_runs();
    for figure in [
        "outflow",
        "velocity-profile",
        "cross-profile",
        "packing-map",
        "radial-distribution",
        "bond-angles",
        "diffusion",
        "retention",
        "residence",
        "cost-error",
    ] {
        let arguments = [
            "plot", "full.h5", "off.h5", "--figure", figure, "--times", "1,8",
        ];
        place
            .phase(&arguments)
            .code(0)
            .says(&format!("{figure}.png"));
        let svg = place.read(&format!("{figure}.svg"));
        assert!(svg.contains("relaxation not set"), "{figure}: {svg}");
        assert!(svg.contains("off"), "{figure}");
    }
    place
        .phase(&[
            "plot", "full.h5", "off.h5", "--figure", "outflow", "--name", "both",
        ])
        .code(0)
        .says("both-outflow.svg");
    let labels = ["--figure", "outflow", "--label", "exact", "--label"];
    place
        .phase(&[&["plot", "full.h5", "off.h5"], &labels[..], &["fast"]].concat())
        .code(0);
    assert!(place.read("outflow.svg").contains(">fast"));
    place
        .phase(&[
            "plot", "full.h5", "off.h5", "--figure", "outflow", "--label", "one",
        ])
        .code(2)
        .complains("once for each");
    place
        .phase(&["plot", "full.h5", "--figure", "cost-error"])
        .code(2)
        .complains("two runs or more, the first of which is the reference");
    // Too narrow for columns of the surface, too low for two layers.
    for figure in ["surface-angle", "mixing"] {
        place
            .phase(&["plot", "full.h5", "--figure", figure])
            .code(1)
            .complains(&format!(
                "no run has a measure that the figure `{figure}` shows"
            ));
    }
    place
        .phase(&["plot", "full.h5", "off.h5", "--figure", "tracks"])
        .code(2)
        .complains("one by one");
    place
        .phase(&["plot", "full.h5", ".", "--figure", "mixing"])
        .code(2)
        .complains("must all be records");
    place
        .phase(&["plot", "full.h5", "--figure", "mixing", "--times", "3,1"])
        .code(2)
        .complains("the earlier first");
    place
        .phase(&["plot", "full.h5", "--figure", "outflw"])
        .code(2)
        .complains("is not a figure of a record of a drainage; available: `tracks`");
    let list = place.phase(&["plot", "--list", "full.h5"]).code(0);
    let list = list.says("packing-map").stdout;
    // It holds no ledger.
    assert!(!list.contains("ledger"), "{list}");
}

/// A record compared with itself differs by nothing, and without relaxation spheres overlap more.
#[test]
#[ignore = "takes a quarter of a minute"]
fn records_are_compared() {
    let place = two_runs();
    let answer = |other: &str| {
        let arguments = ["compare", "full.h5", other, "--times", "2,8", "--json"];
        let answer = place.phase(&arguments).code(0);
        serde_json::from_str::<serde_json::Value>(&answer.stdout).unwrap()
    };
    let same = answer("full.h5");
    let rows = same["rows"].as_array().unwrap();
    let named = |rows: &[serde_json::Value], name: &str| {
        let row = rows.iter().find(|row| row["quantity"] == name);
        row.unwrap_or_else(|| panic!("{name}")).clone()
    };
    for row in rows {
        let difference = &row["difference"];
        assert!(difference.is_null() || *difference == 0.0, "{row}");
    }
    // Two seeds differ by their spread: twice the interval of a difference is passed by chance in
    // one of 10,000, and there are some eight of them.
    let other = ["--seed", "2", "--out", "other.h5"];
    place
        .phase(&[&["run", "scene.toml"], &other[..]].concat())
        .code(0);
    let seeds = answer("other.h5");
    let number = |row: &serde_json::Value, key: &str| row[key].as_f64();
    let pairs = seeds["rows"].as_array().unwrap().iter();
    let pairs = pairs.filter_map(|row| {
        let interval = number(row, "difference_half_width")?;
        Some((number(row, "difference")?, interval, row))
    });
    let pairs: Vec<_> = pairs.collect();
    assert!(pairs.len() >= 6 && pairs.iter().any(|pair| pair.0 != 0.0));
    for (difference, interval, row) in pairs {
        assert!(difference.abs() <= 2.0 * interval, "{row}");
    }
    let outflow = named(rows, "outflow");
    assert!(outflow["half_widths"][0].as_f64().unwrap() > 0.0);
    let other = answer("off.h5");
    let badness = named(
        other["rows"].as_array().unwrap(),
        "packing badness, of pairs",
    );
    let value = |index: usize| badness["values"][index].as_f64().unwrap();
    assert!(value(1) > 10.0 * value(0), "{badness}");

    place
        .phase(&["compare", "full.h5", "off.h5", "--out", "table.csv"])
        .code(0)
        .says("B - A");
    assert!(
        place
            .read("table.csv")
            .starts_with("quantity,unit,record,value,half_width")
    );
    place.write("mine.csv", "my own table\n");
    place
        .phase(&["compare", "full.h5", "--out", "mine.csv"])
        .code(2)
        .complains("not a table of this command");
    place
        .phase(&["compare", "nowhere.h5"])
        .code(2)
        .complains("nowhere.h5");
}

/// Layers and packing fractions are shown in a cut through the middle.
#[test]
#[ignore = "takes seven seconds"]
fn layers_and_packing_fractions_are_viewed() {
    let place = two_runs();
    for color in ["layer", "packing-fraction"] {
        let arguments = [
            "view", "full.h5", "off.h5", "--time", "8", "--color", color, "--cut",
        ];
        let out = format!("{color}.png");
        let more = ["--window=-4,4,0,5", "--width", "100", "--out", &out];
        place.phase(&[&arguments[..], &more].concat()).code(0);
        assert!(place.path(&out).exists());
    }
    place
        .phase(&["view", "full.h5", "--time", "4", "--since-opening"])
        .code(0)
        .complains("shows t = 4 τ");
    place
        .phase(&["view", "full.h5", "--window", "1,0,0,1"])
        .code(2)
        .complains("--window takes four numbers");
}

/// A key of the command line does what one of the file does, and is checked like it.
#[test]
fn keys_are_set_on_the_command_line() {
    let place = Workplace::new();
    place.write("scene.toml", &drainage_file());
    let edited = drainage_file().replace("duration = 4.0", "duration = 1.0")
        + "schedule = \"steps-random\"\nwalk = { bias = 2 }\n";
    place.write("edited.toml", &edited);
    place
        .phase(&["run", "edited.toml", "--out", "edited.h5"])
        .code(0);
    let set = |setting| ["--set", setting];
    let settings = [
        set("time.duration=1.0"),
        set("spot.schedule=steps-random"),
        set("spot.walk={ bias = 2.0 }"),
    ];
    let arguments = [
        &["run", "scene.toml", "--out", "set.h5"],
        &settings.concat()[..],
    ];
    place.phase(&arguments.concat()).code(0);
    let [edited, set] = ["edited.h5", "set.h5"].map(|name| record(&place, name));
    assert_eq!(
        content_digest(&edited).unwrap(),
        content_digest(&set).unwrap()
    );
    for (option, setting, complaint) in [
        ("--set", "spot.walk.bias=-1", "--set:1:16"),
        ("--set", "time.duraton=1", "did you mean `duration`?"),
        ("--set", "time=1", "`time` must be a table"),
        ("--set", "seed.of=1", "`seed`"),
        ("--set", "duration", "give a key and its value"),
        ("--without", "spot.weighting", "the scene has no such key"),
        ("--without", "spot.radius", "radius"),
    ] {
        place
            .phase(&["run", "scene.toml", option, setting, "--out", "no.h5"])
            .code(2)
            .complains(complaint);
        assert!(!place.path("no.h5").exists());
        place
            .phase(&["check", "scene.toml", option, setting])
            .code(2)
            .complains(complaint);
    }
    let check = |more: &[&str]| {
        place
            .phase(&[&["check", "scene.toml"], more].concat())
            .code(0)
    };
    check(&[]).says("4 τ in 8 frames");
    check(&["--set", "time.duration=1.0"]).says("1 τ in 2 frames");
}

/// Spheres on a cubic lattice in a box of 12 x 6 x 42 diameters, as a table of positions.
fn lattice() -> String {
    let mut table = "x,y,z\n".to_owned();
    for z in 0..42 {
        for (x, y) in (0..12).flat_map(|x| (0..6).map(move |y| (x, y))) {
            let place = [f64::from(x) - 5.5, f64::from(y) - 2.5, f64::from(z) + 0.5];
            table += &place.map(|it| it.to_string()).join(",");
            table += "\n";
        }
    }
    table
}

/// A packing from elsewhere drains too; voids and the kinematic flow stand beside its mixing.
#[test]
#[ignore = "takes a quarter of a minute"]
fn positions_from_a_file_drain_and_are_compared_with_simpler_models() {
    let place = Workplace::new();
    place.write("lattice.csv", &lattice());
    let scene = drainage_file()
        .replace("count = 400", "count = 3024")
        .replace(
            "start = { kind = \"packing\" }",
            "start = { kind = \"file\", path = \"lattice.csv\" }",
        )
        .replace("width = 9.0, depth = 6.0", "width = 12.0, depth = 6.0")
        .replace("orifice_radius = 2.0", "slit_width = 4.0")
        .replace("duration = 4.0", "duration = 16.0")
        .replace("insertion_rate = 375.0", "insertion_rate = 190.0");
    place.write("scene.toml", &scene);
    place
        .phase(&["run", "scene.toml", "--out", "lattice.h5"])
        .code(0);
    let record = record(&place, "lattice.h5");
    assert_eq!(record.snapshots[0].position[[0, 0]], -5.5);
    let left = *record.observations.discharged.last().unwrap();
    assert!(left > 200.0, "{left} have left");
    place
        .phase(&["plot", "lattice.h5", "--figure", "mixing,diffusion"])
        .code(0);
    let svg = place.read("lattice-mixing.svg");
    for name in ["voids on a lattice", "kinematic flow", "over"] {
        assert!(svg.contains(name), "{name}: {svg}");
    }
    let drainage = MeasuredDrainage::new(&record, None).unwrap();
    let voids = mixing_of_voids(&drainage).unwrap();
    let flow = mixing_of_kinematic_flow(&drainage).unwrap();
    // They start on one lattice, and layers bend in both.
    assert_eq!(voids[0], flow[0]);
    // Cells that straddle the edges of layers are not unmixed at the start.
    assert!((0.0..0.35).contains(&voids[0].1), "{voids:?}");
    assert_eq!(voids.len(), record.snapshots.len());
    for mixed in [voids, flow] {
        let [first, last] = [mixed[0].1, mixed[mixed.len() - 1].1];
        assert!((first + 0.1..1.0).contains(&last), "{mixed:?}");
    }
    let packing = "start = { kind = \"file\", path = \"lattice.csv\" }";
    assert!(scene.contains(packing));
    place.write(
        "lattice.csv",
        &lattice().replace("-5.5,-2.5,0.5", "-5.5,-2.5,1.2"),
    );
    place
        .phase(&["run", "scene.toml", "--out", "overlap.h5"])
        .code(2)
        .complains("overlap");
}
