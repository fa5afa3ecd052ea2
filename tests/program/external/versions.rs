//! The version of a program is part of the identity of its runs.

use super::{MODEL, place_of};

#[test]
fn another_version_makes_all_runs_anew() {
    let versions = tempfile::tempdir().unwrap();
    let file = versions.path().join("version");
    let say = |version: &str| std::fs::write(&file, format!("\n{version}\nmore\n")).unwrap();
    let more = format!("version = [\"cat\", {file:?}]");
    let place = place_of(MODEL, "[1.0, 2.0]", &more);
    let sweep = &["sweep", "model.toml", "--allow-program"];
    say("model 1.0");
    place.phase(sweep).code(0).says("2 run now");
    place.phase(sweep).code(0).says("2 done before");
    let stored = place.read("results/model/sweep.json");
    assert!(
        stored.contains("\"found_version\": \"model 1.0\""),
        "{stored}"
    );
    say("model 1.1");
    place
        .phase(sweep)
        .code(0)
        .says("2 run now")
        .complains("scene.program.found_version");
    assert_eq!(place.records("results/model").len(), 4);
    std::fs::remove_file(&file).unwrap();
    place
        .phase(sweep)
        .code(1)
        .complains("which should print the version of the program, failed");
    for (text, expected) in [
        ("version = [\"true\"]", "prints nothing"),
        ("version = [\"no-such-program\"]", "cannot be started"),
    ] {
        place.write("model.toml", &super::sweep_of(MODEL, "[1.0]", text));
        place.phase(sweep).code(1).complains(expected);
    }
}

/// What does not change a result does not change identities, and what does, does.
#[test]
fn identities_are_of_what_is_measured() {
    let ids = |script: &str, more: &str| {
        let place = place_of(script, "[1.0]", more);
        let sweep = phase::sweep::load(&place.path("model.toml")).unwrap();
        sweep.jobs().unwrap().remove(0).id
    };
    let base = ids(MODEL, "");
    for same in [
        "time_limit = 5.0",
        "retries = 2",
        "keep = \"failed\"",
        "most_bytes = 1e3",
    ] {
        assert_eq!(ids(MODEL, same), base, "{same}");
    }
    assert_ne!(ids(&format!("{MODEL}\n# more"), ""), base);
    assert_ne!(ids(MODEL, "exit_codes = [0, 1]"), base);
    assert_ne!(ids(MODEL, "version = [\"true\"]"), base);
}

/// Symptom: an edited file with other thresholds was refused, as one of other runs, because it had
/// no version yet; and a longer time limit made all records useless.
#[test]
fn thresholds_and_limits_change_without_new_runs() {
    let more = "version = [\"echo\", \"1\"]\ntime_limit = 5.0";
    let place = place_of(MODEL, "[1.0, 3.0]", more);
    let sweep = &["sweep", "model.toml", "--allow-program"];
    place.phase(sweep).code(0).says("2 run now");
    let text = place.read("model.toml").replace("2[m]", "0.5[m]");
    place.write("model.toml", &text);
    place
        .phase(&["classify", "results/model", "--sweep", "model.toml"])
        .code(0)
        .says("far               2  100 %");
    let text = text.replace(
        "time_limit = 5.0",
        "time_limit = 9.0\nretries = 1\nkeep = \"failed\"",
    );
    place.write("model.toml", &text);
    place.phase(sweep).code(0).says("2 done before");
}
