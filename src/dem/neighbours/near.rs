//! The pairs of the Verlet list that matter for the next few steps.
//!
//! While the offset of no pair has changed by more than the margin, a pair farther apart than
//! that cannot touch, and one that is farther than that inside or outside the shield's box keeps
//! its part in the shield. The margin adapts: refreshing takes a look at the whole Verlet list, and
//! a wide margin leaves more pairs to look at in every step.

use super::anchor::{Allowance, Anchor};
use super::{Particles, VerletList};
use crate::dem::vector::Vector;

/// A pair that may touch, and its entry in the Verlet list.
#[derive(Clone, Copy, Debug, Default)]
pub struct NearPair {
    /// The sphere of lower index.
    pub i: u32,
    /// The other sphere.
    pub j: u32,
    /// The pair's entry in the Verlet list.
    pub entry: u32,
}

/// Steps from one refresh to the next that the margin adapts to.
const LIFE: std::ops::Range<u64> = 7..14;

/// The inner list.
#[derive(Clone, Debug, Default)]
pub struct Near {
    /// How far the offset of a pair may change (m).
    margin: f64,
    anchor: Anchor,
    half_diagonal: f64,
    pairs: Vec<NearPair>,
    /// Pairs whose part in the shield must be looked at in every step.
    undecided: Vec<[u32; 2]>,
    /// Spheres that shield each one, of the pairs that are decided.
    shielding: Vec<u32>,
}

impl Near {
    /// A list that is not made yet; its margin (m) starts from a guess.
    pub fn new(margin: f64) -> Self {
        Self {
            margin,
            ..Self::default()
        }
    }

    /// How far the offset of a pair may change until the next refresh (m).
    pub fn margin(&self) -> f64 {
        self.margin
    }

    /// The pairs that may touch.
    #[inline]
    pub fn pairs(&self) -> &[NearPair] {
        &self.pairs
    }

    /// Positions at the latest refresh.
    #[inline]
    pub fn anchor(&self) -> &Anchor {
        &self.anchor
    }

    /// Notes that a sphere was added at the end.
    pub fn add_sphere(&mut self, position: Vector) {
        self.anchor.add_sphere(position);
    }

    /// Notes that the spheres that are not to be kept were removed. The pairs must be looked for
    /// anew.
    pub fn remove_spheres(&mut self, keep: &[bool]) {
        self.anchor.remove_spheres(keep);
        self.pairs.clear();
    }

    /// The displacements that the list allows `time` (s) after its refresh.
    pub fn allowance(&self, time: f64) -> Allowance {
        self.anchor.allowance(time, self.margin, self.half_diagonal)
    }

    /// Widens or narrows the margin after a list that held for this many steps.
    pub fn adapt(&mut self, steps: u64, skin: f64) {
        self.margin = self.margin.min(0.5 * skin);
        if steps < LIFE.start {
            self.margin = (1.25 * self.margin).min(0.5 * skin);
        } else if steps >= LIFE.end {
            self.margin *= 0.8;
        }
    }

    /// Makes the list anew from a valid Verlet list. `forget` is called with each entry that is not
    /// near.
    #[inline(always)]
    pub fn refresh<const CONTACTS: bool, const SHIELD: bool>(
        &mut self,
        list: &VerletList,
        particles: &Particles,
        mut forget: impl FnMut(u32),
    ) {
        let (position, radius) = (&particles.position[..], &particles.radius[..]);
        let margin = self.margin;
        // One spare slot each: a pair is always written, and kept only if it belongs there.
        let (mut near, mut open) = (0, 0);
        if CONTACTS {
            self.pairs.resize(list.pairs() + 1, NearPair::default());
        }
        if SHIELD {
            self.undecided.resize(list.pairs() + 1, [0; 2]);
            self.shielding.clear();
            self.shielding.resize(radius.len(), 0);
        }
        for (i, bounds) in list.start().windows(2).enumerate() {
            let (centre, ri) = (position[i], radius[i]);
            let first = bounds[0];
            let neighbours = &list.neighbour()[first as usize..bounds[1] as usize];
            let mut below = 0;
            for (entry, &j) in (first..).zip(neighbours) {
                let rj = radius[j as usize];
                let offset = centre - position[j as usize];
                if CONTACTS {
                    let reach = ri + rj + margin;
                    let is_near = offset.norm_squared() < reach * reach;
                    let i = i as u32;
                    self.pairs[near] = NearPair { i, j, entry };
                    near += usize::from(is_near);
                    if !is_near {
                        forget(entry);
                    }
                }
                if SHIELD {
                    let distance = offset.x.abs().max(offset.y.abs());
                    let within = |reach: f64, depth: f64| (distance < reach) & (depth > 0.0);
                    let possibly = |r: f64, dz: f64| within(2.0 * r + margin, dz + margin);
                    let certainly = |r: f64, dz: f64| within(2.0 * r - margin, dz - margin);
                    let sure = [certainly(ri, offset.z), certainly(rj, -offset.z)];
                    let decided =
                        (possibly(ri, offset.z) == sure[0]) & (possibly(rj, -offset.z) == sure[1]);
                    self.undecided[open] = [i as u32, j];
                    open += usize::from(!decided);
                    below += u32::from(decided & sure[0]);
                    self.shielding[j as usize] += u32::from(decided & sure[1]);
                }
            }
            if SHIELD {
                self.shielding[i] += below;
            }
        }
        self.pairs.truncate(near);
        self.undecided.truncate(open);
        self.anchor.drop(particles);
        self.half_diagonal = list.half_diagonal;
    }

    /// Counts the spheres that shield each one at the present positions.
    #[inline(always)]
    pub fn count_shielding(&self, particles: &Particles, shielding: &mut [u32]) {
        let (position, radius) = (&particles.position[..], &particles.radius[..]);
        shielding.copy_from_slice(&self.shielding);
        for &[i, j] in &self.undecided {
            let (i, j) = (i as usize, j as usize);
            let offset = position[i] - position[j];
            let (dx, dy) = (offset.x.abs(), offset.y.abs());
            let within = |diameter: f64| (dx < diameter) & (dy < diameter);
            shielding[i] += u32::from(within(2.0 * radius[i]) & (offset.z > 0.0));
            shielding[j] += u32::from(within(2.0 * radius[j]) & (offset.z < 0.0));
        }
    }
}
