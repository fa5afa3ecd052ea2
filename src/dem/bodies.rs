//! Spheres in blocks, one column per quantity: what acts on single spheres is computed for all of a block at
//! once.

use super::block::{BLOCK, Column, Columns, ROWS, row};
use super::threads::{split, split_shared};
use super::vector::Vector;
use fearless_simd::Simd;

/// Spheres in rows: all of them, or a thread's share.
pub(super) struct Spheres<'a> {
    /// Index of the first one.
    pub(super) first: usize,
    pub(super) position: &'a [Vector],
    pub(super) velocity: &'a [Vector],
    pub(super) spin: &'a [Vector],
    pub(super) mass: &'a [f64],
    pub(super) force: &'a mut [Vector],
    pub(super) torque: &'a mut [Vector],
}

impl Spheres<'_> {
    /// Takes so many from the front, or all that there are.
    pub(super) fn split(&mut self, count: usize) -> Self {
        let first = self.first;
        self.first += count.min(self.position.len());
        Self {
            first,
            position: split_shared(&mut self.position, count),
            velocity: split_shared(&mut self.velocity, count),
            spin: split_shared(&mut self.spin, count),
            mass: split_shared(&mut self.mass, count),
            force: split(&mut self.force, count),
            torque: split(&mut self.torque, count),
        }
    }
}

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

    /// Takes a block of spheres from a place on, their spins too if these `turn`.
    #[inline(always)]
    pub(super) fn take<S: Simd>(
        &mut self,
        simd: S,
        spheres: &Spheres<'_>,
        from: usize,
        turn: bool,
    ) {
        self.first = spheres.first + from;
        self.count = (spheres.mass.len() - from).min(BLOCK);
        let all = from..from + self.count;
        self.mass[..self.count].copy_from_slice(&spheres.mass[all.clone()]);
        let columns = [
            (true, &mut self.position, spheres.position),
            (true, &mut self.velocity, spheres.velocity),
            (true, &mut self.force, &*spheres.force),
            (turn, &mut self.spin, spheres.spin),
            (turn, &mut self.torque, &*spheres.torque),
        ];
        for (is_asked, columns, vectors) in columns {
            if is_asked {
                fill(simd, columns, &vectors[all.clone()]);
            }
        }
    }

    /// Gives the spheres from that place on what acts on them, torques too if they `turn`.
    #[inline(always)]
    pub(super) fn give<S: Simd>(
        &self,
        simd: S,
        spheres: &mut Spheres<'_>,
        from: usize,
        turn: bool,
    ) {
        let all = from..from + self.count;
        spread(simd, &self.force, &mut spheres.force[all.clone()]);
        if turn {
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
