//! `phase sweep`: jobs that go on.

use crate::support::{TinySweep, Workplace, damage, wait_until};
use std::fs;
use std::path::PathBuf;

/// Checkpoints of the jobs in `results`.
pub(crate) fn checkpoints(place: &Workplace) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(place.path("results/records")) else {
        return Vec::new();
    };
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .filter(|path| path.extension().is_some_and(|it| it == "checkpoint"))
        .collect()
}

/// A sweep whose jobs take some tenths of a second with a checkpoint at every frame.
fn slow() -> TinySweep {
    TinySweep {
        duration: 24.0,
        ..TinySweep::slow()
    }
}

/// A place where a sweep was killed after its first job, in the middle of the second.
fn killed_sweep() -> Workplace {
    let place = Workplace::new();
    place.write("tiny.toml", &slow().text());
    let arguments = [
        "sweep",
        "tiny.toml",
        "--out",
        "results",
        "-j",
        "1",
        "--checkpoint-interval",
        "0",
    ];
    let mut killed = place.start(&arguments);
    // A record is there an instant before the checkpoint of its job goes.
    let under_way = || {
        checkpoints(&place)
            .iter()
            .any(|it| !it.with_extension("h5").exists())
    };
    wait_until(|| !place.records("results").is_empty() && under_way());
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert_eq!(checkpoints(&place).len(), 1);
    place
}

#[test]
fn a_killed_sweep_goes_on_in_the_middle_of_a_job() {
    let place = killed_sweep();
    // How far that job is, is told meanwhile.
    let status = place.phase(&["status", "results", "--json"]).code(0);
    let status: serde_json::Value = serde_json::from_str(&status.stdout).unwrap();
    let under_way = &status["folders"][0]["under_way"];
    let [frame, frames] = ["frame", "frames"].map(|key| under_way[0][key].as_u64().unwrap());
    assert!(0 < frame && frame < frames, "{frame} of {frames}");
    place
        .phase(&["status", "results"])
        .code(0)
        .says("under way  omega = ")
        .says(&format!("checkpoint at frame {frame} of {frames}, "));
    let answer = place
        .phase(&[
            "sweep",
            "tiny.toml",
            "--out",
            "results",
            "--no-plot",
            "--json",
        ])
        .code(0);
    let answer: serde_json::Value = serde_json::from_str(&answer.stdout).unwrap();
    assert_eq!(answer["resumed"], 1);
    assert!(checkpoints(&place).is_empty());
    place
        .phase(&["sweep", "tiny.toml", "--out", "whole", "--no-plot"])
        .code(0);
    assert_eq!(place.digests("results"), place.digests("whole"));
    assert_eq!(
        place.read("results/labels.csv"),
        place.read("whole/labels.csv")
    );
}

#[test]
fn a_sweep_starts_a_job_anew_whose_checkpoint_is_damaged() {
    let place = killed_sweep();
    let path = &checkpoints(&place)[0];
    damage(path);
    place
        .phase(&["sweep", "tiny.toml", "--out", "results", "--no-plot"])
        .code(0)
        .complains("starts from the beginning: ")
        .complains("this checkpoint is damaged");
    assert!(checkpoints(&place).is_empty());
    assert_eq!(place.records("results").len(), slow().jobs());
}

/// A process that is killed right after it stored a record leaves the checkpoint of a job that is
/// done, which nobody would ever read.
#[test]
fn checkpoints_of_jobs_that_are_done_are_removed() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    let sweep = ["sweep", "tiny.toml", "--out", "results", "--no-plot"];
    place.phase(&sweep).code(0);
    let record = place
        .path("results/records")
        .join(&place.records("results")[0]);
    fs::write(record.with_extension("checkpoint"), "").unwrap();
    place.phase(&sweep).code(0);
    assert!(checkpoints(&place).is_empty());
}
