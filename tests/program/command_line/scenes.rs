//! `phase run` and `phase check`.

use super::bench::swept;
use crate::support::{TinySweep, Workplace, scene_file};

#[test]
fn one_scene_is_run_and_stored() {
    let place = Workplace::new();
    place.write("scene.toml", &scene_file());
    let answer = place
        .phase(&["run", "scene.toml"])
        .code(0)
        .says("completed")
        .says("kinetic");
    assert!(
        answer.stdout.ends_with("results/scene.h5\n"),
        "{}",
        answer.stdout
    );
    let record = |name: &str| phase::store::read_record(&place.path(name)).unwrap();
    assert_eq!(record("results/scene.h5").scene.seed, 1);
    place
        .phase(&["run", "scene.toml", "--seed", "5", "--out", "five.h5"])
        .code(0);
    assert_eq!(record("five.h5").scene.seed, 5);
}

#[test]
fn check_says_what_would_run() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    let answer = place.phase(&["check", "tiny.toml"]).code(0);
    let answer = answer
        .says("6 jobs")
        .says("gravity, swirl, contact (hertz), cylinder, floor");
    for name in ["omega", "seeds", "time step", "time  ", "memory", "disk"] {
        assert!(
            answer.stdout.contains(&format!("  {name}")),
            "no {name} in {}",
            answer.stdout
        );
    }
    assert!(!place.path("results").exists());
    place.write("scene.toml", &scene_file());
    place
        .phase(&["check", "scene.toml", "--no-trial"])
        .code(0)
        .says("1 job");
}

#[test]
fn the_forecast_of_disk_is_near_the_truth() {
    let (place, answer) = swept(&TinySweep {
        frame_interval: 0.001,
        ..TinySweep::default()
    });
    answer.code(0);
    let records = place.path("results/tiny/records");
    let sizes = std::fs::read_dir(records)
        .unwrap()
        .map(|entry| entry.unwrap().metadata().unwrap().len());
    let size = sizes.sum::<u64>() as f64;
    let text = place.phase(&["check", "tiny.toml"]).code(0).stdout;
    let line = text.lines().find(|line| line.contains("disk")).unwrap();
    let words: Vec<_> = line.split_whitespace().collect();
    let unit = if words[3] == "MB" { 1e6 } else { 1e3 };
    let forecast = words[2].parse::<f64>().unwrap() * unit;
    assert!(
        (0.7..1.5).contains(&(forecast / size)),
        "{forecast} for {size}"
    );
}

#[test]
fn bad_files_are_refused_before_anything_is_done() {
    let place = Workplace::new();
    let text = TinySweep::default().text();
    place.write("unknown.toml", &text.replace("density", "densty"));
    for command in ["sweep", "check"] {
        place
            .phase(&[command, "unknown.toml"])
            .code(2)
            .complains("unknown.toml")
            .complains("densty");
    }
    place.write("scene.toml", &scene_file().replace("omega", "omeg"));
    for command in ["run", "check"] {
        place
            .phase(&[command, "scene.toml"])
            .code(2)
            .complains("scene.toml")
            .complains("omeg");
    }
    assert!(!place.path("results").exists());
}

/// Symptom: the scene ran as it is, and the point was not said to be ignored.
#[test]
fn a_point_of_a_scene_is_refused() {
    let place = Workplace::new();
    place.write("scene.toml", &scene_file());
    place
        .phase(&["run", "scene.toml", "--point", "radius=0.003"])
        .code(2)
        .complains("--point selects a job of a sweep");
    assert!(!place.path("results").exists());
}

/// Symptom: the run was made, and then had no file to be written to.
#[test]
fn a_record_that_is_named_like_a_folder_is_refused_before_the_run() {
    let place = Workplace::new();
    place.write("scene.toml", &scene_file());
    for out in ["new/", "new/."] {
        place
            .phase(&["run", "scene.toml", "--out", out])
            .code(2)
            .complains("this is the name of a folder");
    }
}

