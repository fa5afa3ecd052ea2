//! A program that fails, hangs, writes nonsense or too much is a failed job.

use super::{MODEL, place_of};

/// What the script does for each `x`, and what is said of the job.
const CASES: [(&str, &str); 9] = [
    (
        "echo one; echo two >&2; exit 3",
        "`sh model.sh` failed (exit code 3); its last lines: one | two",
    ),
    ("kill -KILL $$", "`sh model.sh` failed (signal: 9"),
    (
        "echo waiting; sleep 60",
        "took longer than `program.time_limit` = 2 s and was ended; its last \
                                lines: waiting",
    ),
    (
        "true",
        "out.csv: the program left no such file; check the name in [[program.read]]",
    ),
    (
        "printf 't,y\\n0,zero\\n' > out.csv",
        "out.csv:2: \"zero\" in the column \"y\" is no number",
    ),
    (
        "printf 't,z\\n0,1\\n' > out.csv",
        "out.csv: there is no column `y`; its columns are \"t\", \"z\"",
    ),
    (
        "printf 't,y\\n1,1\\n0,1\\n' > out.csv",
        "out.csv: the time `t` does not grow in row 2 (0)",
    ),
    (
        "printf 't,y\\n' > out.csv",
        "out.csv: it has no rows; check whether the program ran long",
    ),
    ("yes > large", "`program.most_bytes` = 1000000 bytes"),
];

fn script() -> String {
    let cases = CASES.iter().enumerate();
    let cases: Vec<String> = cases
        .map(|(place, (action, _))| format!("@{{x}}-{place}.0) {action};;"))
        .collect();
    let cases = cases.join("\n").replace("@{x}-", "");
    format!("case @{{x}} in\n{cases}\n*) {MODEL};;\nesac")
}

const LIMITS: &str = "time_limit = 2.0\nmost_bytes = 1e6";

#[test]
fn each_failure_is_told_and_ends_no_other_job() {
    let values: Vec<String> = (0..11).map(|x| format!("{x}.0")).collect();
    let place = place_of(&script(), &format!("[{}]", values.join(", ")), LIMITS);
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(1)
        .says("11 jobs: 2 run now")
        .says("9 failed")
        .says("2 runs labelled");
    let table = place.read("results/model/failed.csv");
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), CASES.len());
    for (place, (action, expected)) in CASES.iter().enumerate() {
        let value = format!("{place}.0");
        let row = rows.iter().find(|row| row.iter().any(|it| it == value));
        let row = row.unwrap_or_else(|| panic!("{action} is not in {table}"));
        assert!(
            row.iter().any(|it| it.contains(expected)),
            "{row:?}\n{expected}"
        );
    }
    // What is left to look at, and only failed ones are run again.
    let id = rows[0].get(0).unwrap();
    let said = place.read(&format!("results/model/records/{id}.run/phase-output.txt"));
    assert_eq!(said, "one\ntwo\n");
    place
        .phase(&["status", "results/model"])
        .code(0)
        .says("9 failed");
    place.write("model.toml", &super::sweep_of(MODEL, "[1.0]", ""));
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(0);
}

/// Symptom: 100 runs that failed alike had 100 messages, and their points looked like points that
/// were not run.
#[test]
fn equal_failures_are_told_once_and_their_points_have_a_cross() {
    let values: Vec<String> = (0..16).map(|x| format!("{x}.0")).collect();
    let script = format!("case @{{x}} in [1-9].0) exit 1;; esac\n{MODEL}");
    let place = place_of(&script, &format!("[{}]", values.join(", ")), "");
    let answer = place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(1)
        .says("16 jobs: 7 run now")
        .complains("failed: 9 jobs: `sh model.sh` failed (exit code 1); the first: x = 1, seed 1");
    assert_eq!(answer.stderr.matches("exit code 1").count(), 1);
    let table = place.read("results/model/failed.csv");
    assert_eq!(table.lines().count(), 10, "{table}");
    let has_entry = |figure: &str, entry: &str| {
        let texts = crate::support::texts(&place.read(figure));
        texts.iter().any(|it| it == entry)
    };
    let plot = ["plot", "results/model", "--out", "again"];
    place.phase(&plot).code(0);
    for figure in ["results/model/phase.svg", "again/phase.svg"] {
        assert!(has_entry(figure, "failed") && !has_entry(figure, "not run"));
    }
    std::fs::remove_file(place.path("results/model/failed.csv")).unwrap();
    place.phase(&plot).code(0);
    assert!(has_entry("again/phase.svg", "not run") && !has_entry("again/phase.svg", "failed"));
}

