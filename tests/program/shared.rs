//! Several processes that work on one results folder.

use crate::support::{Answer, TinySweep, Workplace, end, signal, wait_until};
use std::fs;
use std::time::Duration;

/// Runs of a tenth of a second each.
fn slow() -> TinySweep {
    TinySweep {
        omegas: vec![0.0, 2.0, 4.0, 6.0, 8.0],
        duration: 40.0,
        ..TinySweep::slow()
    }
}

const SWEEP: [&str; 6] = ["sweep", "tiny.toml", "--out", "shared", "--jobs", "1"];

/// Number of jobs that a sweep has run.
fn run_now(answer: &Answer) -> usize {
    let text = answer.stdout.split(" run now").next().unwrap();
    let number = text.rsplit([' ', '\n']).next().unwrap();
    number
        .parse()
        .unwrap_or_else(|_| panic!("{}", answer.stdout))
}

fn leases(place: &Workplace) -> usize {
    let files = fs::read_dir(place.path("shared/records")).unwrap();
    let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
    names.filter(|name| name.ends_with(".lease")).count()
}

/// Each run is made once, and the last process to end writes the tables.
#[test]
fn processes_share_the_runs_of_a_sweep() {
    let place = Workplace::new();
    place.write("tiny.toml", &slow().text());
    let children: Vec<_> = (0..3).map(|_| place.start(&SWEEP)).collect();
    let answers: Vec<Answer> = children.into_iter().map(end).collect();
    for answer in &answers {
        assert_eq!(answer.code, Some(0), "{}{}", answer.stdout, answer.stderr);
    }
    let made: Vec<usize> = answers.iter().map(run_now).collect();
    assert_eq!(made.iter().sum::<usize>(), slow().jobs(), "{made:?}");
    assert!(made.iter().filter(|it| **it > 0).count() > 1, "{made:?}");
    assert_eq!(leases(&place), 0);
    place
        .phase(&["sweep", "tiny.toml", "--out", "alone"])
        .code(0);
    assert_eq!(place.digests("shared"), place.digests("alone"));
    for file in ["labels.csv", "points.csv", "sweep.json", "phase.svg"] {
        let [one, other] =
            ["shared", "alone"].map(|folder| place.read(&format!("{folder}/{file}")));
        assert!(one == other, "{file}");
    }
    place
        .phase(&["status", "shared"])
        .code(0)
        .says("10 done, 0 failed, 0 left")
        .says("running    no");
}

/// While a process is at work others may not run another sweep, run everything again, or change
/// labels.
#[test]
fn a_folder_at_work_is_not_changed() {
    let place = Workplace::new();
    let long = TinySweep {
        duration: 3000.0,
        ..slow()
    };
    place.write("tiny.toml", &long.text());
    place.write("other.toml", &slow().text());
    let mut child = place.start(&SWEEP);
    wait_until(|| leases_there(&place));
    for arguments in [
        &["sweep", "other.toml", "--out", "shared"][..],
        &["sweep", "tiny.toml", "--out", "shared", "--force"],
        &["classify", "shared", "--sweep", "tiny.toml"],
        // Symptom: labels of a sweep that had ended meanwhile were replaced by fewer.
        &["classify", "shared"],
    ] {
        place
            .phase(arguments)
            .code(2)
            .complains("another `phase` is at work in this folder, process ");
    }
    place
        .phase(&["status", "shared"])
        .code(0)
        .says("running    1 run, 1 process");
    child.kill().unwrap();
    child.wait().unwrap();
    place
        .phase(&["status", "shared"])
        .code(0)
        .says("running    no");
}

fn leases_there(place: &Workplace) -> bool {
    place.path("shared/records").exists() && leases(place) > 0
}

/// Symptom: two studies of one name replaced each other's tables and figures. Cause: only sweeps
/// were compared with the file that the folder was made from.
#[test]
fn studies_of_one_name_do_not_share_a_folder() {
    let place = Workplace::new();
    let [(text, _), _] = crate::studies::studies();
    for (folder, text) in [
        ("one", &text),
        ("other", &text.replace("count = 8", "count = 4")),
    ] {
        fs::create_dir(place.path(folder)).unwrap();
        place.write(&format!("{folder}/fall.toml"), text);
    }
    place
        .phase(&["study", "one/fall.toml", "--no-plot"])
        .code(0);
    place
        .phase(&["study", "other/fall.toml", "--no-plot"])
        .code(2)
        .complains("one/fall.toml, another study of the same name");
}

/// Symptom: two sweep files of one name in two folders shared their results without a word. Cause:
/// the folder has the name of the file alone.
#[test]
fn files_of_one_name_do_not_share_a_folder() {
    let place = Workplace::new();
    let (one, other) = (TinySweep::default(), slow());
    for (folder, sweep) in [("one", &one), ("other", &other), ("same", &one)] {
        fs::create_dir(place.path(folder)).unwrap();
        place.write(&format!("{folder}/tiny.toml"), &sweep.text());
    }
    place.phase(&["sweep", "one/tiny.toml"]).code(0);
    place
        .phase(&["sweep", "other/tiny.toml"])
        .code(2)
        .complains("results/tiny: this folder holds the results of ")
        .complains(
            "one/tiny.toml, another sweep of the same name; choose another folder with --out",
        );
    // The same runs are no other sweep, an edited file is itself, and --out is a wish.
    place
        .phase(&["sweep", "same/tiny.toml"])
        .code(0)
        .says("6 jobs: 0 run now");
    let edited = TinySweep {
        seeds: vec![1],
        ..one
    };
    place.write("same/tiny.toml", &edited.text());
    place
        .phase(&["sweep", "same/tiny.toml"])
        .code(0)
        .says("3 jobs: 0 run now");
    place
        .phase(&["sweep", "one/tiny.toml", "--out", "results/tiny"])
        .code(0)
        .says("6 jobs: 0 run now");
}

