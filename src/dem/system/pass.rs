//! One pass over all spheres, or over each thread's, block by block: what acts on single spheres, a kick, a drift.
//!
//! A block is at hand until all of it is done.

use super::System;
use super::division::Division;
use crate::dem::block::BLOCK;
use crate::dem::bodies::{Asked, Bodies};
use crate::dem::contact::NormalLaw;
use crate::dem::effects::Effect;
use crate::dem::friction::TangentialLaw;
use crate::dem::neighbours::Allowance;
use crate::dem::profile::{self, Part, Profile};
use crate::dem::spheres::Spheres;
use crate::dem::threads::in_parallel;
use fearless_simd::Level;
use std::ops::Range;

/// Blocks of spheres that are at hand together.
const AT_HAND: usize = 8;

/// What is done to every sphere, in this order.
#[derive(Clone, Default)]
pub(super) struct Moves {
    /// These effects act,
    pub(super) effects: Range<usize>,
    /// velocities and spins change for a time (s),
    pub(super) kick: Option<f64>,
    /// and centres move for a time (s).
    pub(super) drift: Option<f64>,
}

/// What a pass came upon.
#[derive(Clone, Copy, Default)]
pub(super) struct Found {
    /// Whether a sphere may be too fast.
    pub(super) too_fast: bool,
    /// Whether one went farther than the near pairs allow.
    pub(super) too_far: bool,
}

/// What is done to every sphere, and what it depends on.
struct Pass<'a> {
    level: Level,
    effects: &'a [Box<dyn Effect>],
    kick: Option<f64>,
    drift: Option<f64>,
    /// [`Limits::slow`](crate::dem::guard::Limits::slow).
    slow: f64,
    /// Where near pairs are looked for.
    allowance: Option<Allowance>,
    /// What the effects ask for.
    asked: Asked,
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Does that to every sphere. Notes whether one went farther than the near pairs allow, and says whether one
    /// may be too fast.
    pub(super) fn pass(&mut self, moves: Moves) -> bool {
        let Moves {
            effects,
            kick,
            drift,
        } = moves;
        if let Some(time) = drift {
            self.age.time += time;
            self.near_age.time += time;
        }
        let threads = self.division.as_ref().map_or(1, Division::threads);
        let is_listed = self.list.is_some();
        let (shielding, reference) = (self.near.shielding(), self.near.anchor().position());
        let effects = &mut self.parts.effects[effects];
        for effect in effects.iter_mut() {
            effect.prepare(shielding);
            profile::mark(&mut self.profile, effect.part());
        }
        let mut asked = Asked::default();
        for effect in effects.iter() {
            let Asked { motion, rotation } = effect.asks();
            asked.motion |= motion;
            // Without rotation there are neither spins nor torques.
            asked.rotation |= rotation && self.parts.particles.rotate();
        }
        let pass = Pass {
            level: self.level,
            effects,
            kick,
            drift,
            slow: self.parts.limits.slow,
            allowance: is_listed.then(|| self.near.allowance(self.near_age.time)),
            asked,
        };
        let spheres = Spheres::all(&mut self.parts.particles, reference);
        let found = pass.on_threads(spheres, threads, &mut self.bodies, &mut self.profile);
        // It may be so already: a sphere came or went.
        self.stale |= found.too_far;
        found.too_fast
    }
}

impl Pass<'_> {
    /// Goes over all spheres, as many by each thread.
    fn on_threads(
        &self,
        mut all: Spheres<'_>,
        threads: usize,
        buffers: &mut Vec<Vec<Bodies>>,
        profile: &mut Option<Box<Profile>>,
    ) -> Found {
        buffers.resize_with(threads, Vec::new);
        if let [bodies] = &mut buffers[..] {
            return self.over(&mut all, bodies, profile);
        }
        let length = all.len().div_ceil(threads).next_multiple_of(BLOCK);
        let share = |bodies| (all.split(length), bodies, Found::default());
        let mut shares: Vec<_> = buffers.iter_mut().map(share).collect();
        in_parallel(&mut shares, &|(share, bodies, found)| {
            *found = self.over(share, bodies, &mut None);
        });
        profile::mark(profile, Part::Kick);
        shares.iter().fold(Found::default(), |all, (.., found)| Found {
            too_fast: all.too_fast | found.too_fast,
            too_far: all.too_far | found.too_far,
        })
    }

    /// Goes over the spheres of a share.
    fn over(
        &self,
        share: &mut Spheres<'_>,
        buffer: &mut Vec<Bodies>,
        profile: &mut Option<Box<Profile>>,
    ) -> Found {
        let mut found = Found::default();
        for first in (0..share.len()).step_by(AT_HAND * BLOCK) {
            let which = first..(first + AT_HAND * BLOCK).min(share.len());
            if !self.effects.is_empty() {
                self.act(share, which.clone(), buffer, profile);
            }
            if let Some(time) = self.kick {
                found.too_fast |= !share.kick(self.level, which.clone(), time, self.slow);
                profile::mark(profile, Part::Kick);
            }
            if let Some(time) = self.drift {
                found.too_far |= !share.drift(self.level, which, time, self.allowance);
                profile::mark(profile, Part::Drift);
            }
        }
        found
    }

    /// Adds the forces and torques of the effects on some spheres.
    fn act(
        &self,
        share: &mut Spheres<'_>,
        which: Range<usize>,
        buffer: &mut Vec<Bodies>,
        profile: &mut Option<Box<Profile>>,
    ) {
        // One block at a time, but in a step that is looked at: the clock is then read after each part of all of
        // them, as reading it takes as long as an effect takes for some hundred spheres.
        let looking = profile.as_ref().is_some_and(|it| it.is_looking());
        let together = if looking { AT_HAND } else { 1 };
        if buffer.len() < together {
            buffer.resize_with(together, Bodies::new);
        }
        for first in which.clone().step_by(together * BLOCK) {
            let blocks = (first..which.end).step_by(BLOCK).zip(&mut buffer[..together]);
            for (first, block) in blocks {
                block.take(self.level, share, first, self.asked);
            }
            let blocks = (which.end - first).div_ceil(BLOCK).min(together);
            let blocks = &mut buffer[..blocks];
            profile::mark(profile, Part::Rest);
            for effect in self.effects {
                for block in blocks.iter_mut() {
                    effect.apply(self.level, block);
                }
                profile::mark(profile, effect.part());
            }
            for block in blocks.iter() {
                block.give(self.level, share, self.asked);
            }
            profile::mark(profile, Part::Rest);
        }
    }
}
