//! Records are HDF5 files that the HDF5 library reads, number by number.
//!
//! Needs python3 with h5py, and h5dump. Where they are absent the test says that it was skipped;
//! with `PHASE_NEED_HDF5=1` in the environment, as in continuous integration, it fails.

use super::examples;
use phase::record::RunRecord;
use phase::scene::{Start, StartSphere};
use phase::store::write_record;
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;
use std::process::Command;

/// What a program prints, if it can be run and succeeds.
fn output(command: &mut Command) -> Option<String> {
    let output = command
        .output()
        .ok()
        .filter(|output| output.status.success())?;
    String::from_utf8(output.stdout).ok()
}

fn skip(missing: &str) {
    let required = std::env::var_os("PHASE_NEED_HDF5").is_some();
    assert!(!required, "{missing} is needed but absent");
    // Not eprintln!, which the test runner hides.
    let message = format!("SKIPPED a check of records: {missing} is absent\n");
    std::io::stderr().write_all(message.as_bytes()).unwrap();
}

fn python() -> String {
    std::env::var("PHASE_PYTHON").unwrap_or_else(|_| "python3".to_owned())
}

fn example() -> RunRecord {
    with_all(examples::record(501, 15, 20, 2))
}

/// The record with everything that one may hold.
fn with_all(mut record: RunRecord) -> RunRecord {
    record.outcome = examples::unstable();
    record.trajectory = record.snapshots.clone();
    for state in &mut record.trajectory {
        state.spin = ndarray::Array2::zeros((0, 3));
    }
    record
}

/// The spheres of a start that lists more than a record's text holds.
fn long_start(start: &Start) -> &[StartSphere] {
    match start {
        Start::List { spheres } if spheres.len() > 1000 => spheres,
        _ => &[],
    }
}

/// Every dataset by path: type, shape, and bytes in hexadecimal.
fn datasets(record: &RunRecord) -> Value {
    let mut all = serde_json::Map::new();
    let mut add = |name: String, kind: &str, shape: &[usize], bytes: Vec<u8>| {
        let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        all.insert(name, json!({ "dtype": kind, "shape": shape, "bytes": hex }));
    };
    fn f64s<'a>(values: impl IntoIterator<Item = &'a f64>) -> Vec<u8> {
        values
            .into_iter()
            .flat_map(|value| value.to_le_bytes())
            .collect()
    }
    fn f32s<'a>(values: impl IntoIterator<Item = &'a f32>) -> Vec<u8> {
        values
            .into_iter()
            .flat_map(|value| value.to_le_bytes())
            .collect()
    }
    let count = record.radius.len();
    add(
        "spheres/radius".into(),
        "<f8",
        &[count],
        f64s(&record.radius),
    );
    add("spheres/mass".into(), "<f8", &[count], f64s(&record.mass));

    let observations = &record.observations;
    let frames = observations.frames();
    add(
        "observations/time".into(),
        "<f8",
        &[frames],
        f64s(&observations.time),
    );
    for series in observations.scalars() {
        let name = format!("observations/{}", series.name);
        add(name, "<f4", &[frames], f32s(series.values));
    }
    let profile = &observations.profile;
    add(
        "observations/profile".into(),
        "<f4",
        profile.shape(),
        f32s(profile),
    );
    let rising = &observations.rising;
    let bytes = rising
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    add("observations/rising".into(), "<u2", rising.shape(), bytes);
    let output = &record.scene.output;
    for (name, values) in [
        ("rise_radius", &output.rise_radii),
        ("rise_speed", &output.rise_speeds),
    ] {
        add(name.into(), "<f8", &[values.len()], f64s(values));
    }
    // Axes without values.
    for (name, length) in [
        ("sphere", count),
        ("component", 3),
        ("bin_radius", profile.ncols()),
    ] {
        add(name.into(), "|u1", &[length], vec![0; length]);
    }

    let start = long_start(&record.scene.start);
    if !start.is_empty() {
        let shape = [start.len(), 3];
        let position = start.iter().flat_map(|it| &it.position);
        add("start/position".into(), "<f8", &shape, f64s(position));
        let velocity = start.iter().flat_map(|it| &it.velocity);
        add("start/velocity".into(), "<f8", &shape, f64s(velocity));
        let spin = start.iter().flat_map(|it| &it.spin);
        add("start/spin".into(), "<f8", &shape, f64s(spin));
        let radius = start
            .iter()
            .map(|it| it.radius.as_ref().unwrap_or(&f64::NAN));
        add("start/radius".into(), "<f8", &shape[..1], f64s(radius));
    }
    for (group, states) in [
        ("snapshots", &record.snapshots),
        ("trajectory", &record.trajectory),
    ] {
        let time: Vec<f64> = states.iter().map(|state| state.time).collect();
        let shape = [states.len(), count, 3];
        add(format!("{group}/time"), "<f8", &[states.len()], f64s(&time));
        let position = states.iter().flat_map(|state| &state.position);
        add(format!("{group}/position"), "<f8", &shape, f64s(position));
        let velocity = states.iter().flat_map(|state| &state.velocity);
        add(format!("{group}/velocity"), "<f8", &shape, f64s(velocity));
        if group == "snapshots" {
            let spin = states.iter().flat_map(|state| &state.spin);
            add(format!("{group}/spin"), "<f8", &shape, f64s(spin));
        }
    }
    Value::Object(all)
}

