//! Blocks of contacts: what the laws answer for many pairs at once.
//!
//! For all pairs of a block, touching or not, the laws are computed in a loop that the compiler turns
//! into vector instructions; a pair that does not touch gets a force of zero. Then the forces are added up
//! one by one in the order of the list. Adding zero to a sum that began at +0 changes no bit of it.

use super::meeting::{Couple, Earlier, Laws, Meeting, Solid};
use super::wall_contacts::NearSphere;
use crate::dem::block::{BLOCK, Column, Columns, Row};
use crate::dem::contact::NormalLaw;
use crate::dem::friction::{History, Spring, TangentialLaw};
use crate::dem::neighbours::NearPair;
use crate::dem::particles::Particles;
use crate::dem::vector::Vector;
use crate::dem::walls::Wall;
use fearless_simd::{Simd, SimdFrom, f64x4};
use std::marker::PhantomData;

/// Stands for an overlap within the limit; no touching pair has a negative one.
const NOT_DEEP: f64 = -1.0;

/// Velocity and spin of a sphere before an evaluation of forces, in rows.
pub(super) type EarlierRows = [Row; 2];

/// What of the spheres of a block does not change.
struct Solids {
    radius: Column,
    mass: Column,
    inertia: Column,
}

impl Solids {
    fn all(solid: Solid) -> Self {
        Self {
            radius: [solid.radius; BLOCK],
            mass: [solid.mass; BLOCK],
            inertia: [solid.inertia; BLOCK],
        }
    }

    #[inline(always)]
    fn at(&self, k: usize) -> Solid {
        Solid {
            radius: self.radius[k],
            mass: self.mass[k],
            inertia: self.inertia[k],
        }
    }
}

/// Everything about the pairs of a block.
pub(super) struct PairBlock<H> {
    index: [[u32; BLOCK]; 2],
    /// Centre of the first partner from that of the second, or from the origin at a wall (m).
    offset: Columns,
    /// Velocity of the first relative to the second (m/s).
    velocity: Columns,
    /// Spins of both (rad/s).
    spin: [Columns; 2],
    /// The same of before, if springs are loaded by those.
    earlier_velocity: Columns,
    earlier_spin: [Columns; 2],
    /// What does not change from step to step, of both.
    solid: [Solids; 2],
    /// Forces of springs (N).
    spring: Columns,
    force: Columns,
    torque: [Columns; 2],
    /// Overlap of a pair beyond the limit (m), else [`NOT_DEEP`].
    too_deep: Column,
    memory: PhantomData<H>,
}

impl<H: History> PairBlock<H> {
    /// Whether the law has a history.
    pub(super) const REMEMBERS: bool = size_of::<H>() > 0;

    pub(super) fn new() -> Self {
        let pair = || [Columns::ZERO, Columns::ZERO];
        Self {
            index: [[0; BLOCK]; 2],
            offset: Columns::ZERO,
            velocity: Columns::ZERO,
            spin: pair(),
            earlier_velocity: Columns::ZERO,
            earlier_spin: pair(),
            solid: [Solids::all(Solid::WALL), Solids::all(Solid::WALL)],
            spring: Columns::ZERO,
            memory: PhantomData,
            force: Columns::ZERO,
            torque: pair(),
            too_deep: [NOT_DEEP; BLOCK],
        }
    }

    /// Forgets the pairs of the past, which lanes without a pair repeat.
    pub(super) fn forget(&mut self) {
        self.index = [[0; BLOCK]; 2];
    }

    #[inline(always)]
    fn vector(columns: &Columns, k: usize) -> Vector {
        let [x, y, z, _] = &columns.0;
        Vector::new(x[k], y[k], z[k])
    }

    #[inline(always)]
    fn take_spring(&mut self, k: usize, history: H) {
        let Vector { x, y, z, .. } = history.spring().force;
        self.spring.set(k, [x, y, z, 0.0]);
    }

    /// What a contact of the block remembers.
    #[inline(always)]
    pub(super) fn history(&self, k: usize) -> H {
        let force = Self::vector(&self.spring, k);
        H::of_spring(Spring { force })
    }

