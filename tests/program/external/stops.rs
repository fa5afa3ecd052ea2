//! A sweep that is stopped ends its programs, and goes on where they can.
#![cfg(unix)]

use super::{MODEL, place_of};
use crate::support::{end, signal, wait_until};
use std::process::Command;

/// Whether a process runs.
fn is_alive(process: &str) -> bool {
    let answer = Command::new("kill").args(["-0", process.trim()]).output();
    answer.unwrap().status.success()
}

#[test]
fn a_stop_ends_the_program_with_all_that_it_started() {
    let processes = tempfile::tempdir().unwrap();
    let file = processes.path().join("processes");
    let script = format!(
        "sleep 60 & echo $$ $! > {0}.part; mv {0}.part {0}; wait # @{{x}}",
        file.display()
    );
    let place = place_of(&script, "[1.0]", "");
    let child = place.start(&["sweep", "model.toml", "--allow-program"]);
    wait_until(|| file.exists());
    let text = std::fs::read_to_string(&file).unwrap();
    let processes: Vec<&str> = text.split_whitespace().collect();
    assert!(processes.iter().all(|it| is_alive(it)));
    signal(&child, "INT");
    end(child).code(130).complains("1 job left");
    wait_until(|| !processes.iter().any(|it| is_alive(it)));
    let status = place.phase(&["status", "results/model"]).code(0);
    assert!(
        !status.stdout.contains("checkpoint  1"),
        "{}",
        status.stdout
    );
}

#[test]
fn a_run_goes_on_from_what_its_program_left() {
    let script = "echo half > half.txt; sleep 60";
    let more = "resume = { file = \"half.txt\", commands = [[\"sh\", \"-c\", \"read h < half.txt; \
                printf 't,y\\\\n0,@{x}\\\\n' > out.csv; echo went on from $h\"]] }";
    let place = place_of(script, "[1.0]", more);
    place
        .phase(&["check", "model.toml"])
        .code(0)
        .says("from half.txt: sh -c");
    let sweep = &["sweep", "model.toml", "--allow-program"];
    let child = place.start(sweep);
    let is_half = || {
        let entries = std::fs::read_dir(place.path("results/model/records"));
        let entries = entries.into_iter().flatten().flatten();
        entries
            .into_iter()
            .any(|it| it.path().join("half.txt").is_file())
    };
    wait_until(is_half);
    signal(&child, "INT");
    end(child).code(130);
    place.phase(sweep).code(0).says("1 run labelled");
    let name = place.records("results/model").remove(0).replace(".h5", "");
    let said = place.read(&format!(
        "results/model/records/{name}.run/phase-output.txt"
    ));
    assert_eq!(said, "went on from half\n");
}

/// A run goes on from its own folder only: neither another run nor one that has ended, and `phase
/// run` only if it is asked to.
#[test]
fn nothing_goes_on_from_another_run() {
    let more = "resume = { file = \"out.csv\", commands = [[\"false\"]] }";
    let place = place_of(MODEL, "[1.0]", more);
    let text = place.read("model.toml");
    let scene = text[..text.find("[[axis]]").unwrap()].replace("scene.", "");
    place.write("one.toml", &scene);
    let run = |more: &[&str]| {
        let first = ["run", "one.toml", "--allow-program", "--out", "one.h5"];
        place.phase(&[&first[..], more].concat()).code(0)
    };
    run(&[]);
    run(&["--set", "parameters.x=7"]);
    assert_eq!(place.read("one.run/out.csv"), "t,y\n0,0\n1.5,7\n");
    run(&["--set", "parameters.x=7", "--resume"]);
    let sweep = &["sweep", "model.toml", "--allow-program"];
    place.phase(sweep).code(0);
    place.phase(&[&sweep[..], &["--force"]].concat()).code(0);
}

/// Symptom: a program that had outlived a killed `phase` wrote to the folder of its successor.
#[test]
fn a_program_that_outlived_its_phase_is_not_joined() {
    let processes = tempfile::tempdir().unwrap();
    let (file, go) = (
        processes.path().join("process"),
        processes.path().join("go"),
    );
    let script = format!(
        "[ -e {1} ] || {{ echo $$ > {0}.part; mv {0}.part {0}; sleep 60; }}\n{MODEL}",
        file.display(),
        go.display()
    );
    let place = place_of(&script, "[1.0]", "");
    let sweep = &["sweep", "model.toml", "--allow-program"];
    let child = place.start(sweep);
    wait_until(|| file.exists());
    let mut child = child;
    child.kill().unwrap();
    child.wait().unwrap();
    place
        .phase(sweep)
        .code(1)
        .complains("a program that an earlier `phase` started still runs here");
    let process = std::fs::read_to_string(&file).unwrap();
    let group = format!("-{}", process.trim());
    Command::new("kill")
        .args(["-KILL", "--", &group])
        .status()
        .unwrap();
    wait_until(|| !is_alive(&process));
    std::fs::write(&go, "").unwrap();
    place.phase(sweep).code(0).says("1 run labelled");
}

#[test]
fn another_ctrl_c_ends_programs_that_do_not_listen() {
    let processes = tempfile::tempdir().unwrap();
    let file = processes.path().join("process");
    let script = format!(
        "trap '' TERM; echo $$ > {0}.part; mv {0}.part {0}; while :; do sleep 1; done # @{{x}}",
        file.display()
    );
    let place = place_of(&script, "[1.0]", "");
    let child = place.start(&["sweep", "model.toml", "--allow-program"]);
    wait_until(|| file.exists());
    let process = std::fs::read_to_string(&file).unwrap();
    signal(&child, "INT");
    std::thread::sleep(std::time::Duration::from_millis(300));
    signal(&child, "INT");
    end(child).code(130);
    wait_until(|| !is_alive(&process));
}

/// What a program started in the background ends with it.
#[test]
fn what_a_program_started_ends_with_it() {
    let processes = tempfile::tempdir().unwrap();
    let file = processes.path().join("process");
    let script = format!("sleep 60 & echo $! > {}\n{MODEL}", file.display());
    let place = place_of(&script, "[1.0]", "");
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(0);
    let process = std::fs::read_to_string(&file).unwrap();
    wait_until(|| !is_alive(&process));
}

/// A run that failed begins anew, although its program left something to go on from.
#[test]
fn a_failed_run_begins_anew() {
    let script =
        format!("[ -e half.txt ] && exit 7\necho half > half.txt\n{MODEL}\nexit @{{code}}");
    let more = "resume = { file = \"half.txt\", commands = [[\"false\"]] }";
    let place = place_of(&script, "[1.0]", more);
    let with = |code: &str| {
        let text = place.read("model.toml");
        place.write(
            "model.toml",
            &text.replace("x = 1.0", &format!("x = 1.0\ncode = {code}")),
        );
    };
    with("5");
    let sweep = &["sweep", "model.toml", "--allow-program"];
    for _ in 0..2 {
        place.phase(sweep).code(1).complains("failed (exit code 5)");
    }
}
