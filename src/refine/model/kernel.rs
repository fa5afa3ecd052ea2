//! The covariance of latent functions.

use crate::refine::cholesky::Matrix;
use crate::refine::observations::Training;

/// The Matérn covariance of smoothness 5/2 with one length per axis: Rasmussen and Williams,
/// Gaussian Processes for Machine Learning (2006), equation 4.17.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Kernel {
    /// Variance of the latent function.
    pub(super) variance: f64,
    /// Length on each axis of the unit cube.
    pub(super) lengths: Vec<f64>,
}

impl Kernel {
    /// Covariance of two places.
    pub(super) fn covariance(&self, one: &[f64], other: &[f64]) -> f64 {
        let mut square = 0.0;
        for ((one, other), length) in one.iter().zip(other).zip(&self.lengths) {
            let share = (one - other) / length;
            square += share * share;
        }
        let root = (5.0 * square).sqrt();
        self.variance * (1.0 + root + 5.0 / 3.0 * square) * libm::exp(-root)
    }

    /// Covariances of all pairs of runs.
    pub(super) fn matrix(&self, runs: &Training) -> Matrix {
        Matrix::symmetric(runs.runs(), |one, other| {
            self.covariance(runs.unit(one), runs.unit(other))
        })
    }

    /// Covariances of a place and all runs.
    pub(super) fn column(&self, runs: &Training, unit: &[f64]) -> Vec<f64> {
        (0..runs.runs())
            .map(|run| self.covariance(runs.unit(run), unit))
            .collect()
    }
}

/// A trial of the search for the best kernel: an amplitude and one length per axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct KernelSetting {
    amplitude: usize,
    lengths: Vec<usize>,
}

/// Standard deviations of the latent function.
const AMPLITUDES: [f64; 6] = [1.0, 1.6, 2.5, 4.0, 6.3, 10.0];

/// Lengths on the unit cube.
const LENGTHS: [f64; 8] = [0.06, 0.1, 0.16, 0.25, 0.4, 0.63, 1.0, 1.6];

impl KernelSetting {
    /// Where searches start: an amplitude of 4, lengths of 0.4.
    pub(super) fn start(axes: usize) -> Self {
        Self {
            amplitude: 3,
            lengths: vec![4; axes],
        }
    }

    /// The kernel of this setting.
    pub(super) fn kernel(&self) -> Kernel {
        let amplitude = AMPLITUDES[self.amplitude];
        Kernel {
            variance: amplitude * amplitude,
            lengths: self.lengths.iter().map(|it| LENGTHS[*it]).collect(),
        }
    }

    /// The next setting up or down in the amplitude (0) or the length of an axis (from 1).
    fn step(&self, number: usize, up: bool) -> Option<Self> {
        let mut next = self.clone();
        let (index, count) = match number {
            0 => (&mut next.amplitude, AMPLITUDES.len()),
            _ => (&mut next.lengths[number - 1], LENGTHS.len()),
        };
        *index = if up {
            *index + 1
        } else {
            index.checked_sub(1)?
        };
        (*index < count).then_some(next)
    }
}

/// The setting with the largest evidence that can be reached in steps from `start`, one number at a
/// time. The evidence may depend on the setting and on earlier calls only.
pub(super) fn ascend(
    start: KernelSetting,
    mut evidence: impl FnMut(&KernelSetting) -> f64,
) -> KernelSetting {
    let numbers = start.lengths.len() + 1;
    let mut known: Vec<(KernelSetting, f64)> = Vec::new();
    let mut value = |setting: &KernelSetting| {
        if let Some((_, value)) = known.iter().find(|(other, _)| other == setting) {
            return *value;
        }
        let value = evidence(setting);
        known.push((setting.clone(), value));
        value
    };
    let mut best = start;
    loop {
        let before = best.clone();
        for number in 0..numbers {
            for up in [false, true] {
                while let Some(next) = best.step(number, up) {
                    if value(&next) <= value(&best) {
                        break;
                    }
                    best = next;
                }
            }
        }
        if best == before {
            return best;
        }
    }
}
