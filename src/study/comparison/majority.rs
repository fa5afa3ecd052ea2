//! What more seeds at a point buy: how often the majority of a few is that of the others.

use super::Sample;
use super::bootstrap::{below, stream};
use crate::classify::Label;
use serde::Serialize;

/// Splits of the seeds at each point.
const SPLITS: usize = 200;

/// How often the majority of some seeds is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Majority {
    /// Number of seeds that vote.
    pub seeds: usize,
    /// The chance that their majority differs from that of the other seeds, over all points.
    pub chance: f64,
}

/// How often the majority of so many seeds differs from that of at least as many others, for each
/// number that leaves as many.
pub fn majorities(sample: &Sample<'_>) -> Vec<Majority> {
    let labels = sample.labels_with(sample);
    let most = labels
        .iter()
        .map(|[labels, _]| labels.len() / 2)
        .min()
        .unwrap_or(0);
    let mut random = stream("splits of seeds");
    let mut of_count = |seeds: usize| {
        let mut wrong = 0;
        for [labels, _] in &labels {
            let mut labels = labels.clone();
            for _ in 0..SPLITS {
                shuffle(&mut labels, &mut random);
                let (voting, others) = labels.split_at(seeds);
                wrong += usize::from(majority(voting) != majority(others));
            }
        }
        Majority {
            seeds,
            chance: wrong as f64 / (SPLITS * labels.len()).max(1) as f64,
        }
    };
    (1..=most)
        .filter(|count| count % 2 == 1)
        .map(&mut of_count)
        .collect()
}

fn shuffle(labels: &mut [Label], random: &mut rand_pcg::Pcg64) {
    for end in (1..labels.len()).rev() {
        labels.swap(end, below(end + 1, random));
    }
}

/// The most frequent label; of equally frequent ones that with the lower code.
fn majority(labels: &[Label]) -> Option<Label> {
    let count = |label: Label| labels.iter().filter(|it| **it == label).count();
    let mut sorted = labels.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    sorted.into_iter().rev().max_by_key(|label| count(*label))
}