#[test]
fn h5py_reads_every_number() {
    let python = python();
    if output(Command::new(&python).args(["-c", "import h5py"])).is_none() {
        return skip("python3 with h5py");
    }
    let folder = tempfile::tempdir().unwrap();
    // Symptom: h5py with HDF5 2.0 opened no dataset of more than 65,535 spheres or frames. Cause:
    // extents of chunks written in four bytes that it expects in three.
    let large = with_all(examples::record(70_000, 1, 70_000, 1));
    let mut long_start = example();
    examples::list_many(&mut long_start.scene, 1500);
    for record in [example(), large, long_start] {
        reads_every_number(&python, &record, folder.path());
    }
}

fn reads_every_number(python: &str, record: &RunRecord, folder: &Path) {
    let path = folder.join("run.h5");
    write_record(record, &path).unwrap();
    let start = long_start(&record.scene.start);
    // What is more stands in datasets.
    let mut scene = record.scene.clone();
    if !start.is_empty() {
        scene.start = Start::list(Vec::new());
    }
    let expected = json!({
        "attributes": {
            "format": "phase run record",
            "format_version": 3,
            "program_version": record.program.version,
            "program_commit": record.program.commit,
            "identity": record.scene.identity(),
            "seed": record.scene.seed,
            "outcome": "unstable",
            "guard": "overlap",
            "guard_step": u64::MAX,
            "guard_time": 0.1 + 0.2,
            "guard_sphere": 255,
            "guard_detail": "overlap 1.51 r, limit 1.5 r",
            "cpu_seconds": 0.6,
        },
        "scene": scene,
        "datasets": datasets(record),
    });
    let expectation = folder.join("expected.json");
    std::fs::write(&expectation, expected.to_string()).unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/read_record.py");
    let result = Command::new(python)
        .arg(script)
        .arg(&path)
        .arg(&expectation)
        .output()
        .unwrap();
    assert!(
        result.status.success(),
        "{}{}",
        String::from_utf8_lossy(&result.stdout),
        String::from_utf8_lossy(&result.stderr)
    );
}

#[test]
fn h5dump_reads_every_dataset() {
    if output(Command::new("h5dump").arg("--version")).is_none() {
        return skip("h5dump");
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    let record = example();
    write_record(&record, &path).unwrap();

    let dumped = Command::new("h5dump").arg(&path).output().unwrap();
    assert!(dumped.status.success());
    assert_eq!(String::from_utf8_lossy(&dumped.stderr), "");
    assert_eq!(
        String::from_utf8_lossy(&dumped.stdout)
            .matches("DATASET \"")
            .count(),
        datasets(&record).as_object().unwrap().len()
    );

    let rising = output(
        Command::new("h5dump")
            .args(["-y", "-w", "0", "-d", "/observations/rising"])
            .arg(&path),
    )
    .unwrap();
    let numbers: Vec<u16> = rising
        .split("DATA {")
        .nth(1)
        .and_then(|data| data.split('}').next())
        .unwrap()
        .split([',', '\n'])
        .filter_map(|word| word.trim().parse().ok())
        .collect();
    assert!(numbers.iter().eq(&record.observations.rising));
}
