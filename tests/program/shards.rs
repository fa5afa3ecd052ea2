//! Parts of a sweep in processes that need not talk to each other.

use crate::support::{Answer, TinySweep, Workplace, end, wait_until};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::process::{Child, Stdio};
use std::thread;
use std::time::Duration;

const TABLES: [&str; 3] = ["labels.csv", "points.csv", "sweep.json"];

pub(crate) fn refined() -> String {
    let sweep = TinySweep {
        omegas: (0..16).map(f64::from).collect(),
        duration: 4.0,
        ..TinySweep::slow()
    };
    let text = sweep.text().replace("[seeds]\nlist = [1, 2]\n", "");
    text + "[refine]\nbudget = 14\nstart = [6]\nround = 4\nreplicates = 2\n"
}

/// Checks that two results folders hold the same runs and tables.
fn same(place: &Workplace, tables: &[&str]) {
    assert_eq!(place.digests("shared"), place.digests("alone"));
    for file in tables {
        let [one, other] =
            ["shared", "alone"].map(|folder| place.read(&format!("{folder}/{file}")));
        assert_eq!(one, other, "{file}");
    }
}

/// One after the other or at once, shards make each run once, and the last one labels them.
#[test]
fn shards_make_the_runs_of_a_sweep() {
    let place = Workplace::new();
    let sweep = TinySweep::default();
    place.write("tiny.toml", &sweep.text());
    let shard =
        |part: &str| place.phase(&["sweep", "tiny.toml", "--out", "shared", "--shard", part]);
    shard("1/3")
        .code(0)
        .says("2 jobs: 2 run now")
        .says("4 jobs left to other shards, of which the last one writes tables and figures");
    shard("3/3").code(0).says("2 jobs left to other shards");
    // Again, there is nothing to do.
    shard("3/3").code(0).says("2 jobs: 0 run now");
    assert!(!place.path("shared/labels.csv").exists());
    shard("2/3").code(0).says("6 runs labelled");
    assert!(place.path("shared/phase.png").exists());
    place
        .phase(&["sweep", "tiny.toml", "--out", "alone"])
        .code(0);
    same(&place, &TABLES);
}

#[test]
fn what_is_no_shard_is_refused() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    for (shard, message) in [
        ("4/3", "give a part and their number, such as 3/64, or auto"),
        ("auto", "SLURM_ARRAY_TASK_ID is not set"),
    ] {
        place
            .phase(&["sweep", "tiny.toml", "--shard", shard])
            .code(2)
            .complains(message);
    }
    // The task of an array has its number from Slurm.
    let slurm = |task: &str, count: &str| -> Answer {
        let mut command = place.command(&["sweep", "tiny.toml", "--shard", "auto"]);
        command
            .env("SLURM_ARRAY_TASK_ID", task)
            .env("SLURM_ARRAY_TASK_MIN", "10")
            .env("SLURM_ARRAY_TASK_COUNT", count)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        end(command.spawn().unwrap())
    };
    slurm("11", "2").code(0).says("3 jobs: 3 run now");
    slurm("14", "2").code(2).complains(
        "the 2 tasks of this Slurm array are not numbered one by one (task 14, from 10)",
    );
}

/// A round of a refined sweep is one set of shards, whoever comes first.
#[test]
fn shards_make_the_rounds_of_a_refined_sweep() {
    let place = Workplace::new();
    place.write("tiny.toml", &refined());
    let mut calls = 0;
    for round in 0..20 {
        let parts = if round % 2 == 0 {
            ["1/2", "2/2"]
        } else {
            ["2/2", "1/2"]
        };
        let mut last = String::new();
        for part in parts {
            let answer = place
                .phase(&["sweep", "tiny.toml", "--out", "shared", "--shard", part])
                .code(0);
            last = answer.stdout;
            calls += 1;
        }
        if last.contains("runs labelled") {
            break;
        }
        assert!(last.contains("the next round has "), "{last}");
    }
    assert!(calls > 2);
    place
        .phase(&["sweep", "tiny.toml", "--out", "alone"])
        .code(0);
    same(
        &place,
        &["labels.csv", "borders.csv", "sweep.json", "progress.json"],
    );
}

/// Programs that hand jobs out get them as lines, and those that are missing.
#[test]
fn jobs_are_handed_out_as_lines() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    let jobs = |more: &[&str]| -> Vec<String> {
        let arguments = [&["jobs", "tiny.toml", "--out", "shared"], more].concat();
        let answer = place.phase(&arguments).code(0);
        answer.stdout.lines().map(str::to_owned).collect()
    };
    let all = jobs(&[]);
    assert_eq!(all.len(), 6);
    assert_eq!(jobs(&["--chunk", "2h"]).len(), 1);
    let run = |line: &str| place.phase(&["sweep", "tiny.toml", "--out", "shared", "--job", line]);
    run(&all[4]).code(0).says("1 job: 1 run now");
    let missing = jobs(&["--missing"]);
    assert_eq!(missing.len(), 5);
    assert!(!missing.contains(&all[4]));
    let digest = all[0].split(':').next().unwrap();
    run(&format!("{digest}:0-3,5"))
        .code(0)
        .says("6 runs labelled");
    assert!(jobs(&["--missing", "--chunk", "1m"]).is_empty());
    let edited = TinySweep {
        seeds: vec![1],
        ..TinySweep::default()
    };
    place.write("tiny.toml", &edited.text());
    run(&all[0])
        .code(2)
        .complains("lists jobs of another version of the sweep");
    // Nothing was changed.
    place
        .phase(&["status", "shared"])
        .code(0)
        .says("6 jobs, 6 done");
}

