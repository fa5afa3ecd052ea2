//! What is written is what is read.

use super::examples;
use ndarray::{Array2, Array3};
use phase::observe::{Observations, OwnSeries, Snapshot};
use phase::record::{Outcome, Program, RunRecord};
use phase::store::{StoreError, content_digest, read_record, read_record_header, write_record};
use proptest::prelude::*;

/// A change to a record.
type Change = fn(&mut RunRecord);

/// Writes a record; returns what is read from the file, and the file.
fn through_file(record: &RunRecord) -> Result<(RunRecord, Vec<u8>), StoreError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    write_record(record, &path)?;
    let header = read_record_header(&path)?;
    let back = read_record(&path)?;
    assert_eq!(header.scene, back.scene);
    assert_eq!(header.program, back.program);
    assert_eq!(header.outcome, back.outcome);
    assert_eq!(header.cpu_seconds, back.cpu_seconds);
    Ok((back, std::fs::read(path).unwrap()))
}

/// Asserts equality bit by bit, for which "not a number" equals itself.
fn assert_same(found: &RunRecord, expected: &RunRecord) {
    fn bits32<'a>(values: impl IntoIterator<Item = &'a f32>) -> Vec<u32> {
        values.into_iter().map(|value| value.to_bits()).collect()
    }
    fn bits64<'a>(values: impl IntoIterator<Item = &'a f64>) -> Vec<u64> {
        values.into_iter().map(|value| value.to_bits()).collect()
    }
    fn same_states(found: &[Snapshot], expected: &[Snapshot]) {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            assert_eq!(found.time.to_bits(), expected.time.to_bits());
            for (found, expected) in [
                (&found.position, &expected.position),
                (&found.velocity, &expected.velocity),
                (&found.spin, &expected.spin),
            ] {
                assert_eq!(found.dim(), expected.dim());
                assert_eq!(bits64(found), bits64(expected));
            }
        }
    }
    assert_eq!(found.scene, expected.scene);
    assert_eq!(found.scene.identity(), expected.scene.identity());
    assert_eq!(found.program, expected.program);
    assert_eq!(found.outcome, expected.outcome);
    assert_eq!(bits64(&found.radius), bits64(&expected.radius));
    assert_eq!(bits64(&found.mass), bits64(&expected.mass));
    assert_eq!(found.cpu_seconds.to_bits(), expected.cpu_seconds.to_bits());
    same_states(&found.snapshots, &expected.snapshots);
    same_states(&found.trajectory, &expected.trajectory);

    let (found, expected) = (&found.observations, &expected.observations);
    assert_eq!(bits64(&found.time), bits64(&expected.time));
    for (found, expected) in found.scalars().iter().zip(expected.scalars()) {
        assert_eq!(
            bits32(found.values),
            bits32(expected.values),
            "{}",
            found.name
        );
    }
    assert_eq!(found.profile.dim(), expected.profile.dim());
    assert_eq!(bits32(&found.profile), bits32(&expected.profile));
    assert_eq!(found.rising, expected.rising);
}

#[test]
fn a_typical_record_is_under_a_megabyte_and_reads_back() {
    // The tank at its smallest radius: 5 s in frames of 1 ms, 15 radial bins, 256 spheres.
    let record = examples::record(5001, 15, 256, 6);
    let (back, bytes) = through_file(&record).unwrap();
    assert_same(&back, &record);
    assert!(bytes.len() < 1_000_000, "{} bytes", bytes.len());
}

#[test]
fn a_trajectory_of_many_chunks_reads_back() {
    let mut record = examples::record(3, 2, 256, 301);
    record.trajectory = std::mem::take(&mut record.snapshots);
    record.outcome = examples::unstable();
    for state in &mut record.trajectory {
        state.spin = Array2::zeros((0, 3));
    }
    let (back, _) = through_file(&record).unwrap();
    assert_same(&back, &record);
}

#[test]
fn a_scene_with_many_spheres_reads_back() {
    let mut record = examples::record(1, 1, 1, 1);
    // Longer than the 64 KiB that an attribute itself may hold.
    record.scene.spheres.radius =
        phase::scene::Radii::Each((1..=20_000).map(|n| 1.0 / f64::from(n)).collect());
    let (back, _) = through_file(&record).unwrap();
    assert_same(&back, &record);
}

/// Symptom: a million spheres from a file took twice the memory when their record was written, and
/// 250 bytes each in it. Cause: they stood in the scene's texts.
#[test]
fn a_long_list_of_spheres_stands_in_datasets() {
    for count in [1000, 1001, 20_000] {
        let mut record = examples::record(1, 1, 1, 1);
        examples::list_many(&mut record.scene, count);
        let (back, bytes) = through_file(&record).unwrap();
        assert_same(&back, &record);
        record.scene.spheres.count += 1;
        match through_file(&record) {
            Ok(_) => assert!(count <= 1000),
            Err(error) => {
                let reason = "`start/radius` is not one row for each of";
                assert!(error.to_string().contains(reason), "{error}");
            }
        }
        let in_text = bytes.windows(10).any(|text| text == b"\"position\"");
        assert_eq!(in_text, count <= 1000);
    }
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let record = examples::record(50, 4, 5, 2);
    let (_, first) = through_file(&record).unwrap();
    let (_, second) = through_file(&record.clone()).unwrap();
    assert_eq!(first, second);
}

