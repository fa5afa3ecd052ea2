use crate::classify::{ClassifyError, DRAINAGE, Family, Label, Sieves, Verdict, classify};
use crate::observe::{Observations, Snapshot};
use crate::record::{Outcome, Program, RunRecord};
use crate::scene::Scene;
use ndarray::{Array2, Array3};
use std::path::Path;

/// Number of spheres: 20 along x, 10 layers.
const SPHERES: usize = 200;
/// Time between frames, and duration (s).
const INTERVAL: f64 = 1.0;
const DURATION: f64 = 20.0;

fn scene() -> Scene {
    let text = r#"
        spheres = { count = 200, radius = 0.5, density = 1.9 }
        start = { kind = "packing" }
        tank = { width = 20.0, depth = 8.0, floor = 0.0, orifice_radius = 2.0 }
        time = { duration = 20.0, frame_interval = 1.0 }
        [spot]
        radius = 2.6
        displacement_ratio = 399.0
        diffusion_length = 2.28
        vertical_step = 0.1
        insertion_rate = 375.0
        move_rate = 28.0
    "#;
    Scene::from_toml(text, Path::new("scene.toml")).unwrap()
}

fn snapshot(time: f64) -> Snapshot {
    let place = |sphere: usize, axis: usize| match axis {
        0 => -9.5 + (sphere % 20) as f64,
        1 => 0.0,
        _ => 0.5 + (sphere / 20) as f64,
    };
    Snapshot {
        time,
        position: Array2::from_shape_fn((SPHERES, 3), |(sphere, axis)| place(sphere, axis)),
        velocity: Array2::zeros((SPHERES, 3)),
        ..Snapshot::default()
    }
}

/// A box that `left(time)` spheres have left, and in which all that is above a height (m) fell by
/// two diameters.
fn draining(left: impl Fn(f64) -> f64, moved_above: f64) -> RunRecord {
    let frames = (DURATION / INTERVAL) as usize + 1;
    let time: Vec<f64> = (0..frames).map(|frame| frame as f64 * INTERVAL).collect();
    let discharged: Vec<f32> = time.iter().map(|it| left(*it) as f32).collect();
    let mut end = snapshot(DURATION);
    for mut row in end.position.rows_mut() {
        if row[2] > moved_above {
            row[2] -= 2.0;
        }
    }
    RunRecord {
        scene: scene(),
        program: Program::current(),
        outcome: Outcome::Completed,
        radius: vec![0.5; SPHERES],
        mass: vec![1.0; SPHERES],
        milestones: Vec::new(),
        observations: Observations {
            time,
            discharged,
            profile: Array2::zeros((frames, 0)),
            rising: Array3::zeros((frames, 0, 3)),
            ..Observations::default()
        },
        snapshots: vec![snapshot(0.0), end],
        trajectory: Vec::new(),
        work: 0,
        cpu_seconds: 0.0,
    }
}

fn judge(record: &RunRecord) -> Verdict {
    classify(record, &Sieves::default()).unwrap()
}

#[test]
fn a_box_with_an_opening_is_a_drainage() {
    assert_eq!(Family::of(&scene()), &DRAINAGE);
}

#[test]
fn spheres_that_have_not_moved_are_stagnant_corners() {
    for (height, label) in [
        (1.9, Label::DRAINING),
        (3.1, Label::STAGNANT_CORNERS),
        (6.1, Label::STAGNANT_CORNERS),
    ] {
        let verdict = judge(&draining(|time| 2.0 * time, height));
        assert_eq!(verdict.label, label, "{height}");
        let expected = (height + 0.5).floor();
        assert_eq!(verdict.value("stagnant_height"), Some(expected));
        assert_eq!(verdict.value("outflow_rate"), Some(2.0));
        assert_eq!(verdict.value("left_share"), Some(0.2));
    }
}

#[test]
fn an_opening_that_none_leaves_through_is_blocked() {
    let until = |end: f64| draining(move |time| 3.0 * time.min(end), 0.0);
    let verdict = judge(&until(15.0));
    assert_eq!(verdict.label, Label::BLOCKED);
    assert_eq!(verdict.value("blocked_count"), Some(0.0));
    // Symptom: blocked runs counted in the fit of Beverloo's law. Cause: they had the rate
    // of the time before.
    assert_eq!(verdict.value("outflow_rate"), None);
    // The window of 4 s begins at 16 s.
    let verdict = judge(&until(17.0));
    assert_eq!(verdict.label, Label::DRAINING);
    assert_eq!(verdict.value("blocked_count"), Some(3.0));
}

#[test]
fn what_has_nothing_left_over_its_opening_is_empty() {
    let verdict = judge(&draining(|time| 9.5 * time, 0.0));
    assert_eq!(verdict.label, Label::EMPTIED);
    let mut record = draining(|time| (4.0 * time).min(40.0), 0.0);
    assert_eq!(judge(&record).label, Label::BLOCKED);
    for mut row in record.snapshots[1].position.rows_mut() {
        if row[0].abs() < 2.0 {
            row.fill(f64::NAN);
        }
    }
    assert_eq!(judge(&record).label, Label::EMPTIED);
}

#[test]
fn a_threshold_out_of_range_is_named() {
    let mut sieves = Sieves::default();
    sieves.blocked.window = 0.1;
    match sieves.check(&scene()) {
        Err(ClassifyError::Threshold { key, .. }) => assert_eq!(key, "blocked.window"),
        other => panic!("{other:?}"),
    }
}
