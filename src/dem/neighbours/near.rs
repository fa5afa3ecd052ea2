//! The pairs of the Verlet list that matter for the next few steps.
//!
//! As long as no offset of a pair has changed by more than the margin, a pair with a larger gap
//! cannot touch. A pair that is farther than the margin inside or outside the shield's box keeps
//! its part in the shield. The margin adapts: a narrow one makes more refreshes, which read the
//! whole Verlet list, and a wide one leaves more pairs to be tested in every step.
//!
//! Pairs are tested in blocks. The results are bits of one word, and the pairs that matter are
//! written without a branch.

use super::anchor::{Allowance, Anchor};
use super::follow::indices_of_kept;
use super::glance::Glance;
use super::shield::Shield;
use super::{NearPair, Particles, VerletList, WORD, keep_pairs};
use crate::dem::threads::in_parallel;
use crate::particles::block::{BLOCK, ROWS, ones};
use crate::particles::retain;
use crate::particles::vector::Vector;
use fearless_simd::{Level, Simd};
use std::f64::consts::SQRT_2;
use std::ops::Range;

/// Steps from one refresh to the next that the margin adapts to, for the long lists of the shield.
const COLUMN_LIFE: Range<u64> = 14..28;

/// The same for the short lists of contacts.
const CONTACT_LIFE: Range<u64> = 8..16;

/// The largest margin as a part of the skin, for long lists and for lists of contacts. A wide
/// margin shortens the life of the Verlet list.
const MOST_OF_SKIN: [f64; 2] = [0.5, 0.25];

/// Steps after which near pairs are found again with a smaller margin, although they hold.
const LONG_LIFE: u64 = 64;

/// The largest part of the margin that is used by turning all spheres.
const TURN: f64 = 0.4;

/// Why near pairs are needed.
#[derive(Clone, Copy, Debug)]
pub struct Purpose {
    /// Whether pairs may touch.
    pub contacts: bool,
    /// Whether spheres shield one another.
    pub shield: bool,
}

impl Purpose {
    /// No pair matters.
    pub const NONE: Self = Self {
        contacts: false,
        shield: false,
    };
}

/// The inner list.
pub struct Near {
    purpose: Purpose,
    /// How far the offset of a pair may change (m).
    margin: f64,
    /// The margin that is requested at least, and the smallest that is then allowed (m).
    least: f64,
    smallest: f64,
    anchor: Anchor,
    half_diagonal: f64,
    /// How long the previous list held (s).
    life: f64,
    /// Sine and cosine of the angle by which the spheres are turned for the shield.
    turned: (f64, f64),
    pairs: Vec<NearPair>,
    /// How many pairs touched when they were found.
    touching: usize,
    /// See [`Self::mostly_touch`].
    mostly_touch: bool,
    /// The shield of all pairs.
    shielding: Shield,
    glance: Box<Glance>,
    /// Lists of the other threads, each for its part of the pairs.
    helpers: Vec<Near>,
}

impl Near {
    /// A list that is not built yet. Its margin (m) starts from a guess.
    pub fn new(purpose: Purpose, margin: f64) -> Self {
        Self {
            purpose,
            margin,
            least: 0.0,
            smallest: 0.0,
            anchor: Anchor::default(),
            half_diagonal: 0.0,
            life: 0.0,
            turned: (0.0, 1.0),
            pairs: Vec::new(),
            touching: 0,
            mostly_touch: false,
            shielding: Shield::default(),
            glance: Box::new(Glance::new()),
            helpers: Vec::new(),
        }
    }

    /// How far the offset of a pair may change until the next refresh (m).
    pub fn margin(&self) -> f64 {
        self.margin
    }

    /// The gap (m) beyond which a new list may leave pairs out. It exceeds the margin if spheres
    /// are turned first.
    pub fn reach(&self) -> f64 {
        match self.purpose.shield {
            true => (1.0 + TURN) * self.margin,
            false => self.margin,
        }
    }

    /// The pairs that may touch.
    #[inline]
    pub fn pairs(&self) -> &[NearPair] {
        &self.pairs
    }

    /// Whether nine in ten of the pairs, or more, touched when they were found.
    pub fn mostly_touch(&self) -> bool {
        self.mostly_touch
    }

    /// Returns the pairs, and keeps the memory of the given ones for the next list.
    pub fn exchange_pairs(&mut self, pairs: Vec<NearPair>) -> Vec<NearPair> {
        std::mem::replace(&mut self.pairs, pairs)
    }

