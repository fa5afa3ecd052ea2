use crate::classify::tank::synthetic::{ENERGY_UNIT, START, quiet};
use crate::classify::{ClassifyError, Label, Sieves, Verdict, classify};
use crate::record::RunRecord;

fn judge(record: &RunRecord) -> Verdict {
    classify(record, &Sieves::default()).unwrap()
}

/// A quiet run whose energy jumps to and fro in all frames, by this over m g R per sphere.
fn restless(jump: f64) -> RunRecord {
    let mut record = quiet(1000);
    let energies = &mut record.observations.kinetic;
    for energy in energies.iter_mut().skip(1).step_by(2) {
        *energy = (256.0 * ENERGY_UNIT * jump) as f32;
    }
    record
}

#[test]
fn a_run_settles_in_the_middle_of_its_first_steady_window() {
    let verdict = judge(&quiet(1000));
    assert_eq!(verdict.label, Label::SETTLED);
    assert_eq!(verdict.value("settle_time"), Some(START as f64 * 1e-3));
    assert_eq!(verdict.value("settle_change"), Some(0.0));
}

#[test]
fn a_window_needs_all_its_frames() {
    // A change into each of 500 frames, that is 501 frames.
    assert_eq!(judge(&quiet(501)).label, Label::SETTLED);
    let short = judge(&quiet(500));
    assert_eq!(short.label, Label::UNSETTLED);
    assert_eq!(short.value("settle_change"), None);
    assert_eq!(judge(&quiet(0)).label, Label::UNSETTLED);
}

#[test]
fn energy_changes_count_up_to_the_tolerance() {
    for (jump, label) in [(0.99e-3, Label::SETTLED), (1.01e-3, Label::UNSETTLED)] {
        let verdict = judge(&restless(jump));
        assert_eq!(verdict.label, label);
        let change = verdict.value("settle_change").unwrap();
        assert!((change - jump / 1e-3).abs() < 1e-5, "{change}");
    }
}

/// A run of fast spheres, a thousand m g R each, that gain this share of their energy in a
/// second while it jumps to and fro.
fn fast(gain: f64) -> RunRecord {
    let mut record = quiet(4000);
    let energies = &mut record.observations.kinetic;
    for (frame, energy) in energies.iter_mut().enumerate() {
        let jump = 4e-3 * (frame % 2) as f64;
        let own = 1000.0 * (1.0 + gain * (frame as f64 - 1000.0) * 1e-3);
        *energy = (256.0 * ENERGY_UNIT * (own + jump)) as f32;
    }
    record
}

/// Steel at the wall of a fast vortex was unsettled for ever, though its energy stood still to
/// a thousandth: its changes were measured by m g R, a seven hundredth of that energy.
#[test]
fn fast_spheres_settle_by_their_own_energy() {
    for (gain, label) in [
        (0.0, Label::SETTLED),
        (0.019, Label::SETTLED),
        (-0.019, Label::SETTLED),
        (0.5, Label::UNSETTLED),
    ] {
        let verdict = judge(&fast(gain));
        assert_eq!(verdict.label, label, "{gain}");
        assert!(verdict.value("settle_change").unwrap() > 1.0, "{gain}");
        let drift = verdict.value("settle_drift").unwrap();
        assert_eq!(drift <= 1.0, label == Label::SETTLED, "{gain}: {drift}");
    }
    assert_eq!(judge(&fast(0.0)).value("settle_time"), Some(1001.0 * 1e-3));
    // Where changes are small by m g R, nothing else is looked at.
    assert_eq!(judge(&quiet(4000)).value("settle_drift"), None);
}

/// A drift window of one frame has no halves, and found nothing without a word.
#[test]
fn a_drift_window_of_one_frame_is_refused() {
    let mut sieves = Sieves::default();
    for (window, is_refused) in [(1e-3, true), (2e-3, false)] {
        sieves.settle.drift_window = window;
        let found = classify(&quiet(1000), &sieves);
        let key = found.err().map(|error| match error {
            ClassifyError::Threshold { key, .. } => key,
            other => panic!("{other}"),
        });
        assert_eq!(key, is_refused.then_some("settle.drift_window"));
    }
}

