//! Intervals by bootstrap over seeds (B. Efron, Ann. Stat. 7, 1 (1979)).

use crate::statistics::{CONFIDENCE, student_t};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use serde::Serialize;

/// Number of resamples.
const RESAMPLES: usize = 1000;

/// Degrees of freedom of which the t of Student is that of a normal distribution.
const MANY: usize = 10_000;

/// An estimate and the ends of its interval of [`CONFIDENCE`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// The estimate.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Whether zero lies outside.
    pub fn is_clear(&self) -> bool {
        self.low > 0.0 || self.high < 0.0
    }

    /// The same with another measure of what it holds.
    pub(super) fn map(self, change: impl Fn(f64) -> f64) -> Self {
        Self {
            value: change(self.value),
            low: change(self.low),
            high: change(self.high),
        }
    }
}

/// How often each seed is drawn at each point.
pub(super) struct Weights {
    /// One list for each point, with a weight for each seed.
    pub(super) points: Vec<Vec<f64>>,
}

impl Weights {
    /// Each seed once, where there are so many of them at each point.
    pub(super) fn once(seeds: &[usize]) -> Self {
        let points = seeds.iter().map(|&count| vec![1.0; count]);
        Self {
            points: points.collect(),
        }
    }

    /// As many draws with replacement as there are seeds, at every point by itself: runs at
    /// different points start from streams of their own. One seed alone tells no scatter, so a draw
    /// of nothing else is repeated.
    fn draw(seeds: &[usize], random: &mut Pcg64) -> Self {
        let points = seeds.iter().map(|&count| {
            loop {
                let mut weights = vec![0.0; count];
                for _ in 0..count {
                    weights[below(count, random)] += 1.0;
                }
                let drawn = weights.iter().filter(|&&weight| weight > 0.0).count();
                if drawn > 1 || count < 2 {
                    return weights;
                }
            }
        });
        Self {
            points: points.collect(),
        }
    }
}

/// A whole number below `count`, each as likely as the others within one in 2^64.
pub(super) fn below(count: usize, random: &mut Pcg64) -> usize {
    ((u128::from(random.next_u64()) * count as u128) >> 64) as usize
}

/// A stream of random numbers of its own for each purpose.
pub(super) fn stream(purpose: &str) -> Pcg64 {
    Pcg64::from_seed(*blake3::hash(purpose.as_bytes()).as_bytes())
}

/// The interval of an estimate that `estimate` makes of weights, where there are so many seeds at
/// each point. `purpose` names the stream of random numbers.
///
/// The quantiles of the resamples are drawn apart about the estimate: by sqrt(n / (n - 1)), since
/// resamples of n seeds scatter less than n seeds do by that factor, and by Student's t over that
/// of many runs, since few tell their own scatter badly. `together` intervals hold [`CONFIDENCE`]
/// at once (Bonferroni).
pub(super) fn interval(
    seeds: &[usize],
    purpose: &str,
    together: usize,
    estimate: impl Fn(&Weights) -> f64,
) -> Interval {
    let value = estimate(&Weights::once(seeds));
    let mut random = stream(&format!("bootstrap of {purpose}"));
    let draws = (0..RESAMPLES).map(|_| estimate(&Weights::draw(seeds, &mut random)));
    let mut drawn: Vec<f64> = draws.collect();
    drawn.sort_by(f64::total_cmp);
    let total: usize = seeds.iter().sum();
    let mean = total as f64 / seeds.len().max(1) as f64;
    let outside = (1.0 - CONFIDENCE) / together.max(1) as f64;
    let freedom = total.saturating_sub(seeds.len()).max(1);
    let of_few = student_t(1.0 - outside, freedom) / student_t(1.0 - outside, MANY);
    let wider = of_few * (mean / (mean - 1.0).max(0.5)).sqrt();
    let quantile = |share: f64| {
        let place = share * (drawn.len() - 1) as f64;
        value + wider * (drawn[place.round() as usize] - value)
    };
    Interval {
        value,
        low: quantile(0.5 * outside),
        high: quantile(1.0 - 0.5 * outside),
    }
}
