//! Gaussian process regression of the labels.

use super::kernel::{Kernel, KernelSetting, ascend};
use super::{Fitted, LabelModel, normalised};
use crate::refine::cholesky::{Cholesky, dot};
use crate::refine::normal;
use crate::refine::observations::Training;

/// Label regression: 1 where a run has the label and -1 elsewhere is taken as a Gaussian process
/// with Gaussian noise. The probability of a label is proportional to the odds of a value above 0.
/// Rasmussen and Williams, Gaussian Processes for Machine Learning (2006), sections 2.2 and 6.5.
/// All labels share one factorisation, which makes this model faster than expectation propagation.
#[derive(Clone, Copy, Debug, Default)]
pub struct Regression;

struct Regressed {
    runs: Training,
    kernel: Kernel,
    factor: Cholesky,
    weights: Vec<Vec<f64>>,
    noise: f64,
}

/// Variances of the noise over the variance of the latent function.
const NOISES: [f64; 4] = [0.001, 0.01, 0.05, 0.2];

impl LabelModel for Regression {
    fn fit(&self, runs: &Training) -> Box<dyn Fitted> {
        let fits = NOISES.iter().map(|noise| {
            let best = ascend(KernelSetting::start(runs.axes()), |setting| {
                fit(runs, setting, *noise).1
            });
            fit(runs, &best, *noise)
        });
        let fits = fits.collect::<Vec<_>>();
        let best = fits
            .into_iter()
            .max_by(|one, other| one.1.total_cmp(&other.1));
        Box::new(best.expect("there are noises to try").0)
    }
}

/// The regression with this kernel, and the logarithm of the marginal likelihood (equation 2.30)
/// at the amplitude that makes it largest.
fn fit(runs: &Training, setting: &KernelSetting, noise: f64) -> (Regressed, f64) {
    let mut kernel = setting.kernel();
    kernel.variance = 1.0;
    let count = runs.runs();
    let matrix = kernel.matrix(runs);
    let factor = Cholesky::new(count, |i, j| {
        matrix.row(i)[j] + if i == j { noise } else { 0.0 }
    });
    let mut square = 0.0;
    let labels = runs.codes().len();
    let weights = (0..labels).map(|label| {
        let target = |run| if runs.label(run) == label { 1.0 } else { -1.0 };
        let targets: Vec<f64> = (0..count).map(target).collect();
        let mut weights = targets.clone();
        factor.solve(&mut weights);
        square += dot(&targets, &weights);
        weights
    });
    let weights = weights.collect();
    let numbers = (labels * count) as f64;
    kernel.variance = square / numbers;
    let logarithm = labels as f64 * factor.log_determinant() + numbers * libm::log(kernel.variance);
    let regressed = Regressed {
        runs: runs.clone(),
        kernel,
        factor,
        weights,
        noise,
    };
    (regressed, -0.5 * logarithm)
}

impl Fitted for Regressed {
    fn predict(&self, units: &[&[f64]]) -> Vec<Vec<f64>> {
        units.iter().map(|unit| self.at(unit)).collect()
    }
}

impl Regressed {
    fn at(&self, unit: &[f64]) -> Vec<f64> {
        let mut column = self.kernel.column(&self.runs, unit);
        for covariance in &mut column {
            *covariance /= self.kernel.variance;
        }
        let means: Vec<f64> = self.weights.iter().map(|it| dot(it, &column)).collect();
        self.factor.solve_lower(&mut column);
        let rest = (1.0 - dot(&column, &column)).max(0.0) + self.noise;
        let spread = (self.kernel.variance * rest).sqrt();
        let weights = means.iter().map(|mean| normal::odds_below(mean / spread));
        normalised(weights.collect())
    }
}
