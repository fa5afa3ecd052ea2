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