    /// Says what all spheres are like, if they are alike: it is then not fetched.
    pub(super) fn set_alike(&mut self, alike: Option<Solid>) {
        if let Some(solid) = alike {
            self.solid = [Solids::all(solid), Solids::all(solid)];
        }
    }

    /// Fetches what of the spheres of one side does not change.
    #[inline(always)]
    fn gather_solid<T: TangentialLaw>(&mut self, side: usize, particles: &Particles) {
        let Solids {
            radius,
            mass,
            inertia,
        } = &mut self.solid[side];
        for (k, &i) in self.index[side].iter().enumerate() {
            radius[k] = particles.radius[i as usize];
        }
        if T::WEIGHS {
            for (k, &i) in self.index[side].iter().enumerate() {
                mass[k] = particles.mass[i as usize];
                inertia[k] = particles.inertia[i as usize];
            }
        }
    }

    /// Fetches the spheres of pairs. Lanes without a contact hold what an earlier block left.
    #[inline(always)]
    pub(super) fn gather_pairs<S: Simd, T: TangentialLaw<History = H>>(
        &mut self,
        simd: S,
        particles: &Particles,
        earlier: &[EarlierRows],
        alike: bool,
    ) {
        let (position, velocity) = (&particles.position, &particles.velocity);
        self.offset.gather_differences(
            simd,
            &self.index,
            #[inline(always)]
            |i| position[i].row(),
        );
        self.velocity.gather_differences(
            simd,
            &self.index,
            #[inline(always)]
            |i| velocity[i].row(),
        );
        if T::ROTATES {
            self.gather_spin(simd, 0, &particles.spin);
            self.gather_spin(simd, 1, &particles.spin);
        }
        if !alike {
            self.gather_solid::<T>(0, particles);
            self.gather_solid::<T>(1, particles);
        }
        if Self::REMEMBERS && !earlier.is_empty() {
            self.earlier_velocity.gather_differences(
                simd,
                &self.index,
                #[inline(always)]
                |i| earlier[i][0],
            );
            self.gather_earlier_spin(simd, 0, earlier);
            self.gather_earlier_spin(simd, 1, earlier);
        }
    }

    /// Fetches spheres near a wall.
    #[inline(always)]
    pub(super) fn gather_spheres<S: Simd, T: TangentialLaw<History = H>>(
        &mut self,
        simd: S,
        particles: &Particles,
        earlier: &[EarlierRows],
        alike: bool,
    ) {
        let index = &self.index[0];
        let (position, velocity) = (&particles.position, &particles.velocity);
        self.offset.gather(
            simd,
            index,
            #[inline(always)]
            |i| position[i].row(),
        );
        self.velocity.gather(
            simd,
            index,
            #[inline(always)]
            |i| velocity[i].row(),
        );
        if T::ROTATES {
            self.gather_spin(simd, 0, &particles.spin);
        }
        if !alike {
            self.gather_solid::<T>(0, particles);
        }
        if Self::REMEMBERS && !earlier.is_empty() {
            self.earlier_velocity.gather(
                simd,
                &self.index[0],
                #[inline(always)]
                |i| earlier[i][0],
            );
            self.gather_earlier_spin(simd, 0, earlier);
        }
    }

    #[inline(always)]
    fn gather_spin<S: Simd>(&mut self, simd: S, side: usize, spin: &[Vector]) {
        self.spin[side].gather(
            simd,
            &self.index[side],
            #[inline(always)]
            |i| spin[i].row(),
        );
    }

    #[inline(always)]
    fn gather_earlier_spin<S: Simd>(&mut self, simd: S, side: usize, earlier: &[EarlierRows]) {
        self.earlier_spin[side].gather(
            simd,
            &self.index[side],
            #[inline(always)]
            |i| earlier[i][1],
        );
    }

    /// Takes pairs, up to a block of them, with what they remember: histories are those from entry
    /// `first` on.
    #[inline(always)]
    pub(super) fn take_pairs(&mut self, pairs: &[NearPair], histories: &[H], first: usize) {
        for (k, pair) in pairs.iter().enumerate() {
            self.index[0][k] = pair.i;
            self.index[1][k] = pair.j;
        }
        if Self::REMEMBERS {
            for (k, pair) in pairs.iter().enumerate() {
                self.take_spring(k, histories[pair.entry as usize - first]);
            }
        }
    }

