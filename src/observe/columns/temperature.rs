//! Granular temperatures: energies of random motion, over the mass.

use super::mean;
use crate::simulation::Frame;

/// Mean square velocity relative to the mean velocity, over the number of axes (m2/s2): Goldhirsch,
/// Annu. Rev. Fluid Mech. 35 (2003) 267, eq. 2.
pub(super) fn translational(frame: &dyn Frame, axes: f64) -> f64 {
    let [vx, vy, vz] =
        [0, 1, 2].map(|axis| mean(frame, |block| [block.velocity[axis]], |[speed]| speed));
    let square = |[x, y, z]: [f64; 3]| {
        let [x, y, z] = [x - vx, y - vy, z - vz];
        x * x + y * y + z * z
    };
    mean(frame, |block| block.velocity, square) / axes
}

/// Mean of I w^2 / m over the number of axes (m2/s2): Luding, Huthmann, McNamara and Zippelius,
/// Phys. Rev. E 58 (1998) 3416. Not a number without spins.
pub(super) fn rotational(frame: &dyn Frame, axes: f64) -> f64 {
    let mut turn = true;
    frame.show(&mut |block| turn &= block.spin.is_some());
    if !turn {
        return f64::NAN;
    }
    let square = |[inertia, mass, x, y, z]: [f64; 5]| inertia / mass * (x * x + y * y + z * z);
    mean(
        frame,
        |block| {
            let [x, y, z] = block.spin.unwrap_or_default();
            [block.inertia, block.mass, x, y, z]
        },
        square,
    ) / axes
}
