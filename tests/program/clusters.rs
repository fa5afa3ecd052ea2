//! Sweeps that are handed to batch systems, and folders that are joined.

use crate::support::{Answer, TinySweep, Workplace, damage, end};
use std::fs;
use std::process::Stdio;

const TABLES: [&str; 3] = ["labels.csv", "points.csv", "sweep.json"];

/// A batch system of shell scripts: what is submitted is run at once, task by task.
#[cfg(unix)]
fn with_slurm(place: &Workplace, largest: usize) {
    let scripts = [
        (
            "scontrol",
            format!("echo 'MaxArraySize            = {largest}'"),
        ),
        (
            "sbatch",
            r#"
echo "$@" >>"$HERE/submitted"
for script; do :; done
tasks=$(sed -n 's/^#SBATCH --array=//p' "$script")
for range in ${tasks//,/ }; do
    for task in $(seq "${range%-*}" "${range#*-}"); do
        SLURM_ARRAY_TASK_ID=$task bash "$script" >>"$HERE/output" 2>&1
    done
done
if [ -z "$tasks" ]; then bash "$script" >>"$HERE/output" 2>&1; fi
echo 17"#
                .to_owned(),
        ),
    ];
    fs::create_dir(place.path("bin")).unwrap();
    for (name, script) in scripts {
        let path = format!("bin/{name}");
        place.write(&path, &format!("#!/bin/bash\n{script}\n"));
        let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
        fs::set_permissions(place.path(&path), mode).unwrap();
    }
}

/// `phase submit` where that batch system is.
fn submit(place: &Workplace, arguments: &[&str]) -> Answer {
    let path = std::env::var("PATH").unwrap();
    let mut command = place.command(&[&["submit"], arguments].concat());
    command
        .env("PATH", format!("{}:{path}", place.path("bin").display()))
        .env("HERE", place.path("."))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    end(command.spawn().unwrap())
}

/// Runs a line that names the program by its path.
fn run(line: &str) {
    let mut command = crate::support::caller::command("bash");
    let status = command.args(["-c", line]).stdout(Stdio::null()).status();
    assert!(status.unwrap().success(), "{line}");
}

fn same_as_alone(place: &Workplace, folder: &str, tables: &[&str]) {
    place
        .phase(&["sweep", "tiny.toml", "--out", "alone"])
        .code(0);
    assert_eq!(place.digests(folder), place.digests("alone"));
    for file in tables {
        let [one, other] = [folder, "alone"].map(|it| place.read(&format!("{it}/{file}")));
        assert_eq!(one, other, "{file}");
    }
}

#[cfg(unix)]
#[test]
fn a_sweep_goes_through_an_array() {
    let place = Workplace::new();
    with_slurm(&place, 4);
    place.write("tiny.toml", &TinySweep::default().text());
    let arguments = ["tiny.toml", "--to", "slurm", "--tasks", "5"];
    submit(&place, &[&arguments[..], &["--dry-run"]].concat())
        .code(0)
        // Largest number of a task: one less than the size of arrays.
        .says("6 runs missing, about 0.000 core-hours, in 3 tasks of 1 core");
    assert!(!place.path("submitted").exists());
    let script = place.read("results/tiny/cluster/submit.sh");
    assert!(script.contains("#SBATCH --array=1-3\n"), "{script}");
    let more = [&arguments[..], &["--", "--partition", "p"]].concat();
    submit(&place, &more).code(0).says("submitted: 17");
    let submitted = place.read("submitted");
    let lines: Vec<&str> = submitted.lines().collect();
    assert_eq!(lines.len(), 2, "{submitted}");
    assert!(
        lines[0].starts_with("--parsable --partition p "),
        "{submitted}"
    );
    assert!(
        lines[1].starts_with("--parsable --partition p --dependency=afterany:17 "),
        "{submitted}"
    );
    same_as_alone(&place, "results/tiny", &TABLES);
    submit(&place, &arguments).code(0).says("no run is missing");
}

/// Each round is an array, and submits the next one.
#[cfg(unix)]
#[test]
fn rounds_follow_each_other() {
    let place = Workplace::new();
    with_slurm(&place, 1001);
    let sweep = TinySweep {
        omegas: (0..16).map(f64::from).collect(),
        duration: 4.0,
        ..TinySweep::slow()
    };
    let text = sweep.text().replace("[seeds]\nlist = [1, 2]\n", "");
    let text = text + "[refine]\nbudget = 14\nstart = [6]\nround = 4\nreplicates = 2\n";
    place.write("tiny.toml", &text);
    submit(&place, &["tiny.toml", "--to", "slurm", "--tasks", "2"]).code(0);
    assert!(place.read("submitted").lines().count() >= 6);
    same_as_alone(
        &place,
        "results/tiny",
        &["labels.csv", "borders.csv", "progress.json"],
    );
}

/// A study goes the same way as a sweep.
#[cfg(unix)]
#[test]
fn a_study_goes_through_an_array() {
    let place = Workplace::new();
    with_slurm(&place, 1001);
    let [(text, _), _] = crate::studies::studies();
    place.write("fall.toml", &text);
    submit(&place, &["fall.toml", "--to", "slurm", "--tasks", "2"]).code(0);
    let folder = place.path("results/accuracy/fall");
    let output = place.read("output");
    assert!(folder.join("accuracy.json").exists(), "{output}");
    assert!(folder.join("runs.csv").exists(), "{output}");
    place.phase(&["jobs", "fall.toml", "--missing"]).code(0);
    submit(&place, &["fall.toml", "--to", "slurm"])
        .code(0)
        .says("no run is missing");
}

/// Symptom: sbatch refused scripts of paths with spaces or quotes, and commands replaced "{}" in
/// paths. Cause: paths stood in directives as they are.
#[cfg(unix)]
#[test]
fn odd_paths_are_submitted() {
    let place = Workplace::new();
    with_slurm(&place, 1001);
    fs::create_dir(place.path("it's {} 50%")).unwrap();
    let file = "it's {} 50%/my sweep.toml";
    place.write(file, &TinySweep::default().text());
    let out = "it's {} 50%/out";
    let more = ["--tasks", "2", "--", "--dependency=afterok:5"];
    let arguments = [&[file, "--to", "slurm", "--out", out][..], &more].concat();
    submit(&place, &arguments).code(0);
    let script = place.read(&format!("{out}/cluster/submit.sh"));
    let directives: Vec<&str> = script
        .lines()
        .filter(|it| it.starts_with("#SBATCH"))
        .collect();
    assert!(
        directives.contains(&"#SBATCH --job-name=phase-my-sweep"),
        "{script}"
    );
    assert!(!directives.iter().any(|it| it.contains("it's")), "{script}");
    let submitted = place.read("submitted");
    let next = submitted.lines().last().unwrap();
    // The script waits for its array, whatever else the user waits for.
    let [theirs, own] = ["afterok:5", "afterany:17"].map(|it| next.find(it).unwrap());
    assert!(theirs < own, "{next}");
    assert!(next.contains("{} 50%%/out/cluster/%j.log"), "{next}");
    assert_eq!(place.records(out).len(), 6);
    place
        .phase(&["submit", file, "--to", "row", "--out", "other", "--dry-run"])
        .code(0);
}

/// Only shards that lack runs are submitted again, and a sweep whose tasks make no run is not
/// submitted for ever.
#[cfg(unix)]
#[test]
fn what_is_missing_is_submitted_again() {
    let place = Workplace::new();
    with_slurm(&place, 1001);
    place.write("tiny.toml", &TinySweep::default().text());
    place.phase(&["sweep", "tiny.toml"]).code(0);
    let record = &place.records("results/tiny")[2];
    let path = place.path("results/tiny/records").join(record);
    fs::remove_file(&path).unwrap();
    let arguments = ["tiny.toml", "--to", "slurm", "--tasks", "6"];
    submit(&place, &[&arguments[..], &["--dry-run"]].concat())
        .code(0)
        .says("1 run missing");
    // Something stands in the way of its record.
    fs::create_dir(&path).unwrap();
    fs::write(path.join("file"), "").unwrap();
    submit(&place, &arguments).code(0);
    let output = place.read("output");
    assert!(
        output.contains("the tasks made no run; see their output"),
        "{output}"
    );
    assert_eq!(place.read("submitted").lines().count(), 2);
}

#[test]
fn job_files_of_other_systems_list_what_is_missing() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    place
        .phase(&[
            "submit",
            "tiny.toml",
            "--to",
            "hyperqueue",
            "--tasks",
            "3",
            "--dry-run",
        ])
        .code(0)
        .says("6 runs missing");
    let job: toml::Table = place.read("results/tiny/cluster/job.toml").parse().unwrap();
    let tasks = job["task"].as_array().unwrap();
    let (last, tasks) = tasks.split_last().unwrap();
    assert_eq!(last["deps"].as_array().unwrap().len(), tasks.len());
    // Symptom: directories of an earlier listing stayed, and were run again. Each listing has its
    // own lines.
    for tasks in ["2", "3"] {
        let arguments = ["tiny.toml", "--to", "row", "--dry-run", "--tasks", tasks];
        place.phase(&[&["submit"], &arguments[..]].concat()).code(0);
    }
    let row: toml::Table = place
        .read("results/tiny/cluster/workflow.toml")
        .parse()
        .unwrap();
    let command = row["action"][0]["command"].as_str().unwrap();
    let shards: Vec<_> = fs::read_dir(place.path("results/tiny/cluster/shards"))
        .unwrap()
        .collect();
    assert_eq!(shards.len(), 3);
    // Both describe all runs: a shell makes them.
    for shard in shards {
        let name = shard.unwrap().file_name().into_string().unwrap();
        let command = command.replace("{directory}", &name);
        run(&command);
        assert!(
            place
                .path("results/tiny/cluster/shards")
                .join(name)
                .join("done.json")
                .exists()
        );
    }
    same_as_alone(&place, "results/tiny", &TABLES);
    fs::remove_dir_all(place.path("results/tiny/records")).unwrap();
    for task in tasks {
        let words = task["command"].as_array().unwrap();
        let line = words[2].as_str().unwrap();
        run(line);
    }
    assert_eq!(place.digests("results/tiny"), place.digests("alone"));
    // Symptom: the last task, which submits what is missing, was cancelled by one that was killed.
    fs::remove_file(place.path("tiny.toml")).unwrap();
    run(tasks[0]["command"][2].as_str().unwrap());
}

