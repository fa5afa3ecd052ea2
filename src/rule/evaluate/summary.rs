//! One number of a series of values.

use crate::rule::syntax::Summary;

impl Summary {
    /// Whether it is one of the values, for which their order is enough.
    pub(super) fn is_of_order(self) -> bool {
        matches!(self, Self::Min | Self::Max | Self::First | Self::Last)
    }
}

/// The summary of a series with its times; none if it has too few values.
pub(super) fn value(summary: Summary, series: &[f64], times: &[f64]) -> Option<f64> {
    match summary {
        Summary::Mean => mean(series),
        Summary::Min => series
            .iter()
            .copied()
            .reduce(|a, b| if b < a { b } else { a }),
        Summary::Max => series
            .iter()
            .copied()
            .reduce(|a, b| if b > a { b } else { a }),
        Summary::Deviation => variance(series).map(f64::sqrt),
        Summary::First => series.first().copied(),
        Summary::Last => series.last().copied(),
        Summary::Trend => trend(series, times),
    }
}

fn mean(series: &[f64]) -> Option<f64> {
    let sum: f64 = series.iter().sum();
    (!series.is_empty()).then(|| sum / series.len() as f64)
}

/// The variance of the distribution that the series is a sample of; none for less than two values.
pub(super) fn variance(series: &[f64]) -> Option<f64> {
    let mean = mean(series)?;
    let squares: f64 = series.iter().map(|it| (it - mean) * (it - mean)).sum();
    (series.len() > 1).then(|| squares / (series.len() - 1) as f64)
}

/// Slope of the straight line with the least squares of distances; none if all times are one.
fn trend(series: &[f64], times: &[f64]) -> Option<f64> {
    let (value, time) = (mean(series)?, mean(times)?);
    let (mut rise, mut width) = (0.0, 0.0);
    for (x, t) in series.iter().zip(times) {
        rise += (t - time) * (x - value);
        width += (t - time) * (t - time);
    }
    (width > 0.0).then(|| rise / width)
}
