//! How often labels of a setting and of the reference disagree, beyond what seeds do by themselves.

use super::Sample;
use super::bootstrap::{Interval, Weights, interval};
use crate::classify::Label;
use crate::statistics::CONFIDENCE;
use serde::Serialize;

/// How often labels disagree, over all points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Disagreement {
    /// The chance that a run of the setting and a run of the reference, of different seeds, have
    /// different labels.
    pub chance: Interval,
    /// The chance that two seeds of the reference have different labels: the floor of noise.
    pub floor: Interval,
    /// The first less the second: the share of labels that the setting changes.
    pub excess: Interval,
    /// The same at each point, in the sweep's order.
    #[serde(skip)]
    pub points: Vec<PointDisagreement>,
}

/// How often labels disagree at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointDisagreement {
    /// The chance that a run of the setting and a run of the reference disagree.
    pub chance: f64,
    /// The chance that two seeds of the reference disagree.
    pub floor: f64,
}

/// A width that is rounding.
const NO_WIDTH: f64 = 1e-12;

/// What labels of a point, of the setting and of the reference, give with these weights of seeds.
type OfPoint<'a> = &'a dyn Fn(&[Vec<Label>; 2], &[f64]) -> f64;

impl Disagreement {
    /// Compares the labels of a setting with those of a reference. `purpose` names the stream of
    /// random numbers for the intervals. None with fewer than three seeds everywhere.
    pub fn of(sample: &Sample<'_>, reference: &Sample<'_>, purpose: &str) -> Option<Self> {
        let labels = sample.labels_with(reference);
        let compared: Vec<_> = labels.iter().filter(|[own, _]| own.len() > 2).collect();
        if compared.is_empty() {
            return None;
        }
        let seeds: Vec<usize> = compared.iter().map(|[own, _]| own.len()).collect();
        let mean = |weights: &Weights, of_point: OfPoint<'_>| {
            let points = compared.iter().zip(&weights.points);
            let sum: f64 = points
                .map(|(labels, weights)| of_point(labels, weights))
                .sum();
            sum / compared.len() as f64
        };
        let chance = |[own, other]: &[Vec<Label>; 2], weights: &[f64]| chance(own, other, weights);
        let floor =
            |[_, other]: &[Vec<Label>; 2], weights: &[f64]| self::chance(other, other, weights);
        let estimate = |purpose: &str, of_point: OfPoint<'_>| {
            interval(&seeds, purpose, 1, |weights| mean(weights, of_point))
        };
        let bound = bound_of_never(seeds.iter().sum());
        let excess = estimate(&format!("{purpose}, excess"), &|labels, weights| {
            chance(labels, weights) - floor(labels, weights)
        });
        let excess = widened(excess, bound, -1.0);
        let share = |interval: Interval| widened(interval, bound, 0.0);
        let point = |[own, other]: &[Vec<Label>; 2]| {
            let once = vec![1.0; own.len()];
            PointDisagreement {
                chance: self::chance(own, other, &once),
                floor: self::chance(other, other, &once),
            }
        };
        Some(Self {
            chance: share(estimate(&format!("{purpose}, chance"), &chance)),
            floor: share(estimate(&format!("{purpose}, floor"), &floor)),
            excess,
            points: labels.iter().map(point).collect(),
        })
    }
}

/// The chance that labels of two lists disagree, of different seeds, where each seed weighs so
/// much. NaN with fewer than two seeds.
///
/// Of one seed two settings have the same start, and may agree because of that alone.
fn chance(own: &[Label], other: &[Label], weights: &[f64]) -> f64 {
    let total: f64 = weights.iter().sum();
    let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
    let mut agreeing = 0.0;
    for (at, label) in own.iter().enumerate() {
        // Once for each label that occurs.
        if own[..at].contains(label) {
            continue;
        }
        let weight_of = |labels: &[Label]| -> f64 {
            let own = labels.iter().zip(weights).filter(|(it, _)| *it == label);
            own.map(|(_, weight)| weight).sum()
        };
        agreeing += weight_of(own) * weight_of(other);
    }
    let same_seed = own.iter().zip(other).zip(weights);
    let same_seed: f64 = same_seed
        .filter(|((own, other), _)| own == other)
        .map(|(_, weight)| weight * weight)
        .sum();
    1.0 - (agreeing - same_seed) / (total * total - squares)
}

