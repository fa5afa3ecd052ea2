//! The normal distribution.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Probability that a standard normal variable is below `z`.
pub(crate) fn below(z: f64) -> f64 {
    0.5 * libm::erfc(-z * FRAC_1_SQRT_2)
}

/// Odds of a value below `z`, kept between 1e-12 and 1e12.
pub(crate) fn odds_below(z: f64) -> f64 {
    below(z).max(1e-12) / below(-z).max(1e-12)
}

/// Density of the standard normal distribution over the probability below `z`: the inverse Mills
/// ratio.
pub(crate) fn density_over_below(z: f64) -> f64 {
    if z < -30.0 {
        // Two terms of the asymptotic series: Abramowitz and Stegun (1964), 26.2.12.
        return -z - 1.0 / z;
    }
    libm::exp(-0.5 * z * z) / (2.0 * PI).sqrt() / below(z)
}

/// Logarithm of the probability below `z`.
pub(crate) fn log_below(z: f64) -> f64 {
    if z < -30.0 {
        return -0.5 * z * z - libm::log(-z * (2.0 * PI).sqrt());
    }
    libm::log(below(z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_those_of_tables() {
        assert!((below(1.959_963_984_540_054) - 0.975).abs() < 1e-14);
        assert!((below(-1.0) - 0.158_655_253_931_457).abs() < 1e-14);
        assert!((density_over_below(0.0) - 0.797_884_560_802_865).abs() < 1e-14);
    }

    #[test]
    fn tails_join_without_a_step() {
        for (inner, outer) in [
            (
                density_over_below(-29.999_999),
                density_over_below(-30.000_001),
            ),
            (log_below(-29.999_999), log_below(-30.000_001)),
        ] {
            assert!((inner / outer - 1.0).abs() < 1e-5, "{inner} {outer}");
        }
    }
}
