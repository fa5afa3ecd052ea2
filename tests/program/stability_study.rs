//! Phase diagrams of the numerics: borders lie where theory has them, and studies are kept and gone
//! on with like sweeps.

use crate::support::Workplace;
use phase::classify::Label;
use phase::dem::timestep::largest_stable;
use phase::scene::Scene;
use phase::study::comparison::{RunRow, RunTable};
use phase::study::stability::{self, StabilityStudy};
use phase::sweep::{Event, Folder, LocalThreads, Plan, Pool, Report, Wishes};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

fn study(text: &str) -> StabilityStudy {
    stability::from_str(text, Path::new("study.toml")).unwrap_or_else(|error| panic!("{error}"))
}

/// The rows of all runs, in the order of the jobs.
fn run(study: &StabilityStudy) -> Vec<RunRow> {
    let place = tempfile::tempdir().unwrap();
    let (table, _) = run_into(study, place.path(), Wishes::default());
    table.rows.into_iter().flatten().collect()
}

/// Makes the runs that have neither a row nor a record in a folder, and writes its table.
fn run_into(study: &StabilityStudy, folder: &Path, wishes: Wishes<'_>) -> (RunTable, Report) {
    let (comparison, folder) = (&study.comparison, Folder::new(folder));
    folder.create().unwrap();
    let mut table = RunTable::read(comparison, &folder).unwrap();
    let plan = table.applied_to(Plan::new(&folder, comparison.jobs.clone(), 2).unwrap());
    let threads = LocalThreads::new(1);
    let pool = Pool {
        wishes,
        ..Pool::new(&folder, &comparison.sweep, &threads)
    };
    let report = pool.run(&plan).unwrap();
    table.add_records(comparison, &folder, 2).unwrap();
    table.write(comparison, &folder).unwrap();
    (table, report)
}

/// The rows of the table of a folder, in the order of the jobs.
fn read(study: &StabilityStudy, folder: &Path) -> Vec<RunRow> {
    let table = RunTable::read(&study.comparison, &Folder::new(folder)).unwrap();
    table.rows.into_iter().flatten().collect()
}

/// The scene of the runs of an integrator at a point.
fn scene_at(study: &StabilityStudy, integrator: &str, [x, y]: [f64; 2]) -> Scene {
    let mut settings = study.comparison.settings.iter();
    let place = settings.position(|it| it.name == integrator).unwrap();
    study
        .comparison
        .sweep
        .scene_at(&[x, y, place as f64])
        .unwrap()
}

/// The largest stable and the least other step of an integrator at a value of the second axis.
/// Between them there is nothing: all below are stable, and none above is.
fn border(study: &StabilityStudy, rows: &[RunRow], integrator: &str, value: f64) -> [f64; 2] {
    let (mut stable, mut broken) = (0.0_f64, f64::INFINITY);
    for (job, row) in study.comparison.jobs.iter().zip(rows) {
        let time = &job.scene().time;
        if time.integrator.name() != integrator || job.values[1] != value {
            continue;
        }
        match row.label {
            Label::STABLE => stable = stable.max(time.dt),
            _ => broken = broken.min(time.dt),
        }
    }
    assert!(
        stable < broken,
        "{integrator}, {value}: {stable:e} and {broken:e}"
    );
    [stable, broken]
}

/// A sphere that swings on the floor by a hundredth of the overlap at which it rests, without or
/// with damping. Steps are 1 % apart.
const OSCILLATOR: &str = r#"
    study = "stability"
    integrators = ["symplectic-euler", "velocity-verlet", "synchronised-verlet"]
    [[axis]]
    key = "time.dt"
    from = 2e-3
    to = 5e-3
    count = 93
    spacing = "log"
    [[axis]]
    key = "contact.damping"
    values = [0.0, 0.05, 0.1]
    [scene]
    spheres = { count = 1, radius = 0.004, density = 2500.0 }
    contact = { law = "linear", stiffness = 160.0, damping = 0.0 }
    tank = { floor = 0.0 }
    gravity = { acceleration = 9.8 }
    start = { kind = "list", spheres = [{ position = [0.0, 0.0, 0.0039586] }] }
    time = { dt = 1e-3, duration = 40.0, frame_interval = 1e-1 }
"#;

