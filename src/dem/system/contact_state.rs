//! Position, motion and properties of the two partners of a contact.

use super::contact_laws::Laws;
use super::partners::Partners;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::particles::Particles;
use crate::particles::block::VectorRow;
use crate::particles::vector::Vector;

/// Two spheres at a contact, or a sphere and a wall. Forces act on the first.
#[derive(Clone, Copy)]
pub(super) struct ContactState {
    /// Offset of the first centre from the second, or from the origin (m).
    pub(super) offset: Vector,
    /// Velocity of the first relative to the second (m/s).
    pub(super) velocity: Vector,
    /// Spins (rad/s).
    pub(super) spin: [Vector; 2],
    /// Radius, mass and inertia of both.
    pub(super) properties: [SphereProperties; 2],
    /// 1 / (r1 + r2) (1/m).
    pub(super) inverse_sum: f64,
    /// The earlier motion, if it loads springs instead of the present motion.
    pub(super) earlier: Option<EarlierMotion>,
}

impl ContactState {
    /// Two spheres.
    pub(super) fn of_pair(spheres: &Partners<'_>, i: u32, j: u32) -> Self {
        let (one, other) = (Self::at_wall(spheres, i), Self::at_wall(spheres, j));
        let earlier = one.earlier.zip(other.earlier);
        Self {
            offset: spheres.domain.offset(one.offset, other.offset),
            velocity: one.velocity - other.velocity,
            spin: [one.spin[0], other.spin[0]],
            properties: [one.properties[0], other.properties[0]],
            inverse_sum: 1.0 / (one.properties[0].radius + other.properties[0].radius),
            earlier: earlier.map(|(one, other)| EarlierMotion {
                velocity: one.velocity - other.velocity,
                spin: [one.spin[0], other.spin[0]],
            }),
        }
    }

    /// A sphere at a wall.
    pub(super) fn at_wall(spheres: &Partners<'_>, i: u32) -> Self {
        let i = i as usize;
        let of = |vectors: &[Vector]| vectors.get(i).copied().unwrap_or_default();
        let sphere = SphereProperties {
            radius: spheres.radius[i],
            mass: spheres.mass[i],
            inverse_mass: spheres.inverse_mass[i],
            inertia: spheres.inertia.get(i).copied().unwrap_or(0.0),
        };
        let earlier = spheres.earlier.get(i);
        Self {
            offset: spheres.position[i],
            velocity: spheres.velocity[i],
            spin: [of(spheres.spin), Vector::ZERO],
            properties: [sphere, SphereProperties::WALL],
            inverse_sum: 1.0 / sphere.radius,
            earlier: earlier.map(|&[velocity, spin]: &[VectorRow; 2]| EarlierMotion {
                velocity: Vector::of_row(velocity),
                spin: [Vector::of_row(spin), Vector::ZERO],
            }),
        }
    }

    /// r1 r2 / (r1 + r2) (m).
    #[inline(always)]
    pub(super) fn effective_radius(&self) -> f64 {
        let [one, other] = self.properties;
        one.radius * other.radius * self.inverse_sum
    }
}

/// Properties of a sphere, which do not change with time.
#[derive(Clone, Copy, Default)]
pub(super) struct SphereProperties {
    /// Radius (m).
    pub(super) radius: f64,
    /// Mass (kg).
    pub(super) mass: f64,
    /// Inverse mass (1/kg), zero for what does not move.
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

    /// The properties of the spheres that move, if all spheres are alike to the laws.
    pub(super) fn of_all<N: NormalLaw, T: TangentialLaw>(particles: &Particles) -> Option<Self> {
        let Particles {
            fixed,
            radius,
            mass,
            inverse_mass,
            inertia,
            ..
        } = particles;
        let same = |values: &[f64]| values.windows(2).all(|pair| pair[0] == pair[1]);
        // Only the effective mass distinguishes spheres at rest from others. Fixed ones come first,
        // and a block of pairs looks at them; driven ones may be anywhere.
        let reads_inverse_mass = Laws::<N, T>::NEEDS_EFFECTIVE_MASS;
        let alike = same(radius)
            && same(mass)
            && same(inertia)
            && (!reads_inverse_mass || same(inverse_mass.get(*fixed..).unwrap_or_default()));
        let first = |values: &[f64]| {
            values
                .get(*fixed)
                .or(values.first())
                .copied()
                .unwrap_or(0.0)
        };
        alike.then(|| Self {
            radius: first(radius),
            mass: first(mass),
            inverse_mass: first(inverse_mass),
            inertia: first(inertia),
        })
    }
}

/// Earlier relative velocity (m/s) and spins (rad/s).
#[derive(Clone, Copy)]
pub(super) struct EarlierMotion {
    pub(super) velocity: Vector,
    pub(super) spin: [Vector; 2],
}
