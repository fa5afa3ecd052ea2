//! What a run and `phase check` say of a silo.

use super::{record, shipped};
use crate::support::Workplace;
use phase::record::{Guard, Outcome};

#[test]
fn the_silo_as_printed_reports_the_first_grain_through_the_wall() {
    let record = record(&shipped("silo-as-printed.toml"));
    let Outcome::Unstable(instability) = &record.outcome else {
        panic!("{:?}", record.outcome);
    };
    assert_eq!(instability.guard, Guard::WallPassed);
    assert!(instability.time < 2.0, "{instability}");
    // Through the door, which is the first thing below the middle obstacle.
    let detail = &instability.detail;
    assert!(
        detail.contains("between the fixed ones at (-0.1000, 0.1000) m and (-0.0500, 0.1000) m"),
        "{instability}"
    );
}

#[test]
fn what_a_silo_does_not_do_is_said() {
    let place = Workplace::new();
    let run = |changes: &[(&str, &str)]| {
        let mut text = super::HOPPER.to_owned();
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        place.write("silo.toml", &text);
        place.phase(&["run", "silo.toml"]).code(0).stdout
    };
    assert!(!run(&[]).contains("NEVER"));
    // Far more grains than there is room for.
    let full = run(&[
        ("count = 60", "count = 400"),
        ("duration = 30.0", "duration = 25.0"),
    ]);
    assert!(
        full.contains("NOT FILLED: ") && full.contains("THE DOOR NEVER OPENED"),
        "{full}"
    );
    // All of them fall beside the silo.
    let beside = run(&[("position = [0.0, 0.0, 1.4]", "position = [0.7, 0.0, 1.4]")]);
    assert!(beside.contains("SPILLED: 60 spheres"), "{beside}");
    assert!(!beside.contains("emptied "), "{beside}");
    let restless = run(&[("kinetic_energy = 1e-4", "kinetic_energy = 1e-30")]);
    assert!(restless.contains("NEVER AT REST"), "{restless}");
}

#[test]
fn check_warns_of_walls_that_do_not_hold() {
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/sweeps/scenes/");
    let check = |name: &str| {
        let file = format!("{scenes}{name}");
        Workplace::new()
            .phase(&["check", &file, "--no-trial"])
            .code(0)
    };
    let answer = check("silo-as-printed.toml");
    assert!(
        answer
            .stdout
            .contains("WARNING: faster ones squeeze through"),
        "{}",
        answer.stdout
    );
    let answer = check("silo.toml");
    assert!(answer.stdout.contains("walls") && !answer.stdout.contains("WARNING"));
}

#[test]
fn a_run_writes_its_record_its_table_and_says_what_happened() {
    let place = Workplace::new();
    place.write("silo.toml", super::HOPPER);
    let answer = place.phase(&["run", "silo.toml", "--json"]).code(0);
    let answer: serde_json::Value = serde_json::from_str(&answer.stdout).unwrap();
    assert_eq!(answer["outcome"], "completed");
    let kinds: Vec<_> = answer["milestones"].as_array().unwrap().iter().collect();
    assert_eq!(kinds[3]["kind"], "emptied");
    let table = place.read("results/silo-observations.csv");
    let header = table.lines().next().unwrap();
    for column in [
        "time",
        "kinetic",
        "height_max",
        "released",
        "discharged",
        "discharge_rate",
    ] {
        assert!(
            header.split(',').any(|name| name == column),
            "{column} in {header}"
        );
    }
    // The same again, bit for bit.
    place
        .phase(&["run", "silo.toml", "--out", "again.h5"])
        .code(0);
    assert_eq!(place.read("again-observations.csv"), table);
    // A table that is something else is not replaced.
    place.write("notes-observations.csv", "my notes");
    place
        .phase(&["run", "silo.toml", "--out", "notes.h5"])
        .code(2)
        .complains("notes-observations.csv: this is not a table of observables");
}

/// Symptom: `check` said that the walls hold up to 8.976 m/s, and the run ended by the overlap
/// guard. Cause: a disc that comes straight at a fixed one overlaps it too deep before it could
/// pass between two.
#[test]
fn check_warns_of_walls_that_break_the_overlap_guard() {
    let place = Workplace::new();
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/sweeps/scenes");
    let text = std::fs::read_to_string(format!("{folder}/silo.toml")).unwrap();
    let check = |density: &str| {
        let changed = text
            .replace("density = 1.0 ", &format!("density = {density} "))
            .replace("silo1.dat", &format!("{folder}/silo1.dat"));
        place.write("silo.toml", &changed);
        place
            .phase(&["check", "--no-trial", "silo.toml"])
            .code(0)
            .stdout
    };
    assert!(!check("1.0").contains("WARNING: faster ones"));
    for density in ["2.8", "3.0", "3.14159265"] {
        let text = check(density);
        assert!(
            text.contains("may break the overlap guard"),
            "{density}: {text}"
        );
    }
}
