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
        .complains("`phase sweep` replaces it");
    assert!(!place.path("results/tiny/runs").exists());
}

#[test]
fn the_point_must_be_one_of_the_sweep() {
    let place = swept();
    let from = |more: &[&str]| place.phase(&[&["run", "--from", "results/tiny"], more].concat());
    from(&[])
        .code(2)
        .complains("--point: add omega=... to choose a run; values: 0, 4, 8");
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
        .complains("using the first, seed=1");
    let own = original(&place);
    from(&["--point", "omega=4,seed=2", "--out", own.to_str().unwrap()])
        .code(2)
        .complains("the sweep's own record");
    place.phase(&["run"]).code(2).complains("<SCENE>");
}

/// Symptom: `--point ...,seed=9007199254740993` ran the seed ...992 and said "same bits as in the
/// sweep"; of two neighbouring values of an axis the first was run for both. Cause: seeds were
/// compared as floating point numbers, and values within a tolerance.
#[test]
fn a_point_is_the_run_of_its_seed_and_value_alone() {
    let place = Workplace::new();
    let seeds = [9_007_199_254_740_992, 9_007_199_254_740_993];
    let omegas = [0.3, 0.1 + 0.2];
    let sweep = TinySweep {
        omegas: omegas.to_vec(),
        seeds: seeds.to_vec(),
        duration: 0.1,
        ..TinySweep::default()
    };
    place.write("tiny.toml", &sweep.text());
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    assert_eq!(place.records("results/tiny").len(), 4);
    let labels = place.read("results/tiny/labels.csv");
    for omega in omegas {
        for seed in seeds {
            assert!(labels.contains(&format!(",{omega},{seed},")), "{labels}");
            let point = format!("omega={omega},seed={seed}");
            let run = ["run", "--from", "results/tiny", "--point", &point, "--json"];
            let answer = place.phase(&run).code(0);
            let answer: serde_json::Value = serde_json::from_str(&answer.stdout).unwrap();
            assert_eq!(
                (&answer["seed"], &answer["same_bits"]),
                (&seed.into(), &true.into())
            );
            let path = format!("results/tiny/runs/omega-{omega}_seed-{seed}.h5");
            assert_eq!(answer["record"], path);
            let scene = read_record(&place.path(&path)).unwrap().scene;
            let swirl = scene.dem.effects.swirl.unwrap();
            assert_eq!((scene.seed, swirl.omega.to_bits()), (seed, omega.to_bits()));
        }
    }
    let refused = |point: &str, message: &str| {
        let run = ["run", "--from", "results/tiny", "--point", point];
        place.phase(&run).code(2).complains(message);
        let plot = [
            "plot",
            "results/tiny",
            "--figure",
            "speeds",
            "--point",
            point,
        ];
        place.phase(&plot).code(2);
    };
    refused(
        "omega=.3,seed=9007199254740994",
        "`seed` is never 9007199254740994; it takes 9007199254740992, 9007199254740993",
    );
    refused(
        "omega=.3000000001",
        "`omega` is never 0.3000000001; it takes 0.3, 0.30000000000000004",
    );
    refused(
        "omega=.3,omega=.30000000000000004",
        "the point gives `omega` twice",
    );
}