    /// The pairs, to be put into another order.
    pub(in crate::dem) fn pairs_mut(&mut self) -> &mut Vec<NearPair> {
        &mut self.pairs
    }

    /// Asks for a margin of at least this (m). Returns whether the list has it already.
    pub fn require(&mut self, margin: f64) -> bool {
        self.least = margin;
        let wide = self.margin >= margin;
        self.margin = self.margin.max(margin);
        wide
    }

    /// Whether the list holds `time` (s) after its refresh, and will hold while no sphere moves by
    /// more than `way` (m).
    pub fn holds(&self, particles: &Particles, time: f64, way: f64) -> bool {
        let margin = self.margin - 2.0 * way;
        let allowance = self.anchor.allowance(time, margin, self.half_diagonal);
        allowance.hold(&particles.position, self.anchor.position())
    }

    /// The spheres at the latest refresh.
    #[inline]
    pub fn anchor(&self) -> &Anchor {
        &self.anchor
    }

    /// Notes that a sphere was added at the end.
    pub fn add_sphere(&mut self, position: Vector) {
        self.anchor.add_sphere(position);
    }

    /// Replaces the pairs by these, until the next refresh.
    pub fn set_pairs(&mut self, pairs: impl Iterator<Item = (u32, u32)>) {
        self.mostly_touch = false;
        self.pairs.clear();
        self.pairs.extend(pairs.map(|(i, j)| NearPair::new(i, j)));
    }

    /// Notes that the spheres not marked in `keep` were removed. Their pairs are removed, and the
    /// others get new indices. The list must then be refreshed. Returns for each pair whether it is
    /// kept.
    pub fn remove_spheres(&mut self, keep: &[bool]) -> Vec<bool> {
        self.anchor.remove_spheres(keep);
        let index = indices_of_kept(keep);
        let stays = |pair: &NearPair| keep[pair.i() as usize] && keep[pair.j() as usize];
        let kept: Vec<bool> = self.pairs.iter().map(stays).collect();
        retain(&mut self.pairs, &kept);
        for pair in &mut self.pairs {
            *pair = NearPair::new(index[pair.i() as usize], index[pair.j() as usize]);
        }
        // Lanes without a pair repeat one of the past, whose spheres may be gone.
        self.glance.pairs = [NearPair::default(); BLOCK];
        kept
    }

    /// The displacements that the list allows `time` (s) after its refresh.
    pub fn allowance(&self, time: f64) -> Allowance {
        self.anchor.allowance(time, self.margin, self.half_diagonal)
    }

    /// Widens or narrows the margin after a list that held for this many steps and this time (s),
    /// for a Verlet list of that skin (m).
    pub fn adapt(&mut self, steps: u64, time: f64, skin: f64) {
        self.life = time;
        let life = if self.purpose.shield {
            COLUMN_LIFE
        } else {
            CONTACT_LIFE
        };
        if steps < life.start {
            self.margin *= 1.25;
        } else if steps >= life.end {
            // A margin that held for long was far too wide.
            self.margin *= if steps < LONG_LIFE { 0.8 } else { 0.3 };
        }
        self.smallest = self.least.max(0.02 * skin);
        let [most_of_long, most] = MOST_OF_SKIN;
        let most = if self.purpose.shield {
            most_of_long
        } else {
            most
        };
        self.margin = (self.margin).clamp(self.smallest, self.smallest.max(most * skin));
    }

    /// Whether the list has held for so many steps that a smaller margin pays. Every near pair
    /// costs as much as one that touches.
    pub fn is_too_wide(&self, steps: u64) -> bool {
        self.purpose.contacts && steps >= LONG_LIFE && self.margin > self.smallest
    }

