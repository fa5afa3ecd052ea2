//! `phase run`: interrupted, resumed, refused, and two at once.

use super::bench::{digest, interrupted_by, resume, slow_scene, whole};
use crate::support::{TinySweep, Workplace, damage, end, signal, wait_until};
use phase::record::Program;
use phase::store::content_digest;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::Child;

#[test]
fn an_interrupted_run_goes_on_from_its_checkpoint() {
    for name in ["INT", "TERM", "KILL"] {
        let place = interrupted_by(name);
        let answer = resume(&place, &["--json"])
            .code(0)
            .complains("continuing at ")
            .complains("from run.checkpoint");
        let answer: serde_json::Value = serde_json::from_str(&answer.stdout).unwrap();
        assert!(answer["resumed_from"].as_f64().unwrap() > 0.0);
        assert!(!place.path("run.checkpoint").exists());
        place
            .phase(&["run", "scene.toml", "--out", "whole.h5"])
            .code(0);
        assert_eq!(
            digest(&place.path("run.h5")),
            digest(&place.path("whole.h5"))
        );
    }
}

#[test]
fn without_a_checkpoint_a_run_starts_from_the_beginning() {
    let place = Workplace::new();
    place.write("scene.toml", &crate::support::scene_file());
    resume(&place, &[])
        .code(0)
        .complains("no checkpoint run.checkpoint; starting from the beginning");
    assert!(place.path("run.h5").exists());
    assert!(!place.path("run.checkpoint").exists());
}

/// Who forgets `--resume` and stops the run at once has lost nothing.
#[test]
fn a_run_from_the_beginning_replaces_a_checkpoint_only_with_one_of_its_own_time() {
    let place = interrupted_by("INT");
    let before = fs::read(place.path("run.checkpoint")).unwrap();
    let mut child = place.start(&["run", "scene.toml", "--out", "run.h5"]);
    let stderr = child.stderr.take().unwrap();
    let mut lines = BufReader::new(stderr).lines().map(Result::unwrap);
    let line = lines.find(|line| line.contains("run.checkpoint")).unwrap();
    assert!(
        line.contains("replaces the checkpoint run.checkpoint"),
        "{line}"
    );
    assert!(line.contains("--resume would continue"), "{line}");
    signal(&child, "INT");
    end(child).code(130);
    assert_eq!(fs::read(place.path("run.checkpoint")).unwrap(), before);

    // To the end: the checkpoint is of no use any more.
    place
        .phase(&["run", "scene.toml", "--out", "run.h5"])
        .code(0);
    assert!(!place.path("run.checkpoint").exists());
}

/// Changes bytes and puts a checksum below that fits.
fn forge(path: &Path, change: impl FnOnce(&mut Vec<u8>)) {
    let mut bytes = fs::read(path).unwrap();
    bytes.truncate(bytes.len() - blake3::OUT_LEN);
    change(&mut bytes);
    let hash = blake3::hash(&bytes);
    bytes.extend_from_slice(hash.as_bytes());
    fs::write(path, bytes).unwrap();
}

pub(crate) fn replace(bytes: &mut [u8], text: &str, by: &str) {
    assert_eq!(text.len(), by.len());
    let mut windows = bytes.windows(text.len());
    let at = windows
        .position(|window| window == text.as_bytes())
        .unwrap();
    bytes[at..at + by.len()].copy_from_slice(by.as_bytes());
}

/// What is to be said of a checkpoint, and what was done to it.
type Spoil<'a> = (&'a str, &'a dyn Fn(&Path));

