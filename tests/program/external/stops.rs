//! A sweep that is stopped ends its programs, and goes on where they can.
#![cfg(unix)]

use super::{MODEL, place_of};
use crate::support::{end, signal, wait_until};
use std::process::Command;

fn is_alive(process: &str) -> bool {
    let answer = Command::new("kill").args(["-0", process.trim()]).output();
    answer.unwrap().status.success()
}

#[test]
fn a_stop_ends_the_program_with_all_that_it_started() {
    let processes = tempfile::tempdir().unwrap();
    let file = processes.path().join("processes");
    let script = format!(
        "sleep 60 & echo $$ $! > {0}.part; mv {0}.part {0}; wait",
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
