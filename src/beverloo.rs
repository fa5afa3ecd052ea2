//! The law of Beverloo for the discharge of a silo, fitted to measured rates.
//!
//! W = C sqrt(g) n (D - k d)^p grains per second leave through an opening of width D. A round hole
//! has p = 5/2: Beverloo, Leniger and van de Velde, Chemical Engineering Science 15, 260 (1961). A
//! slit, and a silo in two dimensions, have p = 3/2: Franklin and Johanson, Chemical Engineering
//! Progress 51, 119 (1955); Mankoc et al., Granular Matter 9, 407 (2007). n is the number of grains
//! per volume of the bed, or per area of the bed in the plane of the flow; d is their diameter.

use crate::statistics::{CONFIDENCE, Estimate, student_t};

/// The opening through which grains leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Opening {
    /// A gap of width D in a plane, or a slit as long as the bed is deep.
    Flat,
    /// A round hole of diameter D.
    Round,
}

impl Opening {
    /// The exponent p of the law.
    pub const fn exponent(self) -> f64 {
        match self {
            Self::Flat => 1.5,
            Self::Round => 2.5,
        }
    }

    /// x^p.
    fn power(self, x: f64) -> f64 {
        match self {
            Self::Flat => x * x.sqrt(),
            Self::Round => x * x * x.sqrt(),
        }
    }

    /// p x^(p - 1), the slope of the power.
    fn slope(self, x: f64) -> f64 {
        match self {
            Self::Flat => 1.5 * x.sqrt(),
            Self::Round => 2.5 * x * x.sqrt(),
        }
    }
}

/// Properties of a bed of grains in the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrainBed {
    /// Acceleration g (m/s2).
    pub gravity: f64,
    /// Number n of grains: per area of the plane of the flow (1/m2) with a flat opening, per volume
    /// (1/m3) with a round one.
    pub number_density: f64,
    /// Mean diameter d of the grains (m).
    pub diameter: f64,
    /// The opening.
    pub opening: Opening,
}

impl GrainBed {
    /// Grains per second through an opening of this width (m): C sqrt(g) n (D - k d)^p, zero if D <
    /// k d.
    pub fn discharge_rate(&self, width: f64, [c, k]: [f64; 2]) -> f64 {
        c * self.rate_unit() * self.opening.power(self.free(width, k))
    }

    /// D - k d (m), not below 0.
    fn free(&self, width: f64, k: f64) -> f64 {
        (width - k * self.diameter).max(0.0)
    }

    fn rate_unit(&self) -> f64 {
        self.gravity.sqrt() * self.number_density
    }
}

/// A measured discharge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Discharge {
    /// Width D of the opening (m).
    pub width: f64,
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
    /// Root mean square of the residuals (grains per second), with two degrees of freedom fewer
    /// than discharges.
    pub residual: f64,
    /// Number of discharges.
    pub discharges: usize,
}

/// Why the law cannot be fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct FitError(&'static str);

/// Two constants and their scatter need more discharges.
const TOO_FEW: FitError =
    FitError("the fit needs three discharges or more, of two openings or more");

/// No such law has these rates.
const NO_LAW: FitError = FitError("the rates do not grow with the opening as the law requires");

/// Steps after which a fit that has not converged is given up; it takes about five.
const MOST_STEPS: usize = 200;

/// Least share by which a step must lower the sum of squares.
const PROGRESS: f64 = 1e-13;

