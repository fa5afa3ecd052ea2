//! What editors, shells and scripts are given: schemas, starter files, completions, manual pages,
//! `--json`. `BLESS=1` writes the pages in `docs/` anew.

use crate::support::{TinySweep, Workplace, drainage_file, scene_file};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The commands that answer in JSON are tested below; these are all.
const COMMANDS: [&str; 19] = [
    "sweep", "classify", "plot", "report", "run", "export", "view", "check", "cost", "compare",
    "fit", "study", "verify", "jobs", "submit", "status", "merge", "new", "generate",
];

#[test]
fn documents_are_what_the_program_prints() {
    let place = Workplace::new();
    for (arguments, path) in [
        (["schema", "scene"], "docs/schema/scene.json"),
        (["schema", "sweep"], "docs/schema/sweep.json"),
        (["schema", "stability"], "docs/schema/stability.json"),
        (["schema", "accuracy"], "docs/schema/accuracy.json"),
        (["reference", "keys"], "docs/reference.md"),
        (["reference", "notation"], "docs/notation.md"),
    ] {
        let arguments = [&["generate"], &arguments[..]].concat();
        let printed = place.phase(&arguments).code(0).stdout;
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(path, &printed).unwrap();
        }
        let kept = std::fs::read_to_string(path).unwrap_or_default();
        assert!(
            printed == kept,
            "{path} is not what `phase {}` prints; write it anew with BLESS=1",
            arguments.join(" ")
        );
    }
}

#[test]
fn the_reference_tells_type_unit_default_and_description() {
    let page = Workplace::new()
        .phase(&["generate", "reference", "keys"])
        .code(0);
    page.says("| `density` | number, 1e-9 to 1e15 (kg/m³, kg/m²) | *needed* | Density rho")
        .says("| `dt` | number, 1e-15 to 1e15 or \"auto\" (s) | *needed* | Time step dt;")
        .says("| `overlap` | number > 0 | `1.5` | Largest overlap")
        .says("| `window` | number > 0 (s) | `0.5` | Window. |")
        .says("### `[friction]` with `law = \"mindlin\"`")
        .says("Largest \\|x\\| and \\|y\\| of a centre");
}

/// TOML files in a folder and those below it.
fn toml_files(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            toml_files(&path, files);
        } else if path.extension().is_some_and(|end| end == "toml") {
            files.push(path);
        }
    }
}

#[test]
fn shipped_files_name_their_schema_in_the_first_line() {
    let mut files = Vec::new();
    toml_files(Path::new("sweeps"), &mut files);
    assert!(files.len() >= 9);
    for path in files {
        let text = std::fs::read_to_string(&path).unwrap();
        let keys = toml::from_str::<toml::Table>(&text).unwrap();
        let kind = match keys.get("study").and_then(toml::Value::as_str) {
            Some(study) if study != "ablation" => study,
            // The file of an ablation is one of a sweep.
            _ if keys.contains_key("scene") => "sweep",
            _ => "scene",
        };
        let up = "../".repeat(path.components().count() - 1);
        assert_eq!(
            text.lines().next(),
            Some(format!("#:schema {up}docs/schema/{kind}.json").as_str()),
            "{}",
            path.display()
        );
    }
}

#[test]
fn new_files_pass_the_check() {
    let place = Workplace::new();
    for (arguments, path, says) in [
        (&["scene", "tank"][..], "tank.toml", "1 job"),
        (&["scene", "a/b/tank.toml"], "a/b/tank.toml", "1 job"),
        (&["silo", "silo"], "silo.toml", "feed, door, outlet"),
        (&["sweep", "alone"], "alone.toml", "15 jobs"),
        (
            &["sweep", "a/diagram", "--scene", "a/b/tank.toml"],
            "a/diagram.toml",
            "15 jobs",
        ),
    ] {
        let answer = place.phase(&[&["new"], arguments].concat()).code(0);
        assert_eq!(answer.stdout, format!("{path}\n"));
        place
            .phase(&["check", path, "--no-trial"])
            .code(0)
            .says(says);
    }
}

