//! What the system sets limits to: memory, sizes of files, the standard output, signals, names.
#![cfg(target_os = "linux")]

use crate::support::{TinySweep, Workplace, scene_file, signal, silo_file, wait_until};
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::process::{Output, Stdio};

/// Runs a line of the shell in which `phase` stands for the built program.
fn shell(place: &Workplace, line: &str) -> Output {
    place.shell(line).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Changes of a file that is good otherwise.
type Changes = &'static [(&'static str, &'static str)];

/// Symptom: one number of a file took 20 GB, or ended the program without a word. Cause: walls were
/// built before they were checked, and nothing bounded states and spheres.
#[test]
#[allow(clippy::too_many_lines, reason = "a table")]
fn no_number_of_a_file_takes_the_memory() {
    let cases: [(&str, String, Changes, &str); 12] = [
        (
            "hopper",
            silo_file(),
            &[("spacing = 0.05", "spacing = 5e-8")],
            "geometry.spacing",
        ),
        (
            "hopper",
            silo_file(),
            &[("opening = 0.2", "opening = 1e8")],
            "geometry.opening",
        ),
        (
            "hopper",
            silo_file(),
            &[("top = 0.9", "top = 1e9")],
            "geometry.spacing",
        ),
        (
            "hopper",
            silo_file(),
            &[("half_width = 0.3", "half_width = 1e9")],
            "geometry.spacing",
        ),
        (
            "spheres",
            scene_file(),
            &[
                ("count = 8", "count = 100000000"),
                ("z_max = ", "z_max = 1e8 # "),
            ],
            "spheres.count",
        ),
        (
            "bins",
            scene_file() + "[output]\nprofile_bins = 1000000000\n",
            &[],
            "output.profile_bins",
        ),
        (
            "states",
            scene_file() + "[output]\ntrajectory = true\n",
            &[
                ("count = 8", "count = 900000"),
                ("z_max = ", "z_max = 1e4 # "),
            ],
            "output.trajectory",
        ),
        (
            "states",
            scene_file() + "[output]\nsnapshot_interval = 0.01\n",
            &[
                ("count = 8", "count = 900000"),
                ("z_max = ", "z_max = 1e4 # "),
            ],
            "output.snapshot_interval",
        ),
        (
            "frames",
            scene_file(),
            &[("duration = 2", "duration = 2e9 # ")],
            "time.frame_interval",
        ),
        (
            "values",
            TinySweep::default().text(),
            &[(
                "values = [0.0, 4.0, 8.0]",
                "from = 0.0\nto = 1.0\ncount = 10000000000",
            )],
            "axis[0].count",
        ),
        (
            "jobs",
            TinySweep::default().text(),
            &[("list = [1, 2]", "count = 10000000000")],
            "seeds.count",
        ),
        (
            "jobs",
            TinySweep::default().text()
                + "[[axis]]\nkey = \"density\"\nfrom = 1.0\nto = 9.0\ncount = 99999\n",
            &[(
                "values = [0.0, 4.0, 8.0]",
                "from = 0.0\nto = 1.0\ncount = 99999",
            )],
            "axis",
        ),
    ];
    let place = Workplace::new();
    for (name, mut text, changes, key) in cases {
        for (from, to) in changes {
            assert!(text.contains(from), "{name}: {from} in\n{text}");
            text = text.replace(from, to);
        }
        let file = format!("{name}.toml");
        place.write(&file, &text);
        let output = shell(
            &place,
            &format!("ulimit -v 2000000; phase check --no-trial {file}"),
        );
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{key}: {message}");
        assert!(
            message.contains(&format!("--> {file}:")),
            "{key}: {message}"
        );
    }
}

/// Symptom: a standard output that cannot be written cost a sweep its labels and figures, and a run
/// its table. Cause: the first line that could not be printed ended the command.
#[test]
fn a_full_standard_output_costs_no_file() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    place.write("silo.toml", &silo_file());
    for (command, files) in [
        (
            "phase sweep tiny.toml > /dev/full",
            &[
                "results/tiny/labels.csv",
                "results/tiny/points.csv",
                "results/tiny/phase.png",
            ][..],
        ),
        (
            "phase run silo.toml --out silo.h5 > /dev/full",
            &["silo.h5", "silo-observations.csv"],
        ),
        (
            "phase run silo.toml --out again.h5 --json > /dev/full",
            &["again.h5"],
        ),
    ] {
        let output = shell(&place, command);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{command}: {message}");
        assert!(
            message.contains("cannot write to the standard output"),
            "{message}"
        );
        for file in files {
            assert!(place.path(file).exists(), "{command}: {file}");
        }
    }
    // A reader that goes away is no fault.
    let output = shell(&place, "phase run silo.toml --out silo.h5 | head -n 1");
    assert_eq!(output.status.code(), Some(0));
}

