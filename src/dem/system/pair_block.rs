//! Blocks of contacts: what the laws answer for many pairs at once.
//!
//! For all pairs of a block, touching or not, the laws are computed in a loop that the compiler turns
//! into vector instructions; a pair that does not touch gets a force of zero. Then the forces are added up
//! one by one in the order of the list. Adding zero to a sum that began at +0 changes no bit of it.

use crate::dem::block::{BLOCK, Column, Columns, Row};
use crate::dem::contact::NormalLaw;
use crate::dem::friction::{History, Spring, TangentialLaw, Touch, sliding_velocity};
use crate::dem::neighbours::NearPair;
use crate::dem::particles::Particles;
use crate::dem::vector::Vector;
use crate::dem::walls::{Wall, WallContact};
use fearless_simd::{Simd, SimdFrom, f64x4};
use std::marker::PhantomData;

/// Stands for an overlap within the limit; no touching pair has a negative one.
const NOT_DEEP: f64 = -1.0;

/// The time that springs are loaded over until an evaluation of forces, with the mean velocities of that
/// time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loading {
    /// How long it is (s).
    pub(super) duration: f64,
    /// How long before the evaluation the spheres had the velocities that load springs (s): these are
    /// then kept in rows of their own. Zero if they are those of the evaluation.
    pub(super) age: f64,
}

impl Loading {
    /// Over a time (s), by the velocities of the evaluation.
    pub(super) fn present(duration: f64) -> Self {
        Self { duration, age: 0.0 }
    }

    /// Over a time (s), by velocities that are that old (s).
    pub(super) fn earlier(duration: f64, age: f64) -> Self {
        Self { duration, age }
    }
}

/// Velocity and spin of a sphere before an evaluation of forces, in rows.
pub(super) type Earlier = [Row; 2];

/// The laws of a step's contacts.
#[derive(Clone, Copy)]
pub(super) struct Laws<N, T> {
    pub(super) normal: N,
    pub(super) tangential: T,
    pub(super) loading: Loading,
    pub(super) overlap_limit: f64,
}

/// A contact and what its laws answered.
pub(super) struct Meeting {
    /// Unit normal, towards the sphere that the force acts on.
    pub(super) normal: Vector,
    /// Velocity of its centre relative to the other (m/s).
    pub(super) velocity: Vector,
    /// Overlap (m).
    pub(super) overlap: f64,
    /// Effective radius (m).
    pub(super) effective_radius: f64,
    /// Force (N).
    pub(super) force: Vector,
    /// Torques on both partners (N m), zero without rotation.
    pub(super) torque: [Vector; 2],
}

/// What of a sphere does not change, or of several.
#[derive(Clone, Copy)]
pub(super) struct Solid<V> {
    /// Radius (m).
    pub(super) radius: V,
    /// Mass (kg).
    pub(super) mass: V,
    /// Moment of inertia (kg m2).
    pub(super) inertia: V,
}

impl<V: Copy> Solid<V> {
    fn all(value: V) -> Self {
        Self {
            radius: value,
            mass: value,
            inertia: value,
        }
    }
}