/// Symptom: a sweep over a scene that has none of its axes, or is not there, without a word.
#[test]
fn a_new_sweep_says_what_its_scene_lacks() {
    let place = Workplace::new();
    place.phase(&["new", "spot", "box"]).code(0);
    for (scene, lack) in [("box.toml", "no [swirl]"), ("none.toml", "cannot read")] {
        place
            .phase(&["new", "sweep", "mine", "--force", "--scene", scene])
            .code(0)
            .complains("does not fit its scene yet")
            .complains(lack);
    }
}

/// Symptom: `--scene` took its path from the folder of the new file, unlike every other path of a
/// command line.
#[test]
fn a_new_sweep_names_its_scene_from_its_own_folder() {
    let place = Workplace::new();
    for (scene, sweep, path) in [
        ("tank", "diagram", "tank.toml"),
        ("tank", "a/diagram", "../tank.toml"),
        ("scenes/tank", "a/b/diagram", "../../scenes/tank.toml"),
        ("a/tank", "a/other", "tank.toml"),
    ] {
        place.phase(&["new", "scene", scene, "--force"]).code(0);
        let file = format!("{scene}.toml");
        let new = place
            .phase(&["new", "sweep", sweep, "--scene", &file])
            .code(0);
        assert!(!new.stderr.contains("does not fit"), "{new:#?}");
        let text = place.read(&format!("{sweep}.toml"));
        assert!(text.contains(&format!("scene = \"{path}\"")), "{text}");
        let check = ["check", &format!("{sweep}.toml"), "--no-trial"];
        place.phase(&check).code(0).says("15 jobs");
    }
}

/// Symptom: the new sweep named a scene that is not there. Cause: what is no text in a path became
/// U+FFFD.
#[cfg(target_os = "linux")]
#[test]
fn a_new_sweep_does_not_name_a_scene_that_no_text_can_name() {
    use std::os::unix::ffi::OsStrExt;
    let place = Workplace::new();
    let mut new = place.command(&["new", "sweep", "mine", "--scene"]);
    let output = new.arg(std::ffi::OsStr::from_bytes(b"d\xff.toml")).output();
    let output = output.unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        said.contains("a sweep file is UTF-8 text, and this path is not"),
        "{said}"
    );
    assert!(!place.path("mine.toml").exists());
}

#[test]
fn new_files_comment_every_table() {
    let place = Workplace::new();
    for kind in ["scene", "sweep", "silo"] {
        place.phase(&["new", kind, kind]).code(0);
        let text = place.read(&format!("{kind}.toml"));
        assert!(text.starts_with("# "), "{text}");
        let comments = text.matches("# ").count();
        assert!(2 * comments > text.matches(" = ").count(), "{text}");
    }
}

#[test]
fn new_replaces_nothing_unless_it_is_told_to() {
    let place = Workplace::new();
    place.write("mine.toml", "# mine\n");
    place
        .phase(&["new", "scene", "mine"])
        .code(2)
        .complains("mine.toml: the file exists already")
        .complains("--force");
    assert_eq!(place.read("mine.toml"), "# mine\n");
    place.phase(&["new", "scene", "mine", "--force"]).code(0);
    assert!(place.read("mine.toml").contains("[spheres]"));
    place
        .phase(&["new", "scene", "other", "--scene", "mine.toml"])
        .code(2)
        .complains("phase new sweep");
    place.phase(&["new", "tank", "other"]).code(2);
    assert!(!place.path("other.toml").exists());
}

#[test]
fn completions_know_every_command() {
    let place = Workplace::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = place
            .phase(&["generate", "completions", shell])
            .code(0)
            .stdout;
        for command in COMMANDS {
            assert!(script.contains(command), "{shell} does not know {command}");
        }
        assert!(script.contains("no-trial"), "{shell}");
    }
    place
        .phase(&["generate", "completions", "nonsense"])
        .code(2);
}

