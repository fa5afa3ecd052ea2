//! Nothing that cannot be made again is lost, and no record or dump passes for another.

use crate::support::{TinySweep, Workplace, scene_file};

/// A workplace with the results of a tiny sweep.
fn swept() -> Workplace {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    place.write("scene.toml", &scene_file());
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    place
}

/// Symptom: `phase classify results` in a fresh checkout emptied the published tables of labels.
/// Cause: a job without a record was just left out of the new table.
#[test]
fn labels_without_records_are_kept() {
    let place = swept();
    let labels = place.read("results/tiny/labels.csv");
    std::fs::remove_dir_all(place.path("results/tiny/records")).unwrap();
    // A folder that is named itself cannot be done; among several it is kept.
    for (folder, code) in [("results/tiny", 2), ("results", 0)] {
        place
            .phase(&["classify", folder])
            .code(code)
            .complains("the records of 6 of its 6 labels are not in results/tiny/records");
        assert_eq!(place.read("results/tiny/labels.csv"), labels);
    }
}

/// Symptom: another sweep into the folder of published results replaced their tables.
#[test]
fn a_sweep_does_not_replace_labels_that_cannot_be_made_again() {
    let place = swept();
    let labels = place.read("results/tiny/labels.csv");
    let other = TinySweep {
        omegas: vec![6.0],
        ..TinySweep::default()
    };
    place.write("other.toml", &other.text());
    let sweep = ["sweep", "other.toml", "--out", "results/tiny", "--no-plot"];
    // With their records the labels can be made again, so the folder may go over to other runs.
    place
        .phase(&sweep)
        .code(0)
        .says("0 of 0 labels changed, 2 new");
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    assert_eq!(place.read("results/tiny/labels.csv"), labels);

    std::fs::remove_dir_all(place.path("results/tiny/records")).unwrap();
    place.phase(&sweep).code(2).complains("would be lost");
    assert_eq!(place.read("results/tiny/labels.csv"), labels);
    // The sweep itself may always run again.
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    assert_eq!(place.read("results/tiny/labels.csv"), labels);
}

/// Symptom: the label of a damaged record was gone, and "0 labels changed". Cause: only rows that
/// both tables have were compared.
#[test]
fn a_label_that_is_lost_is_counted() {
    let place = swept();
    let record = place.records("results/tiny")[0].clone();
    std::fs::write(
        place.path(&format!("results/tiny/records/{record}")),
        "broken",
    )
    .unwrap();
    place
        .phase(&["classify", "results/tiny"])
        .code(1)
        .says("0 of 5 labels changed, 1 lost (their records cannot be labelled)");
}

/// Symptom: `phase run scene.toml --out scene.toml` replaced the scene with its record.
#[test]
fn outputs_do_not_replace_other_kinds_of_files() {
    let place = swept();
    let scene = place.read("scene.toml");
    place
        .phase(&["run", "scene.toml", "--out", "scene.toml"])
        .code(2)
        .complains("scene.toml: this is not a record");
    assert_eq!(place.read("scene.toml"), scene);
    let labels = place.read("results/tiny/labels.csv");
    let run = ["run", "scene.toml", "--out"];
    place
        .phase(&[&run[..], &["results/tiny/labels.csv"]].concat())
        .code(2);
    place.phase(&[&run[..], &["run.h5"]].concat()).code(0);
    // A record may replace a record.
    place.phase(&[&run[..], &["run.h5"]].concat()).code(0);
    let export = ["export", "run.h5", "--to", "csv", "--out"];
    place
        .phase(&[&export[..], &["results/tiny/labels.csv"]].concat())
        .code(2)
        .complains("this is not a table of spheres");
    assert_eq!(place.read("results/tiny/labels.csv"), labels);
    place
        .phase(&["export", "run.h5", "--to", "xyz", "--out", "run.toml"])
        .code(2)
        .complains("ends in .xyz");
    assert!(!place.path("run.toml").exists());
}

