//! Values between those of an axis.

use crate::grid::spacing;
use crate::refine::{AxisScale, LatticeAxis, RefineError};

/// Ascending values with every step between them cut into `parts` equal ones in their scale.
pub(super) fn finer(values: &[f64], parts: usize) -> Result<Vec<f64>, RefineError> {
    let scale = AxisScale::of(values);
    let axis = LatticeAxis::new("", values.to_vec(), scale)?.finer(parts);
    let largest = values
        .iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    let clean = |(place, value): (usize, &f64)| match (place % parts, scale) {
        // Those of the file stay as they are.
        (0, _) => *value,
        (_, AxisScale::Log) => spacing::clean(*value, *value, 12),
        (_, AxisScale::Linear | AxisScale::Rank) => spacing::clean(*value, largest, 15),
    };
    Ok(axis.values().iter().enumerate().map(clean).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spacings_are_seen() {
        assert_eq!(
            AxisScale::of(&spacing::steps(0.002, 0.0001, 40)),
            AxisScale::Linear
        );
        assert_eq!(
            AxisScale::of(&spacing::logarithmic(1e-3, 7.0, 23)),
            AxisScale::Log
        );
        assert_eq!(AxisScale::of(&[0.0, 4.0, 8.0, 16.0, 40.0]), AxisScale::Rank);
        assert_eq!(AxisScale::of(&[1.0, 2.0, 4.0, 9.0]), AxisScale::Rank);
        assert_eq!(AxisScale::of(&[3.0]), AxisScale::Linear);
        assert_eq!(AxisScale::of(&[3.0, 9.0]), AxisScale::Linear);
    }

    #[test]
    fn values_between_are_clean_and_those_of_the_file_stay() {
        let values = spacing::steps(0.002, 0.0001, 4);
        let found = finer(&values, 2).unwrap();
        assert_eq!(
            found,
            [
                0.002, 0.00205, 0.0021, 0.00215, 0.0022, 0.00225, 0.0023, 0.00235, 0.0024
            ]
        );
        assert_eq!(AxisScale::of(&found), AxisScale::Linear);
        let found = finer(&[1e-3, 0.1, 10.0], 4).unwrap();
        assert_eq!(found.len(), 9);
        assert_eq!((found[2], found[4], found[6]), (1e-2, 0.1, 1.0));
        assert_eq!(
            finer(&[0.0, 1.0, 8.0], 2).unwrap(),
            [0.0, 0.5, 1.0, 4.5, 8.0]
        );
        assert_eq!(finer(&[2.0], 3).unwrap(), [2.0]);
    }
}
