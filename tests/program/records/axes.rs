//! Records are netCDF: their datasets have axes with names, units and names as CF has them.
//!
//! Half of it needs python3 with xarray, h5netcdf and netCDF4. Where they are absent the tests say
//! that they were skipped; with `PHASE_NEED_READERS=1` in the environment they fail.

use super::examples;
use hdf5_pure::{AttrValue, Datatype, File};
use ndarray::{Array2, Array3};
use phase::observe::OwnSeries;
use phase::record::RunRecord;
use phase::store::{read_record, write_record};
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;
use std::process::Command;

/// A record of a round tank, with everything that has axes.
fn example() -> RunRecord {
    let mut record = examples::record(40, 5, 7, 3);
    record.scene.tank = toml::from_str("radius = 0.05\nfloor = -0.2").unwrap();
    record.trajectory = record.snapshots.clone();
    record.observations.own = vec![own("flow", "m^2/s^2", 40)];
    record
}

fn own(name: &str, unit: &str, frames: u16) -> OwnSeries {
    OwnSeries {
        name: name.to_owned(),
        unit: unit.to_owned(),
        description: "Flow per width; the mean of a frame".to_owned(),
        values: (0..frames).map(f32::from).collect(),
    }
}

fn written(record: &RunRecord) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    write_record(record, &path).unwrap();
    (folder, path)
}

#[test]
fn datasets_have_units_and_names_of_cf_beside_those_of_phase() {
    let (_folder, path) = written(&example());
    let file = File::open(&path).unwrap();
    let of_root = file.root().attrs().unwrap();
    assert_eq!(of_root["Conventions"].as_str(), Some("CF-1.11"));
    let title = "two lines, \"quotes\",\na tab\t and Ω";
    assert_eq!(of_root["title"].as_str(), Some(title));
    for (path, unit, units, name) in [
        ("observations/time", "s", "s", "Time of each frame"),
        ("observations/flow", "m^2/s^2", "m2 s-2", "Flow per width"),
        ("snapshots/velocity", "m/s", "m s-1", "Velocities x, y, z"),
        ("trajectory/spin", "rad/s", "rad s-1", "Spins x, y, z"),
        ("spheres/mass", "kg", "kg", "Mass of every sphere"),
        ("bin_radius", "m", "m", "Distance from the axis"),
    ] {
        let attributes = file.dataset(path).unwrap().attrs().unwrap();
        let text = |key| attributes.get(key).and_then(AttrValue::as_str).unwrap();
        assert_eq!(text("unit"), unit, "{path}");
        assert_eq!(text("units"), units, "{path}");
        assert_eq!(text("long_name"), name, "{path}");
        assert!(text("description").starts_with(name), "{path}");
    }
}

#[test]
fn axes_are_dimension_scales() {
    let (_folder, path) = written(&example());
    let file = File::open(&path).unwrap();
    let dimension = "This is a netCDF dimension but not a netCDF variable.";
    for (path, name) in [
        ("observations/time", "time".to_owned()),
        ("snapshots/time", "time".to_owned()),
        ("bin_radius", "bin_radius".to_owned()),
        ("rise_speed", "rise_speed".to_owned()),
        ("sphere", format!("{dimension}         7")),
        ("component", format!("{dimension}         3")),
    ] {
        let scale = file.dataset(path).unwrap();
        let attributes = scale.attrs().unwrap();
        assert_eq!(
            attributes["CLASS"].as_str(),
            Some("DIMENSION_SCALE"),
            "{path}"
        );
        assert_eq!(attributes["NAME"].as_str(), Some(&name[..]), "{path}");
        let kinds = scale.attr_datatypes().unwrap();
        assert!(
            matches!(kinds["REFERENCE_LIST"], Datatype::Compound { .. }),
            "{path}"
        );
    }
    for path in ["observations/profile", "snapshots/position", "spheres/mass"] {
        let kinds = file.dataset(path).unwrap().attr_datatypes().unwrap();
        let kind = &kinds["DIMENSION_LIST"];
        assert!(
            matches!(kind, Datatype::VariableLength { .. }),
            "{path}: {kind:?}"
        );
    }
}

#[test]
fn a_record_of_more_columns_than_a_scale_lists_reads_back() {
    let mut record = examples::record(2, 0, 1, 1);
    let column = |number: usize| own(&format!("column_{number:04}"), "1", 2);
    record.observations.own = (0..4500).map(column).collect();
    record.observations.rising = Array3::zeros((2, 0, 3));
    record.observations.profile = Array2::zeros((2, 0));
    let (_folder, path) = written(&record);
    assert_eq!(
        read_record(&path).unwrap().observations,
        record.observations
    );
}

