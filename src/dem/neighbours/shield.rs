//! Which spheres shield which from below: what is known for some steps, and the pairs to be tested
//! in each.

use super::{NearPair, Particles, WORD};
use crate::particles::block::{ROWS, ones, turned};
use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8};

/// The count of spheres that shield each one, kept up with the pairs whose part in it may change.
/// From one step to the next few do: what is found is compared with what was, and only what differs
/// is counted.
#[derive(Default)]
pub(super) struct Shield {
    /// Spheres that shield each one.
    pub(super) counts: Vec<u32>,
    /// Undecided pairs; whole groups, filled up with a sphere that does not shield itself.
    pub(super) pairs: Vec<NearPair>,
    /// Of as many pairs as a number has bits: whose second sphere shields the first, and whose
    /// first the second, as far as `counts` has it.
    shields: Vec<[u64; 2]>,
}

impl Shield {
    /// Begins anew with pairs, so many of those in `pairs`, that `counts` has nothing of.
    pub(super) fn begin(&mut self, pairs: usize) {
        self.pairs.truncate(pairs);
        self.pairs
            .resize(pairs.next_multiple_of(ROWS), NearPair::default());
        self.shields.clear();
        self.shields.resize(pairs.div_ceil(WORD), [0; 2]);
    }

    /// Counts what is so at the present positions; all spheres have the same radius (m), if one is
    /// given.
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
        // What is found of many is compared at once: that something has changed is hard to foresee
        // of a few.
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

/// Whose second sphere shields the first, and whose first the second, of eight pairs, as bits.
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
        |k| pairs[k].difference(simd, position),
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

/// Notes what has changed in some pairs.
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
