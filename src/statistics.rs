//! Means of replicates and their intervals, and trends of series in time.

mod trend;

pub(crate) use trend::LEAST_VALUES;
pub use trend::Trend;

use std::f64::consts::{FRAC_PI_2, PI};

/// Confidence of all intervals.
pub const CONFIDENCE: f64 = 0.95;

/// A value and half the width of its interval of [`CONFIDENCE`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Half the width of its interval; infinite if the scatter is unknown.
    pub half_width: f64,
}

impl Estimate {
    /// Mean of independent values with the interval of Student's t; `None` without values.
    ///
    /// ```
    /// use phase::statistics::Estimate;
    ///
    /// let mean = Estimate::of_mean(&[1.0, 2.0, 3.0]).unwrap();
    /// assert_eq!(mean.value, 2.0);
    /// assert!((mean.half_width - 4.302_653 / 3.0_f64.sqrt()).abs() < 1e-6);
    /// ```
    pub fn of_mean(values: &[f64]) -> Option<Self> {
        let count = values.len() as f64;
        let value = (!values.is_empty()).then(|| values.iter().sum::<f64>() / count)?;
        let squares: f64 = values.iter().map(|it| (it - value) * (it - value)).sum();
        let half_width = match values.len() - 1 {
            0 => f64::INFINITY,
            freedom => {
                let variance = squares / freedom as f64;
                student_t(CONFIDENCE, freedom) * (variance / count).sqrt()
            }
        };
        Some(Self { value, half_width })
    }
}

/// Ends of the interval of [`CONFIDENCE`] for a share found in this number of independent trials:
/// Wilson's score interval (E. B. Wilson, J. Am. Stat. Assoc. 22, 209 (1927)). It stays between 0
/// and 1.
///
/// ```
/// let [low, high] = phase::statistics::share_interval(1.0, 12);
/// assert!((low - 0.757_5).abs() < 1e-4 && high == 1.0);
/// ```
pub fn share_interval(share: f64, trials: usize) -> [f64; 2] {
    // The normal quantile of the confidence, as the limit of Student's t.
    const Z: f64 = 1.959_963_984_540_054;
    let count = trials as f64;
    let square = Z * Z / count;
    let centre = (share + 0.5 * square) / (1.0 + square);
    let scatter = share * (1.0 - share) / count + 0.25 * square / count;
    let half = Z * scatter.sqrt() / (1.0 + square);
    [(centre - half).max(0.0), (centre + half).min(1.0)]
}

/// Ends of the interval of [`CONFIDENCE`] for the mean of independent shares; `None` without
/// shares. Student's t, cut off at 0 and 1; if all shares are 0 or all are 1, so that their scatter
/// says nothing, Wilson's interval ([`share_interval`]).
///
/// ```
/// use phase::statistics::mean_share_interval;
///
/// let [low, high] = mean_share_interval(&[0.4, 0.5, 0.6]).unwrap();
/// assert!((low - 0.251_6).abs() < 1e-4 && (high - 0.748_4).abs() < 1e-4);
/// assert_eq!(mean_share_interval(&[0.5]), Some([0.0, 1.0]));
/// let [low, high] = mean_share_interval(&[1.0, 1.0, 1.0]).unwrap();
/// assert!((low - 0.438_5).abs() < 1e-4 && high == 1.0);
/// ```
pub fn mean_share_interval(shares: &[f64]) -> Option<[f64; 2]> {
    let Estimate { value, half_width } = Estimate::of_mean(shares)?;
    let are_yes_or_no = shares.iter().all(|share| [0.0, 1.0].contains(share));
    Some(match are_yes_or_no {
        true => share_interval(value, shares.len()),
        false => [value - half_width, value + half_width].map(|end| end.clamp(0.0, 1.0)),
    })
}

/// The t of Student's distribution with `freedom` (1 or more) degrees of freedom for which |T| <= t
/// with this probability, by bisection.
///
/// ```
/// assert!((phase::statistics::student_t(0.95, 10) - 2.228_139).abs() < 1e-6);
/// ```
pub fn student_t(probability: f64, freedom: usize) -> f64 {
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    loop {
        let angle = 0.5 * (low + high);
        if angle <= low || angle >= high {
            return (freedom as f64).sqrt() * libm::tan(angle);
        }
        if within(angle, freedom) < probability {
            low = angle;
        } else {
            high = angle;
        }
    }
}

/// P(|T| <= sqrt(freedom) tan(angle)), a finite sum: Abramowitz and Stegun, Handbook of
/// Mathematical Functions (1964), 26.7.3 and 26.7.4.
fn within(angle: f64, freedom: usize) -> f64 {
    let (sine, cosine) = libm::sincos(angle);
    let odd = freedom % 2 == 1;
    let mut term = if odd { cosine } else { 1.0 };
    let mut sum = 0.0;
    // Powers of the cosine up to freedom - 2, each term made from the one before.
    for power in (usize::from(odd)..freedom.saturating_sub(1)).step_by(2) {
        sum += term;
        term *= cosine * cosine * (power + 1) as f64 / (power + 2) as f64;
    }
    if odd {
        2.0 / PI * (angle + sine * sum)
    } else {
        sine * sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables() {
        for (freedom, expected) in [
            (1, 12.706_205),
            (2, 4.302_653),
            (3, 3.182_446),
            (4, 2.776_445),
            (5, 2.570_582),
            (9, 2.262_157),
            (19, 2.093_024),
            (20, 2.085_963),
            (100, 1.983_972),
            (1000, 1.962_339),
        ] {
            let found = student_t(0.95, freedom);
            assert!((found - expected).abs() < 2e-6, "{freedom}: {found}");
        }
        assert!((student_t(0.99, 4) - 4.604_095).abs() < 2e-6);
        assert!((student_t(0.5, 1) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_single_value_has_no_scatter_and_no_value_no_mean() {
        let one = Estimate::of_mean(&[4.0]).unwrap();
        assert_eq!((one.value, one.half_width), (4.0, f64::INFINITY));
        assert_eq!(Estimate::of_mean(&[]), None);
        let equal = Estimate::of_mean(&[4.0, 4.0]).unwrap();
        assert_eq!(equal.half_width, 0.0);
    }
}