#[test]
fn every_command_has_a_manual_page() {
    let place = Workplace::new();
    let answer = place.phase(&["generate", "man", "share/man1"]).code(0);
    let page = place.read("share/man1/phase.1");
    assert!(page.contains(".TH phase 1"), "{page}");
    for command in COMMANDS {
        assert!(page.contains(&format!("phase\\-{command}(1)")));
    }
    assert_eq!(answer.stdout.lines().count(), COMMANDS.len() + 1);
    for command in COMMANDS {
        let page = place.read(&format!("share/man1/phase-{command}.1"));
        assert!(page.contains(&format!(".TH phase-{command} 1")), "{page}");
        assert!(page.contains(&format!("\\fBphase {command}\\fR")), "{page}");
    }
}

/// What a command answers in JSON: one line, with keys that `docs/json.md` names.
#[track_caller]
fn answer(place: &Workplace, arguments: &[&str], code: i32) -> Value {
    let stdout = place
        .phase(&[arguments, &["--json"]].concat())
        .code(code)
        .stdout;
    assert_eq!(stdout.matches('\n').count(), 1, "{stdout}");
    let answer: Value = serde_json::from_str(&stdout).unwrap();
    assert!(answer.is_object());
    let page = std::fs::read_to_string("docs/json.md").unwrap();
    let (_, rest) = page
        .split_once(&format!("## `phase {} ", arguments[0]))
        .unwrap();
    // A sweep's labels are described with those of `classify`.
    let chapter = match arguments[0] {
        "sweep" => rest,
        _ => rest.split("\n## ").next().unwrap(),
    };
    assert_described(&answer, chapter);
    answer
}

#[track_caller]
fn assert_described(value: &Value, chapter: &str) {
    match value {
        Value::Object(table) => {
            for (key, value) in table {
                // The names of axes are those of the sweep.
                if key != "omega" {
                    assert!(
                        chapter.contains(&format!("`{key}`")),
                        "docs/json.md does not say what `{key}` is"
                    );
                }
                assert_described(value, chapter);
            }
        }
        Value::Array(entries) => entries
            .iter()
            .for_each(|entry| assert_described(entry, chapter)),
        _ => {}
    }
}

