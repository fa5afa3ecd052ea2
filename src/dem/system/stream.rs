//! Forces and moves of a large scene in one pass over its spheres, or over the spheres of each
//! thread.
//!
//! Pairs are sorted by their first spheres. Once the pairs of a sphere are done, no later pair
//! reads its position, and the sphere can be moved while it is in the cache. The operations on a
//! sphere and their order are the same as if all forces came first.
//!
//! A thread never reads the spheres of another thread, which may have moved already. Pairs across a
//! boundary read copies of the spheres around it. So do all later pairs of a thread, starting at
//! the first sphere with a partner in a later thread, because a block of pairs reads its partners
//! from one array.

use super::System;
use super::candidates::{AtWall, Candidates};
use super::contact_task::{ContactSettings, ContactSlice, ContactTask, FirstTooDeep};
use super::division::{ThreadContacts, first_too_deep, threads};
use super::moves::{FirstTooFast, Found, Moves};
use super::partners::Partners;
use super::sums::Sums;
use super::touching::CHUNK;
use crate::dem::bodies::SphereRows;
use crate::dem::neighbours::NearPair;
use crate::dem::profile::Profile;
use crate::dem::threads::in_parallel;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::{History, TangentialLaw};
use crate::particles::block::BLOCK;
use crate::particles::bodies::Bodies;
use fearless_simd::Level;

/// Spheres are moved after this many near pairs. They are few enough that the spheres are still in
/// a near cache, and so many that few lanes of blocks stay empty.
const SPAN: usize = 16 * CHUNK;

/// The work of one thread: forces and moves of its spheres.
pub(super) struct Stream<'a, H> {
    spheres: SphereRows<'a>,
    /// How many of them have been moved.
    moved: usize,
    /// Contacts that are still to be computed.
    contacts: ThreadContacts<'a, H>,
    bodies: &'a mut Bodies,
    /// Copies of spheres around the boundaries.
    before: Option<Partners<'a>>,
    after: Option<Partners<'a>>,
    /// The first contact beyond the overlap limit, pairs before walls.
    too_deep: FirstTooDeep,
    found: Found,
    profile: Option<Box<Profile>>,
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Whether forces and moves may come in one pass.
    pub(super) fn streams(&self) -> bool {
        let division = self.division.as_ref();
        self.setup.sorted
            && self.neighbours.list.is_some()
            && self.ledger.is_none()
            && self.rolling.is_none()
            && division.is_none_or(|it| it.has_narrow_boundaries())
    }

    /// Adds up all forces, kicks for these times (s), drifts for a time (s), and clears the forces.
    /// The near pairs must hold. Returns the first sphere beyond its speed limit, and notes whether
    /// a contact is too deep.
    pub(super) fn stream(&mut self, kicks: &[f64], drift: f64) -> FirstTooFast {
        if !std::mem::replace(&mut self.step.forces_are_zero, true) {
            self.particles.clear_forces();
        }
        self.neighbours.let_pass(drift);
        debug_assert!(
            self.loading.age == 0.0,
            "springs are loaded by present velocities"
        );
        let settings = self.settings();
        let near = &self.neighbours.near;
        let moves = Moves {
            effects: &self.setup.effects,
            kicks,
            drift: Some(self.neighbours.drift(drift)),
            clear: true,
            limits: &self.setup.limits,
            dt: self.setup.dt,
        };
        self.bodies
            .resize_with(threads(self.division.as_ref()), Bodies::new);
        let bodies = &mut self.bodies[..];
        let spheres = SphereRows::new(&mut self.particles, near.anchor().position());
        let candidates = Candidates::all(near.pairs(), &mut self.pair_history, &mut self.walls);
        let mut streams = match &mut self.division {
            Some(division) => {
                let mut bodies = bodies.iter_mut();
                division.share_out(spheres, candidates, |spheres, contacts, around| {
                    let bodies = bodies.next().expect("each thread has bodies");
                    Stream::new(spheres, contacts, bodies, around)
                })
            }
            None => {
                let all = ThreadContacts::all(candidates, &mut self.buffers);
                vec![Stream::new(spheres, all, &mut bodies[0], (None, None))]
            }
        };
        // A profile measures the first thread only. Its `StepPart::Rest` includes the wait for the
        // others.
        streams[0].profile = self.profile.take();
        let level = self.level;
        in_parallel(&mut streams, &|stream| {
            stream.run(level, &settings, &moves);
        });
        self.profile = streams[0].profile.take();
        self.step.too_deep = first_too_deep(streams.iter().map(|it| it.too_deep));
        let found = streams.iter().map(|it| it.found);
        let found = found.fold(Found::default(), Found::and);
        self.neighbours.stale |= found.far;
        found.too_fast
    }
}

