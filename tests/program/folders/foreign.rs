//! Files of other programs that have the names of ours are not replaced.

use crate::support::{TinySweep, Workplace, scene_file};
use std::fs;

/// Files of another program by their names.
const FOREIGN: [(&str, &str); 7] = [
    (
        "sweep.json",
        "{\"method\": \"bayes\", \"parameters\": {\"lr\": [0.1, 0.2]}}",
    ),
    ("sweep.json", "not JSON at all"),
    ("labels.csv", "image,label\n1.png,cat\n"),
    ("points.csv", "x,y\n1,2\n"),
    ("failed.csv", "id,when\n1,now\n"),
    (
        "phase.svg",
        "<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>",
    ),
    ("settle-time.png", "\u{89}PNG"),
];

/// Symptom: `phase sweep -o DIR` replaced another program's labels.csv, points.csv, sweep.json and
/// phase.svg without a word.
#[test]
fn a_sweep_replaces_no_file_of_another_program() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    let sweep = ["sweep", "tiny.toml", "--out", "out"];
    for (name, text) in FOREIGN {
        fs::create_dir(place.path("out")).unwrap();
        let file = format!("out/{name}");
        place.write(&file, text);
        for more in [&[][..], &["--force"]] {
            place
                .phase(&[&sweep[..], more].concat())
                .code(2)
                .complains(&format!("{file}: phase did not write this file"))
                .complains("choose another folder with --out, or move it away");
            assert_eq!(place.read(&file), text);
            assert_eq!(
                fs::read_dir(place.path("out")).unwrap().count(),
                1,
                "{name}"
            );
        }
        fs::remove_dir_all(place.path("out")).unwrap();
    }
    // Other files are in nobody's way, and the folder is ours from then on.
    fs::create_dir(place.path("out")).unwrap();
    place.write("out/notes.txt", "mine");
    place.write("out/other.svg", "<svg></svg>");
    place.phase(&sweep).code(0);
    place.write("out/phase.svg", "broken");
    place.phase(&sweep).code(0);
    assert!(place.read("out/phase.svg").contains("Software: phase "));
    assert_eq!(place.read("out/notes.txt"), "mine");
    // What is not written is not in the way.
    fs::create_dir(place.path("bare")).unwrap();
    place.write("bare/phase.svg", "<svg></svg>");
    let bare = ["sweep", "tiny.toml", "--out", "bare", "--no-plot"];
    place.phase(&bare).code(0);
    assert_eq!(place.read("bare/phase.svg"), "<svg></svg>");
}

/// Results of an earlier version have keys that this one does not know: they are ours all the same.
#[test]
fn a_sweep_of_an_earlier_version_is_replaced() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    let sweep = ["sweep", "tiny.toml", "--out", "out", "--no-plot"];
    place.phase(&sweep).code(0);
    let text = place
        .read("out/sweep.json")
        .replace("\"sieves\"", "\"thresholds\"");
    place.write("out/sweep.json", &text);
    place.phase(&["status", "out"]).code(1);
    place.phase(&sweep).code(0);
    place.phase(&["status", "out"]).code(0);
}

