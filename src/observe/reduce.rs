//! Sums and extremes over the spheres, in a fixed order that still fills vector registers.
//!
//! Sphere i goes to partial result i modulo `LANES`; the partial results are combined at the end.
//! The order is part of the result: another order would round differently.

use crate::simulation::FRAME_BLOCK as LANES;

/// A sum over spheres that come block by block.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sum([f64; LANES]);

impl Sum {
    /// Adds the terms that follow from the entries of each sphere in the columns of a block.
    #[expect(
        clippy::needless_range_loop,
        reason = "the index runs through all columns at once"
    )]
    pub(super) fn add<const N: usize>(
        &mut self,
        columns: [&[f64]; N],
        term: impl Fn([f64; N]) -> f64,
    ) {
        let count = columns[0].len();
        let split = columns.map(|column| column[..count].as_chunks());
        let (chunks, rest): ([&[[f64; LANES]]; N], [&[f64]; N]) =
            (split.map(|it| it.0), split.map(|it| it.1));
        let mut lanes = self.0;
        for chunk in 0..count / LANES {
            for (lane, sum) in lanes.iter_mut().enumerate() {
                *sum += term(std::array::from_fn(|column| chunks[column][chunk][lane]));
            }
        }
        for (lane, sum) in lanes.iter_mut().enumerate().take(count % LANES) {
            *sum += term(rest.map(|column| column[lane]));
        }
        self.0 = lanes;
    }

    /// The total.
    pub(super) fn total(self) -> f64 {
        let [a, b, c, d] = self.0;
        (a + b) + (c + d)
    }
}

/// The least value; not a number if there is none.
pub(super) fn least(values: &[f64]) -> f64 {
    extreme(values, f64::INFINITY, |a, b| if b < a { b } else { a })
}

/// The largest value; not a number if there is none.
pub(super) fn largest(values: &[f64]) -> f64 {
    extreme(values, f64::NEG_INFINITY, |a, b| if b > a { b } else { a })
}

fn extreme(values: &[f64], none: f64, better: impl Fn(f64, f64) -> f64) -> f64 {
    if values.is_empty() {
        return f64::NAN;
    }
    let (chunks, rest) = values.as_chunks::<LANES>();
    let mut lanes = [none; LANES];
    for chunk in chunks {
        for (best, &value) in lanes.iter_mut().zip(chunk) {
            *best = better(*best, value);
        }
    }
    lanes
        .iter()
        .chain(rest)
        .fold(none, |best, &value| better(best, value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_count_is_summed_whole() {
        for count in 0..12 {
            let a: Vec<f64> = (0..count).map(f64::from).collect();
            let b: Vec<f64> = (0..count).map(|i| f64::from(2 * i + 1)).collect();
            let expected: f64 = (0..count).map(|i| f64::from(i * (2 * i + 1))).sum();
            for first in (0..=count as usize).step_by(LANES) {
                let mut sum = Sum::default();
                for block in [0..first, first..count as usize] {
                    sum.add([&a[block.clone()], &b[block]], |[a, b]| a * b);
                }
                assert_eq!(sum.total(), expected);
            }
        }
    }

    #[test]
    fn extremes_are_found_at_every_place() {
        for count in 1..12 {
            for place in 0..count {
                let mut values = vec![0.5; count];
                values[place] = -1.0;
                assert_eq!((least(&values), largest(&[]).is_nan()), (-1.0, true));
                values[place] = 2.0;
                assert_eq!(largest(&values), 2.0);
            }
        }
        assert!(least(&[]).is_nan());
    }
}