/// Fits C and k to discharges from one bed by least squares of the rates (Gauss-Newton, steps
/// halved until they improve the fit).
///
/// The intervals follow from the linearised fit: plus and minus t s sqrt(V_ii), with Student's t
/// for 95 % and n - 2 degrees of freedom for n discharges, the residual s, and V the inverse of J^T
/// J. They assume equal scatter at all openings and an exactly known bed.
///
/// # Errors
/// If there are too few discharges, or they do not follow the law.
pub fn fit(discharges: &[Discharge], bed: &GrainBed) -> Result<Fit, FitError> {
    let mut widths: Vec<f64> = discharges.iter().map(|it| it.width).collect();
    widths.sort_by(f64::total_cmp);
    widths.dedup();
    if discharges.len() < 3 || widths.len() < 2 {
        return Err(TOO_FEW);
    }
    let squares = |constants| -> f64 {
        let residuals = discharges.iter().map(|it| residual(it, bed, constants));
        residuals.map(|it| it * it).sum()
    };
    let mut constants = straightened(discharges, bed).ok_or(NO_LAW)?;
    let mut least = squares(constants);
    for _ in 0..MOST_STEPS {
        let normal = Normal::at(discharges, bed, constants);
        let step = normal.step().ok_or(NO_LAW)?;
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
    Err(NO_LAW)
}

fn residual(measured: &Discharge, bed: &GrainBed, constants: [f64; 2]) -> f64 {
    measured.rate - bed.discharge_rate(measured.width, constants)
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

/// A first guess: W^(1/p) is a straight line over D.
fn straightened(discharges: &[Discharge], bed: &GrainBed) -> Option<[f64; 2]> {
    let exponent = bed.opening.exponent();
    let root = |rate: f64| libm::pow(rate, 1.0 / exponent);
    let count = discharges.len() as f64;
    let x_mean = discharges.iter().map(|it| it.width).sum::<f64>() / count;
    let y_mean = discharges.iter().map(|it| root(it.rate)).sum::<f64>() / count;
    let (mut variance, mut covariance) = (0.0, 0.0);
    for it in discharges {
        variance += (it.width - x_mean) * (it.width - x_mean);
        covariance += (it.width - x_mean) * (root(it.rate) - y_mean);
    }
    let slope = covariance / variance;
    let foot = x_mean - y_mean / slope;
    let narrowest = discharges
        .iter()
        .map(|it| it.width)
        .fold(f64::INFINITY, f64::min);
    // Every opening must have a positive rate to count.
    let foot = foot.min(narrowest - 1e-3 * bed.diameter);
    let c = libm::pow(slope, exponent) / bed.rate_unit();
    (slope > 0.0).then_some([c, foot / bed.diameter])
}

/// The normal equations J^T J x = J^T r of the linearised law, x in C and k.
struct Normal {
    matrix: [[f64; 2]; 2],
    right: [f64; 2],
}

impl Normal {
    fn at(discharges: &[Discharge], bed: &GrainBed, constants: [f64; 2]) -> Self {
        let mut normal = Self {
            matrix: [[0.0; 2]; 2],
            right: [0.0; 2],
        };
        let [c, k] = constants;
        for it in discharges {
            let (free, unit) = (bed.free(it.width, k), bed.rate_unit());
            let slopes = [
                unit * bed.opening.power(free),
                -c * unit * bed.diameter * bed.opening.slope(free),
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

    const BED: GrainBed = GrainBed {
        gravity: 9.81,
        number_density: 160.0,
        diameter: 0.08,
        opening: Opening::Flat,
    };

    const ROUND: GrainBed = GrainBed {
        number_density: 2300.0,
        opening: Opening::Round,
        ..BED
    };

    const WIDTHS: [f64; 8] = [0.32, 0.36, 0.40, 0.44, 0.48, 0.52, 0.56, 0.64];

    fn exact(bed: &GrainBed, constants: [f64; 2]) -> Vec<Discharge> {
        let of = |width| Discharge {
            width,
            rate: bed.discharge_rate(width, constants),
        };
        WIDTHS.map(of).into()
    }

    #[test]
    fn the_law_by_hand() {
        // C = 1, D - k d = 0.25: sqrt(9.81) 160 / 8.
        let rate = BED.discharge_rate(0.37, [1.0, 1.5]);
        assert!((rate - 9.81_f64.sqrt() * 20.0).abs() < 1e-9);
        assert_eq!(BED.discharge_rate(0.1, [1.0, 1.5]), 0.0);
        // sqrt(9.81) 2300 / 32.
        let rate = ROUND.discharge_rate(0.37, [1.0, 1.5]);
        assert!((rate - 9.81_f64.sqrt() * 71.875).abs() < 1e-9);
    }

    #[test]
    fn exact_rates_give_their_constants_back() {
        for constants in [[1.0, 1.5], [0.6, 3.2], [2.0, -0.5], [1.3, 0.0]] {
            for bed in [BED, ROUND] {
                let fit = fit(&exact(&bed, constants), &bed).unwrap();
                assert!((fit.c.value - constants[0]).abs() < 1e-9, "{fit:?}");
                assert!((fit.k.value - constants[1]).abs() < 1e-9, "{fit:?}");
                assert!(fit.c.half_width < 1e-6 && fit.residual < 1e-6);
            }
        }
    }

    #[test]
    fn three_discharges_at_least_of_two_openings() {
        let all = exact(&BED, [1.0, 1.5]);
        assert_eq!(fit(&all[..2], &BED), Err(TOO_FEW));
        assert_eq!(fit(&[all[0]; 5], &BED), Err(TOO_FEW));
        assert!(fit(&[all[0], all[0], all[5]], &BED).is_ok());
        let mut falling = all;
        falling.reverse();
        for (it, width) in falling.iter_mut().zip(WIDTHS) {
            it.width = width;
        }
        assert_eq!(fit(&falling, &BED), Err(NO_LAW));
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
        let exact = exact(&BED, truth);
        for _ in 0..SETS {
            let mut discharges = [&exact[..]; 3].concat();
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