/// The limit of a pair, at half of the stiffness and damping: that of one sphere and the floor,
/// which is twice as heavy as a pair.
fn limit_on_the_floor(study: &StabilityStudy, damping: f64, integrator: &str) -> f64 {
    let scene = scene_at(study, integrator, [1e-3, damping]);
    let halves = [
        ("contact.stiffness", 80.0),
        ("contact.damping", 0.5 * damping),
    ];
    let tree = serde_json::to_value(&scene).unwrap();
    let mut tree = tree;
    for (key, value) in halves {
        let (table, key) = key.split_once('.').unwrap();
        tree[table][key] = value.into();
    }
    let scene: Scene = serde_json::from_value(tree).unwrap();
    largest_stable(&scene).unwrap().seconds
}

#[test]
#[ignore = "takes a quarter of a minute"]
fn an_oscillator_breaks_at_the_limit_of_its_integrator() {
    let study = study(OSCILLATOR);
    let rows = run(&study);
    let mut limits = Vec::new();
    for integrator in study.comparison.settings.iter().map(|it| &it.name) {
        for damping in [0.0, 0.05, 0.1] {
            let limit = limit_on_the_floor(&study, damping, integrator);
            let [stable, broken] = border(&study, &rows, integrator, damping);
            let name = format!("{integrator}, damping {damping}");
            // The border is in the cell of the limit or in one next to it.
            assert!(
                stable < 1.011 * limit && broken > 0.989 * limit,
                "{name}: {stable:e} to {broken:e} for {limit:e}"
            );
            assert!(broken < 1.011 * stable, "{name}: a hole");
            limits.push(limit);
        }
    }
    // The limits differ, or the borders would say little.
    assert!(
        limits[2] < 0.9 * limits[0] && limits[8] < 0.9 * limits[5],
        "{limits:?}"
    );
}

#[test]
fn sub_steps_leave_the_displacement() {
    let study = study(
        r#"
        study = "stability"
        integrators = ["adaptive-verlet"]
        [[axis]]
        key = "time.dt"
        from = 1e-3
        to = 1e-2
        count = 231
        spacing = "log"
        [[axis]]
        key = "spheres.radius"
        values = [0.002, 0.004]
        [scene]
        spheres = { count = 1, radius = 0.004, density = 2500.0 }
        contact.law = "hertz"
        contact.young_modulus = 1e9
        contact.poisson_ratio = 0.3
        contact.dissipation_time = 0.0
        start.kind = "list"
        start.spheres = [{ position = [0.0, 0.0, 0.0], velocity = [1.0, 0.0, 0.0] }]
        time = { dt = 1e-5, duration = 0.1, frame_interval = 1e-3 }
        "#,
    );
    let rows = run(&study);
    for radius in [0.002, 0.004] {
        let scene = scene_at(&study, "adaptive-verlet", [1e-3, radius]);
        let limit = largest_stable(&scene).unwrap();
        assert_eq!((limit.name, limit.seconds), ("displacement", radius));
        let [stable, broken] = border(&study, &rows, "adaptive-verlet", radius);
        assert!(
            stable <= 1.000_001 * radius && broken > radius,
            "{stable:e} to {broken:e}"
        );
        assert!(broken < 1.011 * stable);
    }
}

/// A sphere that falls onto the floor, with steps far above the limit, in milliseconds.
const TINY: &str = r#"
study = "stability"
title = "A drop"
integrators = ["velocity-verlet", "adaptive-verlet"]
frames = 20
[[axis]]
key = "time.dt"
values = [1e-5, 1e-3, 1e-2]
[[axis]]
key = "contact.young_modulus"
values = [1e6, 1e8]
[scene]
spheres = { count = 1, radius = 0.004, density = 2500.0 }
contact = { law = "hertz", young_modulus = 1e6, poisson_ratio = 0.3, dissipation_time = 0.0 }
tank = { floor = 0.0 }
gravity = { acceleration = 9.8 }
start = { kind = "list", spheres = [{ position = [0.0, 0.0, 0.03] }] }
time = { dt = 1e-5, duration = 0.5, frame_interval = 1e-2 }
"#;

