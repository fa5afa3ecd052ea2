//! A job of a sweep that is run again gives the same bits, however much of it is stored.

use crate::support::{TinySweep, Workplace};
use phase::store::{read_record, write_record};

fn swept() -> Workplace {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    place
        .phase(&["sweep", "tiny.toml", "--no-classify"])
        .code(0);
    place
}

const AGAIN: [&str; 5] = ["run", "--from", "results/tiny", "--point", "omega=4,seed=2"];

/// The record of the sweep for that point.
fn original(place: &Workplace) -> std::path::PathBuf {
    let folder = place.path("results/tiny/records");
    let found = place.records("results/tiny").into_iter().find(|name| {
        let scene = read_record(&folder.join(name)).unwrap().scene;
        scene.seed == 2 && scene.dem.effects.swirl.unwrap().omega == 4.0
    });
    folder.join(found.unwrap())
}

#[test]
fn more_output_gives_the_same_bits() {
    let place = swept();
    let more = ["--trajectory", "--snapshot-interval", "0.5"];
    let path = "results/tiny/runs/omega-4_seed-2.h5";
    place
        .phase(&[&AGAIN[..], &more[..]].concat())
        .code(0)
        .says(path)
        .says("same bits as in the sweep: 201 frames");
    let again = read_record(&place.path(path)).unwrap();
    let before = read_record(&original(&place)).unwrap();
    // As text, which knows every bit: an empty bin is not a number, and not equal to itself.
    let all = |record: &phase::record::RunRecord| {
        format!(
            "{:?}",
            record
                .observations
                .scalars()
                .iter()
                .map(|series| series.values.to_vec())
                .collect::<Vec<_>>()
        )
    };
    assert!(all(&again) == all(&before), "other observables");
    let bits = |record: &phase::record::RunRecord| -> Vec<u32> {
        let profile = record.observations.profile.iter();
        profile.map(|height| height.to_bits()).collect()
    };
    assert!(bits(&again) == bits(&before), "another profile");
    assert_eq!(again.observations.rising, before.observations.rising);
    assert_eq!(again.snapshots.last(), before.snapshots.last());
    assert_eq!(again.outcome, before.outcome);
    assert_eq!((before.snapshots.len(), before.trajectory.len()), (3, 0));
    assert_eq!((again.snapshots.len(), again.trajectory.len()), (5, 201));
    assert_eq!(again.trajectory.last(), before.snapshots.last());
}

#[test]
fn other_bits_are_noticed() {
    let place = swept();
    let path = original(&place);
    let whole = read_record(&path).unwrap();

    let mut record = whole.clone();
    record.observations.kinetic[7] *= 1.000_001;
    write_record(&record, &path).unwrap();
    place
        .phase(&AGAIN)
        .code(1)
        .complains("differs from the sweep's record");

    let mut record = whole.clone();
    let end = record.snapshots.last_mut().unwrap();
    end.position[[3, 1]] = end.position[[3, 1]].next_up();
    write_record(&record, &path).unwrap();
    place
        .phase(&AGAIN)
        .code(1)
        .complains("differs from the sweep's record");

    write_record(&whole, &path).unwrap();
    place.phase(&AGAIN).code(0).says("same bits");
    std::fs::remove_file(&path).unwrap();
    place
        .phase(&AGAIN)
        .code(0)
        .says("no record of this job to compare with");
}

/// Symptom: a damaged record was found after the whole run, which then seemed to have failed.
#[test]
fn a_damaged_record_is_found_before_the_run() {
    let place = swept();
    std::fs::write(original(&place), "junk").unwrap();
    place
        .phase(&AGAIN)
        .code(2)
        .complains("it is not an HDF5 file")
        .complains("`phase sweep` makes it again");
    assert!(!place.path("results/tiny/runs").exists());
}

#[test]
fn the_point_must_be_one_of_the_sweep() {
    let place = swept();
    let from = |more: &[&str]| place.phase(&[&["run", "--from", "results/tiny"], more].concat());
    from(&[])
        .code(2)
        .complains("--point: say which run: add omega=..., one of 0, 4, 8");
    from(&["--point", "omega=5"])
        .code(2)
        .complains("`omega` is never 5; it takes 0, 4, 8");
    from(&["--point", "omega=4,seed=3"])
        .code(2)
        .complains("`seed` is never 3; it takes 1, 2");
    from(&["--point", "omega"]).code(2).complains("name=value");
    from(&["--point", "omega=4", "--snapshot-interval", "0.015"])
        .code(2)
        .complains("output.snapshot_interval");
    from(&["--point", "omega=4", "--snapshot-interval=-1"])
        .code(2)
        .complains("0 or more");
    from(&["--point", "omega=4"])
        .code(0)
        .complains("taking the first, seed=1");
    let own = original(&place);
    from(&["--point", "omega=4,seed=2", "--out", own.to_str().unwrap()])
        .code(2)
        .complains("the sweep's own record");
    place.phase(&["run"]).code(2).complains("<SCENE>");
}