#[test]
fn the_jobs_of_a_refined_sweep_are_those_of_its_round() {
    let place = Workplace::new();
    place.write("tiny.toml", &refined());
    let (mut rounds, mut last) = (0, String::new());
    loop {
        let answer = place
            .phase(&["jobs", "tiny.toml", "--missing", "--chunk", "1h"])
            .code(0);
        let Some(line) = answer.stdout.lines().next() else {
            break;
        };
        place.phase(&["sweep", "tiny.toml", "--job", line]).code(0);
        last = line.to_owned();
        rounds += 1;
    }
    assert!(rounds > 1);
    // Symptom: once all rounds were done any line was taken.
    place
        .phase(&["sweep", "tiny.toml", "--job", &last])
        .code(2)
        .complains("of an earlier round");
    place
        .phase(&["status", "results/tiny"])
        .code(0)
        .says("14 runs of at most 14");
}

/// A process whose lines go to a file.
fn start(place: &Workplace, number: usize) -> Child {
    let mut command = place.command(&[
        "sweep",
        "tiny.toml",
        "--out",
        "shared",
        "--jobs",
        "1",
        "--verbose",
        "--no-plot",
        "--checkpoint-interval",
        "0",
    ]);
    let file = |end: &str| File::create(place.path(&format!("{number}.{end}"))).unwrap();
    command.stdout(file("out")).stderr(file("err"));
    command.spawn().unwrap()
}

/// How often each job was run to its end: what the processes said.
fn ends(place: &Workplace, processes: usize) -> BTreeMap<String, usize> {
    let mut ends = BTreeMap::new();
    for number in 0..processes {
        let text = place.read(&format!("{number}.err"));
        for line in text.lines().filter(|line| line.contains("done: ")) {
            let id = line
                .split("(job ")
                .nth(1)
                .unwrap()
                .split(')')
                .next()
                .unwrap();
            *ends.entry(id.to_owned()).or_default() += 1;
        }
    }
    ends
}

/// Processes on one folder that are killed at random: no run is lost, none is done twice, and the
/// bits are the same.
fn kill_at_random(processes: usize, kills: usize, seed: u64) {
    let place = Workplace::new();
    let sweep = TinySweep {
        omegas: (0..kills / 2 + 20).map(|it| it as f64 / 8.0).collect(),
        duration: 10.0,
        ..TinySweep::slow()
    };
    place.write("tiny.toml", &sweep.text());
    let mut random = seed;
    let mut next = || {
        // Knuth's linear congruential generator (The Art of Computer Programming, 3.3.4).
        random = random
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        random >> 33
    };
    let mut started = 0;
    let mut begin = || {
        started += 1;
        start(&place, started - 1)
    };
    let mut children: Vec<Child> = (0..processes).map(|_| begin()).collect();
    let mut killed = 0;
    while killed < kills {
        thread::sleep(Duration::from_millis(20 + next() % 150));
        let child = &mut children[next() as usize % processes];
        if child.try_wait().unwrap().is_none() {
            child.kill().unwrap();
            child.wait().unwrap();
            killed += 1;
        }
        *child = begin();
    }
    for child in children {
        let status = child.wait_with_output().unwrap().status;
        assert!(status.success(), "{status}");
    }
    assert_eq!(place.records("shared").len(), sweep.jobs());
    let twice = ends(&place, started).into_iter().filter(|it| it.1 > 1);
    assert_eq!(twice.collect::<Vec<_>>(), []);
    // A process that was killed between its record and its lease leaves the lease to the next one.
    place
        .phase(&["sweep", "tiny.toml", "--out", "shared", "--no-plot"])
        .code(0)
        .says(" 0 run now");
    let files = fs::read_dir(place.path("shared/records")).unwrap();
    let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
    let left: Vec<String> = names.filter(|name| !name.ends_with(".h5")).collect();
    assert!(left.is_empty(), "{left:?}");
    place
        .phase(&["sweep", "tiny.toml", "--out", "alone", "--no-plot"])
        .code(0);
    same(&place, &TABLES);
}

#[test]
fn killed_processes_lose_no_run() {
    kill_at_random(3, 12, 1);
}

#[test]
#[ignore = "takes some minutes"]
fn processes_killed_three_hundred_times_lose_no_run() {
    for (processes, seed) in [(2, 2), (4, 3), (8, 4)] {
        kill_at_random(processes, 100, seed);
    }
}

/// Who runs what is seen while it runs, and what a killed process left behind.
#[test]
fn status_names_processes_and_what_dead_ones_left() {
    let place = Workplace::new();
    let long = TinySweep {
        duration: 3000.0,
        ..TinySweep::slow()
    };
    place.write("tiny.toml", &long.text());
    let mut child = place.start(&["sweep", "tiny.toml", "--out", "shared", "--jobs", "1"]);
    let process = format!("process {}", child.id());
    let status = || place.phase(&["status", "shared"]).code(0).stdout;
    wait_until(|| {
        place.path("shared/sweep.json").exists() && status().contains("1 run, 1 process")
    });
    let text = status();
    assert!(
        text.contains(&format!("  process    {process} on ")),
        "{text}"
    );
    child.kill().unwrap();
    child.wait().unwrap();
    let text = status();
    assert!(text.contains("running    no"), "{text}");
    assert!(text.contains(&format!(" of {process} on ")), "{text}");
    assert!(
        text.contains("which is dead: the same sweep makes it again"),
        "{text}"
    );
}
