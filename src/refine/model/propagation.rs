//! Gaussian process classification by expectation propagation.

use super::ep::{Posterior, Sites};
use super::kernel::{Kernel, KernelSetting, ascend};
use super::{Fitted, LabelModel, normalised};
use crate::refine::cholesky::{LANES, Lanes, Matrix};
use crate::refine::normal;
use crate::refine::observations::Training;

/// Each label has a latent Gaussian process f with a Matérn covariance; a run shows the label with
/// probability Φ(f), independently of other labels, but exactly one label is shown. So the
/// probability of a label is proportional to its odds Φ(f) / (1 - Φ(f)).
///
/// - Posteriors follow from expectation propagation: Rasmussen and Williams, Gaussian Processes for
///   Machine Learning (2006), section 3.6.
/// - All labels share the amplitude and the lengths of the covariance, chosen on a small grid for
///   the largest sum of the approximate log marginal likelihoods (section 5.5.2).
/// - The latent mean over spread is divided by a temperature, found by leave-one-out
///   cross-validation (section 5.4.2): the largest one within a standard deviation of the best.
///   Above 1 it makes the bands wider, below 1 narrower.
#[derive(Clone, Copy, Debug, Default)]
pub struct Propagation;

/// Change at which sweeps end: while kernels are compared, and for the chosen kernel.
const TOLERANCES: [f64; 2] = [0.1, 1e-3];

/// Temperatures that are tried, ascending.
const TEMPERATURES: [f64; 12] = [
    0.7, 0.78, 0.88, 1.0, 1.12, 1.26, 1.4, 1.6, 1.8, 2.0, 2.25, 2.5,
];

/// By how much the logarithm of the likelihood may fall from its maximum within one standard
/// deviation.
const ONE_DEVIATION: f64 = 0.5;

struct Classifier {
    runs: Training,
    kernel: Kernel,
    labels: Vec<Posterior>,
    temperature: f64,
}

impl LabelModel for Propagation {
    fn fit(&self, runs: &Training) -> Box<dyn Fitted> {
        let labels = 0..runs.codes().len();
        let signs: Vec<Vec<f64>> = labels
            .map(|label| {
                let sign = |run| if runs.label(run) == label { 1.0 } else { -1.0 };
                (0..runs.runs()).map(sign).collect()
            })
            .collect();
        let mut sites: Vec<Sites> = signs.iter().map(|it| Sites::vague(it.len())).collect();
        let mut posteriors = |covariance: &Matrix, tolerance: f64| -> Vec<Posterior> {
            let labels = signs.iter().zip(&mut sites);
            let labels = labels.map(|(signs, sites)| {
                let posterior = Posterior::new(covariance, signs, sites.clone(), tolerance);
                *sites = posterior.sites();
                posterior
            });
            labels.collect()
        };
        let best = ascend(KernelSetting::start(runs.axes()), |setting| {
            let covariance = setting.kernel().matrix(runs);
            let labels = posteriors(&covariance, TOLERANCES[0]);
            labels.iter().map(|label| label.evidence).sum()
        });
        let kernel = best.kernel();
        let labels = posteriors(&kernel.matrix(runs), TOLERANCES[1]);
        Box::new(Classifier {
            runs: runs.clone(),
            kernel,
            temperature: temperature(runs, &labels),
            labels,
        })
    }
}

/// The largest temperature within one standard deviation of the one that maximises the
/// leave-one-out probability of the runs' labels.
fn temperature(runs: &Training, labels: &[Posterior]) -> f64 {
    let fits = TEMPERATURES.map(|temperature| {
        let logs = (0..runs.runs()).map(|run| {
            let odds = labels
                .iter()
                .map(|label| normal::odds_below(label.left_out[run] / temperature));
            libm::log(normalised(odds.collect())[runs.label(run)])
        });
        logs.sum::<f64>()
    });
    let best = fits
        .iter()
        .fold(f64::NEG_INFINITY, |best, fit| best.max(*fit));
    let known = TEMPERATURES.iter().zip(fits);
    let close = known.filter(|(_, fit)| *fit >= best - ONE_DEVIATION);
    close.fold(1.0, |_, (temperature, _)| *temperature)
}

impl Fitted for Classifier {
    fn predict(&self, units: &[&[f64]]) -> Vec<Vec<f64>> {
        let mut buffer = Vec::with_capacity(self.runs.runs());
        let blocks = units.chunks(LANES);
        blocks
            .flat_map(|block| self.predict_block(block, &mut buffer))
            .collect()
    }
}

impl Classifier {
    /// Predictions for at most as many places as there are lanes.
    fn predict_block(&self, units: &[&[f64]], buffer: &mut Vec<Lanes>) -> Vec<Vec<f64>> {
        let mut covariances = vec![[0.0; LANES]; self.runs.runs()];
        for (run, of_run) in covariances.iter_mut().enumerate() {
            for (covariance, unit) in of_run.iter_mut().zip(units) {
                *covariance = self.kernel.covariance(self.runs.unit(run), unit);
            }
        }
        let mut odds = vec![Vec::with_capacity(self.labels.len()); units.len()];
        for label in &self.labels {
            let means = label.means(&covariances);
            let variances = label.variances(&covariances, self.kernel.variance, buffer);
            for (odds, (mean, variance)) in odds.iter_mut().zip(means.into_iter().zip(variances)) {
                let z = mean / (1.0 + variance).sqrt();
                odds.push(normal::odds_below(z / self.temperature));
            }
        }
        odds.into_iter().map(normalised).collect()
    }
}
