//! Models of the probability of each label at each place.

mod ep;
mod kernel;
mod nearest;
mod propagation;
mod regression;
mod votes;

pub use nearest::Nearest;
pub use propagation::Propagation;
pub use regression::Regression;
pub use votes::Votes;

use super::observations::Training;

/// A way to learn the probability of labels from runs.
pub trait Model {
    /// Learns from runs. The same runs give the same bits on every machine.
    fn fit(&self, runs: &Training) -> Box<dyn Fitted>;
}

/// What a model has learnt.
pub trait Fitted {
    /// What runs at these places of the unit cube would show.
    fn predict(&self, units: &[&[f64]]) -> Vec<Prediction>;
}

/// What a run at one place would show.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// Probability of each label, in the order of [`Training::codes`]; their sum is 1.
    pub probabilities: Vec<f64>,
    /// What the label of one more run here would tell of the model's latent functions, in bits,
    /// summed over labels. Noise of the label tells nothing. It is 0 for models without a
    /// posterior.
    pub information: f64,
}

/// Divides by the sum.
fn normalised(mut weights: Vec<f64>) -> Vec<f64> {
    let sum: f64 = weights.iter().sum();
    for weight in &mut weights {
        *weight /= sum;
    }
    weights
}