impl<'a, H: History> Stream<'a, H> {
    /// The work on these spheres and contacts, with copies of the spheres around the boundaries
    /// before and after them.
    pub(super) fn new(
        spheres: SphereRows<'a>,
        contacts: ThreadContacts<'a, H>,
        bodies: &'a mut Bodies,
        (before, after): (Option<Partners<'a>>, Option<Partners<'a>>),
    ) -> Self {
        Self {
            spheres,
            moved: 0,
            contacts,
            bodies,
            before,
            after,
            too_deep: None,
            found: Found::default(),
            profile: None,
        }
    }

    /// Computes all contacts, and moves each sphere after its last one.
    fn run<N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        level: Level,
        settings: &ContactSettings<N, T>,
        moves: &Moves<'_>,
    ) {
        let first = self.spheres.first;
        let end = first + self.spheres.len();
        if self.before.is_some() {
            let crossing = std::mem::replace(&mut self.contacts.crossing, ContactSlice::none());
            self.add(
                level,
                settings,
                self.before,
                [crossing, ContactSlice::none()],
                first,
            );
        }
        // The spheres from `inside` on have pairs with spheres of later threads.
        let inside = (self.after).map_or(end, |it| (it.first as usize).clamp(first, end));
        let own = &mut self.contacts.pairs;
        let within = (own.contacts).partition_point(|it| (it.i() as usize) < inside);
        let mut within = own.split(within);
        while first + self.moved < inside {
            let until = match within.contacts.get(SPAN) {
                Some(next) => next.i() as usize / BLOCK * BLOCK,
                None => inside,
            };
            let some = within.split(SPAN);
            self.add(level, settings, None, [ContactSlice::none(), some], until);
            self.move_until(level, moves, until);
        }
        if inside < end {
            let rest = std::mem::replace(&mut self.contacts.pairs, ContactSlice::none());
            self.add(
                level,
                settings,
                self.after,
                [ContactSlice::none(), rest],
                end,
            );
            self.move_until(level, moves, end);
        }
    }

    /// Adds the forces of some pairs, crossing ones and own ones, and of walls on the next spheres,
    /// which end before `until`. Contacts read the spheres from `copies`, if these are given.
    fn add<N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        level: Level,
        settings: &ContactSettings<N, T>,
        copies: Option<Partners<'_>>,
        [crossing, pairs]: [ContactSlice<'_, NearPair, H>; 2],
        until: usize,
    ) {
        let walls = self.contacts.walls.iter_mut().map(|at_wall| {
            let near = at_wall.near.contacts;
            let count = near.partition_point(|it| (it.i as usize) < until);
            AtWall {
                wall: at_wall.wall,
                near: at_wall.near.split(count),
            }
        });
        let walls = walls.collect();
        let first = self.spheres.first;
        let (partners, [force, torque]) = Partners::of(&mut self.spheres, &[]);
        let partners = copies.unwrap_or(partners);
        let mut task = ContactTask {
            partners,
            sums: Sums {
                first: first.wrapping_sub(partners.first as usize),
                clear: false,
                force,
                torque,
            },
            buffers: self.contacts.buffers,
            crossing,
            pairs,
            walls,
            too_deep: self.too_deep,
        };
        task.add_contacts(level, settings, &mut self.profile);
        self.too_deep = task.too_deep;
    }

    /// Moves the next spheres, which end before `until`.
    fn move_until(&mut self, level: Level, moves: &Moves<'_>, until: usize) {
        let from = std::mem::replace(&mut self.moved, until - self.spheres.first);
        let next = self.spheres.part(from..self.moved);
        let bodies = std::slice::from_mut(self.bodies);
        let found = moves.apply(next, bodies, level, &mut self.profile);
        self.found = self.found.and(found);
    }
}