/// Symptom: the run of a killed process was left to the next command. Cause: nobody waited for it.
#[cfg(unix)]
#[test]
fn the_run_of_a_killed_process_is_taken_over_by_one_at_work() {
    let place = Workplace::new();
    place.write("tiny.toml", &slow().text());
    let mut killed = place.start(&SWEEP);
    // Stopped in the middle of a run, it keeps its lease.
    wait_until(|| {
        if !leases_there(&place) {
            return false;
        }
        signal(&killed, "STOP");
        let is_at_work = leases(&place) == 1;
        if !is_at_work {
            signal(&killed, "CONT");
        }
        is_at_work
    });
    let other = place.start(&SWEEP);
    wait_until(|| place.records("shared").len() >= slow().jobs() - 1);
    std::thread::sleep(Duration::from_millis(300));
    killed.kill().unwrap();
    killed.wait().unwrap();
    let answer = end(other);
    assert_eq!(answer.code, Some(0), "{}{}", answer.stdout, answer.stderr);
    let waits = "waiting for 1 job that other processes are making";
    assert!(answer.stderr.contains(waits), "{}", answer.stderr);
    assert!(
        answer.stdout.contains("10 runs labelled"),
        "{}",
        answer.stdout
    );
    assert_eq!(place.records("shared").len(), slow().jobs());
    assert_eq!(leases(&place), 0);
}

/// A sweep waits for a process that has the folder alone for some seconds, such as a long
/// `classify`.
#[test]
fn a_sweep_waits_for_a_process_that_changes_labels() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    place.phase(&["sweep", "tiny.toml"]).code(0);
    let folder = phase::sweep::Folder::new(place.path("results/tiny"));
    let classify = folder.lock(&|_| {}).unwrap();
    let mut sweep = place.start(&["sweep", "tiny.toml"]);
    std::thread::sleep(Duration::from_secs(1));
    assert!(sweep.try_wait().unwrap().is_none());
    drop(classify);
    end(sweep).code(0).says("6 done before");
}

/// One that is asked to end gives its leases back.
#[cfg(unix)]
#[test]
fn an_interrupted_process_leaves_no_lease() {
    let place = Workplace::new();
    let long = TinySweep {
        duration: 3000.0,
        ..slow()
    };
    place.write("tiny.toml", &long.text());
    let child = place.start(&SWEEP);
    wait_until(|| leases_there(&place));
    signal(&child, "TERM");
    end(child).code(130);
    assert_eq!(leases(&place), 0);
}

/// Processes that refine one sweep choose the same rounds, and wait for each other.
#[test]
fn processes_share_the_rounds_of_a_refined_sweep() {
    let place = Workplace::new();
    let sweep = TinySweep {
        omegas: (0..16).map(f64::from).collect(),
        duration: 10.0,
        ..TinySweep::slow()
    };
    let text = sweep.text().replace("[seeds]\nlist = [1, 2]\n", "");
    let text = text + "[refine]\nbudget = 14\nstart = [6]\nround = 4\nreplicates = 2\n";
    place.write("tiny.toml", &text);
    let children: Vec<_> = (0..2).map(|_| place.start(&SWEEP)).collect();
    let answers: Vec<Answer> = children.into_iter().map(end).collect();
    for answer in &answers {
        assert_eq!(answer.code, Some(0), "{}{}", answer.stdout, answer.stderr);
    }
    let made: Vec<usize> = answers.iter().map(run_now).collect();
    assert_eq!(made.iter().sum::<usize>(), 14, "{made:?}");
    place
        .phase(&["sweep", "tiny.toml", "--out", "alone"])
        .code(0);
    for file in ["labels.csv", "borders.csv", "sweep.json", "progress.json"] {
        let [one, other] =
            ["shared", "alone"].map(|folder| place.read(&format!("{folder}/{file}")));
        assert_eq!(one, other, "{file}");
    }
}

/// The lease of a process on a machine that is gone.
fn dead_lease(place: &Workplace, name: &str) {
    let text = r#"{"host":"gone","process":1,"since":1,"serial":0}"#;
    place.write(&format!("results/tiny/{name}.lease"), text);
}

/// Symptom: a dead process on another machine kept all others out for ever, and later for two
/// minutes with each of its leases. Cause: they gave up after ten seconds, and began to watch it
/// anew each time; leases were watched one after the other.
#[test]
#[ignore = "watches for two minutes"]
fn leases_of_a_dead_machine_are_broken() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    place.phase(&["sweep", "tiny.toml"]).code(0);
    fs::remove_file(place.path("results/tiny/labels.csv")).unwrap();
    for name in [".door", ".at-work-gone-1-0", ".at-work-gone-2-0", ".labels"] {
        dead_lease(&place, name);
    }
    let begun = std::time::Instant::now();
    place
        .phase(&["sweep", "tiny.toml", "--force"])
        .code(0)
        .complains("watching for up to two minutes whether process 1 on gone is still at work")
        .says("6 runs labelled");
    // All at once.
    assert!(
        begun.elapsed() < Duration::from_secs(230),
        "{:?}",
        begun.elapsed()
    );
}
