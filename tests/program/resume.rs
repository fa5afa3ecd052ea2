//! A sweep that was stopped goes on; what is done is not done again, and nothing is lost.

use crate::support::{TinySweep, Workplace, damage, end, signal, wait_until};
use std::fs;
use std::process::Command;

/// Sweeps a file into `results`.
fn sweep(place: &Workplace, sweep: &TinySweep) -> crate::support::Answer {
    place.write("tiny.toml", &sweep.text());
    place.phase(&["sweep", "tiny.toml", "--out", "results", "--no-plot"])
}

#[test]
fn a_second_run_does_nothing_again() {
    let place = Workplace::new();
    sweep(&place, &TinySweep::default())
        .code(0)
        .says("6 jobs: 6 run now");
    let digests = place.digests("results");
    assert_eq!(digests.len(), 6);
    let labels = place.read("results/labels.csv");
    sweep(&place, &TinySweep::default())
        .code(0)
        .says("6 jobs: 0 run now")
        .says("6 done before");
    assert_eq!(place.digests("results"), digests);
    assert_eq!(place.read("results/labels.csv"), labels);
}

#[test]
fn the_number_of_workers_changes_no_bit() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    for (results, workers) in [("one", "1"), ("two", "2")] {
        place
            .phase(&[
                "sweep",
                "tiny.toml",
                "--out",
                results,
                "-j",
                workers,
                "--no-plot",
            ])
            .code(0);
    }
    assert_eq!(place.digests("one"), place.digests("two"));
    assert_eq!(place.read("one/labels.csv"), place.read("two/labels.csv"));
    assert_eq!(place.read("one/points.csv"), place.read("two/points.csv"));
}