/// Symptom: under `ulimit -f` the program ended without a word. Cause: the signal of a file that
/// grows too large ends a program that does not heed it.
#[test]
fn a_limit_on_the_size_of_files_is_an_error() {
    let place = Workplace::new();
    place.write("scene.toml", &scene_file());
    let output = shell(&place, "ulimit -f 8; phase run scene.toml --out scene.h5");
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(
        message.contains("disk full while writing scene.h5"),
        "{message}"
    );
    assert!(!place.path("scene.h5").exists());
}

/// Symptom: `nohup phase sweep ... &` stopped at the hang-up. Cause: a handler took the place of
/// signals that were ignored when the program started.
#[test]
fn a_signal_that_was_ignored_stays_ignored() {
    let place = Workplace::new();
    let many = TinySweep {
        seeds: (1..=500).collect(),
        ..TinySweep::default()
    };
    place.write("many.toml", &many.text());
    for (name, trap) in [
        ("HUP", "trap '' HUP; "),
        ("INT", "trap '' INT; "),
        ("HUP", ""),
        ("TERM", ""),
    ] {
        let results = format!("{name}{}", trap.len());
        let mut child = place
            .shell(&format!("{trap}exec phase sweep many.toml --out {results}"))
            .stderr(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let records = place.path(&results).join("records");
        wait_until(|| {
            records
                .read_dir()
                .is_ok_and(|mut files| files.next().is_some())
        });
        signal(&child, name);
        std::thread::sleep(std::time::Duration::from_millis(300));
        let ended = child.try_wait().unwrap();
        assert_eq!(
            ended.is_none(),
            !trap.is_empty(),
            "{name} after `{trap}`: {ended:?}"
        );
        child.kill().unwrap();
        child.wait().unwrap();
    }
}

/// Symptom: pictures cut short under their final names after a kill; files `.phase-*.tmp` that
/// stayed. Cause: an export wrote its frames in place, and only sweeps removed what killed ones
/// left.
#[test]
fn a_killed_export_leaves_whole_files_and_the_next_one_cleans_up() {
    let place = Workplace::new();
    place.write(
        "scene.toml",
        &(scene_file() + "[output]\ntrajectory = true\n"),
    );
    place
        .phase(&["run", "scene.toml", "--out", "run.h5"])
        .code(0);
    let export = ["export", "run.h5", "--to", "svg", "--out", "pictures"];
    let pictures = place.path("pictures/run");
    let names = || {
        let files = pictures.read_dir().into_iter().flatten();
        let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
        names.collect::<Vec<_>>()
    };
    for _ in 0..5 {
        let mut child = place.start(&export);
        wait_until(|| names().len() > 1);
        child.kill().unwrap();
        child.wait().unwrap();
        for name in names().iter().filter(|name| name.ends_with(".svg")) {
            let text = std::fs::read_to_string(pictures.join(name)).unwrap();
            assert!(text.trim_end().ends_with("</svg>"), "{name} is cut short");
        }
    }
    place.phase(&export).code(0);
    assert!(
        names().iter().all(|name| name.ends_with(".svg")),
        "{:?}",
        names()
    );
}

/// Symptom: `--json` with a path that is not UTF-8 failed after all work was done.
#[test]
fn a_name_that_json_cannot_hold_is_refused_before_the_work() {
    let place = Workplace::new();
    let name = Path::new(std::ffi::OsStr::from_bytes(b"sc\xffene.toml"));
    std::fs::write(place.path("").join(name), scene_file()).unwrap();
    let run = |json: &[&str]| {
        let mut command = place.command(&["run"]);
        command
            .arg(name)
            .args(["--out", "run.h5"])
            .args(json)
            .output()
            .unwrap()
    };
    let refused = run(&["--json"]);
    assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
    assert!(stderr(&refused).contains("UTF-8"), "{}", stderr(&refused));
    assert!(!place.path("run.h5").exists());
    assert_eq!(run(&[]).status.code(), Some(0));
}

/// Symptom: a file that is not UTF-8 was refused without a line. Cause: it was read as text at
/// once.
#[test]
fn what_is_not_utf8_is_pointed_at() {
    let place = Workplace::new();
    let text = [scene_file().as_bytes(), b"title = \"Z\xfcrich\"\n"].concat();
    std::fs::write(place.path("scene.toml"), &text).unwrap();
    let line = scene_file().lines().count() + 1;
    place
        .phase(&["check", "--no-trial", "scene.toml"])
        .code(2)
        .complains("error: this is not UTF-8 text")
        .complains(&format!("--> scene.toml:{line}:11"))
        .complains("save the file as UTF-8 text");
}
