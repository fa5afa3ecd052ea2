//! The numerical outcome of a run: stable, or how its numbers went wrong. Studies of stability use
//! it for scenes of any family.

use super::measure::{measured, measures};
use super::{Family, Label, Verdict};
use crate::dem::timestep::largest_stable;
use crate::observe::Observations;
use crate::record::{Guard, Outcome, RunRecord};

impl Label {
    /// No guard was broken, but energy came out of nothing.
    pub const ENERGY_GAIN: Self = Self::new(13, "energy-gain", 0xe2_a8_3c);
    /// A sphere moved too far in one step, left the bounds, or passed through something.
    pub const LOST_SPHERE: Self = Self::new(14, "lost-sphere", 0x98_2c_74);
    /// A position or velocity is not a number.
    pub const NOT_A_NUMBER: Self = Self::new(15, "not-a-number", 0x00_00_00);
}

/// Runs that are judged numerically. No scene is of this family by itself.
pub static NUMERICS: Family = Family {
    name: "study of stability",
    rules: &[],
    sieves: &[],
    without_sieve: &[
        Label::STABLE,
        Label::ENERGY_GAIN,
        Label::LOST_SPHERE,
        Label::NOT_A_NUMBER,
    ],
    order: Numbers::MEASURES,
    default_figures: &["phase"],
    takes: |_| false,
    check: |_, _| Ok(()),
    judge: |record, _| {
        let verdict = judge_numerics(record, ENERGY_GAIN);
        Ok((verdict.label, verdict.values))
    },
    measured: &[],
    base: None,
};

/// Largest spurious gain of energy that counts as stable, by default.
pub const ENERGY_GAIN: f64 = 0.05;

measures! {
    /// Measures of the numerics of a run.
    struct Numbers {
        /// Time step.
        time_step: measured("time step", "s"),
        /// Time step over the least limit that decides about stability.
        step_over_limit: measured("time step over its limit", ""),
        /// Largest energy out of nothing, over the largest energy so far.
        energy_gain: measured("energy gain", ""),
    }
}

/// Judges a run numerically: `threshold` is the largest spurious gain of energy that is still
/// stable. Unlike the verdict of sieves, one on a run that a guard ended has measures.
pub fn judge_numerics(record: &RunRecord, threshold: f64) -> Verdict {
    let gain = energy_gain(record);
    let scene = &record.scene;
    let limit = largest_stable(scene);
    let numbers = Numbers {
        time_step: Some(scene.time.dt),
        step_over_limit: limit.map(|limit| scene.time.dt / limit.seconds),
        energy_gain: Some(gain),
    };
    Verdict {
        label: match &record.outcome {
            Outcome::Unstable(broken) if broken.guard == Guard::NotANumber => Label::NOT_A_NUMBER,
            Outcome::Unstable(_) => Label::LOST_SPHERE,
            Outcome::Completed => label_of_gain(gain, threshold),
        },
        family: &NUMERICS,
        steady: None,
        values: numbers.values(),
    }
}

/// The label of a run by another threshold, from its label and measures by any.
pub fn judge_numerics_again(label: Label, values: &[Option<f64>], threshold: f64) -> Label {
    let place = NUMERICS.measures().position(|it| it.name == "energy_gain");
    match place.and_then(|place| *values.get(place)?) {
        Some(gain) if [Label::STABLE, Label::ENERGY_GAIN].contains(&label) => {
            label_of_gain(gain, threshold)
        }
        _ => label,
    }
}

/// The label of a run that no guard ended.
fn label_of_gain(gain: f64, threshold: f64) -> Label {
    match gain {
        gain if !gain.is_finite() => Label::NOT_A_NUMBER,
        gain if gain <= threshold => Label::STABLE,
        _ => Label::ENERGY_GAIN,
    }
}

/// The largest spurious gain of energy up to a frame, relative: the residual of the energy balance
/// over the larger of two reference energies.
///
/// The first is the largest sum of the kinetic, rotational and elastic energies and of the
/// tangential springs of the frames so far. An instability cannot hide behind its own growth: the
/// sum then grows with the residual, and their ratio tends to 1. The second is the sum of m g r,
/// what lifts each sphere by its radius: spheres at rest have almost no energy, and negligible
/// errors would exceed it many times.
///
/// Zero if energy was only lost. Needs a record with the energy balance.
fn energy_gain(record: &RunRecord) -> f64 {
    let gravity = record.scene.dem.effects.gravity.as_ref();
    let acceleration = gravity.map_or(0.0, |gravity| gravity.acceleration);
    let spheres = record.mass.iter().zip(&record.radius);
    let lift: f64 = spheres
        .map(|(mass, radius)| mass * acceleration * radius)
        .sum();
    gain_over(&record.observations, lift)
}

/// The same with the second energy (J) given.
fn gain_over(books: &Observations, lift: f64) -> f64 {
    let (mut scale, mut gain) = (lift, 0.0);
    for (frame, residual) in books.residual.iter().enumerate() {
        let parts = [
            &books.kinetic,
            &books.rotational,
            &books.elastic,
            &books.springs,
        ];
        // What a scene does not have is not observed.
        let energy = parts.iter().filter_map(|part| part.get(frame));
        let energy: f64 = energy.map(|energy| f64::from(*energy)).sum();
        scale = energy.max(scale);
        let residual = f64::from(*residual);
        if !residual.is_finite() {
            return f64::INFINITY;
        }
        if residual > 0.0 {
            gain = (residual / scale).max(gain);
        }
    }
    gain
}

#[cfg(test)]
mod tests {
    use super::*;

    fn books(kinetic: &[f32], residual: &[f32]) -> Observations {
        let none = vec![0.0; kinetic.len()];
        Observations {
            kinetic: kinetic.to_vec(),
            residual: residual.to_vec(),
            rotational: none.clone(),
            elastic: none.clone(),
            springs: none,
            ..Observations::default()
        }
    }

    #[test]
    fn growth_does_not_hide_itself() {
        let kinetic: Vec<f32> = (0..20).map(|frame| libm::exp2f(frame as f32)).collect();
        let residual: Vec<f32> = kinetic.iter().map(|energy| energy - 1.0).collect();
        let gain = gain_over(&books(&kinetic, &residual), 1.0);
        assert!((0.99..1.0).contains(&gain), "{gain}");
    }

    #[test]
    fn losses_and_specks_at_rest_are_no_gain() {
        assert_eq!(gain_over(&books(&[1.0, 0.5], &[0.0, -0.5]), 0.0), 0.0);
        let speck = books(&[0.0, 1e-9], &[0.0, 1e-9]);
        assert_eq!(gain_over(&speck, 0.0), 1.0);
        assert!(gain_over(&speck, 1e-3) < 1e-5);
        let broken = books(&[0.0, 1.0], &[0.0, f32::NAN]);
        assert_eq!(gain_over(&broken, 1.0), f64::INFINITY);
    }

    #[test]
    fn another_threshold_changes_no_label_of_a_guard() {
        assert_eq!(label_of_gain(0.05, 0.05), Label::STABLE);
        assert_eq!(label_of_gain(0.06, 0.05), Label::ENERGY_GAIN);
        let again = |label: Label| {
            let values = [None, None, Some(0.06)];
            judge_numerics_again(label, &values, 0.1)
        };
        assert_eq!(again(Label::ENERGY_GAIN), Label::STABLE);
        assert_eq!(again(Label::LOST_SPHERE), Label::LOST_SPHERE);
    }
}
