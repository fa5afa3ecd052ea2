//! Spheres in blocks, one column per quantity. Effects on single spheres are computed for a whole
//! block at once.
//!
//! | type | what it holds |
//! |---|---|
//! | [`Particles`] | all spheres, one array per quantity |
//! | [`SphereRows`] | borrowed parts of these arrays: all spheres, or the share of a thread |
//! | [`Bodies`] | copies of a block of [`BLOCK`] spheres, one column per coordinate, for effects |

use super::neighbours::Reference;
use super::threads::{split, split_shared};
use crate::particles::block::{BLOCK, ROWS, VectorColumns, row};
use crate::particles::bodies::{Asked, Bodies};
use crate::particles::vector::Vector;
use crate::particles::{Domain, Particles};
use fearless_simd::Simd;
use std::ops::Range;

/// Spheres in rows: all of them, the share of a thread, or the next few.
pub(super) struct SphereRows<'a> {
    /// Index of the first one.
    pub(super) first: usize,
    pub(super) domain: Domain,
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
    /// Positions of the spheres when near pairs were found. Empty if there are no near pairs.
    pub(super) reference: &'a [Reference],
}

impl<'a> SphereRows<'a> {
    /// All spheres, with their references.
    pub(super) fn new(particles: &'a mut Particles, reference: &'a [Reference]) -> Self {
        Self {
            first: 0,
            domain: particles.domain,
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

    /// Number of spheres.
    pub(super) fn len(&self) -> usize {
        self.position.len()
    }

    /// The spheres of a range, counted from the first of these spheres.
    pub(super) fn part(&mut self, range: Range<usize>) -> SphereRows<'_> {
        let mut all = SphereRows {
            first: self.first,
            domain: self.domain,
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

    /// Splits off `count` spheres at the front, or all if there are fewer.
    pub(super) fn split(&mut self, count: usize) -> Self {
        let first = self.first;
        self.first += count.min(self.len());
        Self {
            first,
            domain: self.domain,
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

impl Bodies {
    /// Reads a block of spheres from index `from` on: masses, forces, and the columns of `asked`.
    #[inline(always)]
    pub(super) fn take<S: Simd>(
        &mut self,
        simd: S,
        spheres: &SphereRows<'_>,
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

    /// Writes the forces and torques of the block back to the spheres.
    #[inline(always)]
    pub(super) fn give<S: Simd>(
        &self,
        simd: S,
        spheres: &mut SphereRows<'_>,
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
fn fill<S: Simd>(simd: S, columns: &mut VectorColumns, vectors: &[Vector]) {
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
fn spread<S: Simd>(simd: S, columns: &VectorColumns, vectors: &mut [Vector]) {
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
