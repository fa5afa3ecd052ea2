//! Commands that go through several results folders, records or figures: one that cannot be done
//! does not stop the others.

use crate::support::{Answer, TinySweep, Workplace, scene_file};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Copies the files of a folder, not the folders in it.
fn copy_files(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        if path.is_file() {
            fs::copy(&path, to.join(path.file_name().unwrap())).unwrap();
        }
    }
}

/// A workplace with the published results, and beside them a tiny sweep. Gives the number
/// of published sweeps.
fn published() -> (Workplace, usize) {
    let place = Workplace::new();
    let mut sweeps = 0;
    for entry in fs::read_dir("results").unwrap() {
        let folder = entry.unwrap().path();
        if folder.is_dir() {
            let copy = place.path("").join(&folder);
            copy_files(&folder, &copy);
            sweeps += usize::from(copy.join("sweep.json").exists());
        }
    }
    assert!(sweeps > 10);
    place.write("tiny.toml", &TinySweep::default().text());
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    (place, sweeps)
}

/// The entries of folders of an answer.
fn entries(answer: &Answer) -> Vec<Value> {
    let answer: Value = serde_json::from_str(&answer.stdout).unwrap();
    answer["folders"].as_array().unwrap().clone()
}

/// The entry of the folder of that name.
fn entry<'a>(entries: &'a [Value], name: &str) -> &'a Value {
    let path = format!("results/{name}");
    entries
        .iter()
        .find(|it| it["folder"] == path.as_str())
        .unwrap()
}

/// What became of the folders `a`, `b` and `c`.
fn outcomes(entries: &[Value]) -> Vec<String> {
    let outcome = |it: &Value| it["outcome"].as_str().unwrap().to_owned();
    entries.iter().map(outcome).collect()
}

/// Symptom: `phase classify results` ended at the first published folder, and never came to the one
/// whose runs are there. Cause: a folder that could not be labelled ended the loop.
#[test]
fn published_results_are_kept_and_others_labelled() {
    let (place, sweeps) = published();
    let labels = place.read("results/beverloo/labels.csv");
    let tiny = place.read("results/tiny/labels.csv");
    fs::remove_file(place.path("results/tiny/labels.csv")).unwrap();
    let answer = place.phase(&["classify", "results", "--json"]).code(0);
    let entries = entries(&answer);
    assert_eq!(entries.len(), sweeps + 1);
    let one = entry(&entries, "tiny");
    assert_eq!(
        (&one["outcome"], &one["labelled"]),
        (&"done".into(), &6.into())
    );
    assert_eq!(
        entries.iter().filter(|it| it["outcome"] == "kept").count(),
        sweeps
    );
    let kept = entry(&entries, "beverloo");
    let reason = kept["reason"].as_str().unwrap();
    assert!(
        reason.contains("labels are not in results/beverloo/records"),
        "{reason}"
    );
    assert!(!answer.stderr.contains("error"), "{}", answer.stderr);
    assert!(answer.stderr.contains("kept: results/beverloo/labels.csv"));
    assert_eq!(place.read("results/tiny/labels.csv"), tiny);
    assert_eq!(place.read("results/beverloo/labels.csv"), labels);
    // Named itself, it is refused.
    let alone = place
        .phase(&["classify", "results/beverloo", "--json"])
        .code(2);
    assert_eq!(alone.stdout, "");

    let answer = place.phase(&["status", "results", "--json"]).code(0);
    assert_eq!(self::entries(&answer).len(), sweeps + 1);
    let answer = place
        .phase(&["plot", "results", "--out", "figures", "--json"])
        .code(0);
    let drawn = self::entries(&answer);
    assert_eq!(drawn.len(), sweeps + 1);
    assert!(
        drawn
            .iter()
            .all(|it| it["files"].as_array().unwrap().len() >= 2)
    );
    // What this program drew may be drawn again.
    place
        .phase(&["plot", "results/tiny", "--out", "figures/tiny"])
        .code(0);
}

/// Results folders `a`, `b` and `c` of which `b` cannot be read.
fn with_a_broken_one() -> Workplace {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    for name in ["a", "c"] {
        let out = format!("results/{name}");
        place
            .phase(&["sweep", "tiny.toml", "--no-plot", "--out", &out])
            .code(0);
    }
    copy_files(&place.path("results/a"), &place.path("results/b"));
    place.write("results/b/sweep.json", "{\"title\": null}");
    place
}

#[test]
fn a_folder_that_cannot_be_read_does_not_stop_the_others() {
    let place = with_a_broken_one();
    for command in [
        &["status", "results"][..],
        &["classify", "results"],
        &["plot", "results"],
        &["plot", "--list", "results"],
        &["plot", "results", "--figure", "phase"],
    ] {
        let answer = place.phase(&[command, &["--json"]].concat()).code(1);
        let answer = answer.complains("error: results/b/sweep.json: this is no sweep of phase");
        let entries = entries(&answer);
        assert_eq!(
            outcomes(&entries),
            ["done", "failed", "done"],
            "{command:?}"
        );
        let reason = entry(&entries, "b")["reason"].as_str().unwrap();
        assert!(reason.contains("results/b/sweep.json"), "{reason}");
    }
    for name in ["a", "c"] {
        assert!(place.path(&format!("results/{name}/phase.svg")).exists());
    }
    // Named itself, it fails as a whole.
    let answer = place.phase(&["status", "results/b", "--json"]).code(1);
    assert_eq!(answer.stdout, "");
}

