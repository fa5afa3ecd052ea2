//! What all studies have in common: their runs are made like those of sweeps, and files and options
//! that are wrong are refused before any.

use crate::support::{Answer, Workplace, end};
use serde_json::Value;
use std::fs;

/// Eight spheres fall on a floor. Without drag a run takes some ten milliseconds.
const SCENE: &str = r#"
[scene.spheres]
count = 8
radius = 0.004
density = 1000.0

[scene.contact]
law = "hertz"
young_modulus = 1e5
poisson_ratio = 0.3
dissipation_time = 1e-3

[scene.tank]
radius = 0.02
floor = 0.0

[scene.start]
kind = "random"
z_min = 0.01
z_max = 0.06

[scene.gravity]
acceleration = 9.8

[scene.time]
dt = 1e-4
duration = 4.0
frame_interval = 4e-2
"#;

/// Two time steps beside that of the scene, and two searches, which change no motion.
const STUDY: &str = r#"
study = "accuracy"
seeds.count = 3

[[ladder]]
key = "time.dt"
values = [2e-4, 5e-5]

[[variant]]
name = "all pairs"
set = { neighbours = { search = "all-pairs" } }
"#;

/// A study, and one whose settings share no runs.
pub(crate) fn studies() -> [(String, u64); 2] {
    let shared = format!("{STUDY}{SCENE}");
    let timed = format!("step_time = [\"dt\"]\n{STUDY}{SCENE}");
    [(shared, 9), (timed, 12)]
}

fn json(answer: &Answer) -> Value {
    serde_json::from_str(&answer.stdout).unwrap()
}

/// The rows of a table without the columns of processor times.
fn but_times(table: &str) -> Vec<Vec<String>> {
    let mut table = csv::Reader::from_reader(table.as_bytes());
    let columns = table.headers().unwrap().clone();
    let is_time = |name: &str| name == "cpu_seconds" || name == "time_ratio";
    let rows = table.records().map(|row| {
        let row = row.unwrap();
        let cells = columns.iter().zip(row.iter());
        let cells = cells.filter(|(name, _)| !is_time(name));
        cells.map(|(_, cell)| cell.to_owned()).collect()
    });
    rows.collect()
}

/// Symptom: a second process on the folder of a study was refused. Cause: studies kept the rows of
/// their runs in one table, under a lock of their own.
#[test]
fn processes_share_the_runs_of_a_study() {
    for (text, runs) in studies() {
        let place = Workplace::new();
        place.write("study.toml", &text);
        let command = [
            "study",
            "study.toml",
            "--out",
            "shared",
            "-j",
            "1",
            "--json",
        ];
        let children: Vec<_> = (0..3).map(|_| place.start(&command)).collect();
        let answers: Vec<Answer> = children.into_iter().map(end).collect();
        let found = answers.iter().map(|answer| {
            assert_eq!(answer.code, Some(0), "{}{}", answer.stdout, answer.stderr);
            json(answer)
        });
        let found: Vec<Value> = found.collect();
        let made: Vec<u64> = found
            .iter()
            .map(|it| it["run_now"].as_u64().unwrap())
            .collect();
        assert_eq!(made.iter().sum::<u64>(), runs, "{made:?}");
        assert!(made.iter().filter(|it| **it > 0).count() > 1, "{made:?}");
        assert_eq!(found[0]["finding"], found[1]["finding"]);
        let alone = ["study", "study.toml", "--out", "alone", "--no-plot"];
        place.phase(&alone).code(0);
        for table in ["runs.csv", "accuracy.csv"] {
            let [shared, alone] =
                ["shared", "alone"].map(|it| but_times(&place.read(&format!("{it}/{table}"))));
            assert!(shared.len() > 3 && shared == alone, "{table}");
        }
        place
            .phase(&["status", "shared"])
            .code(0)
            .says(&format!("{runs} jobs, {runs} done, 0 failed, 0 left"));
    }
}

