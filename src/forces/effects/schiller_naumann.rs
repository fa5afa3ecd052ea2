//! The drag of a sphere from creeping to fast flow.

use super::drag_kernel::DragKernel;
use crate::particles::vector::Vector;
use std::f64::consts::PI;

/// C_d of fast flow, as in Newton's law.
pub(super) const FAST: f64 = 0.44;

/// Schiller and Naumann (Z. Ver. Dtsch. Ing. 77, 318 (1933)): F = (pi/8) C_d rho D^2 |u| u with
///
/// C_d = max(24/Re (1 + 0.15 Re^0.687), 0.44), Re = rho D |u| / mu,
///
/// for a sphere of diameter D in a fluid of density rho and viscosity mu. Their formula holds up to
/// Re = 800; from Re = 1000 on C_d stays near 0.44, up to 2e5 (Clift, Grace and Weber, Bubbles,
/// Drops, and Particles (1978), chapter 5). Its limits are 3 pi mu D u (Stokes) and
/// 0.44 (pi/8) rho D^2 |u| u (Newton).
///
/// Here c1 = 3 pi mu D (kg/s) and c2 = rho D / mu (s/m): F = c1 u max(1 + 0.15 (c2 |u|)^0.687,
/// 0.44/24 c2 |u|).
#[derive(Clone, Copy)]
pub(super) struct SchillerNaumann;

/// C_d over C_d of Stokes' law, at a Reynolds number.
#[inline(always)]
fn over_stokes(reynolds: f64) -> f64 {
    let slow = 1.0 + 0.15 * libm::pow(reynolds, 0.687);
    let fast = FAST / 24.0 * reynolds;
    if fast > slow { fast } else { slow }
}

impl SchillerNaumann {
    /// The coefficients c1 (kg/s) and c2 (s/m) of a sphere of this radius (m).
    pub(super) fn coefficients(viscosity: f64, density: f64, radius: f64) -> (f64, f64) {
        let diameter = 2.0 * radius;
        (
            3.0 * PI * viscosity * diameter,
            density * diameter / viscosity,
        )
    }

    /// Force over speed (kg/s) at a speed (m/s).
    pub(super) fn coefficient(c1: f64, c2: f64, speed: f64) -> f64 {
        c1 * over_stokes(c2 * speed)
    }

    /// The speed (m/s) at which the force reaches `force` (N), to the last digit. It lies between 0
    /// and the speed by Stokes' law.
    pub(super) fn speed_at(c1: f64, c2: f64, force: f64) -> f64 {
        let (mut slow, mut fast) = (0.0, force / c1);
        loop {
            let middle = 0.5 * (slow + fast);
            if !(slow < middle && middle < fast) {
                return fast;
            }
            match Self::coefficient(c1, c2, middle) * middle < force {
                true => slow = middle,
                false => fast = middle,
            }
        }
    }

    /// The largest dF/du (kg/s) at speeds up to u (m/s).
    pub(super) fn slope(c1: f64, c2: f64, speed: f64) -> f64 {
        let reynolds = c2 * speed;
        let power = 0.15 * libm::pow(reynolds, 0.687);
        let fast = FAST / 24.0 * reynolds;
        match fast > 1.0 + power {
            true => c1 * 2.0 * fast,
            false => c1 * (1.0 + 1.687 * power),
        }
    }
}

impl DragKernel for SchillerNaumann {
    #[inline(always)]
    fn vector(c1: f64, c2: f64, air: Vector) -> Vector {
        air * (c1 * over_stokes(c2 * air.norm()))
    }

    #[inline(always)]
    fn along(c1: f64, c2: f64, air: f64) -> f64 {
        c1 * over_stokes(c2 * air.abs()) * air
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_is_that_of_the_force() {
        // A sphere of 1 mm in water.
        let (c1, c2) = SchillerNaumann::coefficients(1e-3, 1e3, 5e-4);
        for speed in [1e-6, 1e-3, 0.1, 0.9, 1.1, 5.0] {
            let force = |speed: f64| SchillerNaumann::along(c1, c2, speed);
            let step = 1e-5 * speed;
            let expected = (force(speed + step) - force(speed - step)) / (2.0 * step);
            let found = SchillerNaumann::slope(c1, c2, speed);
            assert!((found / expected - 1.0).abs() < 1e-6, "{speed}: {found}");
            let over_speed = SchillerNaumann::coefficient(c1, c2, speed);
            assert!((over_speed * speed / force(speed) - 1.0).abs() < 1e-15);
        }
    }
}
