//! The law of Beverloo for the discharge of a silo in two dimensions, fitted to measured rates.
//!
//! W = C sqrt(g) n (D - k d)^(3/2) grains per second leave through an opening of width D: Beverloo,
//! Leniger and van de Velde, Chemical Engineering Science 15, 260 (1961), with the exponent of a
//! flat silo instead of their 5/2: Franklin and Johanson, Chemical Engineering Progress 51, 119
//! (1955); Mankoc et al., Granular Matter 9, 407 (2007). n is the number of grains per area of the
//! bed, d their diameter.

use crate::statistics::{CONFIDENCE, Estimate, student_t};

/// What the law needs to know of a bed of grains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bed {
    /// Acceleration g (m/s2).
    pub gravity: f64,
    /// Number n of grains per area (1/m2).
    pub number_density: f64,
    /// Mean diameter d of the grains (m).
    pub diameter: f64,
}

impl Bed {
    /// Grains per second through an opening (m): C sqrt(g) n (D - k d)^(3/2), none where D < k d.
    pub fn discharge_rate(&self, opening: f64, [c, k]: [f64; 2]) -> f64 {
        let free = (opening - k * self.diameter).max(0.0);
        c * self.rate_unit() * free * free.sqrt()
    }

    fn rate_unit(&self) -> f64 {
        self.gravity.sqrt() * self.number_density
    }
}

/// A measured discharge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Discharge {
    /// Width D of the opening (m).
    pub opening: f64,
    /// Grains per second.
    pub rate: f64,
}

/// The law fitted to measured discharges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The constant C.
    pub c: Estimate,
    /// The constant k.
    pub k: Estimate,
    /// Root mean square of the residuals (grains per second), over two less than the number of
    /// discharges.
    pub residual: f64,
    /// Number of discharges.
    pub discharges: usize,
}

/// Why the law cannot be fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FitError {
    /// Two constants and their scatter need more.
    #[error("the fit needs three discharges or more, of two openings or more")]
    TooFew,
    /// The rates are not those of any such law.
    #[error("the rates do not grow with the opening as the law has it")]
    NoLaw,
}

/// Steps after which a fit that has not converged is given up; it takes about five.
const MOST_STEPS: usize = 200;

/// Least share by which a step must lower the sum of squares.
const PROGRESS: f64 = 1e-13;

/// Fits C and k to discharges from one bed by least squares of the rates (Gauss-Newton, steps
/// halved while they do not pay).
///
/// The intervals are those of the linearised fit: plus and minus t s sqrt(V_ii), with Student's t
/// of 95 % and two less than the number of discharges, the residual s, and V the inverse of J^T J.
/// They take the scatter for the same at all openings, and the bed for known exactly.
///
/// # Errors
/// If there are too few discharges, or they do not follow the law.
pub fn fit(discharges: &[Discharge], bed: &Bed) -> Result<Fit, FitError> {
    let mut openings: Vec<f64> = discharges.iter().map(|it| it.opening).collect();
    openings.sort_by(f64::total_cmp);
    openings.dedup();
    if discharges.len() < 3 || openings.len() < 2 {
        return Err(FitError::TooFew);
    }
    let squares = |constants| -> f64 {
        let residuals = discharges.iter().map(|it| residual(it, bed, constants));
        residuals.map(|it| it * it).sum()
    };
    let mut constants = straightened(discharges, bed).ok_or(FitError::NoLaw)?;
    let mut least = squares(constants);
    for _ in 0..MOST_STEPS {
        let normal = Normal::at(discharges, bed, constants);
        let step = normal.step().ok_or(FitError::NoLaw)?;
        let moved = |share: f64| {
            [
                constants[0] + share * step[0],
                constants[1] + share * step[1],
            ]
        };
        let shares = (0..40).map(|halvings| libm::pow(0.5, f64::from(halvings)));
        let better = shares
            .map(moved)
            .find(|next| squares(*next) < least * (1.0 - PROGRESS));
        let Some(next) = better else {
            return Ok(estimates(discharges.len(), constants, least, &normal));
        };
        (constants, least) = (next, squares(next));
    }
    Err(FitError::NoLaw)
}

fn residual(measured: &Discharge, bed: &Bed, constants: [f64; 2]) -> f64 {
    measured.rate - bed.discharge_rate(measured.opening, constants)
}

fn estimates(count: usize, [c, k]: [f64; 2], squares: f64, normal: &Normal) -> Fit {
    let freedom = count - 2;
    let residual = (squares / freedom as f64).sqrt();
    let t = student_t(CONFIDENCE, freedom);
    let [c_variance, k_variance] = normal.inverse_diagonal();
    let estimate = |value: f64, variance: f64| Estimate {
        value,
        half_width: t * residual * variance.sqrt(),
    };
    Fit {
        c: estimate(c, c_variance),
        k: estimate(k, k_variance),
        residual,
        discharges: count,
    }
}

/// A first guess: W^(2/3) is a straight line over D.
fn straightened(discharges: &[Discharge], bed: &Bed) -> Option<[f64; 2]> {
    let power = |rate: f64| libm::cbrt(rate * rate);
    let count = discharges.len() as f64;
    let x_mean = discharges.iter().map(|it| it.opening).sum::<f64>() / count;
    let y_mean = discharges.iter().map(|it| power(it.rate)).sum::<f64>() / count;
    let (mut variance, mut covariance) = (0.0, 0.0);
    for it in discharges {
        variance += (it.opening - x_mean) * (it.opening - x_mean);
        covariance += (it.opening - x_mean) * (power(it.rate) - y_mean);
    }
    let slope = covariance / variance;
    let foot = x_mean - y_mean / slope;
    let narrowest = discharges
        .iter()
        .map(|it| it.opening)
        .fold(f64::INFINITY, f64::min);
    // Every opening must let something through, or it would not count.
    let foot = foot.min(narrowest - 1e-3 * bed.diameter);
    (slope > 0.0).then(|| [slope * slope.sqrt() / bed.rate_unit(), foot / bed.diameter])
}