/// Symptom: `--sweep` changed the first folder before it refused the second.
#[test]
fn edited_thresholds_change_all_folders_or_none() {
    let place = with_a_broken_one();
    let edited = TinySweep {
        more: "[sieves.settle]\ntolerance = 1e-30".to_owned(),
        ..TinySweep::default()
    };
    place.write("edited.toml", &edited.text());
    let files = || {
        ["a", "c"].map(|name| {
            ["labels.csv", "sweep.json"].map(|file| place.read(&format!("results/{name}/{file}")))
        })
    };
    let before = files();
    let classify = ["classify", "results", "--sweep", "edited.toml"];
    place
        .phase(&classify)
        .code(1)
        .complains("results/b/sweep.json");
    assert_eq!(files(), before);
    // One with other runs.
    let other = TinySweep {
        omegas: vec![6.0],
        ..TinySweep::default()
    };
    place.write("other.toml", &other.text());
    fs::remove_dir_all(place.path("results/b")).unwrap();
    place
        .phase(&["sweep", "other.toml", "--no-plot", "--out", "results/b"])
        .code(0);
    place
        .phase(&classify)
        .code(2)
        .complains("results/b: the edited sweep describes other runs");
    assert_eq!(files(), before);
    fs::remove_dir_all(place.path("results/b")).unwrap();
    place.phase(&classify).code(0).says("6 of 6 labels changed");
    let after = files();
    assert!(after[0] != before[0] && after[1] != before[1]);
}

/// Symptom: results whose sweep.json was lost were passed over, with exit 0. Cause: a folder
/// counted only if a file of that name could be seen in it.
#[cfg(unix)]
#[test]
fn results_without_their_sweep_are_named() {
    let place = with_a_broken_one();
    let sweep = |name: &str| place.path(&format!("results/{name}/sweep.json"));
    let copy = |name: &str| {
        copy_files(
            &place.path("results/a"),
            &place.path(&format!("results/{name}")),
        );
        fs::remove_file(sweep(name)).unwrap();
    };
    ["b1", "b2", "b3", "b4"].into_iter().for_each(copy);
    fs::create_dir_all(place.path("results/b4/records")).unwrap();
    fs::rename(
        place.path("results/b4/labels.csv"),
        place.path("results/b4/records/0123456789abcdef.h5"),
    )
    .unwrap();
    std::os::unix::fs::symlink("nowhere.json", sweep("b2")).unwrap();
    fs::create_dir(sweep("b3")).unwrap();
    // These are no results: files of others, and dumps with labels.
    for name in ["d/notes.txt", "e/labels.csv", "f/dump.npy"] {
        fs::create_dir_all(place.path("results").join(name).parent().unwrap()).unwrap();
        place.write(&format!("results/{name}"), "of others\n");
    }
    fs::copy(
        place.path("results/a/labels.csv"),
        place.path("results/f/labels.csv"),
    )
    .unwrap();
    for command in ["status", "classify", "plot"] {
        let answer = place.phase(&[command, "results", "--json"]).code(1);
        let entries = entries(&answer);
        let expected = [
            "done", "failed", "failed", "failed", "failed", "failed", "done",
        ];
        assert_eq!(outcomes(&entries), expected, "{command}");
        for (name, reason) in [
            ("b1", "this file is missing"),
            ("b2", "this link leads nowhere"),
            ("b3", "this is a folder"),
            ("b4", "this file is missing"),
        ] {
            let found = entry(&entries, name)["reason"].as_str().unwrap();
            let expected = format!("results/{name}/sweep.json: {reason}");
            assert!(found.starts_with(&expected), "{found}");
        }
    }
    // Named itself, such a folder is no folder of folders.
    let answer = place.phase(&["status", "results/b2"]).code(1);
    answer.complains("results/b2/sweep.json: this link leads nowhere");
}

/// Symptom: a folder that nobody may look into was passed over, with exit 0.
#[cfg(unix)]
#[test]
fn a_folder_that_nobody_may_look_into_is_named() {
    use std::os::unix::fs::PermissionsExt;
    let place = with_a_broken_one();
    let folder = place.path("results/b");
    let allow = |mode| fs::set_permissions(&folder, fs::Permissions::from_mode(mode)).unwrap();
    allow(0);
    if fs::read_dir(&folder).is_ok() {
        // The superuser may look into every folder.
        return;
    }
    let answer = place.phase(&["status", "results", "--json"]);
    allow(0o755);
    let answer = answer.code(1).complains("check the permissions");
    assert_eq!(outcomes(&entries(&answer)), ["done", "failed", "done"]);
}

