//! Votes of all runs, weighted by distance.

use super::{Fitted, Model, Prediction, normalised};
use crate::refine::lattice::square_distance;
use crate::refine::observations::Training;

/// Inverse distance weighting (Shepard, Proc. 23rd ACM National Conference, 517 (1968)): the
/// probability of a label is the share of its runs, each weighing 1 / (d² + s²)². The distance s,
/// a quarter of the mean spacing of the runs, keeps a run from deciding alone at its place.
#[derive(Clone, Copy, Debug, Default)]
pub struct Votes;

struct Ballot {
    runs: Training,
    softening: f64,
}

impl Model for Votes {
    fn fit(&self, runs: &Training) -> Box<dyn Fitted> {
        let spacing = libm::pow(runs.runs() as f64, -1.0 / runs.axes() as f64);
        Box::new(Ballot {
            runs: runs.clone(),
            softening: 0.0625 * spacing * spacing,
        })
    }
}

impl Fitted for Ballot {
    fn predict(&self, units: &[&[f64]]) -> Vec<Prediction> {
        units.iter().map(|unit| self.at(unit)).collect()
    }
}

impl Ballot {
    fn at(&self, unit: &[f64]) -> Prediction {
        let mut votes = vec![0.0; self.runs.codes().len()];
        for run in 0..self.runs.runs() {
            let square = square_distance(unit, self.runs.unit(run)) + self.softening;
            votes[self.runs.label(run)] += 1.0 / (square * square);
        }
        Prediction {
            probabilities: normalised(votes),
            information: 0.0,
        }
    }
}
