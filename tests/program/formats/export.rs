//! Exports hold every number of the record, as programs read them that are not ours.
//!
//! Needs python3 with numpy, h5py, ase and vtk. Where they are absent the tests say that they were
//! skipped; with `PHASE_NEED_READERS=1` in the environment, as in continuous integration, they
//! fail.

use crate::support::{Workplace, scene_file, silo_file};
use ndarray_npy::ReadNpyExt;
use phase::observe::Snapshot;
use phase::scene::FixedSphere;
use phase::store::read_record;
use std::io::Write;
use std::path::Path;
use std::process::Command;

const FORMATS: [&str; 5] = ["xyz", "vtk", "npy", "csv", "dump"];

fn python() -> String {
    std::env::var("PHASE_PYTHON").unwrap_or_else(|_| "python3".to_owned())
}

/// Whether Python has the readers; says so if not.
fn readers() -> bool {
    let modules = "import numpy, h5py, ase, vtkmodules";
    let found = Command::new(python()).args(["-c", modules]).output();
    if found.is_ok_and(|output| output.status.success()) {
        return true;
    }
    let required = std::env::var_os("PHASE_NEED_READERS").is_some();
    assert!(
        !required,
        "python3 with numpy, h5py, ase and vtk is needed but absent"
    );
    // Not eprintln!, which the test runner hides.
    let message = b"SKIPPED a check of exports: python3 with numpy, h5py, ase and vtk is absent\n";
    std::io::stderr().write_all(message).unwrap();
    false
}

/// A scene whose spheres have radii of their own and, with friction, spins.
fn scene(friction: bool) -> String {
    let shares = "[{ radius = 0.003, share = 1 }, { radius = 0.0041, share = 1 }]";
    let mut text = scene_file().replace("radius = 0.004", &format!("radius = {shares}"));
    if friction {
        text += "[friction]\nlaw = \"spin\"\ncoefficient = 0.01\n";
    }
    text
}

