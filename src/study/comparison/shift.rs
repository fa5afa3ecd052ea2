//! How far an order parameter of a setting is from that of the reference, in units of its spread
//! over seeds.

use super::Sample;
use super::bootstrap::{Interval, Weights, interval};
use serde::Serialize;

/// How far an order parameter is shifted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Shift {
    /// Its spread over seeds: root mean square over points of the standard deviations over seeds of
    /// setting and reference, in the unit of the quantity.
    pub spread: f64,
    /// Mean over points of the difference of the means over seeds, in units of the spread.
    pub mean: Interval,
    /// Root mean square over points of that difference, less what seeds alone make of it, in units
    /// of the spread. A negative square counts as the negative root of its size.
    pub root_mean_square: Interval,
}

impl Shift {
    /// Compares a quantity, by its place, with that of a reference. `purpose` names the stream of
    /// random numbers for the intervals, `together` of which hold at once. None with fewer than
    /// three seeds everywhere, where neither has a spread, or where fewer than half of the runs
    /// have the quantity.
    pub fn of(
        sample: &Sample<'_>,
        reference: &Sample<'_>,
        quantity: usize,
        purpose: &str,
        together: usize,
    ) -> Option<Self> {
        let values = sample.values_with(reference, quantity);
        let pairs: usize = values.iter().map(|[own, _]| own.len()).sum();
        let all: usize = sample.points.iter().map(Vec::len).sum();
        if 2 * pairs < all {
            return None;
        }
        let compared: Vec<&[Vec<f64>; 2]> =
            values.iter().filter(|[own, _]| own.len() > 2).collect();
        let count = compared.len() as f64;
        // Of both: one run of the setting that goes astray would else count as many spreads of a
        // reference whose seeds hardly differ.
        let variances = compared
            .iter()
            .map(|[own, reference]| 0.5 * (variance(own) + variance(reference)));
        let spread = (variances.sum::<f64>() / count).sqrt();
        if !(spread > 0.0 && spread.is_finite()) {
            return None;
        }
        let differences = compared.iter().map(|[own, other]| {
            let pairs = own.iter().zip(other);
            pairs.map(|(own, other)| (own - other) / spread).collect()
        });
        let differences: Vec<Vec<f64>> = differences.collect();
        let seeds: Vec<usize> = differences.iter().map(Vec::len).collect();
        let over_points = |weights: &Weights, of_point: fn(&[f64], &[f64]) -> f64| {
            let points = differences.iter().zip(&weights.points);
            points
                .map(|(values, weights)| of_point(values, weights))
                .sum::<f64>()
                / count
        };
        let mean = interval(&seeds, &format!("{purpose}, mean"), together, |weights| {
            over_points(weights, mean)
        });
        let square = interval(&seeds, &format!("{purpose}, square"), together, |weights| {
            over_points(weights, square_of_mean)
        });
        Some(Self {
            spread,
            mean,
            root_mean_square: square.map(|square| square.abs().sqrt().copysign(square)),
        })
    }
}

/// Variance over seeds, without bias.
fn variance(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values
        .iter()
        .map(|value| (value - mean) * (value - mean))
        .sum();
    squares / (count - 1.0)
}

/// Weighted mean.
fn mean(values: &[f64], weights: &[f64]) -> f64 {
    let sum: f64 = values
        .iter()
        .zip(weights)
        .map(|(value, weight)| weight * value)
        .sum();
    sum / weights.iter().sum::<f64>()
}

/// The square of the mean, without bias: the weighted mean of products of different seeds.
fn square_of_mean(values: &[f64], weights: &[f64]) -> f64 {
    let weighted = || {
        values
            .iter()
            .zip(weights)
            .map(|(value, weight)| weight * value)
    };
    let sum: f64 = weighted().sum();
    let own: f64 = weighted().map(|it| it * it).sum();
    let total: f64 = weights.iter().sum();
    let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
    (sum * sum - own) / (total * total - squares)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_square_of_a_mean_is_that_of_different_seeds() {
        // 1*2 + 1*4 + 2*4 over three pairs.
        let square = square_of_mean(&[1.0, 2.0, 4.0], &[1.0; 3]);
        assert!((square - 14.0 / 3.0).abs() < 1e-12);
        // The third twice: pairs with it count twice, and it does not pair with itself.
        let square = square_of_mean(&[1.0, 2.0, 4.0], &[1.0, 1.0, 2.0]);
        assert!((square - (2.0 + 8.0 + 16.0) / 5.0).abs() < 1e-12);
        assert_eq!(variance(&[1.0, 3.0]), 2.0);
        assert_eq!(mean(&[1.0, 4.0], &[2.0, 1.0]), 2.0);
    }
}
