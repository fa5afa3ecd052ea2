//! Impacts of single pairs in closed form.

use super::restitution::time_scale;
use std::f64::consts::PI;

/// An elastic head-on impact of two equal spheres, in Hertz's theory (Landau and Lifshitz, Theory
/// of Elasticity, section 9).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Effective mass m1 m2 / (m1 + m2) (kg).
    pub effective_mass: f64,
    /// K = 2 Y sqrt(R_eff) / (3 (1 - nu^2)) (N/m^1.5), of F = K xi^1.5.
    pub stiffness: f64,
    /// Relative speed (m/s).
    pub speed: f64,
}

impl Impact {
    /// Two spheres of one radius (m) and mass (kg), with Young's modulus (Pa) and Poisson's ratio,
    /// at a relative speed (m/s).
    pub fn of_equal_spheres(
        radius: f64,
        mass: f64,
        young_modulus: f64,
        poisson_ratio: f64,
        speed: f64,
    ) -> Self {
        let effective_radius = 0.5 * radius;
        Self {
            effective_mass: 0.5 * mass,
            stiffness: 2.0 * young_modulus * effective_radius.sqrt()
                / (3.0 * (1.0 - poisson_ratio * poisson_ratio)),
            speed,
        }
    }

    /// T = (m_eff / K)^(2/5) v^(-1/5) (s).
    pub fn time_scale(&self) -> f64 {
        time_scale(self.effective_mass, self.stiffness, self.speed)
    }

    /// The impact whose deepest overlap is `overlap` (m). It rebounds like a pair released at rest
    /// from this overlap.
    pub fn from_overlap(self, overlap: f64) -> Self {
        let speed_squared = 0.8 * self.stiffness * overlap * overlap * overlap.sqrt();
        Self {
            speed: (speed_squared / self.effective_mass).sqrt(),
            ..self
        }
    }

    /// This impact, or the release from an overlap (m) if that is faster.
    pub(super) fn or_release_from(self, overlap: f64) -> Self {
        let release = self.from_overlap(overlap);
        if release.speed > self.speed {
            release
        } else {
            self
        }
    }

    /// Duration of the contact, 3.218065460 T (s).
    pub fn contact_time(&self) -> f64 {
        3.218_065_460 * self.time_scale()
    }

    /// Deepest overlap, (5/4)^(2/5) v T (m).
    pub fn deepest_overlap(&self) -> f64 {
        libm::pow(1.25, 0.4) * self.speed * self.time_scale()
    }

    /// Largest force (N).
    pub fn largest_force(&self) -> f64 {
        let overlap = self.deepest_overlap();
        self.stiffness * overlap * overlap.sqrt()
    }

    /// Angular frequency w (1/s) of the linearised contact at its deepest overlap, where it is
    /// stiffest: w^2 = (3/2) K sqrt(xi) / m_eff, so that 2/w = contact time / 2.015.
    pub fn angular_frequency(&self) -> f64 {
        (1.5 * self.stiffness * self.deepest_overlap().sqrt() / self.effective_mass).sqrt()
    }
}

/// A head-on impact under F = k delta + b d(delta)/dt, from the first touch until the centres are
/// as far apart again: half a period of a damped oscillator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearImpact {
    /// Effective mass m1 m2 / (m1 + m2) (kg).
    pub effective_mass: f64,
    /// Spring constant k (N/m).
    pub stiffness: f64,
    /// Drag constant b (N s/m).
    pub damping: f64,
}

impl LinearImpact {
    /// Angular frequency w = sqrt(k / m_eff) without damping (1/s).
    pub fn angular_frequency(&self) -> f64 {
        (self.stiffness / self.effective_mass).sqrt()
    }

    /// Rate g = b / m_eff at which the damping slows the approach (1/s).
    pub fn damping_rate(&self) -> f64 {
        self.damping / self.effective_mass
    }

    /// Duration of the contact (s), pi / sqrt(w^2 - g^2 / 4); infinite if it is overdamped.
    pub fn contact_time(&self) -> f64 {
        let (frequency, rate) = (self.angular_frequency(), self.damping_rate());
        let squared = frequency * frequency - 0.25 * rate * rate;
        if squared > 0.0 {
            PI / squared.sqrt()
        } else {
            f64::INFINITY
        }
    }

    /// Coefficient of restitution, exp(-g t_c / 2); zero if it is overdamped.
    pub fn restitution(&self) -> f64 {
        match self.contact_time() {
            time if time.is_finite() => libm::exp(-0.5 * self.damping_rate() * time),
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impacts_of_the_silo() {
        // m = rho R^2 with rho = 1, R = 0.04; k = 100, b = 0.05: a pair, and a grain on a fixed
        // one.
        let mass = 1.0 * 0.04 * 0.04;
        let cases = [
            (0.5 * mass, 8.921e-3, 0.756_713, 5.657e-3),
            (mass, 1.2591e-2, 0.821_409, 8.0e-3),
        ];
        for (effective_mass, contact_time, restitution, limit) in cases {
            let impact = LinearImpact {
                effective_mass,
                stiffness: 100.0,
                damping: 0.05,
            };
            assert!((impact.contact_time() / contact_time - 1.0).abs() < 1e-4);
            assert!((impact.restitution() / restitution - 1.0).abs() < 1e-5);
            assert!((2.0 / impact.angular_frequency() / limit - 1.0).abs() < 1e-4);
        }
    }
}