/// Shards make each run of a study once, and the last one says what follows.
#[test]
fn shards_make_the_runs_of_a_study() {
    for (text, runs) in studies() {
        let place = Workplace::new();
        place.write("study.toml", &text);
        let mut made = 0;
        for shard in ["2/3", "1/3", "3/3"] {
            let command = [
                "study",
                "study.toml",
                "--out",
                "shared",
                "--shard",
                shard,
                "--json",
            ];
            let answer = json(&place.phase(&command).code(0));
            made += answer["run_now"].as_u64().unwrap();
            assert_eq!(answer["left_to_others"].as_u64().unwrap(), runs - made);
            assert_eq!(answer["finding"].is_null(), made < runs);
        }
        let alone = ["study", "study.toml", "--out", "alone", "--no-plot"];
        place.phase(&alone).code(0);
        for table in ["runs.csv", "accuracy.csv"] {
            let [shared, alone] =
                ["shared", "alone"].map(|it| but_times(&place.read(&format!("{it}/{table}"))));
            assert!(shared.len() > 3 && shared == alone, "{table}");
        }
    }
}

/// Symptom: without their table all runs of a study were made again. Of published studies there is
/// the table alone.
#[test]
fn a_run_is_known_by_its_record_or_by_its_row() {
    for (text, runs) in studies() {
        let place = Workplace::new();
        place.write("study.toml", &text);
        let command = ["study", "study.toml", "--no-plot"];
        let none_made = || {
            let says = format!("{runs} runs: 0 made now");
            place.phase(&command).code(0).says(&says);
        };
        place
            .phase(&command)
            .code(0)
            .says(&format!("{runs} runs: {runs} made now"));
        let path = "results/accuracy/study/runs.csv";
        let table = place.read(path);
        fs::remove_file(place.path(path)).unwrap();
        none_made();
        assert_eq!(table, place.read(path));
        fs::remove_dir_all(place.path("results/accuracy/study/records")).unwrap();
        none_made();
        assert_eq!(table, place.read(path));
    }
}

/// One run that fails does not stop the others, and is noted and tried again like one of a sweep.
#[test]
fn a_run_that_fails_is_noted() {
    let place = Workplace::new();
    place.write("study.toml", &studies()[0].0);
    let command = ["study", "study.toml", "--no-plot"];
    place.phase(&command).code(0);
    let name = place.records("results/accuracy/study")[0].clone();
    let record = format!("results/accuracy/study/records/{name}");
    fs::remove_dir_all(place.path("results")).unwrap();
    fs::create_dir_all(place.path(&record)).unwrap();
    place
        .phase(&command)
        .code(1)
        .says("9 runs: 8 made now")
        .complains("failed: variant = ")
        .complains(&format!("cannot write {record}"));
    let failed = place.read("results/accuracy/study/failed.csv");
    assert_eq!(failed.lines().count(), 2, "{failed}");
    assert!(failed.starts_with("id,variant,seed,reason\n"), "{failed}");
    place
        .phase(&["status", "results/accuracy/study"])
        .code(0)
        .says("9 jobs, 8 done, 1 failed, 0 left");
    fs::remove_dir(place.path(&record)).unwrap();
    place.phase(&command).code(0).says("9 runs: 1 made now");
    assert!(!place.path("results/accuracy/study/failed.csv").exists());
}

/// A study and a sweep have different files in their folders.
#[test]
fn a_folder_is_of_a_study_or_of_a_sweep() {
    let place = Workplace::new();
    place.write("study.toml", &studies()[0].0);
    let sweep = format!("seeds.count = 3\n{SCENE}");
    place.write("sweep.toml", &sweep);
    let study = ["study", "study.toml", "--out", "study", "--no-plot"];
    place.phase(&study).code(0);
    place
        .phase(&["sweep", "sweep.toml", "--out", "study"])
        .code(2)
        .complains("study: this folder holds the results of a study; choose another one");
    place
        .phase(&["classify", "study"])
        .code(2)
        .complains("has its labels in runs.csv");
    place
        .phase(&["sweep", "sweep.toml", "--out", "sweep"])
        .code(0);
    place
        .phase(&["study", "study.toml", "--out", "sweep"])
        .code(2)
        .complains("sweep: this folder holds the results of a sweep; choose another one");
}

