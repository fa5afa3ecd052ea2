//! `phase run` and `phase check`.

use super::bench::swept;
use crate::support::{TinySweep, Workplace, drainage_file, scene_file};

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
        .complains("--point is a job of a sweep");
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

/// Symptom: a panic, and messages for those who write programs.
#[test]
fn scenes_without_a_search_are_refused() {
    let place = Workplace::new();
    place.write("spots.toml", &drainage_file());
    place
        .phase(&["neighbours", "spots.toml"])
        .code(2)
        .complains("spots.toml: spots search no contacts");
    let driven = "[[driven]]\nsphere = 2\nvelocity = [0.0, 0.0, 0.0]\n";
    place.write("driven.toml", &(scene_file() + driven));
    let answer = place.phase(&["neighbours", "driven.toml", "--count", "1"]);
    assert!(!answer.stderr.contains("panicked"), "{answer:?}");
    place
        .phase(&["neighbours", "driven.toml", "--count", "4000000000"])
        .code(2);
}