#[test]
fn a_sweep_answers_in_json() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    let forecast = answer(&place, &["check", "tiny.toml"], 0);
    assert_eq!(forecast["kind"], "sweep");
    assert_eq!(forecast["jobs"], 6);
    assert_eq!(
        forecast["axes"][0]["values"],
        serde_json::json!([0.0, 4.0, 8.0])
    );
    assert_eq!(forecast["limits"][0]["decisive"], true);
    assert!(forecast["limits"][0]["ratio"].as_f64().unwrap() < 1.0);
    assert!(forecast["forecast"]["disk"].as_f64().unwrap() > 0.0);

    let cost = answer(&place, &["cost", "tiny.toml", "--seconds", "1"], 0);
    assert_eq!((&cost["kind"], &cost["jobs"]), (&"sweep".into(), &6.into()));
    let parts = cost["parts"].as_array().unwrap();
    let shares = parts.iter().map(|part| part["share"].as_f64().unwrap());
    assert!((shares.sum::<f64>() - 1.0).abs() < 1e-9, "{cost}");
    assert_eq!(cost["tried"][1]["point"]["omega"], 8.0);

    let swept = answer(&place, &["sweep", "tiny.toml"], 0);
    assert_eq!(swept["folder"], "results/tiny");
    assert_eq!(
        (&swept["jobs"], &swept["run_now"]),
        (&6.into(), &6.into()),
        "{swept}"
    );
    assert_eq!(swept["interrupted"], false);
    let labels = swept["labels"]["labels"].as_object().unwrap();
    let labelled: u64 = labels.values().map(|runs| runs.as_u64().unwrap()).sum();
    assert_eq!(labelled, 6);
    let files = swept["files"].as_array().unwrap();
    assert!(files.contains(&"results/tiny/phase.png".into()), "{swept}");

    let again = answer(&place, &["sweep", "tiny.toml", "--no-plot", "--quiet"], 0);
    assert_eq!(
        (&again["done_before"], &again["run_now"]),
        (&6.into(), &0.into())
    );

    let status = answer(&place, &["status", "results"], 0);
    assert_eq!(status["folders"][0]["done"], 6);
    assert_eq!(status["folders"][0]["running"], serde_json::json!([]));

    let reported = answer(&place, &["report", "results/tiny"], 0);
    let page = &reported["pages"][0];
    let size = std::fs::metadata(place.path("results/tiny/report.html")).unwrap();
    assert_eq!(
        (&page["runs"], &page["bytes"]),
        (&6.into(), &size.len().into())
    );

    let more = "[sieves.settle]\ntolerance = 1e-30".to_owned();
    let edited = TinySweep {
        more,
        ..TinySweep::default()
    };
    place.write("edited.toml", &edited.text());
    let arguments = ["classify", "results/tiny", "--sweep", "edited.toml"];
    let classified = answer(&place, &arguments, 0);
    let folder = &classified["folders"][0];
    assert_eq!(folder["labels"]["unsettled"], 6);
    let changes = folder["changes"].as_array().unwrap();
    let changed: u64 = changes
        .iter()
        .map(|change| change["runs"].as_u64().unwrap())
        .sum();
    assert_eq!((changed, &changes[0]["to"]), (6, &"unsettled".into()));
}

#[test]
fn unstable_runs_are_named_in_json() {
    let place = Workplace::new();
    let more = "[scene.guards]\ndisplacement = 1e-6".to_owned();
    let sweep = TinySweep {
        more,
        ..TinySweep::default()
    };
    place.write("tiny.toml", &sweep.text());
    let swept = answer(&place, &["sweep", "tiny.toml", "--no-plot"], 0);
    let unstable = swept["unstable"].as_array().unwrap();
    assert_eq!(unstable.len(), 6);
    assert_eq!(unstable[2]["point"]["omega"], 4.0);
    assert_eq!(unstable[2]["seed"], 1);
    let reason = unstable[2]["reason"].as_str().unwrap();
    assert!(reason.starts_with("displacement guard"), "{reason}");
}

#[test]
fn a_run_answers_in_json() {
    let place = Workplace::new();
    place.write("scene.toml", &scene_file());
    let run = answer(&place, &["run", "scene.toml", "--seed", "5"], 0);
    assert_eq!(run["record"], "results/scene.h5");
    assert_eq!((&run["seed"], &run["frames"]), (&5.into(), &201.into()));
    assert_eq!(run["outcome"], "completed");
    assert_eq!(run["last_frame"]["time"], 2.0);
    assert!(run["last_frame"]["height_mean"].as_f64().unwrap() > 0.0);

    let text = format!("{}[guards]\ndisplacement = 1e-6\n", scene_file());
    place.write("scene.toml", &text);
    let run = answer(&place, &["run", "scene.toml"], 0);
    assert_eq!(run["outcome"], "unstable");
    assert_eq!(run["instability"]["guard"], "displacement");
}

#[test]
fn a_comparison_answers_in_json() {
    let place = Workplace::new();
    place.write("scene.toml", &drainage_file());
    place
        .phase(&["run", "scene.toml", "--out", "run.h5"])
        .code(0);
    let compared = answer(&place, &["compare", "run.h5", "run.h5"], 0);
    assert_eq!(compared["records"], serde_json::json!(["run.h5", "run.h5"]));
    assert_eq!(compared["rows"][0]["difference"], 0.0);
}

