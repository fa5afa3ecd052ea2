//! What each command prints, writes and returns.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod support;

use std::process::Stdio;
use support::{Answer, TinySweep, Workplace, scene_file};

/// A workplace whose `results/tiny` holds the default sweep.
fn swept(sweep: &TinySweep) -> (Workplace, Answer) {
    let place = Workplace::new();
    place.write("tiny.toml", &sweep.text());
    let answer = place.phase(&["sweep", "tiny.toml"]);
    (place, answer)
}

#[test]
fn one_command_makes_a_phase_diagram() {
    let (place, answer) = swept(&TinySweep::default());
    let answer = answer
        .code(0)
        .says("6 jobs: 6 run now")
        .says("6 runs labelled");
    for file in [
        "labels.csv",
        "points.csv",
        "phase.svg",
        "phase.png",
        "settle-time.svg",
        "settle-time.png",
    ] {
        let path = format!("results/tiny/{file}");
        assert!(
            answer.stdout.lines().any(|line| line == path),
            "{path} not in {}",
            answer.stdout
        );
        assert!(
            std::fs::metadata(place.path(&path)).unwrap().len() > 0,
            "{path}"
        );
    }
    assert!(place.path("results/tiny/sweep.json").exists());
    assert!(!place.path("results/tiny/failed.csv").exists());
    assert_eq!(place.records("results/tiny").len(), 6);
    assert_eq!(place.read("results/tiny/labels.csv").lines().count(), 7);
    assert_eq!(place.read("results/tiny/points.csv").lines().count(), 4);
}

#[test]
fn labels_and_figures_can_be_left_out() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    place
        .phase(&["sweep", "tiny.toml", "--no-classify"])
        .code(0);
    assert!(!place.path("results/tiny/labels.csv").exists());
    place
        .phase(&["plot", "results/tiny"])
        .code(2)
        .complains("run `phase classify results/tiny`");
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    assert!(place.path("results/tiny/labels.csv").exists());
    assert!(!place.path("results/tiny/phase.svg").exists());
}

#[test]
fn seeds_can_be_replaced() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    place
        .phase(&["sweep", "tiny.toml", "--seed", "7", "--no-plot"])
        .code(0)
        .says("3 jobs: 3 run");
    place
        .phase(&["sweep", "tiny.toml", "--seed", "7,8", "--no-plot"])
        .code(0)
        .says("6 jobs: 3 run");
}

#[test]
fn quiet_says_nothing_but_errors() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    let answer = place.phase(&["sweep", "tiny.toml", "--quiet"]).code(0);
    assert_eq!((answer.stdout.as_str(), answer.stderr.as_str()), ("", ""));
    let answer = place
        .phase(&["--quiet", "sweep", "absent.toml"])
        .code(2)
        .complains("absent.toml");
    assert_eq!(answer.stdout, "");
}

#[test]
fn verbose_names_every_job() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    let answer = place
        .phase(&["sweep", "tiny.toml", "--verbose", "--no-plot"])
        .code(0);
    for omega in ["0", "4", "8"] {
        for seed in ["1", "2"] {
            let name = format!("done: omega = {omega}, seed {seed} (job ");
            assert!(
                answer.stderr.contains(&name),
                "no {name} in {}",
                answer.stderr
            );
        }
    }
}

#[test]
fn unstable_runs_are_named_and_no_failure() {
    let more = "[scene.guards]\ndisplacement = 1e-6".to_owned();
    let (place, answer) = swept(&TinySweep {
        more,
        ..TinySweep::default()
    });
    answer
        .code(0)
        .says("6 unstable")
        .complains("unstable: omega = 0, seed 1 (job ")
        .complains("displacement guard at step");
    let labels = place.read("results/tiny/labels.csv");
    assert_eq!(
        labels
            .lines()
            .filter(|line| line.contains(",unstable,"))
            .count(),
        6,
        "{labels}"
    );
    place
        .phase(&["status", "results/tiny"])
        .code(0)
        .says("unstable   6 of those done");
}

