//! What is said of results that another file made.

use super::{MODEL, place_of, sweep_of};

const SWEEP: &[&str] = &["sweep", "model.toml", "--allow-program"];

#[test]
fn check_says_which_runs_are_kept() {
    let place = place_of(MODEL, "[1.0, 2.0]", "version = [\"echo\", \"first\"]");
    let check = |text: &str| {
        place.write("model.toml", text);
        place.phase(&["check", "model.toml"]).code(0)
    };
    let of =
        |script: &str, values: &str| sweep_of(script, values, "version = [\"echo\", \"first\"]");
    let first = check(&of(MODEL, "[1.0, 2.0]"));
    assert!(!first.stdout.contains("results  "), "{first:?}");
    place.phase(SWEEP).code(0);
    check(&of(MODEL, "[1.0, 2.0]")).says(
        "results     2 of 2 runs are done and kept in results/model while the version is \"first\"",
    );
    check(&of(MODEL, "[2.0, 3.0, 4.0]")).says("1 of 3 runs are done and kept");
    check(&of(&format!("{MODEL}\n# other"), "[1.0, 2.0]"))
        .says("0 of 2 runs are done and kept in results/model\n")
        .says("the others are made: what was run there differs in scene.program.files");
}

/// Symptom: after labels got other names, the table of labels was called no table.
#[test]
fn labels_of_other_names_are_named() {
    let place = place_of(MODEL, "[1.0, 3.0]", "");
    place.phase(SWEEP).code(0);
    let text = place.read("model.toml").replace("\"near\"", "\"close\"");
    place.write("model.toml", &text);
    let expected = "labels.csv:1: this table is of other labels or measures than the sweep: it \
                    has near and lacks close";
    place.phase(&[SWEEP, &["--no-classify"]].concat()).code(0);
    place
        .phase(&["plot", "results/model"])
        .code(1)
        .complains(expected)
        .complains("`phase classify results/model` rewrites it");
    place.phase(SWEEP).code(0).says("close").complains(expected);
}

#[test]
fn a_column_that_is_spelt_otherwise_is_suggested() {
    let script = "printf 't,heights\\n0,0\\n1,@{x}\\n' > out.csv";
    let place = place_of(script, "[1.0]", "");
    let text = place.read("model.toml");
    let text = text.replace("name = \"y\"", "name = \"y\", from = \"height\"");
    place.write("model.toml", &text);
    place.phase(SWEEP).code(1).complains(
        "there is no column `height`; did you mean `heights`? its columns are \"t\", \"heights\"",
    );
}
