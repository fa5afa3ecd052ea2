//! How far apart the values of an axis stand.

use crate::refine::{self, LatticeAxis};

/// How far apart the values of an axis stand.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) enum AxisSpacing {
    /// By their differences.
    #[default]
    Linear,
    /// By their ratios; all are above zero.
    Logarithmic,
    /// The values of this axis at equal distances, all others between them by differences.
    Equal(LatticeAxis),
}

impl AxisSpacing {
    /// Equal distances between ascending values; linear for a single one.
    pub(super) fn equal(values: Vec<f64>) -> Self {
        if values.len() < 2 {
            return Self::Linear;
        }
        LatticeAxis::new("", values, refine::AxisScale::Rank).map_or(Self::Linear, Self::Equal)
    }

    /// Whether values stand by their ratios.
    pub(super) fn is_logarithmic(&self) -> bool {
        *self == Self::Logarithmic
    }

    /// The place of a value, on a line of any unit.
    pub(super) fn place(&self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Logarithmic => libm::log(value),
            Self::Equal(axis) => axis.unit(value),
        }
    }

    /// The value at a place.
    pub(super) fn value(&self, place: f64) -> f64 {
        match self {
            Self::Linear => place,
            Self::Logarithmic => libm::exp(place),
            Self::Equal(axis) => axis.value(place),
        }
    }

    /// Where a value stands between two others, 0 to 1.
    pub(super) fn fraction(&self, value: f64, low: f64, high: f64) -> f64 {
        match self {
            Self::Logarithmic => libm::log(value / low) / libm::log(high / low),
            _ => {
                let [value, low, high] = [value, low, high].map(|it| self.place(it));
                (value - low) / (high - low)
            }
        }
    }

    /// The value at a fraction of the way between two others.
    pub(super) fn along(&self, fraction: f64, low: f64, high: f64) -> f64 {
        match self {
            Self::Logarithmic => low * libm::pow(high / low, fraction),
            _ => {
                let [low, high] = [low, high].map(|it| self.place(it));
                self.value(low + (high - low) * fraction)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_values_are_each_others_inverse() {
        let values = vec![0.0, 0.01, 0.1, 100.0];
        for spacing in [AxisSpacing::Linear, AxisSpacing::equal(values.clone())] {
            for value in [-0.005, 0.0, 0.004, 0.1, 60.0, 140.0] {
                let found = spacing.value(spacing.place(value));
                assert!((found - value).abs() < 1e-9, "{spacing:?}: {value} {found}");
                let share = spacing.fraction(value, -0.005, 140.0);
                let found = spacing.along(share, -0.005, 140.0);
                assert!((found - value).abs() < 1e-9, "{spacing:?}: {value} {found}");
            }
        }
        let equal = AxisSpacing::equal(values);
        let share = |value: f64| equal.fraction(value, 0.0, 100.0);
        assert!((share(0.01) - 1.0 / 3.0).abs() < 1e-12);
        assert!((share(0.1) - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!(AxisSpacing::equal(vec![3.0]), AxisSpacing::Linear);
    }
}
