//! What speaks for and against a condition.

use super::formula::{Comparison, Reduction, Test};
use super::frames::Frames;
use crate::rule::unit::Unit;
use serde::Serialize;

/// Whether a condition holds for a run, and how clearly.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Evidence {
    /// Whether the condition holds.
    pub holds: bool,
    /// How clearly: positive if it holds, negative if it does not, and 0 on the border. Of parts
    /// that `and` joins it is the least one's margin, of parts that `or` joins the largest one's.
    /// Margins of comparisons count relative to the larger of value and threshold, from -2 to 2.
    /// Not a number if the decision lies with a comparison that is undefined.
    pub margin: f64,
    /// The comparisons outside of reductions, from left to right.
    pub comparisons: Vec<ComparisonEvidence>,
}

/// A comparison and its numbers for a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ComparisonEvidence {
    /// The comparison in normal form.
    pub text: String,
    /// Whether it holds.
    pub holds: bool,
    /// The number on its left.
    pub value: f64,
    /// The number on its right.
    pub threshold: f64,
    /// Distance to the border, negative if the comparison does not hold; not a number if the
    /// comparison is undefined.
    pub margin: f64,
    /// The margin over the larger size of value and threshold, from -2 to 2; 0 if both are 0.
    pub relative_margin: f64,
    /// Unit of value, threshold and margin.
    pub unit: Unit,
}

impl ComparisonEvidence {
    /// Whether both value and threshold are numbers. An undefined comparison does not hold.
    pub fn is_defined(&self) -> bool {
        !self.value.is_nan() && !self.threshold.is_nan()
    }
}

/// The evidence of a condition.
pub(in crate::rule) fn evidence(test: &Test<Reduction>, frames: &Frames<'_>) -> Evidence {
    let mut comparisons = Vec::new();
    let (holds, margin) = decide(test, frames, &mut comparisons);
    Evidence {
        holds,
        margin: if margin.is_infinite() {
            f64::NAN
        } else {
            margin
        },
        comparisons,
    }
}

/// Whether a condition holds, and its margin; infinite if it lies with an undefined comparison.
fn decide(
    test: &Test<Reduction>,
    frames: &Frames<'_>,
    comparisons: &mut Vec<ComparisonEvidence>,
) -> (bool, f64) {
    match test {
        Test::Comparison(comparison) => {
            let found = compare(comparison, frames);
            let margin = match found.is_defined() {
                true => found.relative_margin,
                false => f64::NEG_INFINITY,
            };
            let decision = (found.holds, margin);
            comparisons.push(found);
            decision
        }
        Test::Not(operand) => {
            let (holds, margin) = decide(operand, frames, comparisons);
            (!holds, -margin)
        }
        Test::And(left, right) => {
            let left = decide(left, frames, comparisons);
            let right = decide(right, frames, comparisons);
            (left.0 && right.0, left.1.min(right.1))
        }
        Test::Or(left, right) => {
            let left = decide(left, frames, comparisons);
            let right = decide(right, frames, comparisons);
            (left.0 || right.0, left.1.max(right.1))
        }
    }
}

fn compare(comparison: &Comparison<Reduction>, frames: &Frames<'_>) -> ComparisonEvidence {
    let Comparison {
        order,
        value,
        threshold,
        unit,
        text,
    } = comparison;
    let (value, threshold) = (frames.value(value), frames.value(threshold));
    ComparisonEvidence {
        text: text.clone(),
        holds: order.holds(value, threshold),
        value,
        threshold,
        margin: order.margin(excess(value, threshold)),
        relative_margin: order.margin(relative_excess(value, threshold)),
        unit: *unit,
    }
}

/// How much more the value is than the threshold; two infinities of one sign are equal.
fn excess(value: f64, threshold: f64) -> f64 {
    if value == threshold {
        0.0
    } else {
        value - threshold
    }
}

/// The same over the larger of both sizes. It is 0 for equal numbers only, even where the
/// difference would overflow.
fn relative_excess(value: f64, threshold: f64) -> f64 {
    let size = value.abs().max(threshold.abs());
    if value == threshold {
        0.0
    } else if size.is_finite() {
        value / size - threshold / size
    } else {
        let side = |number: f64| match number.is_infinite() {
            true => number.signum(),
            false => 0.0 * number,
        };
        side(value) - side(threshold)
    }
}