/// The interval within the range from `least` to 1, with the upper end at `bound` or above. A
/// bootstrap of equal values tells no scatter, however few they are: where all labels of some
/// points changed, and none of others, both ends are `bound` away from the value. What did not
/// change at all does not come to less than nothing by that.
fn widened(interval: Interval, bound: f64, least: f64) -> Interval {
    let Interval {
        value,
        mut low,
        mut high,
    } = interval;
    if high - low <= NO_WIDTH {
        let zero = if value > -NO_WIDTH { 0.0 } else { -1.0 };
        (low, high) = ((value - bound).max(zero), value + bound);
    }
    Interval {
        value,
        low: low.clamp(least, 1.0),
        high: high.max(bound).min(1.0),
    }
}

/// The largest chance of an event that has not been seen in so many trials: 1 - (1 - c)^(1/n) of
/// the confidence c.
fn bound_of_never(trials: usize) -> f64 {
    1.0 - libm::pow(1.0 - CONFIDENCE, 1.0 / trials.max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: Label = Label::STABLE;
    const B: Label = Label::UNSETTLED;

    /// By its definition: all pairs of different seeds.
    fn chance_by_pairs(own: &[Label], other: &[Label], weights: &[f64]) -> f64 {
        let (mut disagreeing, mut all) = (0.0, 0.0);
        for (i, own) in own.iter().enumerate() {
            for (j, other) in other.iter().enumerate().filter(|(j, _)| *j != i) {
                let weight = weights[i] * weights[j];
                all += weight;
                disagreeing += if own == other { 0.0 } else { weight };
            }
        }
        disagreeing / all
    }

    #[test]
    fn the_chance_is_that_of_pairs_of_different_seeds() {
        let lists = [[A, A, B, A], [A, B, B, B], [B, B, B, B], [A, B, A, B]];
        for weights in [[1.0; 4], [2.0, 0.0, 1.0, 1.0], [3.0, 1.0, 0.0, 0.0]] {
            for own in &lists {
                for other in &lists {
                    let expected = chance_by_pairs(own, other, &weights);
                    let found = chance(own, other, &weights);
                    assert!((found - expected).abs() < 1e-12, "{found} {expected}");
                }
            }
        }
    }

    /// Symptom: intervals of no width where a setting changed all labels of some points. Cause:
    /// only what was never seen had a bound.
    #[test]
    fn an_interval_has_a_width_on_both_sides() {
        let of = |value: f64, least: f64| {
            let interval = Interval {
                value,
                low: value,
                high: value,
            };
            let Interval { low, high, .. } = widened(interval, 0.1, least);
            [low, high]
        };
        assert_eq!(of(1.0, 0.0), [0.9, 1.0]);
        assert_eq!(of(0.0, 0.0), [0.0, 0.1]);
        assert_eq!(of(0.5, -1.0), [0.4, 0.6]);
        assert_eq!(of(0.05, -1.0), [0.0, 0.05 + 0.1]);
        assert_eq!(of(1.0, -1.0), [0.9, 1.0]);
        assert_eq!(of(-0.5, -1.0), [-0.6, 0.1]);
        let wide = Interval {
            value: 0.5,
            low: 0.2,
            high: 0.8,
        };
        assert_eq!(widened(wide, 0.1, 0.0), wide);
        assert_eq!(widened(wide, 0.9, 0.0).high, 0.9);
    }

    #[test]
    fn what_was_never_seen_may_still_happen() {
        assert!((bound_of_never(300) - 3.0 / 300.0).abs() < 1e-4);
        assert_eq!(bound_of_never(1), 0.95);
    }
}