/// Exports a record in these formats and has the result read.
fn exported_and_read(place: &Workplace, formats: &[&str], every: usize, states: &str) {
    let step = every.to_string();
    for &format in formats {
        let mut arguments = vec!["export", "run.h5", "--to", format, "--out", "out"];
        if format != "dump" {
            arguments.extend(["--every", &step]);
        }
        place.phase(&arguments).code(0).complains(states);
    }
    if !readers() {
        return;
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/read_exports.py");
    let result = Command::new(python())
        .arg(script)
        .args([place.path("run.h5"), place.path("out")])
        .arg(step)
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
fn others_read_every_number_of_a_trajectory() {
    let place = Workplace::new();
    place.write("scene.toml", &scene(true));
    place
        .phase(&["run", "scene.toml", "--trajectory", "--out", "run.h5"])
        .code(0);
    exported_and_read(
        &place,
        &FORMATS,
        50,
        "run.h5: the trajectory, every frame: ",
    );
}

#[test]
fn others_read_every_number_of_snapshots() {
    let place = Workplace::new();
    place.write("scene.toml", &scene(false));
    place
        .phase(&["run", "scene.toml", "--out", "run.h5"])
        .code(0);
    exported_and_read(
        &place,
        &FORMATS,
        1,
        "run.h5: the snapshots, as there is no trajectory: 3 states",
    );
}

#[test]
fn others_read_the_grains_that_are_in() {
    let friction = "[friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\nregularisation = 1e-3\n";
    for more in ["", friction] {
        let place = Workplace::new();
        place.write("silo.toml", &(silo_file() + more));
        place
            .phase(&["run", "silo.toml", "--out", "run.h5"])
            .code(0);
        exported_and_read(&place, &FORMATS[..4], 1, "run.h5: the snapshots");
        place
            .phase(&["export", "run.h5", "--to", "dump"])
            .code(2)
            .complains("cannot represent spheres that enter or leave")
            .complains("--to npy");
    }
}

#[test]
fn tables_hold_the_grains_that_are_in_and_what_is_fixed() {
    let place = Workplace::new();
    place.write("silo.toml", &silo_file());
    place
        .phase(&["run", "silo.toml", "--out", "run.h5"])
        .code(0);
    for format in ["xyz", "csv", "npy"] {
        place.phase(&["export", "run.h5", "--to", format]).code(0);
    }
    let record = read_record(&place.path("run.h5")).unwrap();
    let inside = |state: &Snapshot| {
        state
            .position
            .column(0)
            .iter()
            .filter(|x| !x.is_nan())
            .count()
    };
    let counts: Vec<usize> = record.snapshots.iter().map(inside).collect();
    assert!(
        counts.contains(&0) && counts.contains(&12) && counts.iter().any(|it| (1..12).contains(it))
    );

    let table = place.read("run.csv");
    assert!(!table.contains("NaN"));
    assert_eq!(table.lines().count(), 1 + counts.iter().sum::<usize>());
    let xyz = place.read("run.xyz");
    let heads = xyz.lines().filter_map(|line| line.parse::<usize>().ok());
    assert_eq!(heads.collect::<Vec<_>>(), counts);
    assert!(!xyz.contains("NaN"));
    let file = std::fs::File::open(place.path("run/position.npy")).unwrap();
    let array = ndarray::Array3::<f64>::read_npy(file).unwrap();
    let numbers = array.iter().filter(|value| !value.is_nan()).count();
    assert_eq!(numbers, 3 * counts.iter().sum::<usize>());

    let fixed = record.scene.dem.geometry.unwrap().spheres();
    let rows = |kind: &str, spheres: &[FixedSphere]| -> String {
        let row = |it: &FixedSphere| {
            let [x, y, z] = it.position;
            format!("{kind},{x:?},{y:?},{z:?},{:?}\n", it.radius)
        };
        spheres.iter().map(row).collect()
    };
    let expected = rows("wall", &fixed.walls) + &rows("door", &fixed.door);
    assert_eq!(
        place.read("run-fixed.csv"),
        format!("kind,x,y,z,radius\n{expected}")
    );
}

#[test]
fn exports_go_where_they_are_sent() {
    let place = Workplace::new();
    place.write("scene.toml", &scene_file());
    for seed in ["1", "2"] {
        let record = format!("run-{seed}.h5");
        place
            .phase(&["run", "scene.toml", "--seed", seed, "--out", &record])
            .code(0);
    }
    let export = |more: &[&str]| place.phase(&[&["export", "run-1.h5"], more].concat());
    export(&["--to", "xyz"]).code(0).says("run-1.xyz");
    export(&["--to", "csv", "--out", "a/b.csv"])
        .code(0)
        .says("a/b.csv\na/b-observations.csv");
    export(&["--to", "vtk", "--out", "a/b.pvd"]).code(0);
    assert!(place.path("a/b/frame_00002.vtp").exists());
    assert!(!place.path("a/b/frame_00003.vtp").exists());
    export(&["run-2.h5", "--to", "dump", "--out", "dumps"])
        .code(0)
        .says("dumps/dump_r00.004_p03750.0_f004.0.npy")
        .says("dumps/dump_r00.004_p03750.0_f004.0_s2.npy")
        .complains("a dump of snapshots cannot be classified");
    assert_eq!(place.read("a/b-observations.csv").lines().count(), 202);
    assert_eq!(place.read("a/b.csv").lines().count(), 1 + 3 * 8);
    assert_eq!(place.read("a/b.csv"), {
        export(&["--to", "csv", "--out", "again"]).code(0);
        place.read("again/run-1.csv")
    });

    export(&["run-1.h5", "--to", "npy", "--out", "twice"])
        .code(2)
        .complains("would both be written to twice/run-1");
    assert!(!place.path("twice").exists());
    export(&["--to", "dump", "--every", "2"])
        .code(2)
        .complains("drop --every");
    export(&["--to", "pdb"])
        .code(2)
        .complains("possible values: xyz, vtk, npy, csv, svg, page, dump");
    place
        .phase(&["export", "scene.toml", "--to", "xyz"])
        .code(2)
        .complains("is not a run record");
}

/// Others read the polygons of listed walls.
#[test]
fn others_read_the_walls() {
    let place = Workplace::new();
    let walls = "[[wall]]
plate = { corner = [0.5, 0.0, 0.1], first_edge = [0.2, 0.0, 0.0], second_edge = [0.0, 0.3, 0.0] }

[[wall]]
disc = { centre = [0.0, 0.0, 0.7], radius = 0.02 }
";
    place.write("scene.toml", &(scene_file() + walls));
    place
        .phase(&["run", "scene.toml", "--out", "run.h5"])
        .code(0);
    place
        .phase(&["export", "run.h5", "--to", "vtk", "--out", "out"])
        .code(0);
    assert!(place.read("out/run.pvd").contains("run/surfaces.vtp"));
    if !readers() {
        return;
    }
    let script = "import sys
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
reader = vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1])
reader.Update()
walls = reader.GetOutput()
assert walls.GetNumberOfPolys() >= 2, walls
low_x, high_x, low_y, high_y, low_z, high_z = walls.GetBounds()
assert abs(high_x - 0.7) < 1e-12 and abs(high_y - 0.3) < 1e-12, walls.GetBounds()
assert abs(low_x + 0.02) < 1e-3 and abs(low_y + 0.02) < 1e-3, walls.GetBounds()
assert abs(low_z - 0.1) < 1e-12 and abs(high_z - 0.7) < 1e-12, walls.GetBounds()
";
    let result = Command::new(python())
        .args(["-c", script])
        .arg(place.path("out/run/surfaces.vtp"))
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&result.stderr);
    assert!(result.status.success(), "{error}");
}

