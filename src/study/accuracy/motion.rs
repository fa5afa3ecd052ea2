//! How far a motion is from that of the reference at given times.

use crate::study::comparison::{Quantity, Sample};
use serde::Serialize;

/// Relative errors of a motion.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MotionError {
    /// At each time: root mean square over the quantities; none where the run did not get there.
    pub times: Vec<Option<f64>>,
    /// Of each quantity at each time, in the order of the columns; none of one that the reference
    /// does not have.
    pub quantities: Vec<Option<f64>>,
}

impl MotionError {
    /// Compares the one run of a setting with that of the reference. The scale of a quantity is its
    /// largest size in the reference over all times, that of a component the largest one of all
    /// components of all spheres.
    pub(super) fn of(sample: &Sample<'_>, reference: &Sample<'_>, quantities: &[Quantity]) -> Self {
        let scales = scales(reference, quantities);
        let errors = quantities.iter().enumerate().map(|(place, _)| {
            let (own, other) = (sample.first_value(place)?, reference.first_value(place)?);
            (scales[place] > 0.0).then(|| (own - other).abs() / scales[place])
        });
        let errors: Vec<Option<f64>> = errors.collect();
        let times = quantities
            .iter()
            .filter_map(|it| it.time)
            .max()
            .map_or(0, |last| last + 1);
        let at = |time: usize| {
            let own = quantities
                .iter()
                .zip(&errors)
                .filter(|(it, _)| it.time == Some(time));
            let own: Vec<f64> = own.filter_map(|(_, error)| *error).collect();
            let squares: f64 = own.iter().map(|error| error * error).sum();
            (!own.is_empty()).then(|| (squares / own.len() as f64).sqrt())
        };
        Self {
            times: (0..times).map(at).collect(),
            quantities: errors,
        }
    }
}

/// What the name of a quantity begins with whose scale is that of all alike.
const COMPONENT: &str = "velocity_";

fn scales(reference: &Sample<'_>, quantities: &[Quantity]) -> Vec<f64> {
    let size = |place: usize| reference.first_value(place).map_or(0.0, f64::abs);
    let is_alike = |one: &Quantity, other: &Quantity| {
        let stem = |it: &Quantity| it.name.rsplit_once('_').map(|(stem, _)| stem.to_owned());
        let both = one.name.starts_with(COMPONENT) && other.name.starts_with(COMPONENT);
        both || stem(one) == stem(other)
    };
    let scale = |one: &Quantity| {
        let alike = quantities
            .iter()
            .enumerate()
            .filter(|(_, other)| is_alike(one, other));
        alike.map(|(place, _)| size(place)).fold(0.0, f64::max)
    };
    quantities.iter().map(scale).collect()
}