    /// The same with spheres near a wall.
    #[inline(always)]
    pub(super) fn take_spheres(&mut self, spheres: &[NearSphere], histories: &[H], first: usize) {
        for (k, sphere) in spheres.iter().enumerate() {
            self.index[0][k] = sphere.i;
        }
        if Self::REMEMBERS {
            for (k, sphere) in spheres.iter().enumerate() {
                self.take_spring(k, histories[sphere.entry as usize - first]);
            }
        }
    }

    /// Computes the laws for every pair.
    #[inline(always)]
    pub(super) fn interact<N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        laws: &Laws<N, T>,
    ) {
        // Two loops, as a branch in one would keep it from being turned into vector instructions.
        match Self::REMEMBERS && laws.loading.age > 0.0 {
            true => self.interact_as::<N, T, true>(laws),
            false => self.interact_as::<N, T, false>(laws),
        }
    }

    #[inline(always)]
    fn interact_as<N: NormalLaw, T: TangentialLaw<History = H>, const EARLIER: bool>(
        &mut self,
        laws: &Laws<N, T>,
    ) {
        for k in 0..BLOCK {
            let couple = self.couple::<T, EARLIER>(k, self.solid[1].at(k));
            let meeting = laws.between(&couple, self.spring(k));
            self.keep::<T>(k, &meeting);
        }
    }

    /// Computes the laws for every sphere at a wall.
    #[inline(always)]
    pub(super) fn interact_with_wall<W: Wall, N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        wall: W,
        laws: &Laws<N, T>,
    ) {
        match Self::REMEMBERS && laws.loading.age > 0.0 {
            true => self.interact_with_wall_as::<W, N, T, true>(wall, laws),
            false => self.interact_with_wall_as::<W, N, T, false>(wall, laws),
        }
    }

    #[inline(always)]
    fn interact_with_wall_as<
        W: Wall,
        N: NormalLaw,
        T: TangentialLaw<History = H>,
        const EARLIER: bool,
    >(
        &mut self,
        wall: W,
        laws: &Laws<N, T>,
    ) {
        for k in 0..BLOCK {
            let mut couple = self.couple::<T, EARLIER>(k, Solid::WALL);
            couple.spin[1] = Vector::ZERO;
            if let Some(earlier) = &mut couple.earlier {
                earlier.spin[1] = Vector::ZERO;
            }
            let meeting = laws.at_wall(wall, &couple, self.spring(k));
            self.keep::<T>(k, &meeting);
        }
    }

    /// The partners of a contact, the second of them like that, with what they did before if springs are
    /// loaded by that.
    #[inline(always)]
    fn couple<T: TangentialLaw, const EARLIER: bool>(&self, k: usize, other: Solid) -> Couple {
        let mut couple = Couple {
            offset: Self::vector(&self.offset, k),
            velocity: Self::vector(&self.velocity, k),
            spin: [Vector::ZERO; 2],
            solid: [self.solid[0].at(k), other],
            earlier: None,
        };
        if T::ROTATES {
            couple.spin = [0, 1].map(|side| Self::vector(&self.spin[side], k));
        }
        if EARLIER {
            couple.earlier = Some(Earlier {
                velocity: Self::vector(&self.earlier_velocity, k),
                spin: [0, 1].map(|side| Self::vector(&self.earlier_spin[side], k)),
            });
        }
        couple
    }

    #[inline(always)]
    fn spring(&self, k: usize) -> Spring {
        let force = match Self::REMEMBERS {
            true => Self::vector(&self.spring, k),
            false => Vector::ZERO,
        };
        Spring { force }
    }

    /// Keeps what the laws answered.
    #[inline(always)]
    fn keep<T: TangentialLaw>(&mut self, k: usize, meeting: &Meeting) {
        let touches = meeting.touches;
        self.too_deep[k] = if meeting.too_deep {
            meeting.overlap
        } else {
            NOT_DEEP
        };
        store(&mut self.force, k, touches, meeting.force);
        if T::ROTATES {
            store(&mut self.torque[0], k, touches, meeting.torque[0]);
            store(&mut self.torque[1], k, touches, meeting.torque[1]);
        }
        if Self::REMEMBERS {
            store(&mut self.spring, k, touches, meeting.spring.force);
        }
    }

    /// The first of so many contacts that is too deep: its lane and overlap.
    #[inline(always)]
    pub(super) fn first_too_deep(&self, contacts: usize) -> Option<(usize, f64)> {
        let any = |any, &overlap: &f64| any | (overlap != NOT_DEEP);
        if !self.too_deep.iter().fold(false, any) {
            return None;
        }
        (0..contacts)
            .find(|&k| self.too_deep[k] != NOT_DEEP)
            .map(|k| (k, self.too_deep[k]))
    }

    /// Adds forces and torques of a wall to the spheres.
    #[inline(always)]
    pub(super) fn scatter_to_spheres<S: Simd, T: TangentialLaw<History = H>>(
        &self,
        simd: S,
        spheres: &[NearSphere],
        sums: &mut Sums<'_>,
    ) {
        let mut sums = sums.here();
        for (at, four) in (0..BLOCK).step_by(4).zip(spheres.chunks(4)) {
            let force = self.force.rows(simd, at);
            let torque = if T::ROTATES {
                self.torque[0].rows(simd, at)
            } else {
                force
            };
            for (k, sphere) in four.iter().enumerate() {
                sums.add::<S, T>(simd, sphere.i, force[k], torque[k]);
            }
        }
    }

    /// Adds forces and torques to those partners whose sums these are, pair by pair.
    #[inline(always)]
    pub(super) fn scatter<S: Simd, T: TangentialLaw<History = H>>(
        &self,
        simd: S,
        pairs: &[NearPair],
        sums: &mut Sums<'_>,
    ) {
        let mut sums = sums.here();
        for (at, four) in (0..BLOCK).step_by(4).zip(pairs.chunks(4)) {
            let force = self.force.rows(simd, at);
            let torque = if T::ROTATES {
                [self.torque[0].rows(simd, at), self.torque[1].rows(simd, at)]
            } else {
                [force; 2]
            };
            for (k, pair) in four.iter().enumerate() {
                sums.add::<S, T>(simd, pair.i, force[k], torque[0][k]);
                sums.add::<S, T>(simd, pair.j, -force[k], torque[1][k]);
            }
        }
    }
}