#[test]
fn a_failed_job_does_not_stop_the_rest_and_is_listed() {
    let place = Workplace::new();
    // Spheres of 15.5 mm in a tank of 30 mm can only stand on each other: with some seeds the
    // first ones leave no room for the last.
    let seeds: Vec<u64> = (1..=20).collect();
    let text = TinySweep {
        seeds,
        ..TinySweep::default()
    }
    .text();
    let text = text.replace("\"swirl.omega\"", "\"spheres.radius\"");
    let text = text.replace("[0.0, 4.0, 8.0]", "[0.004, 0.0155]");
    let text = text
        .replace("z_min = 0.01", "z_min = 0.02")
        .replace("z_max = 0.05", "z_max = 0.23");
    place.write("tiny.toml", &text);
    let answer = place.phase(&["sweep", "tiny.toml"]).code(1);

    let table = place.read("results/tiny/failed.csv");
    let failed: Vec<_> = table.lines().skip(1).collect();
    assert!((1..20).contains(&failed.len()), "{table}");
    assert!(
        failed
            .iter()
            .all(|row| row.contains(",0.0155,") && row.contains("no room")),
        "{table}"
    );
    let (done, failed) = (40 - failed.len(), failed.len());
    let answer = answer
        .says(&format!("40 jobs: {done} run now"))
        .says(&format!("{failed} failed"));
    let named = answer
        .stderr
        .matches("error: failed: radius = 0.0155, seed ")
        .count();
    assert_eq!(named, failed, "{}", answer.stderr);
    assert_eq!(place.records("results/tiny").len(), done);
    assert!(place.path("results/tiny/phase.png").exists());

    let answer = place.phase(&["status", "results"]).code(0);
    let answer = answer.says(&format!("40 jobs, {done} done, {failed} failed, 0 left"));
    assert_eq!(
        answer
            .stdout
            .matches("failed     radius = 0.0155, seed ")
            .count(),
        failed
    );
}

#[test]
fn other_thresholds_change_labels_without_any_run() {
    let (place, answer) = swept(&TinySweep::default());
    answer.code(0);
    let records = place.digests("results/tiny");
    let labels = place.read("results/tiny/labels.csv");
    assert!(
        labels
            .lines()
            .skip(1)
            .all(|line| !line.contains(",unsettled,")),
        "{labels}"
    );
    place
        .phase(&["classify", "results/tiny"])
        .code(0)
        .says("0 of 6 labels changed");
    assert_eq!(place.read("results/tiny/labels.csv"), labels);

    let more = "[sieves.settle]\ntolerance = 1e-30".to_owned();
    place.write(
        "edited.toml",
        &TinySweep {
            more,
            ..TinySweep::default()
        }
        .text(),
    );
    place
        .phase(&["classify", "results/tiny", "--sweep", "edited.toml"])
        .code(0)
        .says("6 of 6 labels changed")
        .says("-> unsettled");
    let unsettled = place.read("results/tiny/labels.csv");
    assert_eq!(
        unsettled
            .lines()
            .filter(|line| line.contains(",unsettled,"))
            .count(),
        6
    );
    // The thresholds are kept, until the sweep is run with its own again.
    place
        .phase(&["classify", "results/tiny"])
        .code(0)
        .says("0 of 6 labels changed");
    place
        .phase(&["sweep", "tiny.toml"])
        .code(0)
        .says("6 jobs: 0 run")
        .says("6 of 6 labels changed");
    assert_eq!(place.read("results/tiny/labels.csv"), labels);
    assert_eq!(place.digests("results/tiny"), records);
}

#[test]
fn thresholds_of_other_runs_are_refused_by_name() {
    let (place, answer) = swept(&TinySweep {
        seeds: vec![1],
        ..TinySweep::default()
    });
    answer.code(0);
    let text = TinySweep {
        seeds: vec![1, 2],
        ..TinySweep::default()
    }
    .text();
    place.write(
        "edited.toml",
        &text.replace("density = 3750.0", "density = 3000.0"),
    );
    let labels = place.read("results/tiny/labels.csv");
    place
        .phase(&["classify", "results/tiny", "--sweep", "edited.toml"])
        .code(2)
        .complains("they differ in scene.spheres.density, seeds.");
    assert_eq!(place.read("results/tiny/labels.csv"), labels);
}