/// The first jobs decide; who gives the same command again has seen why.
#[test]
fn a_program_that_always_fails_is_started_a_few_times() {
    let values: Vec<String> = (0..40).map(|x| format!("{x}.0")).collect();
    let values = format!("[{}]", values.join(", "));
    let sweep = &["sweep", "model.toml", "--allow-program", "-j", "1"];
    let failed = |place: &crate::support::Workplace| {
        let table = place.read("results/model/failed.csv");
        table.lines().count() - 1
    };
    let place = place_of("cat absent-@{x}", &values, "");
    place.phase(sweep).code(1).says("40 failed");
    let place = place_of("exit 1; echo @{x}", &values, "");
    place
        .phase(sweep)
        .code(1)
        .says("8 failed, 32 left")
        .complains("failed: 8 jobs: `sh model.sh` failed (exit code 1)")
        .complains("the first 8 jobs, spread over the sweep, all failed alike");
    assert_eq!(failed(&place), 8);
    // Another failure stops it again, the same one does not.
    let text = super::sweep_of("exit 2; echo @{x}", &values, "");
    place.write("model.toml", &text);
    place.phase(sweep).code(1).says("8 failed, 32 left");
    place.phase(sweep).code(1).says("40 failed");
    assert_eq!(failed(&place), 40);
    place.write("model.toml", &super::sweep_of(MODEL, &values, ""));
    place.phase(sweep).code(0).says("40 run now");
}

#[test]
fn a_program_that_is_not_there_is_named() {
    let place = place_of(MODEL, "[1.0]", "");
    let text = place
        .read("model.toml")
        .replace("\"sh\"", "\"no-such-program\"");
    place.write("model.toml", &text);
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(1)
        .complains(
            "cannot start `no-such-program`: there is no such program, or no interpreter for it",
        );
    let text = text.replace("\"no-such-program\", ", "\"no-such-program ");
    let text = text.replace("program \"model.sh\"", "program model.sh\"");
    place.write("model.toml", &text);
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(1)
        .complains("split it into words: [\"no-such-program\", \"model.sh\"]");
}

#[test]
fn other_exit_codes_may_count_as_success_and_runs_are_tried_again() {
    let counter = tempfile::tempdir().unwrap();
    let file = counter.path().join("tries");
    let script = format!(
        "echo try >> {0}\n[ $(wc -l < {0}) -ge 3 ] || exit 1\n{MODEL}\nexit 4",
        file.display()
    );
    let more = "exit_codes = [0, 4]\nretries = 1";
    let place = place_of(&script, "[1.0]", more);
    let sweep = &["sweep", "model.toml", "--allow-program"];
    place
        .phase(sweep)
        .code(1)
        .complains("failed (exit code 1), in 2 of as many attempts");
    place.phase(sweep).code(0).says("1 run labelled");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "try\n".repeat(3));
}

#[test]
fn folders_of_runs_go_if_the_file_says_so() {
    let script = format!("[ @{{x}} = 2.0 ] && exit 1\n{MODEL}");
    let place = place_of(&script, "[1.0, 2.0]", "keep = \"failed\"");
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(1);
    let entries = std::fs::read_dir(place.path("results/model/records")).unwrap();
    let names = entries.map(|it| it.unwrap().file_name().into_string().unwrap());
    let folders: Vec<String> = names.filter(|it| it.ends_with(".run")).collect();
    assert_eq!(folders.len(), 1, "{folders:?}");
}

#[test]
fn a_folder_of_something_else_is_not_emptied() {
    let place = place_of(MODEL, "[1.0]", "");
    let text = place.read("model.toml");
    let scene = text[..text.find("[[axis]]").unwrap()].replace("scene.", "");
    place.write("one.toml", &scene);
    std::fs::create_dir_all(place.path("mine.run")).unwrap();
    place.write("mine.run/thesis.tex", "years");
    let run = |out: &str| place.phase(&["run", "one.toml", "--allow-program", "--out", out]);
    run("mine.h5")
        .code(1)
        .complains("this is no folder of a run, and would be emptied; move it away");
    assert_eq!(place.read("mine.run/thesis.tex"), "years");
    run("other.h5").code(0).says("completed");
    assert_eq!(place.read("other.run/out.csv"), "t,y\n0,0\n1.5,1.0\n");
}