/// A sphere leaves on the right and comes in on the left: pictures and programs that show the box
/// find it there, numbers to compute with go on.
#[test]
fn exports_show_the_images_in_a_periodic_box() {
    let place = Workplace::new();
    let scene = "[spheres]
count = 1
radius = 0.004
density = 1000.0

[periodic]
x = 0.1

[start]
kind = \"list\"
spheres = [{ position = [0.03, 0.01, 0.02], velocity = [0.1, 0.0, 0.0] }]

[time]
dt = 1e-3
duration = 1.0
frame_interval = 0.25

[output]
snapshot_interval = 0.25
";
    place.write("scene.toml", scene);
    place
        .phase(&["run", "scene.toml", "--out", "run.h5"])
        .code(0);
    for format in ["xyz", "csv", "vtk", "page"] {
        place.phase(&["export", "run.h5", "--to", format]).code(0);
    }
    let xyz = place.read("run.xyz");
    assert!(xyz.contains("Lattice=\"0.1 "), "{xyz}");
    assert!(xyz.contains("Origin=\"-0.05 "), "{xyz}");
    assert!(xyz.contains("pbc=\"T F F\""), "{xyz}");
    let column = |text: &str, lines: &str, separator: char, at: usize| -> Vec<f64> {
        let rows = text.lines().filter(|line| line.starts_with(lines));
        let number = |row: &str| row.split(separator).nth(at).unwrap().parse().unwrap();
        rows.map(number).collect()
    };
    let shown = column(&xyz, "X", ' ', 1);
    let table = place.read("run.csv");
    let at = table
        .lines()
        .next()
        .unwrap()
        .split(',')
        .position(|it| it == "x");
    let numbers: Vec<f64> = (table.lines().skip(1))
        .map(|row| row.split(',').nth(at.unwrap()).unwrap().parse().unwrap())
        .collect();
    let places = [0.03, 0.055, 0.08, 0.105, 0.13];
    for (state, place) in places.into_iter().enumerate() {
        assert!((numbers[state] - place).abs() < 1e-9, "{numbers:?}");
        let image = if place < 0.05 { place } else { place - 0.1 };
        assert!((shown[state] - image).abs() < 1e-9, "{shown:?}");
    }
    place.phase(&["view", "run.h5", "--width", "100"]).code(0);
}