#[test]
fn a_folder_of_several_results_is_taken_as_all_of_them() {
    let place = Workplace::new();
    for name in ["a", "b"] {
        place.write(&format!("{name}.toml"), &TinySweep::default().text());
        place
            .phase(&["sweep", &format!("{name}.toml"), "--no-plot"])
            .code(0);
    }
    for (command, file) in [
        ("status", ": 6 jobs"),
        ("classify", "/labels.csv"),
        ("plot", "/phase.svg"),
    ] {
        let answer = place.phase(&[command, "results"]).code(0);
        for name in ["a", "b"] {
            let text = format!("results/{name}{file}");
            assert!(
                answer.stdout.contains(&text),
                "no {text} in {}",
                answer.stdout
            );
        }
    }
    place
        .phase(&["status", "absent"])
        .code(2)
        .complains("absent: there is no such folder");
    place
        .phase(&["status", "results/a/records"])
        .code(2)
        .complains("sweep.json");
}

#[test]
fn figures_are_drawn_by_name() {
    let (place, answer) = swept(&TinySweep::default());
    answer.code(0);
    let list = place.phase(&["plot", "--list"]).code(0).stdout;
    let names: Vec<_> = list
        .lines()
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert!(
        names.contains(&"phase") && names.contains(&"settle-time"),
        "{list}"
    );
    let other = names
        .iter()
        .find(|name| !["phase", "settle-time"].contains(name))
        .unwrap();
    let answer = place
        .phase(&["plot", "results/tiny", "--figure", other])
        .code(0);
    assert_eq!(
        answer.stdout,
        format!("results/tiny/{other}.svg\nresults/tiny/{other}.png\n")
    );
    place
        .phase(&["plot", "results/tiny", "--figure", "nonsense"])
        .code(2)
        .complains("`nonsense`");
}

#[test]
fn figures_of_single_runs_read_their_records() {
    let (place, answer) = swept(&TinySweep::default());
    answer.code(0);
    let plot = ["plot", "results/tiny", "--figure", "speeds", "--point"];
    let at = |point: &str| place.phase(&[&plot[..], &[point]].concat());
    at("omega=4,seed=2").code(0).says("results/tiny/speeds.png");
    at("omega=5").code(2).complains("`omega` is never 5");
    at("omega").code(2).complains("`name=value`");
    place
        .phase(&["plot", "results/tiny", "--point", "omega=4"])
        .code(2)
        .complains("--figure");
    std::fs::remove_dir_all(place.path("results/tiny/records")).unwrap();
    at("omega=4,seed=2")
        .code(1)
        .complains("the run at omega = 4, seed = 2: cannot read results/tiny/records/");
}

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
        .says("gravity, contact (Hertz), swirl, cylinder, floor");
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

#[test]
fn wrong_arguments_are_refused() {
    let place = Workplace::new();
    for arguments in [
        &["sweep"][..],
        &["nonsense"],
        &["sweep", "tiny.toml", "-j", "0"],
        &["sweep", "tiny.toml", "--seed", "one"],
        &["sweep", "tiny.toml", "--quiet", "--verbose"],
        &["plot"],
        &[],
    ] {
        let answer = place.phase(arguments).code(2);
        assert_eq!(answer.stdout, "");
    }
}

#[test]
fn every_command_has_an_example() {
    let place = Workplace::new();
    place
        .phase(&["--help"])
        .code(0)
        .says("Exit codes:")
        .says("130")
        .says("Example");
    for command in [
        "sweep",
        "classify",
        "plot",
        "run",
        "check",
        "cost",
        "status",
        "new",
        "schema",
        "reference",
        "completions",
        "man",
    ] {
        place
            .phase(&[command, "--help"])
            .code(0)
            .says("Example")
            .says(&format!("  phase {command} "));
    }
    place
        .phase(&["--version"])
        .code(0)
        .says(env!("CARGO_PKG_VERSION"));
}

#[test]
fn a_reader_that_goes_away_is_no_fault() {
    let place = Workplace::new();
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut command = place.command(&["plot", "--list"]);
    let output = command
        .stdout(writer)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
        .wait_with_output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
}