#[test]
fn the_digest_ignores_only_program_and_processor_time() {
    let record = examples::record(50, 4, 5, 2);
    let digest = content_digest(&record).unwrap();

    let mut same = record.clone();
    same.cpu_seconds = 7.0;
    same.program.version = "9.9.9".to_owned();
    assert_eq!(content_digest(&same).unwrap(), digest);

    let changes: [Change; 7] = [
        |record| record.scene.seed += 1,
        |record| record.outcome = examples::unstable(),
        |record| record.mass[4] *= 1.0 + f64::EPSILON,
        |record| record.observations.time[49] = -1.0,
        |record| record.observations.rising[[49, 2, 2]] += 1,
        |record| record.snapshots[1].spin[[4, 2]] += 1.0,
        |record| record.trajectory = record.snapshots.clone(),
    ];
    for change in changes {
        let mut other = record.clone();
        change(&mut other);
        assert_ne!(content_digest(&other).unwrap(), digest);
    }
}

#[test]
fn what_does_not_fit_together_is_not_written() {
    let faults: [(Change, &str); 6] = [
        (
            |record| record.observations.kinetic.truncate(2),
            "`kinetic` has 2 frames, but `time` has 3",
        ),
        (
            |record| record.observations.profile = Array2::zeros((0, 4)),
            "`profile` has 0 frames, but `time` has 3",
        ),
        (
            |record| record.snapshots[1].velocity = Array2::zeros((4, 3)),
            "snapshots: `velocity` at t = 1 s has shape (4, 3), but (5, 3) is expected",
        ),
        (
            |record| record.scene.dem.guards.overlap = f64::INFINITY,
            "its scene holds a number that is not finite; check the scene file",
        ),
        (
            |record| {
                examples::list_many(&mut record.scene, 1001);
                record.scene.start.list_mut().unwrap()[1000].spin[2] = f64::NAN;
            },
            "its scene holds a number that is not finite; check the scene file",
        ),
        (
            |record| {
                examples::list_many(&mut record.scene, 1001);
                record.scene.start.list_mut().unwrap()[1000].radius = Some(f64::NAN);
            },
            "its scene holds a number that is not finite; check the scene file",
        ),
    ];
    for (fault, message) in faults {
        let mut record = examples::record(3, 4, 5, 2);
        fault(&mut record);
        let found = through_file(&record).unwrap_err().to_string();
        assert!(found.contains("run.h5: "), "{found}");
        assert!(found.ends_with(message), "{found}");
    }
}

fn any_states(spheres: usize, spin: bool) -> impl Strategy<Value = Vec<Snapshot>> {
    let values = prop::collection::vec(any::<f64>(), 9 * spheres + 1);
    prop::collection::vec(values, 0..3).prop_map(move |states| {
        let state = |values: Vec<f64>| {
            let array = |part: usize, rows: usize| {
                let part = values[3 * spheres * part..][..3 * rows].to_vec();
                Array2::from_shape_vec((rows, 3), part).unwrap()
            };
            Snapshot {
                time: values[9 * spheres],
                position: array(0, spheres),
                velocity: array(1, spheres),
                spin: array(2, if spin { spheres } else { 0 }),
            }
        };
        states.into_iter().map(state).collect()
    })
}

fn any_observations() -> impl Strategy<Value = Observations> {
    (0..5usize, 0..4usize, 0..3usize, 0..3usize)
        .prop_flat_map(|(frames, bins, radii, speeds)| {
            let rising = frames * radii * speeds;
            (
                Just((frames, bins, radii, speeds)),
                prop::collection::vec(any::<f64>(), frames),
                prop::collection::vec(any::<f32>(), frames * (bins + 1)),
                prop::collection::vec(any::<u16>(), rising),
            )
        })
        .prop_map(|((frames, bins, radii, speeds), time, values, rising)| {
            let profile = values[frames..].to_vec();
            let mut observations = Observations {
                time,
                profile: Array2::from_shape_vec((frames, bins), profile).unwrap(),
                rising: Array3::from_shape_vec((frames, radii, speeds), rising).unwrap(),
                ..Observations::default()
            };
            for (turn, column) in Observations::COLUMNS.iter().step_by(2).enumerate() {
                let mut series = values[..frames].to_vec();
                series.rotate_left(if frames == 0 { 0 } else { turn % frames });
                *observations.scalar_mut(column.name).unwrap() = series;
            }
            observations.own = vec![OwnSeries {
                name: "spots".to_owned(),
                unit: "1".to_owned(),
                description: "Something that a model declares for itself".to_owned(),
                values: values[..frames].to_vec(),
            }];
            observations
        })
}

prop_compose! {
    fn any_record()(
        spheres in 1..4usize,
        spin in any::<bool>(),
    )(
        radius in prop::collection::vec(any::<f64>(), spheres),
        mass in prop::collection::vec(any::<f64>(), spheres),
        snapshots in any_states(spheres, spin),
        trajectory in any_states(spheres, spin),
        observations in any_observations(),
        stable in any::<bool>(),
        seed in any::<u64>(),
        dt in prop::num::f64::NORMAL,
        version in "\\PC{1,12}",
        work in 0_u64..1 << 50,
        cpu_seconds in 0.0..1e9f64,
    ) -> RunRecord {
        let mut scene = examples::scene();
        scene.seed = seed;
        scene.time.dt = dt;
        RunRecord {
            scene,
            program: Program { version, commit: "unknown".to_owned() },
            outcome: if stable { Outcome::Completed } else { examples::unstable() },
            radius,
            mass,
            milestones: Vec::new(),
            observations,
            snapshots,
            trajectory,
            work,
            cpu_seconds,
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn any_record_reads_back(record in any_record()) {
        let (back, _) = through_file(&record).unwrap();
        assert_same(&back, &record);
    }
}