/// The energy of spheres that fall and bounce has a maximum, about which it drifts slowly.
#[test]
fn fast_spheres_that_slow_down_again_do_not_settle() {
    let mut record = fast(0.0);
    for (frame, energy) in record.observations.kinetic.iter_mut().enumerate() {
        let time = frame as f64 * 1e-3 - 1.5;
        *energy *= (1.0 - 0.2 * time * time) as f32;
    }
    let verdict = judge(&record);
    assert_eq!(verdict.label, Label::UNSETTLED);
    assert!(verdict.value("settle_drift").unwrap() > 1.0);
}

#[test]
fn fast_spheres_above_the_height_do_not_settle() {
    let mut record = fast(0.0);
    record.observations.height_max.fill(0.3);
    assert_eq!(judge(&record).label, Label::UNSETTLED);
    assert_eq!(judge(&record).value("settle_drift"), None);
}

#[test]
fn all_three_energies_count_and_the_elastic_does_not() {
    for name in ["kinetic", "rotational", "gravitational", "elastic"] {
        let mut record = quiet(1000);
        let energies = std::mem::take(&mut restless(2e-3).observations.kinetic);
        *record.observations.scalar_mut(name).unwrap() = energies;
        let settled = judge(&record).label == Label::SETTLED;
        assert_eq!(settled, name == "elastic", "{name}");
    }
}

#[test]
fn changes_are_per_millisecond_whatever_the_frames() {
    let mut record = restless(4e-3);
    record.scene.time.frame_interval = 5e-3;
    let change = judge(&record).value("settle_change").unwrap();
    assert!((change - 0.8).abs() < 1e-5, "{change}");
}

#[test]
fn one_jump_delays_the_run_until_its_window_tolerates_it() {
    // On average over 500 frames this is 1.2 times the tolerance: the window must begin
    // after the frame it leads into.
    let mut record = quiet(2000);
    record.observations.gravitational[300..].fill((256.0 * ENERGY_UNIT * 0.6) as f32);
    assert_eq!(judge(&record).value("settle_time"), Some(551.0 * 1e-3));
}

#[test]
fn a_sphere_may_be_at_the_height_but_not_above() {
    let mut record = quiet(2000);
    record.observations.height_max.fill(0.2);
    assert_eq!(
        judge(&record).value("settle_time"),
        Some(START as f64 * 1e-3)
    );
    record.observations.height_max[400] = 0.200_001;
    assert_eq!(judge(&record).value("settle_time"), Some(651.0 * 1e-3));
    record.observations.height_max.fill(0.3);
    let high = judge(&record);
    assert_eq!(high.label, Label::UNSETTLED);
    assert_eq!(high.value("settle_change"), None);
}

#[test]
fn without_gravity_there_is_no_energy_scale() {
    let mut record = quiet(1000);
    record.scene.dem.effects.gravity = None;
    let error = classify(&record, &Sieves::default()).unwrap_err();
    assert!(matches!(error, ClassifyError::NoEnergyScale { .. }));
    assert!(
        error.to_string().contains("`gravity.acceleration`"),
        "{error}"
    );
}

#[test]
fn spheres_without_a_tank_are_judged_by_no_sieve() {
    let mut record = quiet(1000);
    record.scene.tank = None;
    let verdict = classify(&record, &Sieves::default()).unwrap();
    assert_eq!(verdict.label, Label::STABLE);
    let unstable = classify(&record.unstable(), &Sieves::default()).unwrap();
    assert_eq!(unstable.label, Label::UNSTABLE);
}

#[test]
fn thresholds_out_of_range_are_named() {
    let mut sieves = Sieves::default();
    sieves.settle.tolerance = 0.0;
    let error = sieves.check(&quiet(0).scene).unwrap_err();
    assert_eq!(
        error.to_string(),
        "`sieves.settle.tolerance` is 0, but must be a number above 0"
    );
}