/// Symptom: `merge` labelled the runs of a refined sweep as if they were all, and lost what other
/// folders had chosen.
#[test]
fn folders_of_a_refined_sweep_are_joined() {
    let place = Workplace::new();
    place.write("tiny.toml", &crate::shards::refined());
    for (folder, shard) in [("one", "1/2"), ("two", "2/2")] {
        place
            .phase(&["sweep", "tiny.toml", "--out", folder, "--shard", shard])
            .code(0);
    }
    place
        .phase(&["merge", "one", "two"])
        .code(0)
        .says("two: 3 records taken, 0 in both")
        .says("6 runs labelled")
        .complains("`phase sweep` with the same file continues with these runs");
    place.phase(&["sweep", "tiny.toml", "--out", "one"]).code(0);
    same_as_alone(&place, "one", &["labels.csv", "borders.csv"]);
}

/// Shards on machines without a common disk.
#[test]
fn folders_made_apart_are_joined() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    for (folder, shard) in [("one", "1/3"), ("two", "2/3"), ("three", "3/3")] {
        place
            .phase(&["sweep", "tiny.toml", "--out", folder, "--shard", shard])
            .code(0)
            .says("4 jobs left to other shards");
    }
    // One of them was made twice.
    place
        .phase(&["sweep", "tiny.toml", "--out", "two", "--shard", "1/3"])
        .code(0);
    place
        .phase(&["merge", "one", "two", "three"])
        .code(0)
        .says("two: 2 records taken, 2 in both")
        .says("three: 2 records taken, 0 in both")
        .says("6 runs labelled");
    assert!(place.path("one/phase.png").exists());
    same_as_alone(&place, "one", &TABLES);
}

