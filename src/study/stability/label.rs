//! What became of a run, numerically.

use crate::observe::Observations;
use crate::record::{Guard, RunRecord};

/// What became of a run, from harmless to worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Label {
    /// No guard was broken, and the energy stayed in bounds.
    Stable,
    /// No guard was broken, but energy came out of nothing.
    EnergyGain,
    /// A sphere moved too far in one step, left the bounds, or passed through something.
    LostSphere,
    /// A position or velocity is not a number.
    NotANumber,
}

impl Label {
    /// All labels, from harmless to worst.
    pub const ALL: [Self; 4] = [
        Self::Stable,
        Self::EnergyGain,
        Self::LostSphere,
        Self::NotANumber,
    ];

    /// Name, as in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::EnergyGain => "energy-gain",
            Self::LostSphere => "lost-sphere",
            Self::NotANumber => "not-a-number",
        }
    }

    /// The label of a run that this guard ended, or none, with this gain of energy (of
    /// [`energy_gain`]), of which `threshold` is still stable.
    pub fn of(guard: Option<Guard>, gain: f64, threshold: f64) -> Self {
        match guard {
            Some(Guard::NotANumber) => Self::NotANumber,
            Some(_) => Self::LostSphere,
            None if !gain.is_finite() => Self::NotANumber,
            None if gain <= threshold => Self::Stable,
            None => Self::EnergyGain,
        }
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
pub fn energy_gain(record: &RunRecord) -> f64 {
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
    fn a_guard_outweighs_the_energy() {
        assert_eq!(Label::of(None, 0.05, 0.05), Label::Stable);
        assert_eq!(Label::of(None, 0.06, 0.05), Label::EnergyGain);
        for guard in Guard::ALL {
            let expected = match guard {
                Guard::NotANumber => Label::NotANumber,
                _ => Label::LostSphere,
            };
            assert_eq!(Label::of(Some(guard), 0.0, 0.05), expected);
        }
    }
}