#[test]
fn figures_and_tables_elsewhere_are_not_replaced() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    place.write("scene.toml", &scene_file());
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    place
        .phase(&["run", "scene.toml", "--ledger", "--out", "run.h5"])
        .code(0);
    for folder in ["figures", "dumps"] {
        fs::create_dir(place.path(folder)).unwrap();
    }
    let theirs = "<svg></svg>";
    place.write("figures/phase.svg", theirs);
    place.write("figures/verification.csv", "a,b\n");
    place.write("run-ledger.svg", theirs);
    place.write("run.xyz", "1\nsteel\nFe 0 0 0\n");
    place.write("run-observations.csv", "a,b\n");
    let record = format!("results/tiny/records/{}", place.records("results/tiny")[0]);
    let dump = ["export", &record, "--to", "dump", "--out", "dumps"];
    place.phase(&dump).code(0);
    place.write("dumps/labels.csv", "image,label\n");
    for (command, file) in [
        (
            &["plot", "results/tiny", "--out", "figures"][..],
            "figures/phase.svg",
        ),
        (
            &["verify", "--family", "impact", "--out", "figures"],
            "figures/verification.csv",
        ),
        (&["plot", "run.h5", "--figure", "ledger"], "run-ledger.svg"),
        (
            &["classify", "dumps", "--scene", "scene.toml"],
            "dumps/labels.csv",
        ),
        (&["export", "run.h5", "--to", "xyz"], "run.xyz"),
        (&["export", "run.h5", "--to", "csv"], "run-observations.csv"),
    ] {
        let before = place.read(file);
        place
            .phase(command)
            .code(2)
            .complains(&format!("{file}: phase did not write this file"));
        assert_eq!(place.read(file), before);
        fs::remove_file(place.path(file)).unwrap();
    }
    for _ in 0..2 {
        // What this program wrote may be written again.
        place
            .phase(&["plot", "results/tiny", "--out", "figures"])
            .code(0);
        place
            .phase(&["plot", "run.h5", "--figure", "ledger"])
            .code(0);
        place.phase(&["export", "run.h5", "--to", "xyz"]).code(0);
        place.phase(&["export", "run.h5", "--to", "csv"]).code(0);
    }
}

/// Symptom: exports, pictures, pages of the manual and a run replaced files of other programs that
/// begin with the same bytes, and files in the folder of an export.
#[test]
fn files_of_the_same_format_are_not_replaced() {
    let place = Workplace::new();
    place.write("scene.toml", &scene_file());
    let run = ["run", "scene.toml", "--snapshot-interval", "0.5"];
    place
        .phase(&[&run[..], &["--out", "run.h5"]].concat())
        .code(0);
    let commands: [(&[&str], &str, &[u8]); 8] = [
        (
            &["run", "scene.toml", "--out", "other.h5"],
            "other.h5",
            b"\x89HDF\r\n\x1a\n theirs",
        ),
        (
            &["export", "run.h5", "--to", "vtk"],
            "run/frame_00000.vtp",
            b"<?xml version=\"1.0\"?>",
        ),
        (
            &["export", "run.h5", "--to", "vtk"],
            "run.pvd",
            b"<?xml version=\"1.0\"?>\n<VTKFile>",
        ),
        (
            &["export", "run.h5", "--to", "svg"],
            "run/frame_00000.svg",
            b"<svg></svg>",
        ),
        (
            &["export", "run.h5", "--to", "npy"],
            "run/mass.npy",
            b"\x93NUMPY",
        ),
        (
            &["view", "run.h5", "--each", "pictures"],
            "pictures/frame_00000.png",
            b"\x89PNG",
        ),
        (&["view", "run.h5"], "run.png", b"\x89PNG\r\n\x1a\n"),
        (
            &["generate", "man", "pages"],
            "pages/phase-view.1",
            b".TH view 1\n",
        ),
    ];
    for (command, file, theirs) in commands {
        let path = place.path(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, theirs).unwrap();
        place.phase(command).code(2).complains(file);
        assert_eq!(fs::read(&path).unwrap(), theirs, "{file}");
        fs::remove_file(&path).unwrap();
        for _ in 0..2 {
            // What this program wrote may be written again.
            place.phase(command).code(0);
        }
    }
}

#[test]
fn studies_replace_no_file_of_another_program() {
    let place = Workplace::new();
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/sweeps");
    for (file, names) in [
        (
            "accuracy/quick.toml",
            &[
                "runs.csv",
                "accuracy.csv",
                "accuracy.json",
                "work-precision.svg",
            ][..],
        ),
        (
            "ablation/quick.toml",
            &["runs.csv", "ablation.csv", "ablation.json", "ablation.png"],
        ),
        (
            "stability/cradle.toml",
            &["runs.csv", "sweep.json", "failed.csv", "stability.svg"],
        ),
    ] {
        for name in names {
            fs::create_dir(place.path("out")).unwrap();
            let path = format!("out/{name}");
            place.write(&path, "theirs");
            place
                .phase(&["study", &format!("{scenes}/{file}"), "--out", "out"])
                .code(2)
                .complains(&format!("{path}: phase did not write this file"));
            assert_eq!(place.read(&path), "theirs");
            fs::remove_dir_all(place.path("out")).unwrap();
        }
    }
}
