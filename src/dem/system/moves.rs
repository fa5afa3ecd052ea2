//! Effects, kicks and drifts: loops over all spheres, or over each thread's.

use crate::dem::block::BLOCK;
use crate::dem::bodies::{Bodies, Spheres};
use crate::dem::effects::Effect;
use crate::dem::neighbours::{Allowance, Reference};
use crate::dem::profile::{Part, Profile};
use crate::dem::threads::{in_parallel, split, split_shared};
use crate::dem::vector::Vector;
use fearless_simd::{Level, Simd, SimdBase, SimdFrom, SimdMask, f64x4, mask64x4};

/// Something done to each of some spheres, or of all.
pub(super) trait Move: Send + Sized {
    /// How many spheres they are.
    fn spheres(&self) -> usize;

    /// Takes so many spheres from the front, or all that there are.
    fn split(&mut self, count: usize) -> Self;

    /// Does it to them, for a time (s). Whether one of them is to be looked at.
    fn all<S: Simd>(&mut self, simd: S, dt: f64) -> bool;
}

/// Does it for a time (s), to as many spheres by each thread. Whether one of them is to be looked at.
pub(super) fn by(mut all: impl Move, threads: usize, level: Level, dt: f64) -> bool {
    let length = all.spheres().div_ceil(threads).next_multiple_of(BLOCK);
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

/// What effects add to the forces and torques of some spheres, or of all, block by block.
pub(super) struct Act<'a> {
    pub(super) spheres: Spheres<'a>,
    pub(super) effects: &'a [Box<dyn Effect>],
    /// Whether they ask for spins, or add to torques.
    pub(super) turn: bool,
    pub(super) level: Level,
    /// Of every thread.
    pub(super) bodies: &'a mut [Bodies],
    /// Of one thread for all, if there is one.
    pub(super) profile: Option<&'a mut Profile>,
}

impl Move for Act<'_> {
    fn spheres(&self) -> usize {
        self.spheres.mass.len()
    }

    fn split(&mut self, count: usize) -> Self {
        Self {
            spheres: self.spheres.split(count),
            bodies: split(&mut self.bodies, 1),
            profile: None,
            ..*self
        }
    }

    #[inline(always)]
    fn all<S: Simd>(&mut self, simd: S, _: f64) -> bool {
        let mut mark = |part| self.profile.iter_mut().for_each(|it| it.mark(part));
        let bodies = self.bodies.first_mut();
        let bodies = bodies.expect("every thread has one");
        for from in (0..self.spheres.mass.len()).step_by(BLOCK) {
            bodies.take(simd, &self.spheres, from, self.turn);
            mark(Part::Rest);
            for effect in self.effects {
                effect.apply(self.level, bodies);
                mark(effect.part());
            }
            bodies.give(simd, &mut self.spheres, from, self.turn);
        }
        false
    }
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
        // The last number of a row means nothing.
        let most = [self.slow, self.slow, self.slow, f64::INFINITY];
        let most = f64x4::simd_from(simd, most);
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