#[test]
#[ignore = "takes half a minute"]
fn a_killed_sweep_goes_on_where_it_was() {
    let place = Workplace::new();
    let slow = TinySweep::slow();
    place.write("tiny.toml", &slow.text());
    let mut killed = place.start(&["sweep", "tiny.toml", "--out", "results", "-j", "1"]);
    wait_until(|| place.records("results").len() >= 2);
    killed.kill().unwrap();
    killed.wait().unwrap();

    let done = place.records("results").len();
    assert!((2..slow.jobs()).contains(&done), "{done}");
    let written = |name: &str| {
        let path = place.path("results/records").join(name);
        fs::metadata(path).unwrap().modified().unwrap()
    };
    let before: Vec<_> = place
        .records("results")
        .into_iter()
        .map(|name| (written(&name), name))
        .collect();
    place
        .phase(&["status", "results"])
        .code(0)
        .says(&format!(
            "6 jobs, {done} done, 0 failed, {} left",
            slow.jobs() - done
        ))
        .says("time left  about ");

    sweep(&place, &slow)
        .code(0)
        .says(&format!("{} run now", slow.jobs() - done));
    for (time, name) in before {
        assert_eq!(written(&name), time, "{name} was written again");
    }
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
fn an_interrupted_sweep_ends_soon_and_says_how_to_go_on() {
    for name in ["INT", "TERM"] {
        let place = Workplace::new();
        let slow = TinySweep {
            duration: 3000.0,
            ..TinySweep::slow()
        };
        place.write("tiny.toml", &slow.text());
        let child = place.start(&["sweep", "tiny.toml", "--out", "results"]);
        wait_until(|| place.path("results/sweep.json").exists());
        signal(&child, name);
        end(child)
            .code(130)
            .complains("6 jobs left")
            .complains("same command");
        place
            .phase(&["status", "results"])
            .code(0)
            .says("0 done, 0 failed, 6 left");
        // Checkpoints of what was under way, and nothing else.
        for file in fs::read_dir(place.path("results/records")).unwrap() {
            let path = file.unwrap().path();
            assert!(path.extension().unwrap() == "checkpoint", "{path:?}");
        }
    }
}

/// Symptom: a preempted task left no checkpoint. Cause: Slurm asks all processes of a task to end,
/// its script hands its own request on, and the second one ended the program at once.
#[test]
fn two_requests_to_end_leave_checkpoints() {
    let place = Workplace::new();
    let slow = TinySweep {
        duration: 3000.0,
        ..TinySweep::slow()
    };
    place.write("tiny.toml", &slow.text());
    let files = |end: &str| {
        let files = fs::read_dir(place.path("results/records"))
            .into_iter()
            .flatten();
        let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
        names.filter(|name| name.ends_with(end)).count()
    };
    let child = place.start(&["sweep", "tiny.toml", "--out", "results"]);
    wait_until(|| files(".lease") > 0);
    std::thread::sleep(std::time::Duration::from_millis(300));
    for _ in 0..2 {
        signal(&child, "TERM");
    }
    end(child).code(130).complains("6 jobs left");
    assert!(files(".checkpoint") > 0);
}

#[test]
fn only_new_parameters_are_run() {
    let place = Workplace::new();
    sweep(&place, &TinySweep::default()).code(0);
    let more = TinySweep {
        omegas: vec![0.0, 6.0, 8.0],
        ..TinySweep::default()
    };
    sweep(&place, &more)
        .code(0)
        .says("6 jobs: 2 run now")
        .says("4 done before")
        .says("6 runs labelled")
        .complains("the sweep has changed");
    assert_eq!(place.records("results").len(), 8);
}

#[test]
fn other_output_makes_a_record_anew() {
    let place = Workplace::new();
    sweep(&place, &TinySweep::default()).code(0);
    let more = "[scene.output]\ntrajectory = true".to_owned();
    sweep(
        &place,
        &TinySweep {
            more,
            ..TinySweep::default()
        },
    )
    .code(0)
    .says("6 jobs: 6 run now");
}

#[test]
fn force_runs_everything_again() {
    let place = Workplace::new();
    sweep(&place, &TinySweep::default()).code(0);
    place
        .phase(&[
            "sweep",
            "tiny.toml",
            "--out",
            "results",
            "--force",
            "--no-plot",
        ])
        .code(0)
        .says("6 jobs: 6 run now");
}

#[test]
fn a_record_of_other_parameters_is_refused_by_name() {
    let place = Workplace::new();
    sweep(
        &place,
        &TinySweep {
            seeds: vec![1],
            ..TinySweep::default()
        },
    )
    .code(0);
    let [a, b] = [0, 1].map(|index| {
        place
            .path("results/records")
            .join(&place.records("results")[index])
    });
    fs::copy(&a, &b).unwrap();
    let again = sweep(
        &place,
        &TinySweep {
            seeds: vec![1],
            ..TinySweep::default()
        },
    )
    .code(2);
    let again = again
        .complains("differ in swirl.omega")
        .complains("--force");
    assert!(
        again
            .stderr
            .contains(b.file_name().unwrap().to_str().unwrap()),
        "{}",
        again.stderr
    );
    place
        .phase(&["status", "results"])
        .code(0)
        .says("2 done")
        .says("to redo    1 record");
    place
        .phase(&["sweep", "tiny.toml", "--out", "results", "--force"])
        .code(0)
        .says("3 run now");
}

#[test]
fn a_damaged_record_is_made_anew() {
    let place = Workplace::new();
    sweep(&place, &TinySweep::default()).code(0);
    let digests = place.digests("results");
    let name = &place.records("results")[3];
    damage(&place.path("results/records").join(name));
    place
        .phase(&["status", "results"])
        .code(0)
        .says("5 done, 0 failed, 1 left")
        .says("to redo    1");
    place
        .phase(&["classify", "results"])
        .code(1)
        .complains("no label")
        .complains(name);
    sweep(&place, &TinySweep::default())
        .code(0)
        .says("6 jobs: 1 run now")
        .complains(&format!(
            "running job {} again",
            name.trim_end_matches(".h5")
        ));
    assert_eq!(place.digests("results"), digests);
}

#[test]
fn leftovers_of_a_killed_sweep_are_removed() {
    let place = Workplace::new();
    sweep(&place, &TinySweep::default()).code(0);
    place.write("results/records/.phase-abc.tmp", "half a record");
    sweep(&place, &TinySweep::default()).code(0);
    assert!(!place.path("results/records/.phase-abc.tmp").exists());
}

/// A small file system in memory, gone when dropped.
struct Disk(std::path::PathBuf);

impl Disk {
    fn mount(path: std::path::PathBuf, options: &str) -> Option<Self> {
        fs::create_dir_all(&path).unwrap();
        let mut mount = Command::new("mount");
        mount
            .args(["-t", "tmpfs", "-o", options, "tmpfs"])
            .arg(&path);
        let mounted = mount.output().is_ok_and(|output| output.status.success());
        mounted.then_some(Self(path))
    }

    fn resize(&self, options: &str) {
        let mut mount = Command::new("mount");
        mount.args(["-o", options]).arg(&self.0);
        assert!(mount.status().unwrap().success());
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).status();
    }
}

#[test]
#[expect(clippy::print_stderr, reason = "says that it is skipped")]
fn a_full_disk_is_a_clear_error_and_loses_nothing() {
    let place = Workplace::new();
    let Some(disk) = Disk::mount(place.path("results"), "size=256k") else {
        eprintln!("skipped: mounting a small file system needs root");
        return;
    };
    let many = TinySweep {
        seeds: (1..20).collect(),
        frame_interval: 0.001,
        ..TinySweep::default()
    };
    sweep(&place, &many)
        .code(1)
        .complains("disk full")
        .complains("same command");
    let done = place.digests("results").len();
    assert!((1..many.jobs()).contains(&done), "{done}");

    disk.resize("remount,size=64m");
    sweep(&place, &many)
        .code(0)
        .says(&format!("{done} done before"));
    assert_eq!(place.digests("results").len(), many.jobs());
}

/// Symptom: records of any build were taken over without a word.
#[test]
fn records_of_another_build_are_told_of() {
    let place = Workplace::new();
    sweep(&place, &TinySweep::default()).code(0);
    for name in &place.records("results")[..2] {
        let path = place.path("results/records").join(name);
        let mut record = phase::store::read_record(&path).unwrap();
        record.program.commit = "abc123".to_owned();
        phase::store::write_record(&record, &path).unwrap();
    }
    let answer = sweep(&place, &TinySweep::default()).code(0);
    let version = env!("CARGO_PKG_VERSION");
    answer.complains(&format!(
        "2 records were made by version {version} (commit abc123); --force runs them again"
    ));
}
