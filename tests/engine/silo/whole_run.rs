//! Fill, rest, door, drain.

use super::{hopper, record, shipped, time_of};
use crate::support::Workplace;
use phase::record::{MilestoneKind, Outcome, RunRecord};

/// When so many spheres had left (s).
fn time_left(record: &RunRecord, count: f32) -> f64 {
    let observations = &record.observations;
    let frame = observations
        .discharged
        .iter()
        .position(|left| *left >= count);
    observations.time[frame.unwrap()]
}

/// A number of the whole run: what is measured, the value to meet, and by how much the mean over
/// the seeds may miss it.
struct Expected {
    quantity: &'static str,
    value: f64,
    tolerance: f64,
    measure: fn(&RunRecord) -> f64,
}

/// One run of Remmers' silo by another program; its rate is said to lie in 28.5 to 30.5 over time
/// steps and release positions. Grains move chaotically, so one run is one draw. Over the seeds 1
/// to 8 ours spread by 1.0 s, 0.04 m, 0.9 s and 0.6 grains/s (one standard deviation). Tolerances
/// are 2.5 of these (for the rate 1.7): one run and the mean of four that differ by nothing but
/// chance are farther apart in 3 % (13 %) of all cases; one run and one run, at 1.26 times as much,
/// too. The seeds are fixed: the test gives the same answer every time.
const WHOLE_RUN: [Expected; 4] = [
    Expected {
        quantity: "time at rest (s)",
        value: 51.6,
        tolerance: 2.5,
        measure: |record| time_of(record, MilestoneKind::AtRest),
    },
    Expected {
        quantity: "top of the heap (m)",
        value: 2.906,
        tolerance: 0.1,
        measure: |record| {
            let rest = time_of(record, MilestoneKind::DoorOpened);
            let observations = &record.observations;
            let frame = observations
                .time
                .iter()
                .position(|time| *time >= rest - 1e-9);
            f64::from(observations.height_max[frame.unwrap()])
        },
    },
    Expected {
        quantity: "time from the door's opening to the last grain (s)",
        value: 35.8,
        tolerance: 2.2,
        measure: |record| {
            time_of(record, MilestoneKind::Emptied) - time_of(record, MilestoneKind::DoorOpened)
        },
    },
    Expected {
        quantity: "grains per second from 20 to 80 %",
        value: 29.5,
        tolerance: 1.0,
        measure: |record| 600.0 / (time_left(record, 800.0) - time_left(record, 200.0)),
    },
];

/// Asserts that runs of the shipped silo with these seeds, or as it is shipped, empty it and meet
/// the numbers, within so many times the tolerance of four.
#[track_caller]
fn assert_silo(seeds: &[Option<u64>], tolerances: f64) {
    let scene = shipped("silo.toml");
    let records: Vec<RunRecord> = std::thread::scope(|scope| {
        let start = |seed: &Option<u64>| {
            let mut scene = scene.clone();
            // Far below anything one could see, and enough for another course of everything.
            if let (Some(seed), phase::scene::Start::Feed { spread, .. }) = (seed, &mut scene.start)
            {
                scene.seed = *seed;
                *spread = 1e-6;
            }
            scope.spawn(move || record(&scene))
        };
        let threads: Vec<_> = seeds.iter().map(start).collect();
        let ended = threads.into_iter().map(|thread| thread.join().unwrap());
        ended.collect()
    });
    for record in &records {
        assert_eq!(record.outcome, Outcome::Completed, "no grain passes a wall");
        assert_eq!(record.observations.discharged.last(), Some(&1000.0));
    }
    for Expected {
        quantity,
        value,
        tolerance,
        measure,
    } in WHOLE_RUN
    {
        let mean = records.iter().map(measure).sum::<f64>() / records.len() as f64;
        assert!(
            (mean - value).abs() < tolerances * tolerance,
            "{quantity}: {mean}, not {value}"
        );
    }
}

#[test]
#[ignore = "takes a quarter of a minute"]
fn the_shipped_silo_meets_its_numbers() {
    assert_silo(&[None], 1.26);
}

#[test]
#[ignore = "takes twenty seconds"]
fn four_runs_of_the_shipped_silo_meet_its_numbers() {
    assert_silo(&[None, Some(1), Some(2), Some(3)], 1.0);
}

/// Symptom: a panic, a division by zero. Cause: a feed of no spheres has no interval either.
#[test]
fn grains_may_be_there_from_the_start() {
    let feed = r#"kind = "feed", position = [0.0, 0.0, 1.4], velocity = [0.0, 0.0, -2.0], interval = 0.05, spread = 0.1"#;
    let list = r#"kind = "list", spheres = [
        { position = [0.0, 0.0, 0.5], radius = 0.04 }, { position = [0.1, 0.0, 0.6], radius = 0.04 }]"#;
    let scene = hopper(&[("count = 60", "count = 2"), (feed, list)]);
    let record = record(&scene);
    let kinds: Vec<_> = record.milestones.iter().map(|it| it.kind).collect();
    use MilestoneKind::{AtRest, DoorOpened, Emptied};
    assert_eq!(kinds, [AtRest, DoorOpened, Emptied]);
    let observations = &record.observations;
    assert!(
        observations
            .released
            .iter()
            .all(|released| *released == 2.0)
    );
    assert_eq!(observations.discharged.last(), Some(&2.0));
    assert!(record.work > 0);
}

