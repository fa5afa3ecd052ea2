//! Dumps as the thesis's program wrote them give the labels that records give.

use crate::support::{TinySweep, Workplace, scene_file};
use ndarray_npy::WriteNpyExt;
use phase::classify::Label;
use phase::classify::LabelRow;
use phase::store::read_labels;
use std::collections::BTreeMap;

/// A sweep of every kind of run that eight spheres can give, the last one unstable.
fn sweep() -> TinySweep {
    TinySweep {
        omegas: vec![0.0, 4.0, 20.0, 4000.0],
        more: "[scene.output]\ntrajectory = true\n\
               [sieves]\nsettle = { window = 0.3 }\nfluid = { window = 0.3 }\n\
               pinned = { window = 0.3 }\nspout = { window = 0.3 }\n"
            .to_owned(),
        ..TinySweep::default()
    }
}

pub(super) fn swept_and_exported() -> Workplace {
    let place = Workplace::new();
    place.write("tiny.toml", &sweep().text());
    place.write("scene.toml", &scene_file());
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    let records = place.records("results/tiny");
    let records = records
        .iter()
        .map(|name| format!("results/tiny/records/{name}"));
    let records: Vec<String> = records.collect();
    let mut arguments = vec!["export", "--to", "dump", "--out", "dumps"];
    arguments.extend(records.iter().map(String::as_str));
    place.phase(&arguments).code(0);
    place
}

/// Rows of a table of labels by Omega and seed.
pub(super) fn rows(
    place: &Workplace,
    table: &str,
    omega: &str,
) -> BTreeMap<(String, u64), LabelRow> {
    let table = read_labels(&place.path(table)).unwrap();
    let axis = table.axes.iter().position(|axis| axis == omega).unwrap();
    let key = |row: &LabelRow| (row.values[axis].to_string(), row.seed);
    table.rows.into_iter().map(|row| (key(&row), row)).collect()
}

#[test]
fn dumps_give_the_labels_of_records() {
    let place = swept_and_exported();
    place
        .phase(&[
            "classify",
            "dumps",
            "--scene",
            "scene.toml",
            "--sweep",
            "tiny.toml",
        ])
        .code(0)
        .says("8 runs labelled")
        .says("dumps/labels.csv");
    let of_records = rows(&place, "results/tiny/labels.csv", "omega");
    let of_dumps = rows(&place, "dumps/labels.csv", "omega");
    assert!(of_records.keys().eq(of_dumps.keys()));
    let mut labels = Vec::new();
    for (from_record, from_dump) in of_records.values().zip(of_dumps.values()) {
        let (expected, found) = (&from_record.verdict, &from_dump.verdict);
        assert_eq!(found.label, expected.label, "{}", from_dump.id);
        // What depends on positions alone has the same bits.
        for name in [
            "settle_time",
            "hole_radius",
            "packing_height",
            "spout_count",
            "pinned_share",
            "spout_share",
            "fluid_share",
        ] {
            assert_eq!(found.value(name), expected.value(name), "{name}");
        }
        for (name, tolerance) in [("settle_change", 1e-3), ("rotation", 0.05)] {
            let near = match (found.value(name), expected.value(name)) {
                (Some(a), Some(b)) => (a - b).abs() <= tolerance * b.abs(),
                (a, b) => a == b,
            };
            assert!(near, "{name}: {found:?}, {expected:?}");
        }
        labels.push(expected.label);
    }
    assert!(labels.contains(&Label::UNSTABLE), "{labels:?}");
    labels.sort();
    labels.dedup();
    assert!(labels.len() >= 3, "too few kinds to compare: {labels:?}");
}

#[test]
fn what_is_no_dump_of_the_scene_is_refused() {
    let place = swept_and_exported();
    let classify = |more: &[&str]| place.phase(&[&["classify"], more].concat());
    classify(&["dumps"])
        .code(2)
        .complains("give the scene of the dumps with --scene FILE");
    classify(&["results/tiny", "--scene", "scene.toml"])
        .code(2)
        .complains("drop --scene");
    std::fs::create_dir(place.path("empty")).unwrap();
    classify(&["empty", "--scene", "scene.toml"])
        .code(2)
        .complains("holds no .npy files");
    place.write(
        "short.toml",
        &scene_file().replace("duration = 2.0", "duration = 3.0"),
    );
    classify(&["dumps", "--scene", "short.toml"])
        .code(1)
        .complains("it has 201 frames")
        .complains("make 301");
    let odd = "dumps/dump_r00.004_p03750.0_f009.0.npy";
    place.write(odd, "text");
    classify(&["dumps", "--scene", "scene.toml"])
        .code(1)
        .says("8 runs labelled")
        .complains("f009.0.npy is no dump");
    std::fs::remove_file(place.path(odd)).unwrap();
    std::fs::copy(
        place.path("dumps/dump_r00.004_p03750.0_f004.0.npy"),
        place.path("dumps/dump_r0.004_p3750_f4.npy"),
    )
    .unwrap();
    classify(&["dumps", "--scene", "scene.toml"])
        .code(1)
        .says("8 runs labelled")
        .complains("says the same radius, density, omega and seed as");
    place.write("more.toml", &scene_file().replace("count = 8", "count = 9"));
    classify(&["dumps", "--scene", "more.toml"])
        .code(1)
        .complains("it has 8 spheres, but spheres.count of the scene is 9");
}