#[test]
fn a_study_that_is_stopped_goes_on_where_it_was() {
    let study = study(TINY);
    let place = tempfile::tempdir().unwrap();
    let (whole, cut) = (place.path().join("whole"), place.path().join("cut"));
    for folder in [&whole, &cut] {
        std::fs::create_dir(folder).unwrap();
    }
    let (_, expected) = run_into(&study, &whole, Wishes::default());
    assert_eq!((expected.finished, expected.left), (12, 0));

    let (stop, ended) = (AtomicBool::new(false), AtomicUsize::new(0));
    let stopping = Wishes {
        stop: &stop,
        resume: true,
        watch: &|event| {
            let is_end = matches!(event, Event::Finished(..));
            if is_end && ended.fetch_add(1, Ordering::Relaxed) == 4 {
                stop.store(true, Ordering::Relaxed);
            }
        },
    };
    let (_, made) = run_into(&study, &cut, stopping);
    assert_eq!((made.finished, made.left), (5, 7));
    assert_eq!(read(&study, &cut).len(), 5);

    let (_, rest) = run_into(&study, &cut, Wishes::default());
    assert_eq!((rest.finished, rest.left), (7, 0));
    let but_times = |rows: Vec<RunRow>| {
        let rows = rows.into_iter();
        let rows = rows.map(|row| RunRow {
            cpu_seconds: 0.0,
            ..row
        });
        rows.collect::<Vec<_>>()
    };
    let [whole, cut] = [whole, cut].map(|it| but_times(read(&study, &it)));
    assert_eq!(whole.len(), 12);
    assert_eq!(whole, cut);
}

#[test]
fn rows_are_taken_over_and_labelled_by_the_threshold() {
    let place = Workplace::new();
    place.write("drop.toml", TINY);
    let again = ["study", "drop.toml", "--no-plot"];
    let table = || place.read("results/stability/drop/runs.csv");
    let first = place.phase(&["study", "drop.toml"]).code(0);
    let loose = table();
    first
        .says("12 runs: 12 made now")
        .says("results/stability/drop/stability.png");
    place.phase(&again).code(0).says("12 runs: 0 made now");
    assert_eq!(loose, table());

    // Whatever gains or loses energy at all is told apart by a threshold of nearly nothing.
    let stable = |table: &str| table.matches(",stable,").count();
    place.write("drop.toml", &format!("energy_gain = 1e-12\n{TINY}"));
    place.phase(&again).code(0).says("12 runs: 0 made now");
    let strict = table();
    assert!(stable(&strict) < stable(&loose), "{strict}");

    place.write("drop.toml", TINY);
    let anew = ["study", "drop.toml", "--force", "--no-plot"];
    place.phase(&anew).code(0).says("12 made now");
    assert_eq!(stable(&loose), stable(&table()));
}

#[test]
fn the_figure_has_a_panel_per_integrator_units_and_the_limit() {
    let place = Workplace::new();
    place.write("drop.toml", TINY);
    place.phase(&["study", "drop.toml", "-j", "1"]).code(0);
    let figure = place.read("results/stability/drop/stability.svg");
    for text in [
        "A drop",
        "velocity-verlet",
        "adaptive-verlet",
        "(Pa)",
        "lost sphere",
        "limit of the time step",
        "advised limit of twelve contacts",
        "Software: phase",
    ] {
        assert!(figure.contains(text), "no `{text}`");
    }
}

#[test]
fn a_table_that_is_none_is_refused() {
    let place = Workplace::new();
    place.write("drop.toml", TINY);
    let run = ["study", "drop.toml", "--no-plot"];
    place.phase(&run).code(0);
    let path = "results/stability/drop/runs.csv";
    let table = place.read(path);
    place.write(path, &table.replace("lost-sphere", "lost"));
    place.phase(&run).code(2).complains("delete the file");
}

/// The rows of a published study, in the order of the jobs.
fn published(study: &StabilityStudy, name: &str) -> Vec<RunRow> {
    read(study, &Path::new("results/stability").join(name))
}

/// Part of the published cradle, made again.
#[test]
fn the_published_cradle_keeps_its_rows() {
    let file = "sweeps/stability/cradle.toml";
    let text = std::fs::read_to_string(file).unwrap();
    let text = text.replace(
        "study = \"stability\"\n",
        "study = \"stability\"\nintegrators = [\"velocity-verlet\"]\n",
    );
    let own = stability::from_str(&text, Path::new(file)).unwrap();
    let rows = published(&own, "cradle");
    assert_eq!(rows.len(), own.comparison.jobs.len());
    assert!(rows.iter().any(|row| row.label == Label::ENERGY_GAIN));
    for (found, expected) in run(&own).iter().zip(&rows) {
        assert_eq!(
            (&found.id, found.label, &found.values),
            (&expected.id, expected.label, &expected.values)
        );
    }
}

#[test]
fn published_studies_are_those_that_are_shipped() {
    for name in ["cradle", "pile", "tank"] {
        let study = stability::load(Path::new(&format!("sweeps/stability/{name}.toml"))).unwrap();
        let rows = published(&study, name);
        let jobs = study.comparison.jobs.iter().map(|job| &job.id);
        assert!(jobs.eq(rows.iter().map(|row| &row.id)), "{name}");
    }
}

