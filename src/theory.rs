//! Closed forms for comparison with simulations.

mod with_friction;

pub use with_friction::critical_rotation_with_friction;

use crate::scene::{Drag, Swirl, Updraught};
use std::f64::consts::{PI, SQRT_2};

/// Critical angular velocity Omega_c (rad/s) at which the surface of the spheres, treated as a
/// rotating fluid, touches the floor on the axis: Rice (2012), eq. 43,
///
/// Omega_c = (4 / R^2) sqrt(sqrt(2) / pi n r^3 g).
///
/// It follows from the volume pi Omega^2 R^4 / (4 g) under the paraboloid (eq. 41) and the volume
/// 4 sqrt(2) n r^3 of n close-packed spheres (eq. 42).
///
/// * `count`: number of spheres n
/// * `radius`: radius r of a sphere (m); for unequal spheres the cube root of the mean of r^3
/// * `tank_radius`: radius R of the tank (m)
/// * `gravity`: acceleration g (m/s2)
///
/// ```
/// let omega_c = phase::theory::critical_rotation(256.0, 0.004, 0.06, 9.8);
/// assert!((omega_c - 9.44633).abs() < 1e-5);
/// ```
pub fn critical_rotation(count: f64, radius: f64, tank_radius: f64, gravity: f64) -> f64 {
    4.0 / (tank_radius * tank_radius)
        * (SQRT_2 / PI * count * radius * radius * radius * gravity).sqrt()
}

/// Force of the updraught (N) on an unshielded sphere at rest: Rice (2012), eq. 24 with n = 0,
///
/// F_z = s exp(-beta (z - z0)) drag(v_z), with drag(v) = c1 v + c2 v^2 in the thesis.
///
/// * `swirl`: the rotation of the air, for a strength s proportional to Omega^2
/// * `drag`: the drag law
/// * `radius`: radius of the sphere (m)
/// * `height`: height z of its centre (m)
pub fn unshielded_lift(
    updraught: &Updraught,
    swirl: Option<&Swirl>,
    drag: &Drag,
    radius: f64,
    height: f64,
) -> f64 {
    let speed = updraught.speed;
    updraught.strength_in(swirl)
        * libm::exp(-updraught.decay * (height - updraught.origin))
        * drag.coefficient(radius, speed)
        * speed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{DragForm, DragLaw};

    #[test]
    fn critical_rotation_of_the_tank() {
        for (radius, expected) in [
            (0.002, 3.33978),
            (0.003, 6.13557),
            (0.004, 9.44633),
            (0.005, 13.20165),
            (0.006, 17.35401),
        ] {
            let omega = critical_rotation(256.0, radius, 0.06, 9.8);
            assert!((omega - expected).abs() < 5e-6, "r = {radius}: {omega}");
        }
    }

    #[test]
    fn at_the_critical_rotation_the_paraboloid_holds_the_spheres() {
        let (count, radius, tank_radius, gravity) = (100.0, 0.01, 0.2, 1.6);
        let omega = critical_rotation(count, radius, tank_radius, gravity);
        let paraboloid = PI * omega * omega * libm::pow(tank_radius, 4.0) / (4.0 * gravity);
        let spheres = 4.0 * SQRT_2 * count * libm::pow(radius, 3.0);
        assert!((paraboloid / spheres - 1.0).abs() < 1e-12);
    }

    #[test]
    fn lift_of_the_theoretical_tank_is_three_weights_at_its_floor() {
        // M = 100 kg/(m2 s), v_z = 5.88 m/s, r = 4 mm, 3750 kg/m3, g = 9.8 m/s2: the presets are
        // made so that the lift at z0 is M v_z pi r^2 / (4/3 pi r^3 rho g) = 3 weights.
        let updraught = Updraught {
            speed: 5.88,
            strength: 1.0,
            decay: 25.0,
            origin: -0.2,
            alpha: 0.5,
            reference_omega: None,
        };
        let drag = Drag {
            linear: 100.0,
            quadratic: 0.0,
            viscosity: None,
            density: None,
            law: DragLaw::CrossSection,
            form: DragForm::Component,
        };
        let weight = 3750.0 * 4.0 / 3.0 * PI * 0.004 * 0.004 * 0.004 * 9.8;
        let lift = |height| unshielded_lift(&updraught, None, &drag, 0.004, height);
        assert!((lift(-0.2) / weight - 3.0).abs() < 1e-12);
        assert!((lift(-0.16) / lift(-0.2) - libm::exp(-1.0)).abs() < 1e-12);
    }
}
