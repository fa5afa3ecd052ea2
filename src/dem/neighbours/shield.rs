//! Which spheres shield which from below: counts that hold for some steps, and the pairs to be
//! tested in each step.

use super::{NearPair, Particles, WORD};
use crate::particles::block::{ROWS, ones, row, turned};
use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8};

/// For each sphere the number of spheres that shield it, updated for the undecided pairs: those in
/// which shielding may change. Few of them change from one step to the next. So the bits of all
/// undecided pairs are compared with the previous step, and only the differences are counted.
#[derive(Default)]
pub(super) struct Shield {
    /// For each sphere the number of spheres that shield it.
    pub(super) counts: Vec<u32>,
    /// Undecided pairs in whole groups, filled up with pairs of a sphere and itself, which shield
    /// nothing.
    pub(super) pairs: Vec<NearPair>,
    /// For groups of as many pairs as a word has bits: in which pairs the second sphere shields the
    /// first, and in which the first the second, as counted in `counts`.
    shields: Vec<[u64; 2]>,
}

impl Shield {
    /// Begins again with this number of entries of `pairs`, none of which is counted in `counts`.
    pub(super) fn begin(&mut self, pairs: usize) {
        self.pairs.truncate(pairs);
        self.pairs
            .resize(pairs.next_multiple_of(ROWS), NearPair::default());
        self.shields.clear();
        self.shields.resize(pairs.div_ceil(WORD), [0; 2]);
    }

    /// Updates the counts for the present positions. All spheres have the same radius (m), if one
    /// is given.
    pub(super) fn count(
        &mut self,
        level: Level,
        particles: &Particles,
        common_radius: Option<f64>,
    ) {
        fearless_simd::dispatch!(level, simd => self.count_all(simd, particles, common_radius));
    }

    #[inline(always)]
    fn count_all<S: Simd>(&mut self, simd: S, particles: &Particles, common_radius: Option<f64>) {
        // Many pairs are compared at once: for a few pairs the branch would be unpredictable.
        for (pairs, shields) in self.pairs.chunks(WORD).zip(&mut self.shields) {
            let mut now = [0; 2];
            for (eight, at) in pairs.chunks_exact(ROWS).zip((0..).step_by(ROWS)) {
                let [first, second] = who_shields(simd, eight, particles, common_radius);
                now[0] |= first << at;
                now[1] |= second << at;
            }
            if now != *shields {
                note(&mut self.counts, pairs, *shields, now);
                *shields = now;
            }
        }
    }
}

/// In which of eight pairs the second sphere shields the first, and in which the first the second,
/// as bits.
#[inline(always)]
fn who_shields<S: Simd>(
    simd: S,
    pairs: &[NearPair],
    particles: &Particles,
    common_radius: Option<f64>,
) -> [u64; 2] {
    let position = &particles.position[..];
    let [dx, dy, dz] = turned::<S>(
        #[inline(always)]
        |k| row(simd, position, pairs[k].i()) - row(simd, position, pairs[k].j()),
    );
    let (dx, dy) = (dx.abs(), dy.abs());
    let within = |diameter: f64x8<S>| dx.simd_lt(diameter) & dy.simd_lt(diameter);
    let (first, second) = match common_radius {
        Some(radius) => {
            let within = within(f64x8::splat(simd, 2.0 * radius));
            (within, within)
        }
        None => {
            let diameter = |side: usize| -> [f64; ROWS] {
                std::array::from_fn(|k| 2.0 * particles.radius[pairs[k].sides()[side] as usize])
            };
            (
                within(f64x8::from_slice(simd, &diameter(0))),
                within(f64x8::from_slice(simd, &diameter(1))),
            )
        }
    };
    let zero = f64x8::splat(simd, 0.0);
    [
        (first & zero.simd_lt(dz)).to_bitmask(),
        (second & dz.simd_lt(zero)).to_bitmask(),
    ]
}

/// Counts what has changed in some pairs.
fn note(counts: &mut [u32], pairs: &[NearPair], before: [u64; 2], now: [u64; 2]) {
    for side in [0, 1] {
        for k in ones(before[side] ^ now[side]) {
            let count = &mut counts[pairs[k].sides()[side] as usize];
            match now[side] >> k & 1 {
                1 => *count += 1,
                _ => *count -= 1,
            }
        }
    }
}
