//! The spheres that contacts read.

use super::contact_block::EarlierRows;
use super::wall_contacts::NearSphere;
use crate::dem::bodies::SphereRows;
use crate::dem::neighbours::NearPair;
use crate::particles::block::BLOCK;
use crate::particles::vector::Vector;
use crate::particles::{Domain, Particles};
use std::ops::Range;

/// The spheres that contacts read: all spheres, the spheres of a thread, or copies. Contacts are
/// computed with indices that count from the first of these.
#[derive(Clone, Copy)]
pub(super) struct Partners<'a> {
    /// The index of the first one.
    pub(super) first: u32,
    /// The space in which they move.
    pub(super) domain: Domain,
    /// Centres (m).
    pub(super) position: &'a [Vector],
    /// Velocities (m/s).
    pub(super) velocity: &'a [Vector],
    /// Spins (rad/s), of spheres that rotate.
    pub(super) spin: &'a [Vector],
    /// Radii (m).
    pub(super) radius: &'a [f64],
    /// Masses (kg).
    pub(super) mass: &'a [f64],
    /// Inverse masses (1/kg).
    pub(super) inverse_mass: &'a [f64],
    /// Moments of inertia (kg m2), of spheres that rotate.
    pub(super) inertia: &'a [f64],
    /// Velocities and spins that load springs, if they differ from the present ones.
    pub(super) earlier: &'a [EarlierRows],
}

impl<'a> Partners<'a> {
    /// All spheres.
    pub(super) fn all(particles: &'a Particles, earlier: &'a [EarlierRows]) -> Self {
        let Particles {
            domain,
            position,
            velocity,
            spin,
            radius,
            mass,
            inverse_mass,
            inertia,
            ..
        } = particles;
        Self {
            first: 0,
            domain: *domain,
            position,
            velocity,
            spin,
            radius,
            mass,
            inverse_mass,
            inertia,
            earlier,
        }
    }

    /// These spheres, with the velocities and spins that load springs; and their forces and
    /// torques.
    pub(super) fn of(
        spheres: &'a mut SphereRows<'_>,
        earlier: &'a [EarlierRows],
    ) -> (Self, [&'a mut [Vector]; 2]) {
        let partners = Self {
            first: spheres.first as u32,
            domain: spheres.domain,
            position: spheres.position,
            velocity: spheres.velocity,
            spin: spheres.spin,
            radius: spheres.radius,
            mass: spheres.mass,
            inverse_mass: spheres.inverse_mass,
            inertia: spheres.inertia,
            earlier,
        };
        (partners, [spheres.force, spheres.torque])
    }

    /// The index among all spheres of the first of `spheres` that forces move. Indices in `spheres`
    /// are counted from the first of these partners. A contact of other spheres moves nothing,
    /// however deep it is.
    #[inline(always)]
    pub(super) fn first_to_yield(&self, spheres: &[u32]) -> Option<usize> {
        let mut all = spheres.iter();
        let yielding = all.find(|sphere| self.inverse_mass[**sphere as usize] > 0.0);
        yielding.map(|sphere| (sphere + self.first) as usize)
    }

    /// Pairs with indices counted from the first of these partners. `buffer` holds them, if they
    /// differ from the given ones.
    #[inline(always)]
    pub(super) fn local_pairs<'p>(
        &self,
        pairs: &'p [NearPair],
        buffer: &'p mut [NearPair],
    ) -> &'p [NearPair] {
        if self.first == 0 {
            return pairs;
        }
        let first = NearPair::new(self.first, self.first).word();
        for (local, pair) in buffer.iter_mut().zip(pairs) {
            *local = NearPair::of_word(pair.word() - first);
        }
        &buffer[..pairs.len()]
    }

    /// Spheres at a wall with indices counted from the first of these partners, as above.
    #[inline(always)]
    pub(super) fn local_spheres<'p>(
        &self,
        spheres: &'p [NearSphere; BLOCK],
        buffer: &'p mut [NearSphere; BLOCK],
    ) -> &'p [NearSphere; BLOCK] {
        if self.first == 0 {
            return spheres;
        }
        for (local, sphere) in buffer.iter_mut().zip(spheres) {
            local.i = sphere.i - self.first;
        }
        buffer
    }
}

/// Copies of positions and velocities of some spheres.
#[derive(Default)]
pub(super) struct Copies {
    /// Their indices.
    pub(super) spheres: Range<usize>,
    position: Vec<Vector>,
    velocity: Vec<Vector>,
    spin: Vec<Vector>,
}

impl Copies {
    /// Copies the spheres as they are now, out of all.
    pub(super) fn renew(&mut self, all: &SphereRows<'_>) {
        let columns = [
            (&mut self.position, &*all.position),
            (&mut self.velocity, &*all.velocity),
            (&mut self.spin, &*all.spin),
        ];
        for (copies, all) in columns {
            copies.clear();
            copies.extend_from_slice(part(all, &self.spheres));
        }
    }

    /// These spheres. Their constant properties are read from the original arrays.
    pub(super) fn partners<'a>(&'a self, all: &SphereRows<'a>) -> Partners<'a> {
        Partners {
            first: self.spheres.start as u32,
            domain: all.domain,
            position: &self.position,
            velocity: &self.velocity,
            spin: &self.spin,
            radius: part(all.radius, &self.spheres),
            mass: part(all.mass, &self.spheres),
            inverse_mass: part(all.inverse_mass, &self.spheres),
            inertia: part(all.inertia, &self.spheres),
            earlier: &[],
        }
    }
}

/// These entries of an array, or an empty slice if the array is empty.
fn part<'a, E>(all: &'a [E], range: &Range<usize>) -> &'a [E] {
    all.get(range.clone()).unwrap_or_default()
}