/// Symptom: three errors, two of them about keys of a study of stability.
#[test]
fn a_study_that_there_is_not_is_one_error() {
    let place = Workplace::new();
    let text = STUDY.replace("\"accuracy\"", "\"NAME\"") + SCENE;
    for command in ["study", "check"] {
        place.write("foo.toml", &text.replace("NAME", "foo"));
        let answer = place.phase(&[command, "foo.toml"]).code(2);
        let answer = answer
            .complains("error: there is no study \"foo\"\n --> foo.toml:2:9")
            .complains("choose one of \"stability\", \"accuracy\", \"ablation\"");
        assert_eq!(
            answer.stderr.matches("error").count(),
            1,
            "{}",
            answer.stderr
        );
        place.write("foo.toml", &text.replace("NAME", "acuracy"));
        place
            .phase(&[command, "foo.toml"])
            .code(2)
            .complains("did you mean \"accuracy\"?");
    }
}

/// Symptom: "--no-pairs is of ablations; this study says it in FILE", which says no such thing.
#[test]
fn options_of_ablations_are_refused_for_other_studies() {
    let place = Workplace::new();
    place.write("study.toml", &studies()[0].0);
    for (option, advice) in [
        (&["--no-pairs"][..], "leave the option out\n"),
        (
            &["--seeds", "3"],
            "leave the option out, and set [seeds] in it\n",
        ),
        (
            &["--tolerance", "0.1"],
            "leave the option out, and set [tolerance] in it\n",
        ),
    ] {
        place
            .phase(&[&["study", "study.toml"], option].concat())
            .code(2)
            .complains(&format!("{} is an option of ablations", option[0]))
            .complains("study.toml is a study of accuracy")
            .complains(advice);
    }
    assert!(!place.path("results").exists());
}

/// Symptom: a row that was cut made the study stop with a message of the reader of tables.
#[test]
fn a_table_that_was_cut_is_refused_with_the_remedy() {
    let place = Workplace::new();
    place.write("study.toml", &studies()[0].0);
    let command = ["study", "study.toml", "--no-plot"];
    place.phase(&command).code(0);
    let path = "results/accuracy/study/runs.csv";
    let table = place.read(path);
    place.write(path, &table[..table.len() - 30]);
    place
        .phase(&command)
        .code(2)
        .complains("runs.csv:13: this is no row of a study; remove the line, or delete the file");
    fs::remove_file(place.path(path)).unwrap();
    place.phase(&command).code(0).says("9 runs: 0 made now");
    assert_eq!(place.read(path), table);
}

/// Symptom: the step of the scene on a ladder gave runs of its own beside those of the scene as it
/// is. Cause: "spin" friction mu dt / dt differs from mu in the last bit.
#[test]
fn the_step_of_the_scene_is_the_scene_as_it_is() {
    let place = Workplace::new();
    let study = "study = \"accuracy\"\nseeds.count = 3\n[[ladder]]\nkey = \"time.dt\"\n\
                 values = [1e-4, 2e-4]\n";
    let friction = "[scene.friction]\nlaw = \"spin\"\ncoefficient = 0.02\n";
    assert_ne!((0.02 * 1e-4 / 1e-4_f64).to_bits(), 0.02_f64.to_bits());
    place.write("spin.toml", &format!("{study}{SCENE}{friction}"));
    place
        .phase(&["check", "spin.toml", "--no-trial"])
        .code(0)
        .says("6 runs in all")
        .says("its runs are those of the scene as it is");
}