#[test]
fn a_grain_that_bounces_off_a_corner_has_not_passed_it() {
    // Into the foot of the shipped silo's wall, with a wall that holds it.
    let mut scene = shipped("silo.toml");
    scene.spheres.count = 1;
    scene.start = phase::scene::Start::list(vec![phase::scene::StartSphere {
        velocity: [-1.45, 0.0, -0.6],
        ..phase::scene::StartSphere::at([-1.1, 0.0, 1.12])
    }]);
    let record = record(&scene);
    assert_eq!(record.outcome, Outcome::Completed);
}

#[test]
fn a_run_counts_every_grain_in_and_out() {
    let record = record(&hopper(&[]));
    let kinds: Vec<_> = record.milestones.iter().map(|it| it.kind).collect();
    use MilestoneKind::{AtRest, DoorOpened, Emptied, Filled};
    assert_eq!(kinds, [Filled, AtRest, DoorOpened, Emptied]);
    assert!((time_of(&record, Filled) - 59.0 * 0.05).abs() < 1e-9);
    // At rest for half a second before the door opens.
    let wait = time_of(&record, DoorOpened) - time_of(&record, AtRest);
    assert!((wait - 0.5).abs() < 1e-9);
    let observations = &record.observations;
    let frames = observations.frames();
    for frame in 0..frames {
        let (time, released) = (observations.time[frame], observations.released[frame]);
        let due = ((time + 1e-9) / 0.05).floor() as f32 + 1.0;
        // The first comes in with the first step.
        assert!(
            frame == 0 || released == due.min(60.0),
            "{released} at {time} s"
        );
        let before = if frame == 0 {
            0.0
        } else {
            observations.discharged[frame - 1]
        };
        assert!(observations.discharged[frame] >= before);
        assert!(time >= time_of(&record, DoorOpened) || observations.discharged[frame] == 0.0);
    }
    assert_eq!(observations.discharged[frames - 1], 60.0);
    assert!(observations.time[frames - 1] < 30.0, "it ends by itself");
    // Counts of work are those of the grains that were in.
    let inside = observations
        .released
        .iter()
        .zip(&observations.discharged)
        .skip(1);
    let expected: f32 = inside
        .map(|(released, discharged)| released - discharged)
        .sum();
    // Frames do not say when within them a grain came or left.
    let ratio = record.work as f64 / (f64::from(expected) * 100.0);
    assert!((0.99..1.01).contains(&ratio), "{ratio}");
    // The rate is that of the last second, twenty frames.
    for (frame, rate) in observations.discharge_rate.iter().enumerate().skip(20) {
        let left = observations.discharged[frame] - observations.discharged[frame - 20];
        assert!((rate - left).abs() < 1e-3, "{rate} and {left}");
    }
}

#[test]
fn a_new_silo_fills_rests_and_drains() {
    let place = Workplace::new();
    place.phase(&["new", "silo", "mine"]).code(0);
    let answer = place.phase(&["run", "mine.toml"]).code(0);
    for event in ["filled", "at rest", "door opened", "emptied"] {
        assert!(
            answer.stdout.contains(event),
            "{event} in {}",
            answer.stdout
        );
    }
    let check = place
        .phase(&["check", "mine.toml", "--no-trial", "--verbose"])
        .code(0);
    assert!(!check.stdout.contains("WARNING"), "{}", check.stdout);
}

#[test]
fn friction_lets_grains_arch() {
    // With an opening of two grains; smooth ones run out.
    let narrow = ("opening = 0.3", "opening = 0.16");
    let rough = record(&hopper(&[
        narrow,
        ("coefficient = 0.2", "coefficient = 0.8"),
    ]));
    assert_eq!(rough.milestones.last().unwrap().kind, MilestoneKind::AtRest);
    let left = *rough.observations.discharged.last().unwrap();
    assert!(left < 60.0, "{left}");
    let smooth = record(&hopper(&[
        narrow,
        ("coefficient = 0.2", "coefficient = 0.0"),
    ]));
    assert_eq!(smooth.observations.discharged.last(), Some(&60.0));
}

#[test]
#[ignore = "takes a quarter of a minute"]
fn two_and_a_half_thousand_grains_and_more() {
    // Small grains by the thousand, fed in fast: nothing is limited to the document's 2500.
    let scene = hopper(&[
        ("velocity = [0.0, 0.0, -2.0]", "velocity = [0.0, 0.0, -4.0]"),
        ("count = 60", "count = 3000"),
        (
            "[{ radius = 0.04, share = 1 }, { radius = 0.03, share = 1 }]",
            "0.008",
        ),
        (
            "opening = 0.3, spacing = 0.05, radius = 0.03",
            "opening = 0.3, spacing = 0.02, radius = 0.015",
        ),
        (
            "interval = 0.05, spread = 0.1",
            "interval = 8e-4, spread = 0.3",
        ),
        ("dt = 5e-4, duration = 30.0", "dt = 2e-4, duration = 3.4"),
        (
            "stiffness = 100.0, damping = 0.05",
            "stiffness = 100.0, damping = 0.01",
        ),
        (
            "stiffness = 70.0, damping = 0.02",
            "stiffness = 70.0, damping = 0.004",
        ),
    ]);
    let record = record(&scene);
    assert_eq!(record.outcome, Outcome::Completed);
    assert_eq!(record.observations.released.last(), Some(&3000.0));
}