/// Symptom: runs of a study were labelled like those of a sweep, and their records called wrong.
#[test]
fn folders_of_a_study_are_joined() {
    let place = Workplace::new();
    let [_, (text, runs)] = crate::studies::studies();
    place.write("study.toml", &text);
    for (folder, shard) in [("one", "1/2"), ("two", "2/2")] {
        place
            .phase(&["study", "study.toml", "--out", folder, "--shard", shard])
            .code(0);
    }
    place
        .phase(&["merge", "one", "two"])
        .code(0)
        .says("records taken, 0 in both")
        .says("`phase study` with the same file writes tables and figures");
    assert!(!place.path("one/labels.csv").exists());
    place
        .phase(&["study", "study.toml", "--out", "one", "--no-plot"])
        .code(0)
        .says(&format!("{runs} runs: 0 made now"));
    // Symptom: runs of a published study, whose records are gone, counted as left.
    fs::remove_dir_all(place.path("one/records")).unwrap();
    place
        .phase(&["status", "one"])
        .code(0)
        .says(&format!("{runs} jobs, {runs} done, 0 failed, 0 left"));
}

#[test]
fn folders_of_other_sweeps_are_not_joined() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    place.write("other.toml", &TinySweep::slow().text());
    for (file, folder) in [
        ("tiny.toml", "one"),
        ("other.toml", "other"),
        ("tiny.toml", "two"),
    ] {
        place.phase(&["sweep", file, "--out", folder]).code(0);
    }
    place
        .phase(&["merge", "one", "other"])
        .code(2)
        .complains("other: this folder holds another sweep than one; they differ in ")
        .complains("time.duration");
    // What cannot be read is named, and the rest taken.
    let records = place.records("one");
    fs::remove_dir_all(place.path("one/records")).unwrap();
    fs::create_dir(place.path("one/records")).unwrap();
    fs::remove_file(place.path("one/labels.csv")).unwrap();
    damage(&place.path("two/records").join(&records[0]));
    let name = records[0].clone();
    place
        .phase(&["merge", "one", "two"])
        .code(1)
        .says("two: 5 records taken, 0 in both")
        .complains(&format!("{name}: is no good record of this sweep"));
}
