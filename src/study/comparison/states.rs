//! How far the states of a setting are from those of the reference: labels and order parameters.

use super::{Comparison, Disagreement, RunRow, Shift};
use serde::Serialize;

/// How far the states of a setting are from those of the reference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct States {
    /// How often labels disagree; none if too few runs are there.
    pub disagreement: Option<Disagreement>,
    /// How far each order parameter is shifted.
    pub shifts: Vec<ShiftOf>,
}

/// The shift of an order parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShiftOf {
    /// The order parameter.
    pub quantity: String,
    /// Its shift; none where there is no spread, or few runs have the quantity.
    pub shift: Option<Shift>,
}

impl States {
    /// Those of a setting of a comparison, by its place, from the rows of all jobs.
    pub fn of(comparison: &Comparison, place: usize, rows: &[Option<RunRow>]) -> Self {
        let reference = comparison.sample(comparison.reference, rows);
        let sample = comparison.sample(place, rows);
        let purpose = &comparison.settings[place].name;
        let quantities = comparison.quantities();
        let together = quantities.len();
        let quantities = quantities.into_iter().enumerate();
        let shift = |(place, quantity): (usize, super::Quantity)| ShiftOf {
            shift: Shift::of(
                &sample,
                &reference,
                place,
                &format!("{purpose}, {}", quantity.name),
                together,
            ),
            quantity: quantity.name,
        };
        Self {
            disagreement: Disagreement::of(&sample, &reference, purpose),
            shifts: quantities.map(shift).collect(),
        }
    }

    /// Whether at most this share of the labels changes, and order parameters shift by at most so
    /// many of their spreads, for certain: the upper ends of the intervals say so.
    pub fn are_within(&self, labels: f64, shift: Option<f64>) -> bool {
        let few = self
            .disagreement
            .as_ref()
            .is_some_and(|it| it.excess.high <= labels);
        let known = || self.shifts.iter().filter_map(|it| it.shift.as_ref());
        let near = |most: f64| known().all(|it| it.root_mean_square.high <= most);
        few && shift.is_none_or(near)
    }

    /// How far an order parameter may be shifted at most, and which: the largest upper end of all
    /// intervals.
    pub fn most_shift(&self) -> Option<(&str, f64)> {
        let shifts = self.shifts.iter();
        let known = shifts.filter_map(|it| {
            let most = it.shift.as_ref()?.root_mean_square.high;
            Some((it.quantity.as_str(), most))
        });
        known.max_by(|(_, one), (_, other)| one.total_cmp(other))
    }

    /// The order parameter that is shifted most, for which the lower end of the interval counts.
    pub fn largest_shift(&self) -> Option<(&str, &Shift)> {
        let shifts = self.shifts.iter();
        let known = shifts.filter_map(|it| Some((it.quantity.as_str(), it.shift.as_ref()?)));
        known.max_by(|(_, one), (_, other)| {
            let low = |it: &Shift| it.root_mean_square.low;
            low(one).total_cmp(&low(other))
        })
    }
}