    /// Builds the list again from a valid Verlet list, on this number of threads of the current
    /// pool.
    pub(in crate::dem) fn refresh(
        &mut self,
        level: Level,
        list: &VerletList,
        particles: &Particles,
        threads: usize,
    ) {
        self.anchor.renew(particles);
        if self.purpose.shield {
            // The offset of a pair inside the box, or coming inside, is no longer than this.
            self.half_diagonal = SQRT_2 * 2.0 * particles.largest_radius() + self.margin;
            // A margin that is requested must be available in full from the start.
            let life = if self.least > 0.0 { 0.0 } else { self.life };
            self.turned = self
                .anchor
                .turn(life, TURN * self.margin / self.half_diagonal);
        }
        let entries = list.pairs();
        if threads == 1 || self.purpose.shield {
            self.find_among(level, list, particles, 0..entries);
        } else {
            let mut helpers = std::mem::take(&mut self.helpers);
            helpers.resize_with(threads - 1, || Self::new(self.purpose, 0.0));
            for helper in &mut helpers {
                helper.margin = self.margin;
            }
            let all = std::iter::once(&mut *self).chain(&mut helpers);
            let mut all: Vec<_> = (0..threads).zip(all).collect();
            in_parallel(&mut all, &|(k, near)| {
                let part = entries * *k / threads..entries * (*k + 1) / threads;
                near.find_among(level, list, particles, part);
            });
            for helper in &mut helpers {
                self.pairs.append(&mut helper.pairs);
                self.touching += helper.touching;
            }
            self.helpers = helpers;
        }
        self.mostly_touch = 10 * self.touching >= 9 * self.pairs.len();
    }

    /// Finds the near pairs among these entries of the list.
    fn find_among(
        &mut self,
        level: Level,
        list: &VerletList,
        particles: &Particles,
        entries: Range<usize>,
    ) {
        self.glance.note_radii(&particles.radius);
        fearless_simd::dispatch!(level, simd => self.find(simd, list, particles, entries));
    }

    #[inline(always)]
    fn find<S: Simd>(
        &mut self,
        simd: S,
        list: &VerletList,
        particles: &Particles,
        entries: Range<usize>,
    ) {
        let shield = self.purpose.shield;
        let (mut near, mut open, mut touching) = (0, 0, 0);
        let Shield {
            counts,
            pairs: undecided,
            ..
        } = &mut self.shielding;
        counts.clear();
        counts.resize(if shield { particles.len() } else { 0 }, 0);
        let glance = &mut *self.glance;
        let mut owner = list.owner_of(entries.start);
        let mut owners = [0; BLOCK];
        let blocks = list.neighbour()[entries.clone()].chunks(BLOCK);
        for (first, partners) in entries.step_by(BLOCK).zip(blocks) {
            list.fill_owners(first, &mut owner, &mut owners[..partners.len()]);
            for (pair, (&i, &j)) in glance.pairs.iter_mut().zip(owners.iter().zip(partners)) {
                *pair = NearPair::new(i, j);
            }
            glance.gather(simd, particles);
            make_room(&mut self.pairs, near);
            make_room(undecided, open);
            let (mut shields_first, mut shields_second) = (0, 0);
            for at in (0..partners.len()).step_by(ROWS) {
                let facts = glance.look(simd, at, self.margin, shield.then_some(self.turned));
                let all = u64::MAX >> (WORD - (partners.len() - at).min(ROWS));
                let eight = glance.eight(at);
                near += keep_pairs(simd, eight, facts.near & all, &mut self.pairs[near..]);
                touching += (facts.touching & all).count_ones() as usize;
                if shield {
                    let which = facts.undecided & all;
                    open += keep_pairs(simd, eight, which, &mut undecided[open..]);
                    shields_first |= (facts.shields_first & all) << at;
                    shields_second |= (facts.shields_second & all) << at;
                }
            }
            add_shields(counts, &glance.pairs, [shields_first, shields_second]);
        }
        self.pairs
            .truncate(if self.purpose.contacts { near } else { 0 });
        self.touching = touching;
        self.shielding
            .begin(if self.purpose.shield { open } else { 0 });
    }

    /// Counts the spheres that shield each one at the present positions.
    pub(in crate::dem) fn count_shielding(&mut self, level: Level, particles: &Particles) {
        self.shielding
            .count(level, particles, self.glance.common_radius);
    }

    /// The latest counts, where spheres shield one another.
    pub fn shielding(&self) -> &[u32] {
        &self.shielding.counts
    }
}

/// Counts a shield for the first spheres of some pairs, and for the second spheres of others, as
/// bits select them.
#[inline(always)]
fn add_shields(counts: &mut [u32], pairs: &[NearPair], shields: [u64; 2]) {
    for (side, shields) in shields.into_iter().enumerate() {
        for k in ones(shields) {
            counts[pairs[k].sides()[side] as usize] += 1;
        }
    }
}

/// Makes sure that a block can be written at `from`.
#[inline(always)]
fn make_room<P: Copy + Default>(list: &mut Vec<P>, from: usize) {
    if list.len() < from + BLOCK + ROWS {
        // Not twice as much, which would waste memory in a large scene.
        list.resize(from + from / 8 + 4 * BLOCK, P::default());
    }
}