/// Two balls, the lower on a sphere that shakes, in a tank.
fn balls(places: &str, more: &str) -> String {
    format!(
        "{more}
        spheres = {{ count = 2, radius = 0.01, density = 2500.0 }}
        contact = {{ law = 'hertz', young_modulus = 1e7, poisson_ratio = 0.3, restitution = 0.8 }}
        gravity = {{ acceleration = 9.81 }}
        tank = {{ floor = 0.0 }}
        guards = {{ horizontal = 100.0 }}
        start = {{ kind = 'list', spheres = [{places}] }}
        time = {{ dt = 2e-5, duration = 0.1, frame_interval = 0.01 }}
        output = {{ snapshot_interval = 0.0 }}"
    )
}

/// Symptom: spheres that a list put deep into a wall or into each other were thrown out, and
/// nothing said why. A warning names sphere, partner, depth and speed.
#[test]
fn a_warning_names_overlaps_at_the_start() {
    let place = Workplace::new();
    let apart = "{ position = [0.0, 0.0, 0.01] }, { position = [0.1, 0.0, 0.01] }";
    place.write("apart.toml", &balls(apart, ""));
    let in_the_floor = apart.replace("[0.1, 0.0, 0.01]", "[0.1, 0.0, 0.004]");
    place.write("floor.toml", &balls(&in_the_floor, ""));
    let in_each_other = apart.replace("[0.1, 0.0, 0.01]", "[0.01, 0.0, 0.01]");
    place.write("pair.toml", &balls(&in_each_other, ""));
    let words = |name: &str| {
        [
            format!("warning: sphere 1 starts 6.000e-3 m (0.600 radii) deep in {name}"),
            "faster than any impact expected in this scene (0.443 m/s)".to_owned(),
        ]
    };
    for (file, words) in [
        ("apart.toml", None),
        ("floor.toml", Some(words("the floor"))),
        (
            "pair.toml",
            Some(words("sphere 0").map(|it| it.replace("6.000e-3 m (0.600", "1.000e-2 m (1.000"))),
        ),
    ] {
        for arguments in [&["check", file, "--no-trial"][..], &["run", file]] {
            let answer = place.phase(arguments).code(0);
            match &words {
                None => assert!(!answer.stderr.contains("warning"), "{answer:?}"),
                Some([what, why]) => drop(answer.complains(what).complains(why)),
            }
        }
    }
}

/// A ball on a sphere that shakes at 100 Hz, four times gravity, with what ends the run when all is
/// at rest: the ball is not, and the shaken sphere does not count.
#[test]
fn a_shaken_scene_may_wait_for_rest() {
    let place = Workplace::new();
    let driven = "rest = { kinetic_energy = 1e-6, hold = 0.03 }
        driven = [{ sphere = 0, amplitude = [0.0, 0.0, 1e-4], angular_frequency = 628.3 }]";
    let on_it = "{ position = [0.0, 0.0, 0.02] }, { position = [0.0, 0.0, 0.04] }";
    let beside = "{ position = [0.0, 0.0, 0.02] }, { position = [0.1, 0.0, 0.01] }";
    for (file, places, ends) in [("on.toml", on_it, false), ("beside.toml", beside, true)] {
        place.write(file, &balls(places, driven));
        let integrators = [
            "symplectic-euler",
            "velocity-verlet",
            "synchronised-verlet",
            "adaptive-verlet",
        ];
        for integrator in integrators {
            let set = format!("time.integrator={integrator}");
            let answer = place.phase(&["run", file, "--set", &set, "--out", "run.h5"]);
            answer.code(0).says("completed");
            let record = phase::store::read_record(&place.path("run.h5")).unwrap();
            assert_eq!(
                record.milestones.len(),
                usize::from(ends),
                "{file} {integrator}"
            );
        }
    }
}