#[test]
fn nothing_goes_on_from_a_checkpoint_that_is_not_right() {
    let place = interrupted_by("INT");
    let path = place.path("run.checkpoint");
    let good = fs::read(&path).unwrap();
    let commit = Program::current().commit;
    let other_commit: String = commit
        .chars()
        .rev()
        .map(|it| if it == 'x' { 'y' } else { 'x' })
        .collect();
    let version = phase::store::CHECKPOINT_SIGNATURE.len();
    let spoils: [Spoil<'_>; 8] = [
        ("damaged or cut short: its checksum differs", &|path| {
            damage(path);
        }),
        ("damaged or cut short: its checksum differs", &|path| {
            fs::write(path, &good[..good.len() - 1]).unwrap();
        }),
        ("damaged or cut short: it ends too early", &|path| {
            fs::write(path, &good[..10]).unwrap();
        }),
        ("damaged or cut short: it ends too early", &|path| {
            fs::write(path, "").unwrap();
        }),
        (
            "damaged or cut short: its content has another form",
            &|path| {
                forge(path, |bytes| bytes.truncate(bytes.len() - 10));
            },
        ),
        ("this checkpoint has format 99", &|path| {
            forge(path, |bytes| bytes[version] = 99);
        }),
        ("was written by phase", &|path| {
            forge(path, |bytes| replace(bytes, &commit, &other_commit));
        }),
        ("they differ in seed", &|path| {
            forge(path, |bytes| replace(bytes, "\"seed\":1,", "\"seed\":2,"));
        }),
    ];
    for (message, spoil) in spoils {
        fs::write(&path, &good).unwrap();
        spoil(&path);
        let spoilt = fs::read(&path).unwrap();
        resume(&place, &[])
            .code(2)
            .complains("run.checkpoint: ")
            .complains(message)
            .complains("without --resume the run starts from the beginning");
        assert_eq!(fs::read(&path).unwrap(), spoilt);
        assert!(!place.path("run.h5").exists());
    }

    fs::write(&path, &good).unwrap();
    for (option, key) in [("--trajectory", "output.trajectory"), ("--seed=7", "seed")] {
        resume(&place, &[option])
            .code(2)
            .complains(&format!("they differ in {key}"));
    }
    assert_eq!(fs::read(&path).unwrap(), good);

    fs::write(&path, "something of somebody").unwrap();
    let runs = [
        resume(&place, &[]),
        place.phase(&["run", "scene.toml", "--out", "run.h5"]),
    ];
    for run in runs {
        run.code(2)
            .complains("this is not a checkpoint")
            .complains("choose another name");
    }
    assert_eq!(place.read("run.checkpoint"), "something of somebody");
}

#[test]
fn a_job_that_is_run_again_goes_on_too() {
    let place = Workplace::new();
    let sweep = TinySweep {
        omegas: vec![4.0],
        seeds: vec![1],
        duration: 12.0,
        ..TinySweep::default()
    };
    place.write("tiny.toml", &sweep.text());
    place
        .phase(&["sweep", "tiny.toml", "--out", "results", "--no-plot"])
        .code(0);
    let again = [
        "run",
        "--from",
        "results",
        "--point",
        "omega=4",
        "--trajectory",
    ];
    let more = ["--checkpoint-interval", "0"];
    let child = place.start(&[&again[..], &more[..]].concat());
    wait_until(|| {
        place
            .path("results/runs/omega-4_seed-1.checkpoint")
            .exists()
    });
    signal(&child, "INT");
    end(child).code(130);
    place
        .phase(&[&again[..], &["--resume"]].concat())
        .code(0)
        .complains("continuing at ")
        .says("same bits as in the sweep");
}

/// A run under way with a checkpoint at every frame, and its first one.
pub(crate) fn under_way(place: &Workplace, out: &str) -> Child {
    place.write("scene.toml", &slow_scene());
    let arguments = ["run", "scene.toml", "--checkpoint-interval", "0", "--out"];
    let child = place.start(&[&arguments[..], &[out]].concat());
    wait_until(|| place.path(out).with_extension("checkpoint").exists());
    child
}

/// Symptom: two runs of one record at once wrote each other's checkpoint, and the later one's
/// record replaced the other's. Cause: no lock.
#[test]
fn two_runs_do_not_share_a_record() {
    let place = Workplace::new();
    let mut first = under_way(&place, "run.h5");
    let second = ["run", "scene.toml", "--out", "run.h5"];
    place.phase(&second).code(2).complains(
        "run.h5: another `phase run` is writing this record; wait until it ends, or choose",
    );
    place
        .phase(&["run", "scene.toml", "--out", "else.h5"])
        .code(0);
    first.kill().unwrap();
    first.wait().unwrap();
    // The system gives the right of a killed run back.
    place.phase(&second).code(0);
    let names = fs::read_dir(place.path(".")).unwrap();
    let mut names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    assert!(names.all(|name| !name.ends_with(".lease")));
}

/// Symptom: a run whose record could not be written had come to its end for nothing, or so it said.
#[test]
fn a_record_that_cannot_be_written_leaves_the_checkpoint() {
    let place = Workplace::new();
    let run = under_way(&place, "run.h5");
    fs::create_dir(place.path("run.h5")).unwrap();
    end(run)
        .code(1)
        .complains("cannot write run.h5")
        .complains("is kept: the same command with --resume continues from there (run.checkpoint)");
    fs::remove_dir(place.path("run.h5")).unwrap();
    resume(&place, &[]).code(0).complains("continuing at ");
    let expected = whole(&phase::scene::Scene::load(&place.path("scene.toml")).unwrap());
    let found = digest(&place.path("run.h5"));
    assert_eq!(found, content_digest(&expected).unwrap());
}

/// Symptom: a record was lost whose folder somebody had removed meanwhile.
#[test]
fn a_folder_that_was_removed_is_made_again_for_the_record() {
    let place = Workplace::new();
    let run = under_way(&place, "out/run.h5");
    fs::rename(place.path("out"), place.path("away")).unwrap();
    end(run).code(0);
    assert!(place.path("out/run.h5").exists());
}
