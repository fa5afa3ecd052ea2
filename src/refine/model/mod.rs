//! Models of the probability of each label at each place.

mod ep;
mod kernel;
mod margins;
mod propagation;
mod regression;

pub use margins::Margins;
pub use propagation::Propagation;
pub use regression::Regression;

use super::Code;
use super::observations::Training;

/// A way to learn the probability of labels from runs.
pub trait LabelModel {
    /// Learns from runs. The same runs give the same bits on every machine.
    fn fit(&self, runs: &Training) -> Box<dyn Fitted>;

    /// The codes of the labels whose probabilities it predicts, ascending.
    fn codes(&self, runs: &Training) -> Vec<Code> {
        runs.codes().to_vec()
    }
}

/// What a model has learnt.
pub trait Fitted {
    /// Probability of each label at these places of the unit cube, in the order of
    /// [`LabelModel::codes`]; their sum is 1.
    fn predict(&self, units: &[&[f64]]) -> Vec<Vec<f64>>;
}

/// Divides by the sum.
fn normalised(mut weights: Vec<f64>) -> Vec<f64> {
    let sum: f64 = weights.iter().sum();
    for weight in &mut weights {
        *weight /= sum;
    }
    weights
}
