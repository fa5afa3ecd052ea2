//! The kinematic model: Nedderman and Tüzün, Powder Technology 22 (1979) 243.
//!
//! Grains drift towards faster grains below them, so that the downward speed v diffuses upwards:
//! dv/dz = b d2v/dx2. There is no random motion of single grains, and no mixing.

use std::f64::consts::PI;

/// Steady flow in a plane silo by the kinematic model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KinematicFlow {
    /// Volume that leaves per time and depth (m2/s).
    pub flux: f64,
    /// Length of diffusion b (m).
    pub diffusion: f64,
    /// Half of the width of the orifice (m), over which grains leave at one speed; 0 for a point.
    pub half_opening: f64,
    /// Distance of the side walls from the middle (m), if there are any.
    pub half_width: Option<f64>,
}

impl KinematicFlow {
    /// Downward speed (m/s) at a distance x from the middle and a height z > 0 above the orifice
    /// (m). Without walls and for a point orifice it is a Gaussian:
    ///
    /// v = Q / sqrt(4 pi b z) exp(-x^2 / (4 b z))
    ///
    /// Walls that grains slide along are accounted for by images of the orifice.
    pub fn speed(&self, x: f64, z: f64) -> f64 {
        self.with_images(x, z, |x| self.free(x, z))
    }

    /// The sum of a term over the orifice and its images in the walls.
    fn with_images(&self, x: f64, z: f64, free: impl Fn(f64) -> f64) -> f64 {
        let Some(half_width) = self.half_width else {
            return free(x);
        };
        // Beyond 10 standard deviations a Gaussian is below the last digit of the nearest one.
        let reach = 10.0 * self.standard_deviation(z) + self.half_opening + half_width;
        let images = (reach / (2.0 * half_width)).ceil() as i32;
        let image = |image: i32| free(x + 2.0 * half_width * f64::from(image));
        (-images..=images).map(image).sum()
    }

    /// Velocity of grains (m/s) along x and upwards, at the place of [`speed`](Self::speed). By
    /// continuity dvx/dx = dv/dz, so that vx = b dv/dx.
    pub fn velocity(&self, x: f64, z: f64) -> [f64; 2] {
        let width = (4.0 * self.diffusion * z).sqrt();
        let inward = self.with_images(x, z, |x| self.diffusion * self.free_slope(x, width));
        [inward, -self.speed(x, z)]
    }

    /// Standard deviation of the profile above a point orifice, sqrt(2 b z) (m).
    pub fn standard_deviation(&self, z: f64) -> f64 {
        (2.0 * self.diffusion * z).sqrt()
    }

    /// Speed without walls (m/s).
    fn free(&self, x: f64, z: f64) -> f64 {
        let width = (4.0 * self.diffusion * z).sqrt();
        let a = self.half_opening;
        if a == 0.0 {
            return self.flux / (PI.sqrt() * width) * libm::exp(-(x / width) * (x / width));
        }
        let edges = libm::erf((x + a) / width) - libm::erf((x - a) / width);
        self.flux / (4.0 * a) * edges
    }

    /// Derivative of the speed without walls along x (1/s), for a profile of width `width` = sqrt(4
    /// b z).
    fn free_slope(&self, x: f64, width: f64) -> f64 {
        let gauss = |x: f64| libm::exp(-(x / width) * (x / width)) / (PI.sqrt() * width);
        let a = self.half_opening;
        if a == 0.0 {
            return -2.0 * x / (width * width) * self.flux * gauss(x);
        }
        self.flux / (2.0 * a) * (gauss(x + a) - gauss(x - a))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOWS: [KinematicFlow; 2] = [
        KinematicFlow {
            flux: 3.0,
            diffusion: 2.28,
            half_opening: 0.0,
            half_width: Some(25.0),
        },
        KinematicFlow {
            flux: 3.0,
            diffusion: 2.28,
            half_opening: 4.0,
            half_width: Some(25.0),
        },
    ];

    #[test]
    fn the_flux_is_the_same_at_all_heights() {
        for flow in FLOWS {
            for z in [2.0, 30.0, 500.0] {
                let step = 0.01;
                let places = (0..5000).map(|k| -25.0 + (f64::from(k) + 0.5) * step);
                let flux: f64 = places.map(|x| flow.speed(x, z) * step).sum();
                assert!((flux - flow.flux).abs() < 1e-4, "{flux} at {z}");
            }
        }
    }

    #[test]
    fn the_speed_obeys_its_equation_and_widens_as_printed() {
        let h = 1e-3;
        for flow in FLOWS {
            for (x, z) in [(0.0, 10.0), (6.0, 20.0), (24.0, 60.0)] {
                let along_z = (flow.speed(x, z + h) - flow.speed(x, z - h)) / (2.0 * h);
                let [left, here, right] = [x - h, x, x + h].map(|x| flow.speed(x, z));
                let across = (left - 2.0 * here + right) / (h * h);
                assert!((along_z - 2.28 * across).abs() < 1e-6, "at {x}, {z}");
                let slope = (right - left) / (2.0 * h);
                let [inward, upward] = flow.velocity(x, z);
                assert!((inward - 2.28 * slope).abs() < 1e-6, "at {x}, {z}");
                assert_eq!(upward, -here);
            }
        }
        // Verification: 9.55 d at z = 20 d, 11.70 d at 30 d, 16.54 d at 60 d.
        for (z, sigma) in [(20.0, 9.55), (30.0, 11.70), (60.0, 16.54)] {
            assert!((FLOWS[0].standard_deviation(z) - sigma).abs() < 0.005);
        }
    }
}
