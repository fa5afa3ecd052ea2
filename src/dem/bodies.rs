//! Spheres in blocks, one column per quantity: what acts on single spheres is computed for all of a
//! block at once.

use super::block::{BLOCK, Column, Columns, ROWS, row};
use super::neighbours::Reference;
use super::particles::Particles;
use super::threads::{split, split_shared};
use super::vector::Vector;
use fearless_simd::Simd;
use std::ops::Range;

/// Spheres in rows: all of them, those of a thread, or the next few.
pub(super) struct Spheres<'a> {
    /// Index of the first one.
    pub(super) first: usize,
    pub(super) position: &'a mut [Vector],
    pub(super) velocity: &'a mut [Vector],
    pub(super) force: &'a mut [Vector],
    pub(super) spin: &'a mut [Vector],
    pub(super) torque: &'a mut [Vector],
    pub(super) radius: &'a [f64],
    pub(super) mass: &'a [f64],
    pub(super) inverse_mass: &'a [f64],
    pub(super) inertia: &'a [f64],
    pub(super) inverse_inertia: &'a [f64],
    /// Where they were when near pairs were looked for; nothing where none are looked for.
    pub(super) reference: &'a [Reference],
}

impl<'a> Spheres<'a> {
    /// All spheres, with their references.
    pub(super) fn new(particles: &'a mut Particles, reference: &'a [Reference]) -> Self {
        Self {
            first: 0,
            position: &mut particles.position,
            velocity: &mut particles.velocity,
            force: &mut particles.force,
            spin: &mut particles.spin,
            torque: &mut particles.torque,
            radius: &particles.radius,
            mass: &particles.mass,
            inverse_mass: &particles.inverse_mass,
            inertia: &particles.inertia,
            inverse_inertia: &particles.inverse_inertia,
            reference,
        }
    }

    /// How many they are.
    pub(super) fn len(&self) -> usize {
        self.position.len()
    }

    /// Some of them, by their places among these.
    pub(super) fn part(&mut self, range: Range<usize>) -> Spheres<'_> {
        let mut all = Spheres {
            first: self.first,
            position: self.position,
            velocity: self.velocity,
            force: self.force,
            spin: self.spin,
            torque: self.torque,
            radius: self.radius,
            mass: self.mass,
            inverse_mass: self.inverse_mass,
            inertia: self.inertia,
            inverse_inertia: self.inverse_inertia,
            reference: self.reference,
        };
        all.split(range.start);
        all.split(range.len())
    }

    /// Takes that many from the front, or all if there are fewer.
    pub(super) fn split(&mut self, count: usize) -> Self {
        let first = self.first;
        self.first += count.min(self.len());
        Self {
            first,
            position: split(&mut self.position, count),
            velocity: split(&mut self.velocity, count),
            force: split(&mut self.force, count),
            spin: split(&mut self.spin, count),
            torque: split(&mut self.torque, count),
            radius: split_shared(&mut self.radius, count),
            mass: split_shared(&mut self.mass, count),
            inverse_mass: split_shared(&mut self.inverse_mass, count),
            inertia: split_shared(&mut self.inertia, count),
            inverse_inertia: split_shared(&mut self.inverse_inertia, count),
            reference: split_shared(&mut self.reference, count),
        }
    }
}

/// What effects ask for besides masses and forces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Asked {
    /// Centres and velocities.
    pub(super) motion: bool,
    /// Spins, and torques to add to.
    pub(super) turn: bool,
}

impl Asked {
    /// What one or the other asks for.
    pub(super) fn or(self, other: Self) -> Self {
        Self {
            motion: self.motion || other.motion,
            turn: self.turn || other.turn,
        }
    }
}

/// A block of spheres. Lanes without a sphere repeat the last one.
pub(super) struct Bodies {
    /// Index of the first sphere.
    pub(super) first: usize,
    /// How many they are.
    count: usize,
    /// Forces so far (N).
    pub(super) force: Columns,
    /// Centres (m), if they are asked for.
    pub(super) position: Columns,
    /// Velocities (m/s), if they are asked for.
    pub(super) velocity: Columns,
    /// Spins (rad/s), if they are asked for.
    pub(super) spin: Columns,
    /// Torques so far (N m), if they are asked for.
    pub(super) torque: Columns,
    /// Masses (kg).
    pub(super) mass: Column,
}

impl Bodies {
    pub(super) fn new() -> Self {
        Self {
            first: 0,
            count: 0,
            force: Columns::ZERO,
            position: Columns::ZERO,
            velocity: Columns::ZERO,
            spin: Columns::ZERO,
            torque: Columns::ZERO,
            mass: [0.0; BLOCK],
        }
    }

    /// Takes a block of spheres from a place on: masses, forces, and what else is asked for.
    #[inline(always)]
    pub(super) fn take<S: Simd>(
        &mut self,
        simd: S,
        spheres: &Spheres<'_>,
        from: usize,
        asked: Asked,
    ) {
        self.first = spheres.first + from;
        self.count = (spheres.len() - from).min(BLOCK);
        let all = from..from + self.count;
        self.mass[..self.count].copy_from_slice(&spheres.mass[all.clone()]);
        let Asked { motion, turn } = asked;
        let columns = [
            (true, &mut self.force, &*spheres.force),
            (motion, &mut self.position, &*spheres.position),
            (motion, &mut self.velocity, &*spheres.velocity),
            (turn, &mut self.spin, &*spheres.spin),
            (turn, &mut self.torque, &*spheres.torque),
        ];
        for (is_asked, columns, vectors) in columns {
            if is_asked {
                fill(simd, columns, &vectors[all.clone()]);
            }
        }
    }

    /// Gives the spheres from that place on what acts on them.
    #[inline(always)]
    pub(super) fn give<S: Simd>(
        &self,
        simd: S,
        spheres: &mut Spheres<'_>,
        from: usize,
        asked: Asked,
    ) {
        let all = from..from + self.count;
        spread(simd, &self.force, &mut spheres.force[all.clone()]);
        if asked.turn {
            spread(simd, &self.torque, &mut spheres.torque[all]);
        }
    }
}

#[inline(always)]
fn fill<S: Simd>(simd: S, columns: &mut Columns, vectors: &[Vector]) {
    if vectors.len() == BLOCK {
        columns.fill::<S>(
            #[inline(always)]
            |k| row(simd, vectors, k as u32),
        );
    } else {
        let last = vectors.len() - 1;
        columns.fill::<S>(
            #[inline(always)]
            |k| row(simd, vectors, k.min(last) as u32),
        );
    }
}

#[inline(always)]
fn spread<S: Simd>(simd: S, columns: &Columns, vectors: &mut [Vector]) {
    let mut eights = vectors.chunks_exact_mut(ROWS);
    let mut at = 0;
    for eight in &mut eights {
        let rows = columns.rows(simd, at);
        for k in 0..ROWS {
            eight[k] = Vector::of_row(rows[k].into());
        }
        at += ROWS;
    }
    for (k, vector) in eights.into_remainder().iter_mut().enumerate() {
        *vector = columns.vector(at + k);
    }
}