/// A packing that passes the check is made.
#[test]
fn packings_between_near_walls_are_made() {
    let place = Workplace::new();
    for side in [1.0, 1.0001, 1.5, 2.2] {
        let scene = format!(
            "spheres = {{ count = 20, radius = 0.5, density = 1.9 }}
            contact = {{ law = 'silbert', stiffness = 2e5, damping = 50.0 }}
            gravity = {{ acceleration = 1.0 }}
            tank = {{ width = {side}, depth = {side}, floor = 0.0 }}
            start = {{ kind = 'packing' }}
            time = {{ dt = 1e-4, duration = 0.01, frame_interval = 1e-3 }}
            output = {{ snapshot_interval = 0.0 }}"
        );
        place.write("packed.toml", &scene);
        place.phase(&["check", "packed.toml"]).code(0);
        let answer = place.phase(&["run", "packed.toml"]);
        answer.code(0).says("completed");
    }
}

/// Symptom: of two `--set` of one key the last one counted, without a word.
#[test]
fn a_key_is_set_once() {
    let place = Workplace::new();
    place.write("scene.toml", &scene_file());
    let check = |settings: [&str; 2]| {
        let [one, other] = settings;
        let arguments = [
            "check",
            "scene.toml",
            "--no-trial",
            "--set",
            one,
            "--set",
            other,
        ];
        place.phase(&arguments)
    };
    for settings in [
        ["swirl.omega=3", "swirl.omega=4"],
        ["swirl.omega=3", "swirl={ omega = 3 }"],
    ] {
        check(settings)
            .code(2)
            .complains("--set swirl.omega: this key is set twice; set it once");
    }
    check(["swirl.omega=3", "time.duration=1"]).code(0);
}

/// Symptom: `--seed 3 --set seed=5` ran seed 3, and `--set x=1 --without x` set x, without a word.
/// Cause: options that change the scene were applied one after the other, and none knew of another.
#[test]
fn options_that_contradict_each_other_are_refused() {
    let place = Workplace::new();
    place.write("scene.toml", &scene_file());
    let run = |more: &[&str]| {
        let run = ["run", "scene.toml", "--out", "run.h5"];
        place.phase(&[&run[..], more].concat())
    };
    let (set, without) = ("--set", "--without");
    let interval = "output.snapshot_interval";
    for (more, one, other) in [
        (&["--seed", "3", set, "seed=5"][..], "--seed", "--set seed"),
        (
            &["--trajectory", set, "output.trajectory=false"],
            "--trajectory",
            "--set output.trajectory",
        ),
        (
            &["--ledger", set, "output={ ledger = false }"],
            "--ledger",
            "--set output.ledger",
        ),
        (
            &[
                "--snapshot-interval",
                "0.1",
                set,
                "output.snapshot_interval=0.2",
            ],
            "--snapshot-interval",
            &format!("--set {interval}"),
        ),
        (
            &[set, "swirl.omega=1", without, "swirl.omega"],
            "--set swirl.omega",
            "--without swirl.omega",
        ),
        (
            &[set, "swirl.omega=1", without, "swirl"],
            "--set swirl.omega",
            "--without swirl",
        ),
    ] {
        let answer = run(more).code(2);
        answer.complains(&format!("{one} and {other} "));
        assert!(!place.path("run.h5").exists());
    }
    place
        .phase(&[
            "check",
            "scene.toml",
            set,
            "swirl.omega=1",
            without,
            "swirl",
        ])
        .code(2)
        .complains("contradict each other; leave one out");
    // Other keys of the same table do not.
    run(&["--ledger", "--seed", "3", set, "output.trajectory=true"]).code(0);
}

/// Keys of walls are set as they are named in messages and axes.
#[test]
fn entries_of_lists_are_set() {
    let place = Workplace::new();
    let wall = "[[wall]]\ndisc = { centre = [0.0, 0.0, 0.5], radius = 0.02 }\n";
    place.write("scene.toml", &(scene_file() + wall));
    let run = |set: &str| place.phase(&["run", "scene.toml", "--set", set, "--out", "run.h5"]);
    run("wall[0].disc.radius=0.01").code(0);
    let record = phase::store::read_record(&place.path("run.h5")).unwrap();
    assert_eq!(
        record.scene.dem.walls[0].disc.as_ref().unwrap().radius,
        0.01
    );
    run("wall[0].disc.radius=-1").code(2).complains("--set");
    run("wall[1].disc.radius=0.01")
        .code(2)
        .complains("--set wall[1].disc.radius: not in a table, or in no entry of a list");
}
