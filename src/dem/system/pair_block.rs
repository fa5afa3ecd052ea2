//! Blocks of contacts: what the laws answer for many pairs at once.
//!
//! For all pairs of a block, touching or not, the laws are computed in a loop that the compiler turns
//! into vector instructions; a pair that does not touch gets a force of zero. Then the forces are added up
//! one by one in the order of the list. Adding zero to a sum that began at +0 changes no bit of it.

use crate::dem::block::{BLOCK, Body, Column, Columns, Load, Row};
use crate::dem::contact::NormalLaw;
use crate::dem::friction::{TangentialLaw, Touch, sliding_velocity};
use crate::dem::neighbours::NearPair;
use crate::dem::vector::Vector;
use crate::dem::walls::{Wall, WallContact};
use fearless_simd::{Simd, SimdBase, f64x4};

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

/// Everything about the pairs of a block.
pub(super) struct PairBlock<H> {
    index: [[u32; BLOCK]; 2],
    place: [Columns; 2],
    motion: [Columns; 2],
    turning: [Columns; 2],
    /// Velocities and spins of before, if springs are loaded by those.
    earlier: [[Columns; 2]; 2],
    pub(super) history: [H; BLOCK],
    force: Columns,
    torque: [Columns; 2],
    /// Overlap of a pair beyond the limit (m), else [`NOT_DEEP`].
    too_deep: Column,
}

impl<H: Copy + Default> PairBlock<H> {
    /// Whether the law has a history. Its loop is then not turned into vector instructions, and is
    /// faster if it passes over what does not touch.
    const REMEMBERS: bool = size_of::<H>() > 0;

    /// Notes that nothing acts at a contact.
    #[inline(always)]
    fn leave_out(&mut self, k: usize) {
        self.history[k] = H::default();
        self.too_deep[k] = NOT_DEEP;
        for columns in [&mut self.force].into_iter().chain(&mut self.torque) {
            store(columns, k, false, Vector::ZERO);
        }
    }

