//! Confidence intervals of quantities measured over a correlated time series.

use crate::statistics::Estimate;

/// Largest number of blocks of a series. Ten to thirty are enough for an interval, and the fewer
/// they are, the less neighbouring ones are correlated: Schmeiser, Operations Research 30, 556
/// (1982).
const BLOCKS: usize = 10;

/// Sums over a series, and sums that leave out each of its blocks of consecutive members.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    whole: Vec<f64>,
    without: Vec<Vec<f64>>,
}

impl Blocks {
    /// From rows in the order of time with the same columns: at most ten blocks of equal length,
    /// within one row.
    pub(super) fn of(rows: &[Vec<f64>]) -> Self {
        let count = rows.len().min(BLOCKS);
        let columns = rows.first().map_or(0, Vec::len);
        let block = |block| {
            let [from, to] = [block, block + 1].map(|it| it * rows.len() / count);
            sum(columns, rows[from..to].iter())
        };
        let blocks: Vec<Vec<f64>> = (0..count).map(block).collect();
        let without = |own| {
            let others = (0..count).filter(|it| *it != own);
            sum(columns, others.map(|it| &blocks[it]))
        };
        Self {
            whole: sum(columns, blocks.iter()),
            without: (0..count).map(without).collect(),
        }
    }

    /// The value that `follows` from the sums of the columns, if any.
    ///
    /// The interval is Student's t of Tukey's pseudo-values, which leave out one block after the
    /// other (jackknife over blocks: Künsch, Annals of Statistics 17, 1217 (1989)). For a mean
    /// over blocks of equal length it is the usual interval. It holds if a block is several
    /// correlation times long. It is infinite if no value follows without one of the blocks.
    pub(super) fn estimate(&self, follows: impl Fn(&[f64]) -> Option<f64>) -> Option<Estimate> {
        let [estimate] = self.estimates(|sums| Some([follows(sums)?]))?;
        Some(estimate)
    }

    /// The same for several values at once.
    pub(super) fn estimates<const N: usize>(
        &self,
        follow: impl Fn(&[f64]) -> Option<[f64; N]>,
    ) -> Option<[Estimate; N]> {
        if self.without.is_empty() {
            return None;
        }
        let values = follow(&self.whole)?;
        let without: Option<Vec<[f64; N]>> = self.without.iter().map(|it| follow(it)).collect();
        let count = self.without.len() as f64;
        let estimate = |index: usize| {
            let value = values[index];
            let pseudo_value = |it: &[f64; N]| count * value - (count - 1.0) * it[index];
            let pseudo_values = without
                .as_deref()
                .unwrap_or_default()
                .iter()
                .map(pseudo_value);
            let of_blocks = Estimate::of_mean(&pseudo_values.collect::<Vec<_>>());
            let half_width = of_blocks.map_or(f64::INFINITY, |it| it.half_width);
            Estimate { value, half_width }
        };
        Some(std::array::from_fn(estimate))
    }
}

/// A quotient of sums, unless the divisor is zero.
pub(super) fn quotient(dividend: f64, divisor: f64) -> Option<f64> {
    (divisor != 0.0).then(|| dividend / divisor)
}

fn sum<'a>(columns: usize, rows: impl Iterator<Item = &'a Vec<f64>>) -> Vec<f64> {
    let mut sums = vec![0.0; columns];
    for row in rows {
        for (sum, value) in sums.iter_mut().zip(row) {
            *sum += value;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean(rows: &[Vec<f64>]) -> Option<Estimate> {
        Blocks::of(rows).estimate(|sums| quotient(*sums.first()?, *sums.get(1)?))
    }

    #[test]
    fn of_blocks_of_one_length_it_is_the_interval_of_their_means() {
        let values = [3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0, 5.0, 3.0];
        let rows: Vec<Vec<f64>> = values
            .iter()
            .flat_map(|it| [vec![it - 7.0, 1.0], vec![it + 7.0, 1.0]])
            .collect();
        let (found, expected) = (mean(&rows).unwrap(), Estimate::of_mean(&values).unwrap());
        assert!((found.value - expected.value).abs() < 1e-12);
        assert!((found.half_width - expected.half_width).abs() < 1e-12);
    }

    #[test]
    fn a_single_block_tells_no_scatter_and_none_no_value() {
        let one = mean(&[vec![6.0, 2.0]]).unwrap();
        assert_eq!((one.value, one.half_width), (3.0, f64::INFINITY));
        // Without its first block the second has no divisor.
        let two = mean(&[vec![6.0, 2.0], vec![6.0, 0.0]]).unwrap();
        assert_eq!((two.value, two.half_width), (6.0, f64::INFINITY));
        assert_eq!(mean(&[]), None);
    }
}
