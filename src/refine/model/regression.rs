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

pub(super) struct Regressed {
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
        let targets = (0..runs.codes().len()).map(|label| {
            let target = |run| if runs.label(run) == label { 1.0 } else { -1.0 };
            (0..runs.runs()).map(target).collect()
        });
        Box::new(Regressed::best(runs, &targets.collect::<Vec<_>>()))
    }
}

/// The regression with this kernel, and the logarithm of the marginal likelihood (equation 2.30)
/// at the amplitude that makes it largest.
fn fit(
    runs: &Training,
    targets: &[Vec<f64>],
    setting: &KernelSetting,
    noise: f64,
) -> (Regressed, f64) {
    let mut kernel = setting.kernel();
    kernel.variance = 1.0;
    let count = runs.runs();
    let matrix = kernel.matrix(runs);
    let factor = Cholesky::new(count, |i, j| {
        matrix.row(i)[j] + if i == j { noise } else { 0.0 }
    });
    let mut square = 0.0;
    let weights = targets.iter().map(|targets| {
        let mut weights = targets.clone();
        factor.solve(&mut weights);
        square += dot(targets, &weights);
        weights
    });
    let weights = weights.collect();
    let series = targets.len();
    let numbers = (series * count) as f64;
    kernel.variance = square / numbers;
    let logarithm = series as f64 * factor.log_determinant() + numbers * libm::log(kernel.variance);
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
    /// The regression of numbers of the runs, one series or several, with the largest marginal
    /// likelihood.
    pub(super) fn best(runs: &Training, targets: &[Vec<f64>]) -> Self {
        let fits = NOISES.iter().map(|noise| {
            let best = ascend(KernelSetting::start(runs.axes()), |setting| {
                fit(runs, targets, setting, *noise).1
            });
            fit(runs, targets, &best, *noise)
        });
        let fits = fits.collect::<Vec<_>>();
        let best = fits
            .into_iter()
            .max_by(|one, other| one.1.total_cmp(&other.1));
        best.expect("there are noises to try").0
    }

    /// Root mean square of the differences between the numbers and what the others predict, over
    /// the spreads of these predictions (equations 5.10 to 5.12).
    pub(super) fn left_out_residual(&self, targets: &[f64]) -> f64 {
        let inverse = self.factor.inverse_diagonal();
        let mut weights = targets.to_vec();
        self.factor.solve(&mut weights);
        let squares = weights.iter().zip(&inverse);
        let squares = squares.map(|(weight, inverse)| weight * weight / inverse);
        (squares.sum::<f64>() / targets.len() as f64 / self.kernel.variance).sqrt()
    }

    fn at(&self, unit: &[f64]) -> Vec<f64> {
        let (means, spread) = self.latent(unit);
        let weights = means.iter().map(|mean| normal::odds_below(mean / spread));
        normalised(weights.collect())
    }

    /// Means of the numbers at a place, and the spread of a run there.
    pub(super) fn latent(&self, unit: &[f64]) -> (Vec<f64>, f64) {
        let mut column = self.kernel.column(&self.runs, unit);
        for covariance in &mut column {
            *covariance /= self.kernel.variance;
        }
        let means: Vec<f64> = self.weights.iter().map(|it| dot(it, &column)).collect();
        self.factor.solve_lower(&mut column);
        let rest = (1.0 - dot(&column, &column)).max(0.0) + self.noise;
        (means, (self.kernel.variance * rest).sqrt())
    }
}