    pub(super) fn new() -> Self {
        let pair = || [Columns::ZERO, Columns::ZERO];
        Self {
            index: [[0; BLOCK]; 2],
            place: pair(),
            motion: pair(),
            turning: pair(),
            earlier: [pair(), pair()],
            history: [H::default(); BLOCK],
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

    /// Fetches the spheres of one side. Lanes without a contact hold what an earlier block left.
    #[inline(always)]
    pub(super) fn gather<S: Simd, T: TangentialLaw<History = H>>(
        &mut self,
        simd: S,
        side: usize,
        bodies: &[Body],
    ) {
        let index = &self.index[side];
        self.place[side].gather(
            simd,
            index,
            #[inline(always)]
            |i| bodies[i].place,
        );
        self.motion[side].gather(
            simd,
            index,
            #[inline(always)]
            |i| bodies[i].motion,
        );
        if T::ROTATES {
            self.turning[side].gather(
                simd,
                index,
                #[inline(always)]
                |i| bodies[i].turning,
            );
        }
    }

    /// Takes pairs, up to a block of them, with what they remember.
    #[inline(always)]
    pub(super) fn take_pairs(&mut self, pairs: &[NearPair], histories: &[H]) {
        for (k, pair) in pairs.iter().enumerate() {
            self.index[0][k] = pair.i;
            self.index[1][k] = pair.j;
        }
        if Self::REMEMBERS {
            for (history, pair) in self.history.iter_mut().zip(pairs) {
                *history = histories[pair.entry as usize];
            }
        }
    }

    /// The same with spheres near a wall.
    #[inline(always)]
    pub(super) fn take_spheres(&mut self, spheres: &[u32], histories: &[H]) {
        self.index[0][..spheres.len()].copy_from_slice(spheres);
        if Self::REMEMBERS {
            for (history, &i) in self.history.iter_mut().zip(spheres) {
                *history = histories[i as usize];
            }
        }
    }

    /// Fetches the velocities and spins of before, of both sides, if there are any.
    #[inline(always)]
    pub(super) fn gather_earlier(&mut self, earlier: &[Earlier]) {
        if !Self::REMEMBERS || earlier.is_empty() {
            return;
        }
        for side in 0..2 {
            for (k, &i) in self.index[side].iter().enumerate() {
                let [velocity, spin] = earlier[i as usize];
                self.earlier[0][side].set(k, velocity);
                self.earlier[1][side].set(k, spin);
            }
        }
    }

    /// Fetches the spheres of both sides, where speed does not matter.
    pub(super) fn gather_slowly(&mut self, bodies: &[Body], earlier: &[Earlier]) {
        self.gather_earlier(earlier);
        for side in 0..2 {
            for (k, &i) in self.index[side].iter().enumerate() {
                let body = &bodies[i as usize];
                self.place[side].set(k, body.place);
                self.motion[side].set(k, body.motion);
                self.turning[side].set(k, body.turning);
            }
        }
    }

    /// What became of a pair of the block, if it touches.
    pub(super) fn meeting(&self, k: usize) -> Option<Meeting> {
        let [one, other] = &self.place;
        let offset = Self::vector(one, k) - Self::vector(other, k);
        let radius = [one.0[3][k], other.0[3][k]];
        let (sum, distance) = (radius[0] + radius[1], offset.norm());
        (distance < sum).then(|| Meeting {
            normal: offset * (1.0 / distance),
            velocity: Self::vector(&self.motion[0], k) - Self::vector(&self.motion[1], k),
            overlap: sum - distance,
            effective_radius: radius[0] * radius[1] / sum,
            force: Self::vector(&self.force, k),
            torque: [0, 1].map(|side| Self::vector(&self.torque[side], k)),
        })
    }

    /// What became of a sphere of the block near a wall, if it touches.
    pub(super) fn meeting_with_wall<W: Wall>(&self, wall: W, k: usize) -> Option<Meeting> {
        let radius = self.place[0].0[3][k];
        let contact = wall.contact(Self::vector(&self.place[0], k), radius);
        contact.touches.then(|| Meeting {
            normal: contact.normal,
            velocity: Self::vector(&self.motion[0], k),
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
            let [place, motion, turning] = [&self.place, &self.motion, &self.turning];
            let offset = Self::vector(&place[0], k) - Self::vector(&place[1], k);
            let radius = [place[0].0[3][k], place[1].0[3][k]];
            let sum = radius[0] + radius[1];
            let distance_squared = offset.norm_squared();
            let touches = distance_squared < sum * sum;
            if Self::REMEMBERS && !touches {
                self.leave_out(k);
                continue;
            }
            let distance = distance_squared.sqrt();
            let normal = offset * (1.0 / distance);
            let overlap = sum - distance;
            let inverse_sum = 1.0 / sum;
            let effective_radius = radius[0] * radius[1] * inverse_sum;
            let velocity = Self::vector(&motion[0], k) - Self::vector(&motion[1], k);
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
                let mass = [motion[0].0[3][k], motion[1].0[3][k]];
                let lever = radius.map(|radius| radius * lever);
                let spin = [Self::vector(&turning[0], k), Self::vector(&turning[1], k)];
                let mut loading_velocity = sliding_velocity(normal, velocity, spin, lever);
                let mut loading_overlap = overlap;
                if Self::REMEMBERS && loading.age > 0.0 {
                    let [velocities, spins] = &self.earlier;
                    let velocity =
                        Self::vector(&velocities[0], k) - Self::vector(&velocities[1], k);
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
                    inertia: [turning[0].0[3][k], turning[1].0[3][k]],
                    lesser_mass: if mass[0] < mass[1] { mass[0] } else { mass[1] },
                    overlap,
                    effective_radius,
                    normal_force: pressing::<N>(normal_force),
                    loading_velocity,
                    loading_overlap,
                    loading_time: loading.duration,
                };
                let mut history = self.history[k];
                let traction = tangential_law.traction(&touch, &mut history);
                self.history[k] = if touches { history } else { H::default() };
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
            let [place, motion, turning] = [&self.place[0], &self.motion[0], &self.turning[0]];
            let radius = place.0[3][k];
            let WallContact {
                touches,
                overlap,
                normal,
            } = wall.contact(Self::vector(place, k), radius);
            if Self::REMEMBERS && !touches {
                self.leave_out(k);
                continue;
            }
            let velocity = Self::vector(motion, k);
            let approach = -velocity.dot(normal);
            let normal_force = normal_law.force(overlap, approach, radius);
            let deep = touches & (overlap > overlap_limit * radius);
            self.too_deep[k] = if deep { overlap } else { NOT_DEEP };
            let mut force = normal * normal_force;
            if N::DRAGS_SIDEWAYS {
                force -= (velocity + normal * approach) * normal_law.sideways_drag();
            }
            if T::ROTATES {
                let (lever, spin) = ([radius, 0.0], [Self::vector(turning, k), Vector::ZERO]);
                let mut loading_velocity = sliding_velocity(normal, velocity, spin, lever);
                let mut loading_overlap = overlap;
                if Self::REMEMBERS && loading.age > 0.0 {
                    let [velocities, spins] = &self.earlier;
                    let velocity = Self::vector(&velocities[0], k);
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
                    inertia: [turning.0[3][k], 0.0],
                    lesser_mass: motion.0[3][k],
                    overlap,
                    effective_radius: radius,
                    normal_force: pressing::<N>(normal_force),
                    loading_velocity,
                    loading_overlap,
                    loading_time: loading.duration,
                };
                let mut history = self.history[k];
                let traction = tangential_law.traction(&touch, &mut history);
                self.history[k] = if touches { history } else { H::default() };
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
        loads: &mut [Load],
    ) {
        for (at, four) in (0..BLOCK).step_by(4).zip(spheres.chunks(4)) {
            let force = self.force.rows(simd, at);
            let torque = if T::ROTATES {
                self.torque[0].rows(simd, at)
            } else {
                force
            };
            for (k, &i) in four.iter().enumerate() {
                let load = &mut loads[i as usize];
                add(simd, &mut load.force, force[k]);
                if T::ROTATES {
                    add(simd, &mut load.torque, torque[k]);
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
        loads: &mut [Load],
    ) {
        for (at, four) in (0..BLOCK).step_by(4).zip(pairs.chunks(4)) {
            let force = self.force.rows(simd, at);
            let torque = if T::ROTATES {
                [self.torque[0].rows(simd, at), self.torque[1].rows(simd, at)]
            } else {
                [force; 2]
            };
            for (k, pair) in four.iter().enumerate() {
                let one = &mut loads[pair.i as usize];
                add(simd, &mut one.force, force[k]);
                if T::ROTATES {
                    add(simd, &mut one.torque, torque[0][k]);
                }
                let other = &mut loads[pair.j as usize];
                add(simd, &mut other.force, -force[k]);
                if T::ROTATES {
                    add(simd, &mut other.torque, torque[1][k]);
                }
            }
        }
    }
}

#[inline(always)]
fn add<S: Simd>(simd: S, sum: &mut Row, row: f64x4<S>) {
    (f64x4::from_slice(simd, sum) + row).store_slice(sum);
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