#[test]
fn a_study_of_stability_answers_in_json() {
    let place = Workplace::new();
    let axes = "[[axis]]\nkey = \"time.dt\"\nvalues = [1e-4, 2e-2]\n\
                [[axis]]\nkey = \"contact.young_modulus\"\nvalues = [1e5, 1e6]\n";
    place.write("scene.toml", &scene_file());
    place.write(
        "study.toml",
        &format!("study = \"stability\"\nscene = \"scene.toml\"\n{axes}"),
    );
    let study = answer(&place, &["study", "study.toml"], 0);
    assert_eq!(study["folder"], "results/stability/study");
    assert_eq!(
        (&study["runs"], &study["run_now"]),
        (&16.into(), &16.into())
    );
    let euler = &study["finding"]["integrators"][0];
    assert_eq!(euler["integrator"], "symplectic-euler");
    let runs = euler["labels"].as_object().unwrap().values();
    assert_eq!(runs.map(|runs| runs.as_u64().unwrap()).sum::<u64>(), 4);
    assert!(
        euler["none_stable_above"].as_f64().unwrap() > 0.1,
        "{euler}"
    );
    let files = study["files"].as_array().unwrap();
    assert!(
        files.contains(&"results/stability/study/stability.png".into()),
        "{study}"
    );
}

#[test]
fn a_refined_sweep_answers_in_json() {
    let place = Workplace::new();
    let tiny = TinySweep::default().text();
    let table = "[refine]\nbudget = 4\nstart = [2]\nround = 1";
    place.write("tiny.toml", &tiny.replace("[seeds]\nlist = [1, 2]", table));
    let check = answer(&place, &["check", "tiny.toml", "--no-trial"], 0);
    assert_eq!((&check["jobs"], &check["budget"]), (&2.into(), &4.into()));
    let swept = answer(&place, &["sweep", "tiny.toml", "--no-plot"], 0);
    let refined = &swept["refined"];
    assert_eq!(refined["end"], "budget", "{swept}");
    assert_eq!(
        (&refined["runs"], &refined["budget"]),
        (&4.into(), &4.into())
    );
    let border = &refined["borders"][0];
    assert_eq!(border["axis"], "omega", "{swept}");
    assert_eq!(border["labels"][1], "pinned", "{swept}");
    let status = answer(&place, &["status", "results/tiny"], 0);
    let folder = &status["folders"][0]["refined"];
    assert_eq!(folder["end"], "budget");
    assert_eq!(folder["borders"], refined["borders"]);
}

/// Symptom: `--json` before the command was refused, and `phase new --json` was not.
#[test]
fn commands_without_a_result_for_programs_refuse_json() {
    let place = Workplace::new();
    let list = place.phase(&["--json", "plot", "--list"]).code(0);
    assert!(list.stdout.starts_with('{'), "{}", list.stdout);
    for arguments in [
        &["new", "scene", "tank", "--json"][..],
        &["generate", "schema", "scene", "--json"],
    ] {
        let answer = place.phase(arguments).code(2);
        assert_eq!(answer.stdout, "");
        answer.complains("no result for programs; leave out --json");
    }
    assert!(!place.path("tank.toml").exists());
}

#[test]
fn figures_are_listed_in_json() {
    let place = Workplace::new();
    let list = answer(&place, &["plot", "--list"], 0);
    let figures = list["figures"].as_array().unwrap();
    assert!(figures.iter().any(|figure| figure["name"] == "phase"));
}

#[test]
fn what_is_refused_answers_nothing() {
    let place = Workplace::new();
    place.write("scene.toml", &scene_file().replace("density", "densty"));
    for arguments in [
        &["run", "scene.toml"][..],
        &["check", "scene.toml"],
        &["sweep", "absent.toml"],
        &["status", "absent"],
    ] {
        let answer = place.phase(&[arguments, &["--json"]].concat()).code(2);
        assert_eq!(answer.stdout, "");
        assert!(answer.stderr.starts_with("error: "), "{}", answer.stderr);
    }
}
