//! How much a series in time with correlated neighbours changes.

use super::student_t;

/// Blocks whose means are fitted. Ten to thirty are enough for an interval, and the fewer they are,
/// the less neighbouring ones are correlated: Schmeiser, Operations Research 30, 556 (1982).
const BLOCKS: usize = 10;

/// Least number of values for a trend: two in each block.
pub(crate) const LEAST_VALUES: usize = 2 * BLOCKS;

/// Largest number of bins for the sum of correlations, whose cost grows with the square.
const MOST_BINS: usize = 500;

/// Least number of independent samples for which the scatter of the block means measures their
/// error. At a third of it, intervals miss the true change twice as often as stated.
const LEAST_SAMPLES: f64 = 24.0;

/// The change of a series from its first to its last value, by a straight line.
///
/// The line is fitted to the means of ten blocks. Their scatter about it measures its error even
/// for correlated values, if blocks are longer than the correlation time (batch means: Schmeiser,
/// 1982). Unlike in the difference of two means (Geweke, Bayesian Statistics 4, 169 (1992)), the
/// scatter does not include the change itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trend {
    /// The change.
    pub change: f64,
    /// The true change is at most this much larger and at most this much smaller, each with the
    /// requested confidence.
    pub error: f64,
    /// Number of independent values that determine the mean as well as the series: its length over
    /// the integrated correlation time, which is the initial monotone sum of Geyer, Statistical
    /// Science 7, 473 (1992), about the line. At most 500, the number of bins.
    pub samples: f64,
    /// Largest value minus the smallest.
    pub range: f64,
}

impl Trend {
    /// The trend of values at equal intervals; `None` if there are fewer than two per block, or if
    /// a value is not a number.
    ///
    /// ```
    /// use phase::statistics::Trend;
    ///
    /// let values: Vec<f64> = (0..1000).map(|it| 5.0 + 0.002 * f64::from(it)).collect();
    /// let trend = Trend::of(&values, 0.95).unwrap();
    /// assert!((trend.change - 1.998).abs() < 1e-9 && trend.error < 1e-9);
    /// assert!(trend.is_within(2.0) && !trend.is_within(1.9));
    /// ```
    pub fn of(values: &[f64], confidence: f64) -> Option<Self> {
        let count = values.len();
        if count < LEAST_VALUES || !values.iter().all(|it| it.is_finite()) {
            return None;
        }
        let blocks = means(values, BLOCKS);
        let line = FittedLine::through(&blocks);
        let squares: f64 = blocks.iter().map(|it| line.miss(it) * line.miss(it)).sum();
        let freedom = BLOCKS - 2;
        let error_of_slope = (squares / freedom as f64 / line.spread).sqrt();
        let quantile = student_t(2.0 * confidence - 1.0, freedom);
        let length = (count - 1) as f64;
        let [low, high] = ends(values);
        Some(Self {
            change: line.slope * length,
            error: quantile * error_of_slope * length,
            samples: {
                let bins = means(values, count.min(MOST_BINS));
                let misses: Vec<f64> = bins.iter().map(|it| line.miss(it)).collect();
                bins.len() as f64 / correlation(&misses)
            },
            range: high - low,
        })
    }

    /// Whether the change is surely no larger than `least`, upward or downward: a series that
    /// changes by more passes at most as often as the confidence leaves.
    ///
    /// Too few independent samples never pass, unless all values are within `least` of each other.
    pub fn is_within(&self, least: f64) -> bool {
        let is_known = self.samples >= LEAST_SAMPLES;
        self.range <= least || (is_known && self.change.abs() + self.error <= least)
    }
}

/// A mean of values and the mean of their places.
#[derive(Clone, Copy)]
struct Mean {
    place: f64,
    value: f64,
}

/// Means over `count` blocks of equal length, within one value.
fn means(values: &[f64], count: usize) -> Vec<Mean> {
    let mean = |block| {
        let [from, to] = [block, block + 1].map(|it| it * values.len() / count);
        let sum: f64 = values[from..to].iter().sum();
        Mean {
            place: 0.5 * (from + to - 1) as f64,
            value: sum / (to - from) as f64,
        }
    };
    (0..count).map(mean).collect()
}

/// A straight line by least squares.
struct FittedLine {
    middle: Mean,
    slope: f64,
    /// Sum of the squares of the places, from the middle.
    spread: f64,
}

impl FittedLine {
    fn through(points: &[Mean]) -> Self {
        let count = points.len() as f64;
        let middle = Mean {
            place: points.iter().map(|it| it.place).sum::<f64>() / count,
            value: points.iter().map(|it| it.value).sum::<f64>() / count,
        };
        let (mut product, mut spread) = (0.0, 0.0);
        for point in points {
            let place = point.place - middle.place;
            product += place * (point.value - middle.value);
            spread += place * place;
        }
        Self {
            middle,
            slope: product / spread,
            spread,
        }
    }

    /// How far a point lies above the line.
    fn miss(&self, point: &Mean) -> f64 {
        point.value - self.middle.value - self.slope * (point.place - self.middle.place)
    }
}

/// Integrated correlation time of values about zero, in their interval, at least 1: the sum over
/// pairs of neighbouring lags as long as they are positive, made non-increasing (Geyer, 1992).
fn correlation(values: &[f64]) -> f64 {
    let covariance = |lag: usize| {
        let pairs = values.iter().zip(&values[lag.min(values.len())..]);
        pairs.map(|(one, other)| one * other).sum::<f64>()
    };
    let variance = covariance(0);
    if variance == 0.0 {
        return 1.0;
    }
    let (mut sum, mut least) = (0.0, f64::INFINITY);
    for lag in (0..values.len()).step_by(2) {
        let pair = covariance(lag) + covariance(lag + 1);
        if pair <= 0.0 {
            break;
        }
        least = pair.min(least);
        sum += least;
    }
    (2.0 * sum / variance - 1.0).max(1.0)
}

/// The smallest and the largest value.
fn ends(values: &[f64]) -> [f64; 2] {
    let ends = [f64::INFINITY, f64::NEG_INFINITY];
    let wider = |[low, high]: [f64; 2], value: &f64| [low.min(*value), high.max(*value)];
    values.iter().fold(ends, wider)
}

#[cfg(test)]
mod tests;
