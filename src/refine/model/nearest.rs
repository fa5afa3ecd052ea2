//! The label of the nearest run.

use super::{Fitted, Model, Prediction, normalised};
use crate::refine::lattice::square_distance;
use crate::refine::observations::Training;

/// The nearest run of each label at distance d weighs 1 / d⁴ (of equal weight if several labels
/// occur at the place itself).
#[derive(Clone, Copy, Debug, Default)]
pub struct Nearest;

struct Neighbours(Training);

impl Model for Nearest {
    fn fit(&self, runs: &Training) -> Box<dyn Fitted> {
        Box::new(Neighbours(runs.clone()))
    }
}

impl Fitted for Neighbours {
    fn predict(&self, units: &[&[f64]]) -> Vec<Prediction> {
        units.iter().map(|unit| self.at(unit)).collect()
    }
}

impl Neighbours {
    fn at(&self, unit: &[f64]) -> Prediction {
        let mut squares = vec![f64::INFINITY; self.0.codes().len()];
        for run in 0..self.0.runs() {
            let square = &mut squares[self.0.label(run)];
            *square = square.min(square_distance(unit, self.0.unit(run)));
        }
        let weights = squares.iter().map(|square| {
            let square = square.max(1e-12);
            1.0 / (square * square)
        });
        Prediction {
            probabilities: normalised(weights.collect()),
            information: 0.0,
        }
    }
}