/// Forces and torques of the spheres from one on, or of all.
pub(super) struct Sums<'a> {
    /// The index of the first one.
    pub(super) first: usize,
    /// Forces (N).
    pub(super) force: &'a mut [Vector],
    /// Torques (N m), of spheres that turn.
    pub(super) torque: &'a mut [Vector],
}

impl Sums<'_> {
    /// The same, for a loop: whose bounds then stay in registers, whatever is written.
    #[inline(always)]
    fn here(&mut self) -> Sums<'_> {
        Sums {
            first: self.first,
            force: self.force,
            torque: self.torque,
        }
    }

    /// Adds to a sphere, if it is one of these.
    #[inline(always)]
    fn add<S: Simd, T: TangentialLaw>(
        &mut self,
        simd: S,
        sphere: u32,
        force: f64x4<S>,
        torque: f64x4<S>,
    ) {
        let at = (sphere as usize).wrapping_sub(self.first);
        if let Some(sum) = self.force.get_mut(at) {
            add(simd, sum, force);
        }
        if T::ROTATES
            && let Some(sum) = self.torque.get_mut(at)
        {
            add(simd, sum, torque);
        }
    }
}

#[inline(always)]
fn add<S: Simd>(simd: S, sum: &mut Vector, row: f64x4<S>) {
    *sum = Vector::of_row((f64x4::simd_from(simd, sum.row()) + row).into());
}

/// Stores what acts on a touching pair.
#[inline(always)]
fn store(columns: &mut Columns, k: usize, touches: bool, vector: Vector) {
    let [x, y, z, _] = &mut columns.0;
    x[k] = if touches { vector.x } else { 0.0 };
    y[k] = if touches { vector.y } else { 0.0 };
    z[k] = if touches { vector.z } else { 0.0 };
}