/// Symptom: a study was refused for keys of frames and output that it does not use, and the message
/// pointed at the scene as a whole. Cause: its scene was checked like one to be run.
#[test]
fn keys_that_a_study_does_not_use_do_not_refuse_it() {
    let own = study(TINY);
    for (from, to) in [
        ("frame_interval = 1e-2", "frame_interval = 1.234e-2"),
        ("frame_interval = 1e-2", "frame_interval = 2.0"),
        (
            "[scene]",
            "[scene]\noutput = { snapshot_interval = 0.012345 }",
        ),
    ] {
        let text = TINY.replace(from, to);
        assert_ne!(text, TINY);
        let other = study(&text).comparison;
        let [other, same] = [&other, &own.comparison]
            .map(|it| it.jobs.iter().map(|job| (&job.values, job.scene())));
        assert!(other.eq(same), "{to}");
    }
}

/// Symptom: a run of half a second with steps of 7 s lasted 7 s and was labelled.
#[test]
fn a_step_longer_than_the_run_is_refused() {
    let text = TINY.replace("1e-2]", "7.0]");
    let error = stability::from_str(&text, Path::new("study.toml")).unwrap_err();
    let error = error.to_string();
    for part in [
        "study.toml:7:",
        "`time.dt` = 7 s is longer than the run, `time.duration` = 0.5 s",
        "help: use a smaller step",
    ] {
        assert!(error.contains(part), "no `{part}` in {error}");
    }
}

/// Symptom: a study with fewer values, or over other keys, wrote the table anew without a word.
#[test]
fn rows_of_another_study_are_not_lost() {
    let place = Workplace::new();
    place.write("drop.toml", TINY);
    let run = ["study", "drop.toml", "--no-plot"];
    place.phase(&run).code(0);
    place.write("drop.toml", &TINY.replace("1e-2]", "2e-2]"));
    place
        .phase(&run)
        .code(0)
        .says("12 runs: 4 made now")
        .complains(
            "runs.csv keeps 4 rows of settings, points or seeds that the study does not have",
        );
    place.write("drop.toml", TINY);
    place.phase(&run).code(0).says("12 runs: 0 made now");

    let table = place.read("results/stability/drop/runs.csv");
    place.write(
        "drop.toml",
        &TINY.replace("time.dt\"", "time.dt\"\nname = \"h\""),
    );
    place.phase(&run).code(2).complains("other axes");
    assert_eq!(place.read("results/stability/drop/runs.csv"), table);
    place.phase(&[&run[..], &["--force"]].concat()).code(0);
}

/// Symptom: rows of any build were taken over without a word. A record says which build made it;
/// of a row alone that is unknown.
#[test]
fn rows_of_an_unknown_build_are_told_of_until_they_are_made_anew() {
    let place = Workplace::new();
    place.write("drop.toml", TINY);
    let again = ["study", "drop.toml", "--no-plot"];
    let quiet =
        |answer: crate::support::Answer| assert!(!answer.stderr.contains("made by"), "{answer:?}");
    place.phase(&again).code(0);
    quiet(place.phase(&again).code(0));
    let record = place.records("results/stability/drop")[0].clone();
    std::fs::remove_file(place.path(&format!("results/stability/drop/records/{record}"))).unwrap();
    for _ in 0..2 {
        place
            .phase(&again)
            .code(0)
            .complains("1 row was made by an unknown version; --force runs it again");
    }
    place.phase(&[&again[..], &["--force"]].concat()).code(0);
    quiet(place.phase(&again).code(0));
}

#[test]
fn check_says_what_a_study_would_run() {
    let place = Workplace::new();
    place.write("drop.toml", TINY);
    place
        .phase(&["check", "drop.toml"])
        .code(0)
        .says("A drop: a study of stability, 2 settings with 1 seed at 6 points, 12 runs in all")
        .says("adaptive-verlet: 6 runs, steps at ")
        .says("at most about");
    // One with no key that a sweep has not, but steps above the limit.
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/sweeps/stability/cradle.toml");
    let answer = place
        .phase(&["check", file, "--no-trial", "--json"])
        .code(0);
    let answer: serde_json::Value = serde_json::from_str(&answer.stdout).unwrap();
    assert_eq!(answer["kind"], "study");
    assert_eq!(answer["jobs"], 4 * 31 * 13);
    assert!(answer["settings"][0]["largest_ratio"].as_f64().unwrap() > 1.0);
}
