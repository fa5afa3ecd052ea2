//! Spheres in blocks, one column per quantity: what acts on single spheres is computed for all of a block at
//! once.

use super::block::{BLOCK, Column, Columns, ROWS, row};
use super::particles::Particles;
use super::vector::Vector;
use fearless_simd::{Level, Simd};
use std::ops::Range;

/// A block of spheres. Lanes without a sphere repeat the last one.
pub(super) struct Bodies {
    /// Index of the first sphere.
    pub(super) first: usize,
    /// How many they are.
    count: usize,
    /// Centres (m).
    pub(super) position: Columns,
    /// Velocities (m/s).
    pub(super) velocity: Columns,
    /// Forces so far (N).
    pub(super) force: Columns,
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
            position: Columns::ZERO,
            velocity: Columns::ZERO,
            force: Columns::ZERO,
            spin: Columns::ZERO,
            torque: Columns::ZERO,
            mass: [0.0; BLOCK],
        }
    }

    /// Their indices.
    pub(super) fn all(&self) -> Range<usize> {
        self.first..self.first + self.count
    }

    /// Takes a block of spheres, their spins too if these `turn`.
    pub(super) fn take(&mut self, level: Level, particles: &Particles, first: usize, turn: bool) {
        self.first = first;
        self.count = (particles.len() - first).min(BLOCK);
        fearless_simd::dispatch!(level, simd => self.fill(simd, particles, turn));
    }

    #[inline(always)]
    fn fill<S: Simd>(&mut self, simd: S, particles: &Particles, turn: bool) {
        let all = self.all();
        self.mass[..self.count].copy_from_slice(&particles.mass[all.clone()]);
        let columns = [
            (&mut self.position, &particles.position),
            (&mut self.velocity, &particles.velocity),
            (&mut self.force, &particles.force),
        ];
        for (columns, vectors) in columns {
            fill(simd, columns, &vectors[all.clone()]);
        }
        if turn {
            fill(simd, &mut self.spin, &particles.spin[all.clone()]);
            fill(simd, &mut self.torque, &particles.torque[all]);
        }
    }

    /// Gives the spheres what acts on them, torques too if they `turn`.
    pub(super) fn give(&self, level: Level, particles: &mut Particles, turn: bool) {
        let all = self.all();
        fearless_simd::dispatch!(level, simd => {
            spread(simd, &self.force, &mut particles.force[all.clone()]);
            if turn {
                spread(simd, &self.torque, &mut particles.torque[all]);
            }
        });
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
