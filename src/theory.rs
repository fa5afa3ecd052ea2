//! Closed forms that the simulations are compared with.

use std::f64::consts::{PI, SQRT_2};

/// Critical angular velocity Omega_c (rad/s) at which the surface of the spheres, taken for that
/// of a rotating fluid, touches the floor on the axis: Rice (2012), eq. 43,
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

#[cfg(test)]
mod tests {
    use super::*;

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
}
