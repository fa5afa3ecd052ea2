//! What holds for all commands.

use crate::support::Workplace;
use std::process::Stdio;

#[test]
fn wrong_arguments_are_refused() {
    let place = Workplace::new();
    for arguments in [
        &["sweep"][..],
        &["nonsense"],
        &["sweep", "tiny.toml", "-j", "0"],
        &["sweep", "tiny.toml", "--seed", "one"],
        &["sweep", "tiny.toml", "--quiet", "--verbose"],
        &["plot"],
        &[],
    ] {
        let answer = place.phase(arguments).code(2);
        assert_eq!(answer.stdout, "");
    }
}

/// Symptom: `--seed -1` advised to write `-- -1`, which does not help, and a seed that no file can
/// hold was taken.
#[test]
fn numbers_are_refused_for_what_they_are() {
    let place = Workplace::new();
    let seeds = "must be a whole number from 0 to 9223372036854775807";
    for (arguments, reason) in [
        (&["run", "tiny.toml", "--seed", "-1"][..], seeds),
        (
            &["run", "tiny.toml", "--seed", "9223372036854775808"],
            seeds,
        ),
        (
            &["sweep", "tiny.toml", "--seed", "1,9223372036854775808"],
            seeds,
        ),
        (
            &["sweep", "tiny.toml", "-j", "-1"],
            "must be a whole number from 1",
        ),
        (
            &["run", "tiny.toml", "--checkpoint-interval", "-1"],
            "must be a time in seconds, 0 or more",
        ),
        (
            &["cost", "tiny.toml", "--seconds", "-1"],
            "must be a time in seconds, 0 or more",
        ),
    ] {
        place.phase(arguments).code(2).complains(reason);
    }
}

#[test]
fn every_command_has_an_example() {
    let place = Workplace::new();
    place
        .phase(&["--help"])
        .code(0)
        .says("Exit codes:")
        .says("130")
        .says("Example");
    for command in [
        "sweep", "classify", "plot", "run", "check", "cost", "status", "new", "generate",
    ] {
        place
            .phase(&[command, "--help"])
            .code(0)
            .says("Example")
            .says(&format!("  phase {command} "));
    }
    place
        .phase(&["--version"])
        .code(0)
        .says(env!("CARGO_PKG_VERSION"));
}

#[test]
fn a_reader_that_goes_away_is_no_fault() {
    let place = Workplace::new();
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut command = place.command(&["plot", "--list"]);
    let output = command
        .stdout(writer)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
        .wait_with_output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
}