/// Symptom: `--sweep` changed folders before it came to one whose tables cannot be written; of one
/// with a damaged record the label was lost.
#[test]
fn edited_thresholds_leave_a_folder_that_cannot_have_them_as_it_was() {
    let place = with_a_broken_one();
    fs::remove_dir_all(place.path("results/b")).unwrap();
    place
        .phase(&["sweep", "tiny.toml", "--no-plot", "--out", "results/b"])
        .code(0);
    let edited = TinySweep {
        more: "[sieves.settle]\ntolerance = 1e-30".to_owned(),
        ..TinySweep::default()
    };
    place.write("edited.toml", &edited.text());
    let files = || {
        ["a", "b", "c"].map(|name| {
            ["labels.csv", "sweep.json"].map(|file| place.read(&format!("results/{name}/{file}")))
        })
    };
    let before = files();
    let points = place.path("results/c/points.csv");
    fs::remove_file(&points).unwrap();
    fs::create_dir(&points).unwrap();
    let classify = ["classify", "results", "--sweep", "edited.toml", "--json"];
    place
        .phase(&classify)
        .code(1)
        .complains("cannot write results/c/points.csv");
    assert_eq!(files(), before);
    fs::remove_dir(&points).unwrap();
    let record = place.records("results/b")[0].clone();
    place.write(&format!("results/b/records/{record}"), "broken");
    let answer = place.phase(&classify).code(1);
    let entries = entries(&answer);
    assert_eq!(outcomes(&entries), ["done", "failed", "done"]);
    let reason = entry(&entries, "b")["reason"].as_str().unwrap();
    assert!(reason.contains("1 record cannot be labelled"), "{reason}");
    let after = files();
    assert_eq!(after[1], before[1]);
    assert!(after[0] != before[0] && after[2] != before[2]);
    // The way out that the message names.
    let sweep = ["sweep", "tiny.toml", "--no-plot", "--out", "results/b"];
    place.phase(&sweep).code(0);
    place.phase(&classify).code(0);
    assert!(files()[1] != before[1]);
}

/// Symptom: `--figure a,b` drew nothing of `b` where `a` could not be drawn.
#[test]
fn a_figure_that_cannot_be_drawn_does_not_stop_the_others() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    let figures = [
        "plot",
        "results/tiny",
        "--figure",
        "discharge-rate,phase",
        "--json",
    ];
    let answer = place
        .phase(&figures)
        .code(1)
        .complains("`discharge-rate` is not a figure");
    let entries = entries(&answer);
    assert_eq!(entries[0]["problems"].as_array().unwrap().len(), 1);
    assert_eq!(entries[0]["files"][1], "results/tiny/phase.png");
    // Nothing is drawn: refused as before.
    let alone = ["plot", "results/tiny", "--figure", "discharge-rate"];
    place.phase(&alone).code(2);
    // In a sweep a figure that is in the way as a folder costs nothing else.
    fs::remove_file(place.path("results/tiny/phase.svg")).unwrap();
    fs::create_dir(place.path("results/tiny/phase.svg")).unwrap();
    let answer = place.phase(&["sweep", "tiny.toml", "--json"]).code(1);
    let answer: Value = serde_json::from_str(&answer.stdout).unwrap();
    assert_eq!(answer["problems"].as_array().unwrap().len(), 1, "{answer}");
    assert!(place.path("results/tiny/settle-time.png").exists());
}

/// Symptom: `phase export a.h5 b.h5` exported nothing of `b` where `a` was no record.
#[test]
fn a_record_that_cannot_be_exported_does_not_stop_the_others() {
    let place = Workplace::new();
    place.write("scene.toml", &scene_file());
    place.phase(&["run", "scene.toml", "--out", "b.h5"]).code(0);
    place.write("a.h5", "no record");
    let export = [
        "export", "a.h5", "b.h5", "--to", "csv", "--out", "tables", "--json",
    ];
    let answer = place.phase(&export).code(1).complains("a.h5");
    let answer: Value = serde_json::from_str(&answer.stdout).unwrap();
    assert_eq!(answer["failed"][0]["record"], "a.h5");
    assert_eq!(answer["files"][0], "tables/b.csv");
    place.phase(&["export", "a.h5", "--to", "csv"]).code(2);
}

/// Symptom: `--json` printed nothing where a folder has a name that is not UTF-8.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_whose_name_is_not_text_has_its_entry() {
    use std::os::unix::ffi::OsStrExt;
    let place = with_a_broken_one();
    let name = std::ffi::OsStr::from_bytes(b"d\xff");
    fs::rename(place.path("results/b"), place.path("results").join(name)).unwrap();
    fs::copy(
        place.path("results/a/sweep.json"),
        place.path("results").join(name).join("sweep.json"),
    )
    .unwrap();
    for command in ["status", "plot"] {
        let answer = place.phase(&[command, "results", "--json"]).code(0);
        let entries = entries(&answer);
        assert_eq!(outcomes(&entries), ["done"; 3]);
        assert_eq!(entry(&entries, "d\u{fffd}")["outcome"], "done");
    }
}
