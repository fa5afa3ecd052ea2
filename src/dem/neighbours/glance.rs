//! Tests on a block of pairs, whose results hold for a few steps.

use super::{NearPair, Particles};
use crate::particles::block::{BLOCK, BlockColumn, ROWS, VectorColumns, row};
use fearless_simd::{Simd, SimdBase, SimdMask, f64x8};

/// Results of the tests on eight pairs, as bits.
pub(super) struct Facts {
    /// Near enough to touch.
    pub(super) near: u64,
    /// Touching now.
    pub(super) touching: u64,
    /// Shielding may begin or end.
    pub(super) undecided: u64,
    /// The second sphere shields the first.
    pub(super) shields_first: u64,
    /// The first sphere shields the second.
    pub(super) shields_second: u64,
}

/// A block of pairs to be tested.
pub(super) struct Glance {
    pub(super) pairs: [NearPair; BLOCK],
    /// From the second centre to the first (m).
    offset: VectorColumns,
    /// Radii (m), and the radius of all spheres if these are equal.
    radius: [BlockColumn; 2],
    pub(super) common_radius: Option<f64>,
}

impl Glance {
    pub(super) fn new() -> Self {
        Self {
            pairs: [NearPair::default(); BLOCK],
            offset: VectorColumns::ZERO,
            radius: [[0.0; BLOCK]; 2],
            common_radius: None,
        }
    }

    /// Notes whether all spheres have the same radius. Radii are then not gathered.
    pub(super) fn note_radii(&mut self, radius: &[f64]) {
        let first = radius.first().copied();
        self.common_radius = first.filter(|first| radius.iter().all(|it| it == first));
        if let Some(radius) = self.common_radius {
            self.radius = [[radius; BLOCK]; 2];
        }
    }

    #[inline(always)]
    pub(super) fn gather<S: Simd>(&mut self, simd: S, particles: &Particles) {
        let Particles {
            position, radius, ..
        } = particles;
        let pairs = &self.pairs;
        self.offset.fill::<S>(
            #[inline(always)]
            |k| row(simd, position, pairs[k].i()) - row(simd, position, pairs[k].j()),
        );
        for at in (0..BLOCK).step_by(ROWS) {
            particles.domain.wrap(simd, &mut self.offset, at);
        }
        if self.common_radius.is_none() {
            let [one, other] = &mut self.radius;
            for (k, pair) in self.pairs.iter().enumerate() {
                let [i, j] = pair.sides().map(|i| i as usize);
                (one[k], other[k]) = (radius[i], radius[j]);
            }
        }
    }

    /// Eight of the pairs.
    #[inline(always)]
    pub(super) fn eight(&self, at: usize) -> &[NearPair; ROWS] {
        let eight = self.pairs[at..].first_chunk();
        eight.expect("a block is of whole groups")
    }

    /// Facts of eight pairs that hold while the offset of no pair changes by more than the margin
    /// (m). With a shield, offsets are first turned by the angle of this sine and cosine.
    #[inline(always)]
    pub(super) fn look<S: Simd>(
        &self,
        simd: S,
        at: usize,
        margin: f64,
        shield: Option<(f64, f64)>,
    ) -> Facts {
        let eight = |column: &BlockColumn| f64x8::from_slice(simd, &column[at..at + ROWS]);
        let ([x, y, z], [ri, rj]) = (&self.offset.0, &self.radius);
        let (dx, dy, dz) = (eight(x), eight(y), eight(z));
        let (ri, rj) = (eight(ri), eight(rj));
        let reach = ri + rj + margin;
        let distance_squared = dx * dx + dy * dy + dz * dz;
        let near = distance_squared.simd_lt(reach * reach);
        let touching = distance_squared.simd_lt((ri + rj) * (ri + rj));
        let mut facts = Facts {
            near: near.to_bitmask(),
            touching: touching.to_bitmask(),
            undecided: 0,
            shields_first: 0,
            shields_second: 0,
        };
        if let Some((sine, cosine)) = shield {
            let (dx, dy) = (dx * cosine - dy * sine, dx * sine + dy * cosine);
            let (across, up) = ([dx.abs(), dy.abs()], dz);
            let first = within(across, up, ri, -margin);
            let second = within(across, -up, rj, -margin);
            facts.undecided =
                first ^ within(across, up, ri, margin) | second ^ within(across, -up, rj, margin);
            facts.shields_first = first & !facts.undecided;
            facts.shields_second = second & !facts.undecided;
        }
        facts
    }
}

/// Bit mask of the pairs within the shielding box of spheres of radius `r`: both horizontal
/// distances below 2 `r` + `margin`, and `up` above -`margin` (m). Not a closure, because a closure
/// that is not inlined is compiled without the wide instruction set.
#[inline(always)]
fn within<S: Simd>(across: [f64x8<S>; 2], up: f64x8<S>, r: f64x8<S>, margin: f64) -> u64 {
    let reach = r * 2.0 + margin;
    let above = up.simd_gt(-margin);
    (across[0].simd_lt(reach) & across[1].simd_lt(reach) & above).to_bitmask()
}
