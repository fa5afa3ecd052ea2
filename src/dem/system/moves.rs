//! Kicks and drifts: loops over the rows of all spheres, or of each thread's.

use crate::dem::neighbours::{Allowance, Reference};
use crate::dem::threads::{in_parallel, split, split_shared};
use crate::dem::vector::Vector;
use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x4, mask64x4};

/// Something done to each of some spheres, or of all.
pub(super) trait Move: Send + Sized {
    /// How many spheres they are.
    fn spheres(&self) -> usize;

    /// Takes so many spheres from the front, or all that there are.
    fn split(&mut self, count: usize) -> Self;

    /// Moves them by a time (s). Whether one of them is to be looked at.
    fn all<S: Simd>(&mut self, simd: S, dt: f64) -> bool;
}

/// Moves spheres by a time (s), as many by each thread. Whether one of them is to be looked at.
pub(super) fn by(mut all: impl Move, threads: usize, level: Level, dt: f64) -> bool {
    let length = all.spheres().div_ceil(threads);
    match threads {
        1 => of_thread(&mut all, level, dt),
        _ => {
            let share = |_| (all.split(length), false);
            let mut shares: Vec<_> = (0..threads).map(share).collect();
            in_parallel(&mut shares, &|(share, found)| {
                *found = of_thread(share, level, dt)
            });
            shares.iter().any(|&(_, found)| found)
        }
    }
}

fn of_thread(share: &mut impl Move, level: Level, dt: f64) -> bool {
    fearless_simd::dispatch!(level, simd => share.all(simd, dt))
}

/// A kick of some spheres, or of all.
pub(super) struct Kick<'a> {
    pub(super) velocity: &'a mut [Vector],
    pub(super) force: &'a [Vector],
    pub(super) spin: &'a mut [Vector],
    pub(super) torque: &'a [Vector],
    pub(super) inverse_mass: &'a [f64],
    pub(super) inverse_inertia: &'a [f64],
    /// [`Limits::slow`](crate::dem::guard::Limits::slow).
    pub(super) slow: f64,
}

impl Move for Kick<'_> {
    fn spheres(&self) -> usize {
        self.velocity.len()
    }

    fn split(&mut self, count: usize) -> Self {
        Self {
            velocity: split(&mut self.velocity, count),
            force: split_shared(&mut self.force, count),
            spin: split(&mut self.spin, count),
            torque: split_shared(&mut self.torque, count),
            inverse_mass: split_shared(&mut self.inverse_mass, count),
            inverse_inertia: split_shared(&mut self.inverse_inertia, count),
            slow: self.slow,
        }
    }

    #[inline(always)]
    fn all<S: Simd>(&mut self, simd: S, dt: f64) -> bool {
        let most = f64x4::splat(simd, self.slow);
        let mut slow = mask64x4::splat(simd, true);
        for ((velocity, force), inverse) in (self.velocity.iter_mut())
            .zip(self.force)
            .zip(self.inverse_mass)
        {
            let row = velocity.simd(simd) + force.simd(simd) * (inverse * dt);
            *velocity = Vector::of_row(row.into());
            // What is not a number is not slow.
            slow &= row.abs().simd_le(most);
        }
        for ((spin, torque), inverse) in (self.spin.iter_mut())
            .zip(self.torque)
            .zip(self.inverse_inertia)
        {
            let row = spin.simd(simd) + torque.simd(simd) * (inverse * dt);
            *spin = Vector::of_row(row.into());
        }
        !slow.all_true()
    }
}

/// A drift of some spheres, or of all.
pub(super) struct Drift<'a> {
    pub(super) position: &'a mut [Vector],
    pub(super) velocity: &'a [Vector],
    /// Where they were when near pairs were looked for, and how far they may be from there; where none are
    /// looked for, nothing.
    pub(super) reference: &'a [Reference],
    pub(super) allowance: Option<Allowance>,
}

impl Move for Drift<'_> {
    fn spheres(&self) -> usize {
        self.position.len()
    }

    fn split(&mut self, count: usize) -> Self {
        Self {
            position: split(&mut self.position, count),
            velocity: split_shared(&mut self.velocity, count),
            reference: split_shared(&mut self.reference, count),
            allowance: self.allowance,
        }
    }

    #[inline(always)]
    fn all<S: Simd>(&mut self, simd: S, dt: f64) -> bool {
        for (position, velocity) in self.position.iter_mut().zip(self.velocity) {
            let row = position.simd(simd) + velocity.simd(simd) * dt;
            *position = Vector::of_row(row.into());
        }
        let allowance = self.allowance;
        allowance.is_some_and(|it| !it.hold(self.position, self.reference))
    }
}