/// Whether Python has the readers; says so if not.
fn readers() -> bool {
    let modules = "import xarray, h5netcdf, netCDF4";
    let found = Command::new(python()).args(["-c", modules]).output();
    if found.is_ok_and(|output| output.status.success()) {
        return true;
    }
    let required = std::env::var_os("PHASE_NEED_READERS").is_some();
    let missing = "python3 with xarray, h5netcdf and netCDF4";
    assert!(!required, "{missing} is needed but absent");
    // Not eprintln!, which the test runner hides.
    let message = format!("SKIPPED a check of records: {missing} is absent\n");
    std::io::stderr().write_all(message.as_bytes()).unwrap();
    false
}

fn python() -> String {
    std::env::var("PHASE_PYTHON").unwrap_or_else(|_| "python3".to_owned())
}

/// Attributes, coordinates, and axes, units and name of some datasets.
fn expected(record: &RunRecord) -> Value {
    let height = "Height of the highest centre in each radial bin, inner bin first";
    let rising = "Number of spheres within a radius fraction that rose faster than the mean by a \
                  speed";
    let states = ["time", "sphere", "component"];
    let centres = [0.5, 1.5, 2.5, 3.5, 4.5].map(|it: f64| it * 0.05 / 5.0);
    let times: Vec<f64> = record.snapshots.iter().map(|state| state.time).collect();
    json!({
        "attributes": {
            "Conventions": "CF-1.11",
            "title": record.scene.title,
            "outcome": "completed",
        },
        "coordinates": {
            "observations/time": record.observations.time,
            "snapshots/time": times,
            "trajectory/time": times,
            "bin_radius": centres,
            "rise_radius": record.scene.output.rise_radii,
            "rise_speed": record.scene.output.rise_speeds,
        },
        "datasets": {
            "observations/flow": [["time"], "m2 s-2", "Flow per width"],
            "observations/profile": [["time", "bin_radius"], "m", height],
            "observations/rising": [["time", "rise_radius", "rise_speed"], "1", rising],
            "snapshots/position": [states, "m", "Centres x, y, z"],
            "trajectory/spin": [states, "rad s-1", "Spins x, y, z"],
            "spheres/mass": [["sphere"], "kg", "Mass of every sphere"],
        },
    })
}

fn read_by_xarray(record: &RunRecord, expected: &Value) {
    let (folder, path) = written(record);
    let expectation = folder.path().join("expected.json");
    std::fs::write(&expectation, expected.to_string()).unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/read_axes.py");
    let result = Command::new(python())
        .arg(script)
        .args([path, expectation])
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
fn xarray_reads_axes_units_and_coordinates() {
    if readers() {
        let record = example();
        read_by_xarray(&record, &expected(&record));
    }
}

/// Lengths that agree by chance are no axes: time has as many entries as there are bins, spheres
/// and components. The other record is compressed.
#[test]
fn xarray_reads_axes_of_equal_and_of_great_length() {
    if readers() {
        for (frames, bins, spheres, snapshots) in [(3, 3, 3, 3), (70_000, 2, 70_000, 1)] {
            let mut record = example();
            let other = examples::record(frames, bins, spheres, snapshots);
            (record.radius, record.mass) = (other.radius, other.mass);
            record.trajectory = other.snapshots.clone();
            (record.snapshots, record.observations) = (other.snapshots, other.observations);
            let mut expected = expected(&record);
            expected["datasets"]
                .as_object_mut()
                .unwrap()
                .remove("observations/flow");
            let centre = |bin: usize| (bin as f64 + 0.5) * 0.05 / bins as f64;
            expected["coordinates"]["bin_radius"] = (0..bins).map(centre).collect();
            read_by_xarray(&record, &expected);
        }
    }
}

/// A tank without a round wall has no bins, a long start has datasets of its own.
#[test]
fn xarray_reads_empty_axes_and_long_starts() {
    if readers() {
        let mut record = examples::record(4, 0, 1500, 1);
        examples::list_many(&mut record.scene, 1500);
        record.observations.rising = Array3::zeros((4, 0, 3));
        let states = ["sphere", "component"];
        let expected = json!({
            "attributes": {},
            "coordinates": { "rise_speed": record.scene.output.rise_speeds },
            "datasets": {
                "observations/profile": [["time", "bin_radius"], "m",
                    "Height of the highest centre in each radial bin, inner bin first"],
                "start/velocity": [states, "m s-1", "Velocities x, y, z"],
            },
        });
        read_by_xarray(&record, &expected);
    }
}
