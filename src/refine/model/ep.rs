//! Expectation propagation for one label against the others.

use crate::refine::cholesky::{Cholesky, LANES, Lanes, Matrix, squared_lengths};
use crate::refine::normal;

/// Largest number of sweeps over the runs.
const MOST_SWEEPS: usize = 60;

/// Damping: share of a new site that replaces the old one. Without it, changing all sites at once
/// oscillates.
const DAMPING: f64 = 0.8;

/// Gaussian factors that approximate the likelihoods of the runs.
#[derive(Clone, Debug)]
pub(super) struct Sites {
    /// Inverse variance of each.
    precision: Vec<f64>,
    /// Inverse variance times mean of each.
    shift: Vec<f64>,
}

impl Sites {
    /// Nearly uninformative sites.
    pub(super) fn vague(runs: usize) -> Self {
        Self {
            precision: vec![1e-6; runs],
            shift: vec![0.0; runs],
        }
    }
}

/// The Gaussian posterior of the latent function of one label.
#[derive(Clone, Debug)]
pub(super) struct Posterior {
    sites: Sites,
    root_precision: Vec<f64>,
    factor: Cholesky,
    /// The mean at a place is the product of this with the covariances to the runs.
    weights: Vec<f64>,
    /// Logarithm of the approximate marginal likelihood.
    pub(super) evidence: f64,
    /// Latent mean over spread with which the other runs predict each run.
    pub(super) left_out: Vec<f64>,
}

impl Posterior {
    /// Posterior for runs with this prior covariance; `signs` are 1 for the label and -1 for the
    /// others. Rasmussen and Williams, Gaussian Processes for Machine Learning (2006), algorithms
    /// 3.5 and 3.6, with all sites changed at once. `start` are the sites to begin with. Sweeps end
    /// when no mean changes by more than `tolerance` spreads, and no variance by more than this
    /// share.
    pub(super) fn new(covariance: &Matrix, signs: &[f64], start: Sites, tolerance: f64) -> Self {
        let mut sites = start;
        let mut sweep = 0;
        loop {
            let (posterior, next) = sweep_once(covariance, signs, sites, tolerance);
            sweep += 1;
            match next {
                Some(next) if sweep < MOST_SWEEPS => sites = next,
                _ => return posterior,
            }
        }
    }

    /// The sites, to start a similar fit from.
    pub(super) fn sites(&self) -> Sites {
        self.sites.clone()
    }

    /// Latent means at places, by the covariances of each run with all of them.
    pub(super) fn means(&self, covariances: &[Lanes]) -> Lanes {
        let mut sums = [0.0; LANES];
        for (weight, of_run) in self.weights.iter().zip(covariances) {
            for lane in 0..LANES {
                sums[lane] += weight * of_run[lane];
            }
        }
        sums
    }

    /// Latent variances at places with this prior variance (equation 3.61): `covariances` has the
    /// covariances of each run with all places. `buffer` is working memory.
    pub(super) fn variances(
        &self,
        covariances: &[Lanes],
        prior: f64,
        buffer: &mut Vec<Lanes>,
    ) -> Lanes {
        buffer.clear();
        let scaled = covariances.iter().zip(&self.root_precision);
        buffer.extend(scaled.map(|(of_run, root)| of_run.map(|covariance| covariance * root)));
        self.factor.solve_lower_lanes(0, buffer);
        squared_lengths(buffer).map(|known| (prior - known).max(0.0))
    }
}

/// The posterior of these sites, and the next sites unless they have converged.
fn sweep_once(
    covariance: &Matrix,
    signs: &[f64],
    sites: Sites,
    tolerance: f64,
) -> (Posterior, Option<Sites>) {
    let size = covariance.size();
    let root: Vec<f64> = sites.precision.iter().map(|it| it.sqrt()).collect();
    // B = I + S^½ K S^½ (equation 3.26).
    let factor = Cholesky::new(size, |i, j| {
        let one = if i == j { 1.0 } else { 0.0 };
        one + root[i] * covariance.row(i)[j] * root[j]
    });
    // Weights = (I - S^½ B⁻¹ S^½ K) ν.
    let mut weights = covariance.times(&sites.shift);
    for (weight, root) in weights.iter_mut().zip(&root) {
        *weight *= root;
    }
    factor.solve(&mut weights);
    for ((weight, root), shift) in weights.iter_mut().zip(&root).zip(&sites.shift) {
        *weight = shift - root * *weight;
    }
    let means = covariance.times(&weights);
    let inverse_diagonal = factor.inverse_diagonal();

    let mut evidence = -0.5 * factor.log_determinant();
    let mut next = sites.clone();
    let mut change = 0.0_f64;
    let mut left_out = Vec::with_capacity(size);
    for run in 0..size {
        let (precision, shift) = (sites.precision[run], sites.shift[run]);
        let variance = (1.0 - inverse_diagonal[run]) / precision;
        // The cavity: the posterior without this run (equation 3.56).
        let cavity_precision = (1.0 / variance - precision).max(1e-9);
        let cavity_variance = 1.0 / cavity_precision;
        let cavity_mean = (means[run] / variance - shift) * cavity_variance;
        let spread = (1.0 + cavity_variance).sqrt();
        left_out.push(cavity_mean / spread);
        // Moments of the cavity times the likelihood (equation 3.58).
        let z = signs[run] * cavity_mean / spread;
        let ratio = normal::density_over_below(z);
        let mean = cavity_mean + signs[run] * cavity_variance * ratio / spread;
        let reduction = cavity_variance * ratio * (z + ratio) / (1.0 + cavity_variance);
        let matched = cavity_variance * (1.0 - reduction).max(1e-9);
        let new_precision = (1.0 / matched - cavity_precision).max(1e-9);
        let new_shift = mean / matched - cavity_mean * cavity_precision;
        next.precision[run] += DAMPING * (new_precision - precision);
        next.shift[run] += DAMPING * (new_shift - shift);
        change = change.max((mean - means[run]).abs() / matched.sqrt());
        change = change.max((matched / variance - 1.0).abs());
        // Equations 3.65, 3.73 and 3.74.
        let both = cavity_precision + precision;
        evidence += normal::log_below(z) + 0.5 * libm::log1p(precision * cavity_variance);
        evidence += 0.5 * shift * (means[run] - shift / both);
        evidence +=
            0.5 * cavity_mean * cavity_precision / both * (precision * cavity_mean - 2.0 * shift);
    }
    let posterior = Posterior {
        sites,
        root_precision: root,
        factor,
        weights,
        evidence,
        left_out,
    };
    (posterior, (change > tolerance).then_some(next))
}