/// Symptom: a record under the name of another was labelled as that other run.
#[test]
fn a_record_is_that_of_its_name() {
    let place = swept();
    let [first, second, ..] = &place.records("results/tiny")[..] else {
        panic!("no records");
    };
    let path = |name: &str| place.path("results/tiny/records").join(name);
    std::fs::copy(path(first), path(second)).unwrap();
    let labels = place.read("results/tiny/labels.csv");
    let second = second.trim_end_matches(".h5");
    place
        .phase(&["classify", "results/tiny"])
        .code(1)
        .complains("holds another run than its name says");
    let row = |table: &str| {
        let mut rows = table.lines().filter(|row| row.starts_with(second));
        rows.next().map(str::to_owned)
    };
    assert!(row(&labels).is_some());
    assert_eq!(row(&place.read("results/tiny/labels.csv")), None);
}

/// Symptom: `-s 1 -s 1` labelled every run twice and called that the agreement of two seeds.
#[test]
fn a_seed_counts_once() {
    let place = swept();
    place
        .phase(&["sweep", "tiny.toml", "-s", "1", "-s", "1"])
        .code(2)
        .complains("duplicate --seed 1");
}

#[test]
fn a_file_of_another_kind_is_named_with_the_command_for_it() {
    let place = swept();
    let study = TinySweep::default().text() + "\n";
    place.write("study.toml", &format!("study = \"stability\"\n{study}"));
    for (command, file, says, command_for_it) in [
        ("sweep", "scene.toml", "a scene, not a sweep", "run"),
        ("run", "tiny.toml", "a sweep, not a scene", "sweep"),
        ("run", "study.toml", "a study, not a scene", "study"),
        ("sweep", "study.toml", "a study, not a sweep", "study"),
    ] {
        place
            .phase(&[command, file])
            .code(2)
            .complains(&format!("this is {says}"))
            .complains(&format!("`phase {command_for_it} {file}` runs it"));
    }
}

/// Symptom: a file of another program was called damaged, with the advice to delete it.
#[test]
fn a_foreign_file_is_not_called_damaged() {
    let place = swept();
    // The signature and nothing that this program wrote.
    let mut bytes = b"\x89HDF\r\n\x1a\n".to_vec();
    bytes.extend([0; 1000]);
    std::fs::write(place.path("foreign.h5"), bytes).unwrap();
    let answer = place
        .phase(&["view", "foreign.h5"])
        .complains("is not a run record of phase");
    assert!(!answer.stderr.contains("delete"), "{}", answer.stderr);
}

/// Symptom: dumps whose names say nothing got the scene's values, and a header that promises more
/// than there is asked for terabytes.
#[test]
fn a_dump_is_what_its_name_and_its_length_say() {
    let place = swept();
    std::fs::create_dir(place.path("dumps")).unwrap();
    let record = place.records("results/tiny")[0].clone();
    let record = format!("results/tiny/records/{record}");
    place
        .phase(&["export", &record, "--to", "dump", "--out", "dumps"])
        .code(0);
    let name = std::fs::read_dir(place.path("dumps")).unwrap().next();
    let name = name.unwrap().unwrap().file_name().into_string().unwrap();
    let bytes = std::fs::read(place.path("dumps").join(&name)).unwrap();
    let classify = |name: &str, bytes: &[u8]| {
        std::fs::remove_dir_all(place.path("dumps")).unwrap();
        std::fs::create_dir(place.path("dumps")).unwrap();
        std::fs::write(place.path("dumps").join(name), bytes).unwrap();
        place.phase(&["classify", "dumps", "--scene", "scene.toml"])
    };
    for name in ["foo.npy", "dump_rx_p3750_f8.npy"] {
        classify(name, &bytes)
            .code(1)
            .complains("its name does not fit `dump_r@{spheres.radius}_p@{spheres.density}");
    }
    classify("dump_r-0.004_p3750_f8.npy", &bytes)
        .code(1)
        .complains("at radius = -0.004, density = 3750, omega = 8:");
    classify("dump_r00.400_p03750.0_f006.0.npy", &bytes)
        .code(1)
        .complains("do not fit into a tank");
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1010101010, 40, 40), }";
    let mut bomb = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    bomb.extend(format!("{header:<117}\n").bytes());
    bomb.extend([0; 64]);
    classify("dump_r00.004_p03750.0_f004.0.npy", &bomb)
        .code(1)
        .complains("is no dump");
}
