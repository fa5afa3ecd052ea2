//! Files that cannot be written, one or all.

use crate::support::{TinySweep, Workplace};
use std::fs;

/// A workplace whose sweep has a folder in the place of one record, which can therefore not be
/// written. Gives the path of the record.
fn blocked(sweep: &TinySweep) -> (Workplace, String) {
    let place = Workplace::new();
    place.write("tiny.toml", &sweep.text());
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    let name = place.records("results/tiny")[0].clone();
    fs::remove_dir_all(place.path("results/tiny")).unwrap();
    let path = format!("results/tiny/records/{name}");
    fs::create_dir_all(place.path(&path)).unwrap();
    (place, path)
}

/// Symptom: one record that could not be written stopped the sweep for good ("0 run now, 3 left"),
/// and failed.csv said nothing. Cause: any error of writing counted as a full disk.
#[test]
fn a_record_that_cannot_be_written_is_a_failed_job() {
    let (place, path) = blocked(&TinySweep::default());
    let sweep = ["sweep", "tiny.toml", "--no-plot", "-j", "1"];
    for (now, before) in [(5, 0), (0, 5)] {
        let answer = place.phase(&sweep).code(1);
        let answer = answer
            .says(&format!("6 jobs: {now} run now"))
            .says("1 failed")
            .complains("error: failed: omega = ")
            .complains(&format!("cannot write {path}"));
        assert!(!answer.stdout.contains("left"), "{}", answer.stdout);
        assert_eq!(answer.stdout.contains("5 done before"), before == 5);
        let failed = place.read("results/tiny/failed.csv");
        assert_eq!(failed.lines().count(), 2, "{failed}");
        assert!(failed.contains("cannot write"), "{failed}");
        // The others have their labels.
        assert_eq!(place.read("results/tiny/labels.csv").lines().count(), 6);
    }
    // Symptom: the job was among those to redo, too. Cause: these were counted by their records.
    let status = place.phase(&["status", "results/tiny"]).code(0);
    let status = status.says("6 jobs, 5 done, 1 failed, 0 left");
    assert!(!status.stdout.contains("to redo"), "{}", status.stdout);
    // It is tried again.
    fs::remove_dir(place.path(&path)).unwrap();
    place
        .phase(&sweep)
        .code(0)
        .says("6 jobs: 1 run now")
        .says("6 runs labelled");
    assert!(!place.path("results/tiny/failed.csv").exists());
}

/// A refined sweep goes on without the label of a job whose record cannot be written.
#[test]
fn a_refined_sweep_goes_on_without_a_record() {
    let sweep = TinySweep {
        omegas: (0..12).map(f64::from).collect(),
        more: String::new(),
        ..TinySweep::default()
    };
    let text = sweep.text().replace("[seeds]\nlist = [1, 2]\n", "");
    let text = text + "[refine]\nbudget = 10\nstart = [4]\nround = 2\nreplicates = 1\n";
    let place = Workplace::new();
    place.write("tiny.toml", &text);
    let run = ["sweep", "tiny.toml", "--no-plot"];
    place.phase(&run).code(0);
    let name = place.records("results/tiny")[0].clone();
    fs::remove_dir_all(place.path("results/tiny")).unwrap();
    fs::create_dir_all(place.path(&format!("results/tiny/records/{name}"))).unwrap();
    let answer = place.phase(&run).code(1);
    answer.says("1 failed").says("refined with ");
    let failed = place.read("results/tiny/failed.csv");
    assert_eq!(failed.lines().count(), 2, "{failed}");
}

/// A checkpoint in the way of nobody, and leftovers that cannot be removed, stop no sweep.
#[test]
fn what_cannot_be_removed_stops_no_sweep() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    let sweep = ["sweep", "tiny.toml", "--no-plot"];
    place.phase(&sweep).code(0);
    let name = place.records("results/tiny")[0].replace(".h5", ".checkpoint");
    for folder in [
        format!("records/{name}"),
        "records/.phase-x-1-y.tmp".to_owned(),
    ] {
        fs::create_dir(place.path(&format!("results/tiny/{folder}"))).unwrap();
    }
    place.phase(&sweep).code(0).says("6 done before");
    let record = place.records("results/tiny")[0].clone();
    fs::remove_file(place.path(&format!("results/tiny/records/{record}"))).unwrap();
    place.phase(&sweep).code(0).says("6 jobs: 1 run now");
}

/// A file that is too large for a limit concerns one job; a full disk ends the sweep, and what has
/// ended is kept.
#[cfg(target_os = "linux")]
#[test]
fn a_limit_on_the_size_of_files_fails_the_jobs_beyond_it() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    let phase = env!("CARGO_BIN_EXE_phase");
    let script = format!("ulimit -f 16; {phase} sweep tiny.toml --no-plot");
    let output = std::process::Command::new("sh")
        .args(["-c", &script])
        .current_dir(place.path(""))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(
        said.contains("6 jobs: 0 run now") && said.contains("6 failed"),
        "{said}"
    );
    assert_eq!(place.read("results/tiny/failed.csv").lines().count(), 7);
    place
        .phase(&["sweep", "tiny.toml", "--no-plot"])
        .code(0)
        .says("6 run now");
}

/// Symptom: the message listed the columns of all families, and `compare` named no remedy.
#[test]
fn labels_that_are_empty_or_cut_are_refused_with_the_remedy() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    let path = "results/tiny/labels.csv";
    let whole = place.read(path);
    let cut = &whole[..whole.rfind(',').unwrap()];
    let lines = whole.lines().count();
    for (table, message) in [
        ("", "labels.csv:1: this file is empty".to_owned()),
        (
            "theirs\n",
            "labels.csv:1: this is not the header line".to_owned(),
        ),
        (cut, format!("labels.csv:{lines}: ")),
    ] {
        place.write(path, table);
        for command in ["plot", "compare"] {
            let folders = match command {
                "plot" => &["results/tiny"][..],
                _ => &["results/tiny", "results/tiny"],
            };
            let answer = place.phase(&[&[command], folders].concat()).code(1);
            let answer = answer
                .complains(&message)
                .complains("; `phase classify results/tiny` rewrites it");
            assert!(answer.stderr.len() < 300, "{}", answer.stderr);
        }
    }
    place.phase(&["classify", "results/tiny"]).code(0);
    assert_eq!(place.read(path), whole);
}