impl Solid<f64> {
    /// What all spheres are like, if they are alike.
    pub(super) fn of_all(particles: &Particles) -> Option<Self> {
        let Particles {
            radius,
            mass,
            inertia,
            ..
        } = particles;
        let same = |values: &[f64]| values.windows(2).all(|pair| pair[0] == pair[1]);
        let alike = same(radius) && same(mass) && same(inertia);
        let first = |values: &[f64]| values.first().copied().unwrap_or(0.0);
        alike.then(|| Self {
            radius: first(radius),
            mass: first(mass),
            inertia: first(inertia),
        })
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
    solid: [Solid<Column>; 2],
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
    const REMEMBERS: bool = size_of::<H>() > 0;

    pub(super) fn new() -> Self {
        let pair = || [Columns::ZERO, Columns::ZERO];
        Self {
            index: [[0; BLOCK]; 2],
            offset: Columns::ZERO,
            velocity: Columns::ZERO,
            spin: pair(),
            earlier_velocity: Columns::ZERO,
            earlier_spin: pair(),
            solid: [Solid::all([0.0; BLOCK]); 2],
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

    /// Says what all spheres are like, if they are alike: it is then not fetched.
    pub(super) fn set_alike(&mut self, alike: Option<Solid<f64>>) {
        if let Some(solid) = alike {
            let solid = Solid {
                radius: [solid.radius; BLOCK],
                mass: [solid.mass; BLOCK],
                inertia: [solid.inertia; BLOCK],
            };
            self.solid = [solid; 2];
        }
    }

    /// Fetches what of the spheres of one side does not change.
    #[inline(always)]
    fn gather_solid(&mut self, side: usize, particles: &Particles) {
        let Solid {
            radius,
            mass,
            inertia,
        } = &mut self.solid[side];
        for (k, &i) in self.index[side].iter().enumerate() {
            let i = i as usize;
            radius[k] = particles.radius[i];
            mass[k] = particles.mass[i];
            if particles.rotate() {
                inertia[k] = particles.inertia[i];
            }
        }
    }

    /// Fetches the spheres of pairs. Lanes without a contact hold what an earlier block left.
    #[inline(always)]
    pub(super) fn gather_pairs<S: Simd, T: TangentialLaw<History = H>>(
        &mut self,
        simd: S,
        particles: &Particles,
        earlier: &[Earlier],
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
            self.gather_solid(0, particles);
            self.gather_solid(1, particles);
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
        earlier: &[Earlier],
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
            self.gather_solid(0, particles);
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

    /// Fetches spheres, of pairs or near a wall, where speed does not matter.
    pub(super) fn gather_slowly<T: TangentialLaw<History = H>>(
        &mut self,
        sides: usize,
        particles: &Particles,
        earlier: &[Earlier],
    ) {
        let pairs = sides == 2;
        let difference = |one: Row, other: Row| match pairs {
            true => std::array::from_fn(|axis| one[axis] - other[axis]),
            false => one,
        };
        for k in 0..BLOCK {
            let [i, j] = [0, 1].map(|side| self.index[side][k] as usize);
            let rows = |vectors: &[Vector]| [vectors[i].row(), vectors[j].row()];
            let [one, other] = rows(&particles.position);
            self.offset.set(k, difference(one, other));
            let [one, other] = rows(&particles.velocity);
            self.velocity.set(k, difference(one, other));
            if T::ROTATES {
                let [one, other] = rows(&particles.spin);
                self.spin[0].set(k, one);
                self.spin[1].set(k, other);
            }
            if Self::REMEMBERS && !earlier.is_empty() {
                let [one, other] = [&earlier[i], &earlier[j]];
                self.earlier_velocity.set(k, difference(one[0], other[0]));
                self.earlier_spin[0].set(k, one[1]);
                self.earlier_spin[1].set(k, other[1]);
            }
        }
        (0..sides).for_each(|side| self.gather_solid(side, particles));
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
    fn gather_earlier_spin<S: Simd>(&mut self, simd: S, side: usize, earlier: &[Earlier]) {
        self.earlier_spin[side].gather(
            simd,
            &self.index[side],
            #[inline(always)]
            |i| earlier[i][1],
        );
    }

    /// Takes pairs, up to a block of them, with what they remember.
    #[inline(always)]
    pub(super) fn take_pairs(&mut self, pairs: &[NearPair], histories: &[H]) {
        for (k, pair) in pairs.iter().enumerate() {
            self.index[0][k] = pair.i;
            self.index[1][k] = pair.j;
        }
        if Self::REMEMBERS {
            for (k, pair) in pairs.iter().enumerate() {
                self.take_spring(k, histories[pair.entry as usize]);
            }
        }
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

    /// The same with spheres near a wall.
    #[inline(always)]
    pub(super) fn take_spheres(&mut self, spheres: &[u32], histories: &[H]) {
        self.index[0][..spheres.len()].copy_from_slice(spheres);
        if Self::REMEMBERS {
            for (k, &i) in spheres.iter().enumerate() {
                self.take_spring(k, histories[i as usize]);
            }
        }
    }

    /// What became of a pair of the block, if it touches.
    pub(super) fn meeting(&self, k: usize) -> Option<Meeting> {
        let offset = Self::vector(&self.offset, k);
        let [one, other] = &self.solid;
        let radius = [one.radius[k], other.radius[k]];
        let (sum, distance) = (radius[0] + radius[1], offset.norm());
        (distance < sum).then(|| Meeting {
            normal: offset * (1.0 / distance),
            velocity: Self::vector(&self.velocity, k),
            overlap: sum - distance,
            effective_radius: radius[0] * radius[1] / sum,
            force: Self::vector(&self.force, k),
            torque: [0, 1].map(|side| Self::vector(&self.torque[side], k)),
        })
    }

    /// What became of a sphere of the block near a wall, if it touches.
    pub(super) fn meeting_with_wall<W: Wall>(&self, wall: W, k: usize) -> Option<Meeting> {
        let radius = self.solid[0].radius[k];
        let contact = wall.contact(Self::vector(&self.offset, k), radius);
        contact.touches.then(|| Meeting {
            normal: contact.normal,
            velocity: Self::vector(&self.velocity, k),
            overlap: contact.overlap,
            effective_radius: radius,
            force: Self::vector(&self.force, k),
            torque: [Self::vector(&self.torque[0], k), Vector::ZERO],
        })
    }

    /// Computes the laws for every pair.
    #[inline(always)]
    pub(super) fn interact<N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        laws: &Laws<N, T>,
    ) {
        let Laws {
            normal: normal_law,
            tangential: tangential_law,
            loading,
            overlap_limit,
        } = *laws;
        for k in 0..BLOCK {
            let offset = Self::vector(&self.offset, k);
            let [one, other] = &self.solid;
            let radius = [one.radius[k], other.radius[k]];
            let sum = radius[0] + radius[1];
            let distance_squared = offset.norm_squared();
            let touches = distance_squared < sum * sum;
            let distance = distance_squared.sqrt();
            let normal = offset * (1.0 / distance);
            let overlap = sum - distance;
            let inverse_sum = 1.0 / sum;
            let effective_radius = radius[0] * radius[1] * inverse_sum;
            let velocity = Self::vector(&self.velocity, k);
            let approach = -velocity.dot(normal);
            let normal_force = normal_law.force(overlap, approach, effective_radius);
            let lesser = if radius[0] < radius[1] {
                radius[0]
            } else {
                radius[1]
            };
            let deep = touches & ((overlap > overlap_limit * lesser) | (distance == 0.0));
            self.too_deep[k] = if deep { overlap } else { NOT_DEEP };
            let mut force = normal * normal_force;
            if N::DRAGS_SIDEWAYS {
                force -= (velocity + normal * approach) * normal_law.sideways_drag();
            }
            if T::ROTATES {
                // Both centres turn about the point where the surfaces meet, so that the pair
                // keeps its angular momentum.
                let lever = distance * inverse_sum;
                let mass = [one.mass[k], other.mass[k]];
                let lever = radius.map(|radius| radius * lever);
                let spin = [
                    Self::vector(&self.spin[0], k),
                    Self::vector(&self.spin[1], k),
                ];
                let mut loading_velocity = sliding_velocity(normal, velocity, spin, lever);
                let mut loading_overlap = overlap;
                if Self::REMEMBERS && loading.age > 0.0 {
                    let spins = &self.earlier_spin;
                    let velocity = Self::vector(&self.earlier_velocity, k);
                    let offset = offset - velocity * loading.age;
                    let distance = offset.norm();
                    let normal = offset * (1.0 / distance);
                    let spin = [Self::vector(&spins[0], k), Self::vector(&spins[1], k)];
                    loading_velocity = sliding_velocity(normal, velocity, spin, lever);
                    loading_overlap = positive(sum - distance);
                }
                let touch = Touch {
                    normal,
                    velocity,
                    spin,
                    lever,
                    inertia: [one.inertia[k], other.inertia[k]],
                    lesser_mass: if mass[0] < mass[1] { mass[0] } else { mass[1] },
                    overlap,
                    effective_radius,
                    normal_force: pressing::<N>(normal_force),
                    loading_velocity,
                    loading_overlap,
                    loading_time: loading.duration,
                };
                let mut spring = Spring::default();
                if Self::REMEMBERS {
                    spring.force = Self::vector(&self.spring, k);
                }
                let traction = tangential_law.traction(&touch, &mut spring);
                if Self::REMEMBERS {
                    store(&mut self.spring, k, touches, spring.force);
                }
                force += traction.force;
                for side in 0..2 {
                    store(&mut self.torque[side], k, touches, traction.torque[side]);
                }
            }
            store(&mut self.force, k, touches, force);
        }
    }

    /// Computes the laws for every sphere at a wall.
    #[inline(always)]
    pub(super) fn interact_with_wall<W: Wall, N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        wall: W,
        laws: &Laws<N, T>,
    ) {
        let Laws {
            normal: normal_law,
            tangential: tangential_law,
            loading,
            overlap_limit,
        } = *laws;
        for k in 0..BLOCK {
            let place = &self.offset;
            let solid = &self.solid[0];
            let radius = solid.radius[k];
            let WallContact {
                touches,
                overlap,
                normal,
            } = wall.contact(Self::vector(place, k), radius);
            let velocity = Self::vector(&self.velocity, k);
            let approach = -velocity.dot(normal);
            let normal_force = normal_law.force(overlap, approach, radius);
            let deep = touches & (overlap > overlap_limit * radius);
            self.too_deep[k] = if deep { overlap } else { NOT_DEEP };
            let mut force = normal * normal_force;
            if N::DRAGS_SIDEWAYS {
                force -= (velocity + normal * approach) * normal_law.sideways_drag();
            }
            if T::ROTATES {
                let (lever, spin) = (
                    [radius, 0.0],
                    [Self::vector(&self.spin[0], k), Vector::ZERO],
                );
                let mut loading_velocity = sliding_velocity(normal, velocity, spin, lever);
                let mut loading_overlap = overlap;
                if Self::REMEMBERS && loading.age > 0.0 {
                    let spins = &self.earlier_spin;
                    let velocity = Self::vector(&self.earlier_velocity, k);
                    let centre = Self::vector(place, k) - velocity * loading.age;
                    let contact = wall.contact(centre, radius);
                    let spin = [Self::vector(&spins[0], k), Vector::ZERO];
                    loading_velocity = sliding_velocity(contact.normal, velocity, spin, lever);
                    loading_overlap = positive(contact.overlap);
                }
                let touch = Touch {
                    normal,
                    velocity,
                    spin,
                    lever,
                    inertia: [solid.inertia[k], 0.0],
                    lesser_mass: solid.mass[k],
                    overlap,
                    effective_radius: radius,
                    normal_force: pressing::<N>(normal_force),
                    loading_velocity,
                    loading_overlap,
                    loading_time: loading.duration,
                };
                let mut spring = Spring::default();
                if Self::REMEMBERS {
                    spring.force = Self::vector(&self.spring, k);
                }
                let traction = tangential_law.traction(&touch, &mut spring);
                if Self::REMEMBERS {
                    store(&mut self.spring, k, touches, spring.force);
                }
                force += traction.force;
                store(&mut self.torque[0], k, touches, traction.torque[0]);
            }
            store(&mut self.force, k, touches, force);
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
        spheres: &[u32],
        particles: &mut Particles,
    ) {
        for (at, four) in (0..BLOCK).step_by(4).zip(spheres.chunks(4)) {
            let force = self.force.rows(simd, at);
            let torque = if T::ROTATES {
                self.torque[0].rows(simd, at)
            } else {
                force
            };
            for (k, &i) in four.iter().enumerate() {
                let i = i as usize;
                add(simd, &mut particles.force[i], force[k]);
                if T::ROTATES {
                    add(simd, &mut particles.torque[i], torque[k]);
                }
            }
        }
    }

    /// Adds forces and torques to the partners, pair by pair.
    #[inline(always)]
    pub(super) fn scatter<S: Simd, T: TangentialLaw<History = H>>(
        &self,
        simd: S,
        pairs: &[NearPair],
        particles: &mut Particles,
    ) {
        for (at, four) in (0..BLOCK).step_by(4).zip(pairs.chunks(4)) {
            let force = self.force.rows(simd, at);
            let torque = if T::ROTATES {
                [self.torque[0].rows(simd, at), self.torque[1].rows(simd, at)]
            } else {
                [force; 2]
            };
            for (k, pair) in four.iter().enumerate() {
                let (i, j) = (pair.i as usize, pair.j as usize);
                add(simd, &mut particles.force[i], force[k]);
                add(simd, &mut particles.force[j], -force[k]);
                if T::ROTATES {
                    add(simd, &mut particles.torque[i], torque[0][k]);
                    add(simd, &mut particles.torque[j], torque[1][k]);
                }
            }
        }
    }
}

#[inline(always)]
fn add<S: Simd>(simd: S, sum: &mut Vector, row: f64x4<S>) {
    *sum = Vector::of_row((f64x4::simd_from(simd, sum.row()) + row).into());
}

/// What of a normal force friction feels: none where partners attract each other.
#[inline(always)]
fn pressing<N: NormalLaw>(normal_force: f64) -> f64 {
    if N::ATTRACTS && normal_force < 0.0 {
        0.0
    } else {
        normal_force
    }
}

/// The overlap of a contact, none before it began.
#[inline(always)]
fn positive(overlap: f64) -> f64 {
    if overlap > 0.0 { overlap } else { 0.0 }
}

/// Stores what acts on a touching pair.
#[inline(always)]
fn store(columns: &mut Columns, k: usize, touches: bool, vector: Vector) {
    let [x, y, z, _] = &mut columns.0;
    x[k] = if touches { vector.x } else { 0.0 };
    y[k] = if touches { vector.y } else { 0.0 };
    z[k] = if touches { vector.z } else { 0.0 };
}
