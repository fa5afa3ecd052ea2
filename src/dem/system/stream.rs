//! Forces and moves of a large scene in one pass through its spheres.
//!
//! Pairs stand in the order of their first spheres. So when those of a sphere are done, all pairs are that act on it,
//! and no later one asks where it is: it can be moved while it is at hand. What is done to a sphere, and in which order,
//! is the same as if all forces came first.

use super::System;
use super::moves::{Drift, FirstTooFast, Found, Moves};
use super::share::{Known, Scenery, Share, TooDeep};
use super::sums::Sums;
use super::touching::{LOOK, come_from_far};
use crate::dem::block::BLOCK;
use crate::dem::bodies::{Bodies, Spheres};
use crate::dem::contact::NormalLaw;
use crate::dem::friction::TangentialLaw;
use crate::dem::neighbours::NearPair;
use crate::dem::walls::TankWall;

/// After so many near pairs spheres are moved: few enough that these are still in a near cache, so many that few lanes
/// of blocks are left over.
const SPAN: usize = 16 * LOOK;

/// How far a pass has come, and what it found.
#[derive(Default)]
struct Pass {
    /// The first pair that is not done.
    pair: usize,
    /// The first sphere that is not moved.
    sphere: usize,
    /// The first contact with each wall that is not done.
    at_wall: [usize; TankWall::MOST],
    /// Of pairs, and at each wall.
    too_deep: [TooDeep; 1 + TankWall::MOST],
    found: Found,
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Whether forces and moves may come in one pass. Not on several threads, as each asks where spheres of the others
    /// are.
    pub(super) fn streams(&self) -> bool {
        self.parts.sorted && self.list.is_some() && self.division.is_none() && self.ledger.is_none()
    }

    /// Adds up all forces, with near pairs that hold, then kicks for these times (s), drifts for a time (s), and forgets
    /// the forces. Says who was too fast, and notes whether a contact is too deep.
    pub(super) fn stream(&mut self, kicks: &[f64], drift: f64) -> FirstTooFast {
        if !std::mem::replace(&mut self.cleared, true) {
            self.parts.particles.clear_forces();
        }
        self.age.time += drift;
        self.near_age.time += drift;
        self.bodies.resize_with(1, Bodies::new);
        let pairs = self.near.take_pairs();
        let spheres = self.parts.particles.len();
        let mut pass = Pass::default();
        while pass.sphere < spheres {
            let end = (pass.pair + SPAN).min(pairs.len());
            let until = match pairs.get(end) {
                Some(next) => next.i() as usize / BLOCK * BLOCK,
                None => spheres,
            };
            self.add_contacts(&mut pass, &pairs[..end], until);
            self.move_until(&mut pass, until, kicks, drift);
        }
        self.near.return_pairs(pairs);
        self.too_deep = pass.too_deep.into_iter().flatten().next();
        self.stale |= pass.found.far;
        pass.found.too_fast
    }

    /// Adds the forces of the next pairs, up to the last of these, and of walls on the spheres before `until`.
    fn add_contacts(&mut self, pass: &mut Pass, pairs: &[NearPair], until: usize) {
        let (laws, far) = (self.laws(), come_from_far(&self.pair_history));
        let particles = &mut self.parts.particles;
        let mut force = std::mem::take(&mut particles.force);
        let mut torque = std::mem::take(&mut particles.torque);
        let mut walls = [const { None }; TankWall::MOST];
        for ((place, wall), from) in walls.iter_mut().zip(&mut self.walls).zip(&mut pass.at_wall) {
            let end = *from + wall.near[*from..].partition_point(|it| (it.i as usize) < until);
            let next = std::mem::replace(from, end)..end;
            let known = Known {
                contacts: &wall.near[next.clone()],
                histories: &mut wall.histories[next],
            };
            *place = Some((wall.wall, known));
        }
        let next = std::mem::replace(&mut pass.pair, pairs.len())..pairs.len();
        let mut share = Share {
            sums: Sums {
                first: 0,
                force: &mut force,
                torque: &mut torque,
            },
            clear: false,
            buffers: &mut self.buffers,
            crossing: Known {
                contacts: &[],
                histories: &mut [],
            },
            pairs: Known {
                contacts: &pairs[next.clone()],
                histories: &mut self.pair_history[next],
            },
            walls,
            too_deep: pass.too_deep,
        };
        let scenery = Scenery {
            laws,
            particles,
            earlier: &self.earlier,
            alike: self.alike,
            mostly_touch: self.near.mostly_touch(),
            far,
        };
        share.add_contacts(self.level, &scenery, &mut self.profile);
        pass.too_deep = share.too_deep;
        (particles.force, particles.torque) = (force, torque);
    }

    /// Moves the next spheres, those before `until`.
    fn move_until(&mut self, pass: &mut Pass, until: usize, kicks: &[f64], drift: f64) {
        let moves = Moves {
            effects: &self.parts.effects,
            kicks,
            drift: Some(Drift {
                dt: drift,
                allowance: Some(self.near.allowance(self.near_age.time)),
            }),
            clear: true,
            limits: &self.parts.limits,
            dt: self.parts.dt,
        };
        let reference = self.near.anchor().position();
        let mut all = Spheres::new(&mut self.parts.particles, reference);
        let from = std::mem::replace(&mut pass.sphere, until);
        all.split(from);
        let next = all.split(until - from);
        let found = moves.of_all(next, &mut self.bodies, self.level, &mut self.profile);
        pass.found = pass.found.and(found);
    }
}