/// The normal equations J^T J x = J^T r of the linearised law, x in C and k.
struct Normal {
    matrix: [[f64; 2]; 2],
    right: [f64; 2],
}

impl Normal {
    fn at(discharges: &[Discharge], bed: &Bed, constants: [f64; 2]) -> Self {
        let mut normal = Self {
            matrix: [[0.0; 2]; 2],
            right: [0.0; 2],
        };
        let [c, k] = constants;
        for it in discharges {
            let root = (it.opening - k * bed.diameter).max(0.0).sqrt();
            let unit = bed.rate_unit();
            let slopes = [
                unit * root * root * root,
                -1.5 * c * unit * bed.diameter * root,
            ];
            for row in 0..2 {
                normal.right[row] += slopes[row] * residual(it, bed, constants);
                for column in 0..2 {
                    normal.matrix[row][column] += slopes[row] * slopes[column];
                }
            }
        }
        normal
    }

    fn determinant(&self) -> f64 {
        let [[a, b], [c, d]] = self.matrix;
        a * d - b * c
    }

    fn step(&self) -> Option<[f64; 2]> {
        let ([[a, b], [c, d]], [x, y]) = (self.matrix, self.right);
        let determinant = self.determinant();
        let step = [(d * x - b * y) / determinant, (a * y - c * x) / determinant];
        (determinant > 0.0 && step.iter().all(|it| it.is_finite())).then_some(step)
    }

    fn inverse_diagonal(&self) -> [f64; 2] {
        let determinant = self.determinant();
        [
            self.matrix[1][1] / determinant,
            self.matrix[0][0] / determinant,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_pcg::Pcg64;

    const BED: Bed = Bed {
        gravity: 9.81,
        number_density: 160.0,
        diameter: 0.08,
    };

    const OPENINGS: [f64; 8] = [0.32, 0.36, 0.40, 0.44, 0.48, 0.52, 0.56, 0.64];

    fn exact(constants: [f64; 2]) -> Vec<Discharge> {
        let of = |opening| Discharge {
            opening,
            rate: BED.discharge_rate(opening, constants),
        };
        OPENINGS.map(of).into()
    }

    #[test]
    fn the_law_by_hand() {
        // C = 1, D - k d = 0.25: sqrt(9.81) 160 / 8.
        let rate = BED.discharge_rate(0.37, [1.0, 1.5]);
        assert!((rate - 9.81_f64.sqrt() * 20.0).abs() < 1e-9);
        assert_eq!(BED.discharge_rate(0.1, [1.0, 1.5]), 0.0);
    }

    #[test]
    fn exact_rates_give_their_constants_back() {
        for constants in [[1.0, 1.5], [0.6, 3.2], [2.0, -0.5], [1.3, 0.0]] {
            let fit = fit(&exact(constants), &BED).unwrap();
            assert!((fit.c.value - constants[0]).abs() < 1e-9, "{fit:?}");
            assert!((fit.k.value - constants[1]).abs() < 1e-9, "{fit:?}");
            assert!(fit.c.half_width < 1e-6 && fit.residual < 1e-6);
        }
    }

    #[test]
    fn three_discharges_at_least_of_two_openings() {
        let all = exact([1.0, 1.5]);
        assert_eq!(fit(&all[..2], &BED), Err(FitError::TooFew));
        assert_eq!(fit(&[all[0]; 5], &BED), Err(FitError::TooFew));
        assert!(fit(&[all[0], all[0], all[5]], &BED).is_ok());
        let mut falling = all;
        falling.reverse();
        for (it, opening) in falling.iter_mut().zip(OPENINGS) {
            it.opening = opening;
        }
        assert_eq!(fit(&falling, &BED), Err(FitError::NoLaw));
    }

    /// A normal deviate: Box and Muller.
    fn normal(random: &mut Pcg64) -> f64 {
        let mut uniform = || ((random.next_u64() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64;
        let (one, other) = (uniform(), uniform());
        (-2.0 * libm::log(one)).sqrt() * libm::cos(2.0 * std::f64::consts::PI * other)
    }

    #[test]
    fn intervals_cover_the_truth_as_often_as_they_say() {
        const SETS: usize = 4000;
        let truth = [1.1, 1.4];
        let mut random = Pcg64::seed_from_u64(4);
        let mut covered = [0; 2];
        for _ in 0..SETS {
            let mut discharges = [exact(truth), exact(truth), exact(truth)].concat();
            for it in &mut discharges {
                it.rate += 5.0 * normal(&mut random);
            }
            let fit = fit(&discharges, &BED).unwrap();
            for (index, estimate) in [fit.c, fit.k].into_iter().enumerate() {
                let off = (estimate.value - truth[index]).abs();
                covered[index] += usize::from(off <= estimate.half_width);
            }
        }
        // The share itself scatters by 0.35 %.
        for count in covered {
            let share = count as f64 / SETS as f64;
            assert!((share - CONFIDENCE).abs() < 0.012, "{share}");
        }
    }
}
