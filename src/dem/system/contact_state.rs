//! Position, motion and properties of the two at a contact.

use crate::particles::Particles;
use crate::particles::vector::Vector;

/// Two spheres at a contact, or a sphere and a wall. Forces act on the first.
#[derive(Clone, Copy)]
pub(super) struct ContactState {
    /// Centre of the first from that of the second, or from the origin (m).
    pub(super) offset: Vector,
    /// Velocity of the first relative to the second (m/s).
    pub(super) velocity: Vector,
    /// Spins (rad/s).
    pub(super) spin: [Vector; 2],
    /// Radius, mass and inertia of both.
    pub(super) properties: [SphereProperties; 2],
    /// 1 / (r1 + r2) (1/m).
    pub(super) inverse_sum: f64,
    /// Their earlier motion, if springs are loaded by that and not by the present one.
    pub(super) earlier: Option<EarlierMotion>,
}

impl ContactState {
    /// r1 r2 / (r1 + r2) (m).
    #[inline(always)]
    pub(super) fn effective_radius(&self) -> f64 {
        let [one, other] = self.properties;
        one.radius * other.radius * self.inverse_sum
    }
}

/// What of a sphere does not change with time.
#[derive(Clone, Copy, Default)]
pub(super) struct SphereProperties {
    /// Radius (m).
    pub(super) radius: f64,
    /// Mass (kg).
    pub(super) mass: f64,
    /// Inverse mass (1/kg), zero of what does not move.
    pub(super) inverse_mass: f64,
    /// Moment of inertia (kg m2).
    pub(super) inertia: f64,
}

impl SphereProperties {
    /// A wall, which friction treats as a body at rest.
    pub(super) const WALL: Self = Self {
        radius: 0.0,
        mass: 0.0,
        inverse_mass: 0.0,
        inertia: 0.0,
    };

    /// The properties of all spheres, if they are alike; `mobile` says whether it matters that some
    /// are fixed.
    pub(super) fn of_all(particles: &Particles, mobile: bool) -> Option<Self> {
        let Particles {
            radius,
            mass,
            inverse_mass,
            inertia,
            ..
        } = particles;
        let same = |values: &[f64]| values.windows(2).all(|pair| pair[0] == pair[1]);
        let alike = same(radius) && same(mass) && same(inertia) && (!mobile || same(inverse_mass));
        let first = |values: &[f64]| values.first().copied().unwrap_or(0.0);
        alike.then(|| Self {
            radius: first(radius),
            mass: first(mass),
            inverse_mass: first(inverse_mass),
            inertia: first(inertia),
        })
    }
}

/// Relative velocity (m/s) and spins (rad/s) before.
#[derive(Clone, Copy)]
pub(super) struct EarlierMotion {
    pub(super) velocity: Vector,
    pub(super) spin: [Vector; 2],
}
