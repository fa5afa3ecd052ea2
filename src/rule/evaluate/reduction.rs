//! Reductions over the frames of a window.

use super::formula::Reduction;
use super::frames::Frames;
use super::{repeats, summary};

impl Reduction {
    /// Its value; not a number without frames, or if the value of a frame is not a number. Infinite
    /// values have an order but no mean.
    pub(in crate::rule) fn value(&self, frames: &Frames<'_>) -> f64 {
        let value = match self {
            Self::Of(summary, formula) => frames
                .series(formula)
                .filter(|series| summary.is_of_order() || are_finite(series))
                .and_then(|series| summary::value(*summary, &series, frames.times())),
            Self::Share(test) => frames.share(test),
            Self::Repeats(formula, period) => {
                let series = frames.series(formula).filter(|series| are_finite(series));
                series.and_then(|series| {
                    repeats::value(&series, frames.times(), frames.constant(period))
                })
            }
        };
        value.unwrap_or(f64::NAN)
    }
}

fn are_finite(series: &[f64]) -> bool {
    series.iter().all(|value| value.is_finite())
}