/// An archive of numpy with arrays that are not packed.
fn archive(arrays: &[(&str, &[u8])]) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for (name, array) in arrays {
        let start = bytes.len() as u32;
        let mut sizes = crc32fast::hash(array).to_le_bytes().to_vec();
        let size = (array.len() as u32).to_le_bytes();
        sizes.extend([size, size].concat());
        sizes.extend((name.len() as u16).to_le_bytes());
        sizes.extend([0; 2]);
        bytes.extend([&b"PK\x03\x04"[..], &[0; 10], &sizes, name.as_bytes(), array].concat());
        directory.extend([&b"PK\x01\x02"[..], &[0; 12], &sizes, &[0; 10]].concat());
        directory.extend(start.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let count = (arrays.len() as u16).to_le_bytes();
    let place = [directory.len() as u32, bytes.len() as u32].map(u32::to_le_bytes);
    bytes.extend(directory);
    bytes.extend(
        [
            &b"PK\x05\x06"[..],
            &[0; 4],
            &count,
            &count,
            &place.concat(),
            &[0; 2],
        ]
        .concat(),
    );
    bytes
}

#[test]
fn archives_of_one_array_are_dumps() {
    let folder = tempfile::tempdir().unwrap();
    let mut array = Vec::new();
    ndarray::Array3::<f64>::ones((2, 3, 4))
        .write_npy(&mut array)
        .unwrap();
    let read = |bytes: &[u8]| {
        let path = folder.path().join("dump.npz");
        std::fs::write(&path, bytes).unwrap();
        phase::store::read_dump(&path)
    };
    let one = archive(&[("arr_0.npy", &array)]);
    assert_eq!(read(&one).unwrap().dim(), (2, 3, 4));
    let two = archive(&[("a.npy", &array), ("b.npy", &array)]);
    let error = read(&two).unwrap_err().to_string();
    let expected = "the archive has 2 arrays; save one alone";
    assert!(error.ends_with(expected), "{error}");
    assert!(read(&archive(&[])).is_err());
    let mut damaged = one.clone();
    damaged[200] ^= 1;
    let error = read(&damaged).unwrap_err().to_string();
    assert!(error.contains("its checksum is another one"), "{error}");
    for length in 4..one.len() {
        assert!(read(&one[..length]).is_err(), "{length}");
    }
}

/// A disc has a moment of inertia of m r^2 / 2, not that of a sphere.
#[test]
fn energies_of_discs_are_those_of_discs() {
    let place = Workplace::new();
    place.write(
        "discs.toml",
        r#"
[spheres]
count = 2
radius = 0.04
shape = "disc"
density = 10.0
[contact]
law = "linear"
stiffness = 100.0
damping = 0.0
[friction]
law = "coulomb"
coefficient = 0.3
regularisation = 1e-3
[start]
kind = "list"
spheres = [
    { position = [0.0, 0.0, 0.0], velocity = [0.0, 0.0, 2.0], spin = [0.0, 30.0, 0.0] },
    { position = [1.0, 0.0, 0.0], spin = [0.0, -5.0, 0.0] },
]
[time]
dt = 1e-3
duration = 0.01
frame_interval = 0.01
"#,
    );
    place
        .phase(&["run", "discs.toml", "--trajectory", "--out", "run.h5"])
        .code(0);
    place.phase(&["export", "run.h5", "--to", "dump"]).code(0);
    let [dump] = std::fs::read_dir(place.path(""))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|it| it == "npy"))
        .collect::<Vec<_>>()
        .try_into()
        .unwrap();
    let values = phase::store::read_dump(&dump).unwrap();
    let mass = 10.0 * 0.04 * 0.04;
    let rotational = |spin: f64| 0.25 * mass * 0.04 * 0.04 * spin * spin;
    for (sphere, expected) in [
        (0, 0.5 * mass * 4.0 + rotational(30.0)),
        (1, rotational(5.0)),
    ] {
        let found = values[[0, sphere, 3]];
        assert!(
            (found - expected).abs() < 1e-12 * expected,
            "{found} {expected}"
        );
    }
}
