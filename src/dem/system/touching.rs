//! Which of those that are near each other touch: contacts are computed of these alone.

use super::meeting::Solid;
use crate::dem::block::{BLOCK, ROWS, row, turned};
use crate::dem::neighbours::NearPair;
use crate::dem::particles::Particles;
use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask32x8, mask64x8, u32x8, u64x8};

/// Contacts that are looked at before those that touch are computed: few enough to stay at hand, so many that
/// few lanes are left over.
pub(super) const LOOK: usize = 512;

/// As lanes are written whole, some are written in vain.
const ROOM: usize = LOOK + ROWS;

/// Contacts that touch, in the order of their list.
pub(super) struct Touching {
    pairs: [NearPair; ROOM],
    /// The last few that are looked at.
    rest: [NearPair; ROWS],
    /// Where the histories are.
    entries: [u32; ROOM],
    /// Centre of the first partner from that of the second, or from the origin at a wall (m).
    offset: [[f64; ROOM]; 3],
}

/// A block of contacts that touch; lanes without one repeat the last.
#[derive(Clone, Copy)]
pub(super) struct Lanes<'a> {
    pub(super) pairs: &'a [NearPair; BLOCK],
    pub(super) entries: &'a [u32; BLOCK],
    pub(super) offset: [&'a [f64; BLOCK]; 3],
    /// How many lanes have one.
    pub(super) count: usize,
}

impl Touching {
    pub(super) fn new() -> Self {
        Self {
            pairs: [NearPair::default(); ROOM],
            rest: [NearPair::default(); ROWS],
            entries: [0; ROOM],
            offset: [[0.0; ROOM]; 3],
        }
    }

    /// The block from `at` on, of so many contacts.
    #[inline(always)]
    pub(super) fn block(&self, at: usize, found: usize) -> Lanes<'_> {
        const FITS: &str = "a block lies within the room";
        let all = at..at + BLOCK;
        let [x, y, z] = &self.offset;
        Lanes {
            pairs: self.pairs[all.clone()].try_into().expect(FITS),
            entries: self.entries[all.clone()].try_into().expect(FITS),
            offset: [
                x[all.clone()].try_into().expect(FITS),
                y[all.clone()].try_into().expect(FITS),
                z[all].try_into().expect(FITS),
            ],
            count: (found - at).min(BLOCK),
        }
    }

    /// Finds who touches among these, up to [`LOOK`] of them, the first of which has its history `from`
    /// there on; histories of the others begin anew. Says how many they are.
    #[inline(always)]
    fn find<S: Simd, H: Default>(
        &mut self,
        simd: S,
        near: &[NearPair],
        from: usize,
        histories: &mut [H],
        touch: impl Fn(&[NearPair; ROWS]) -> (mask64x8<S>, [f64x8<S>; 3]),
    ) -> usize {
        const { assert!(LOOK.is_multiple_of(BLOCK)) };
        let mut found = 0;
        for (first, contacts) in (from..).step_by(ROWS).zip(near.chunks(ROWS)) {
            let eight = match <&[NearPair; ROWS]>::try_from(contacts) {
                Ok(all) => all,
                Err(_) => {
                    for k in 0..ROWS {
                        self.rest[k] = contacts[k.min(contacts.len() - 1)];
                    }
                    &self.rest
                }
            };
            let (mut mask, offset) = touch(eight);
            let mut bits = mask.to_bitmask();
            if contacts.len() < ROWS {
                bits &= (1 << contacts.len()) - 1;
                mask = mask64x8::from_bitmask(simd, bits);
            }
            let mut words = [0; ROWS];
            for k in 0..ROWS {
                words[k] = eight[k].word();
            }
            let all = found..found + ROWS;
            let pairs = u64x8::from_slice(simd, &words).compress(mask);
            pairs.store_slice(&mut words);
            let kept = &mut self.pairs[all.clone()];
            for k in 0..ROWS {
                kept[k] = NearPair::of_word(words[k]);
            }
            for (column, lanes) in self.offset.iter_mut().zip(offset) {
                lanes.compress(mask).store_slice(&mut column[all.clone()]);
            }
            if size_of::<H>() > 0 {
                let mut entries = [0; ROWS];
                for k in 0..ROWS {
                    entries[k] = (first + k) as u32;
                }
                let mask = mask32x8::from_bitmask(simd, bits);
                let entries = u32x8::from_slice(simd, &entries).compress(mask);
                entries.store_slice(&mut self.entries[all]);
                for (k, history) in histories[first..]
                    .iter_mut()
                    .take(contacts.len())
                    .enumerate()
                {
                    if bits >> k & 1 == 0 {
                        *history = H::default();
                    }
                }
            }
            found += bits.count_ones() as usize;
        }
        self.fill_up(found);
        found
    }

    /// Repeats the last contact to the end of its block.
    #[inline(always)]
    fn fill_up(&mut self, found: usize) {
        for k in found..found.next_multiple_of(BLOCK) {
            let last = found - 1;
            self.pairs[k] = self.pairs[last];
            self.entries[k] = self.entries[last];
            for column in &mut self.offset {
                column[k] = column[last];
            }
        }
    }

    /// [Finds](Self::find) pairs that touch; `alike` says what all spheres are like, if they are alike.
    #[inline(always)]
    pub(super) fn pairs<S: Simd, H: Default>(
        &mut self,
        simd: S,
        near: &[NearPair],
        from: usize,
        histories: &mut [H],
        particles: &Particles,
        alike: Option<Solid>,
    ) -> usize {
        let Particles {
            position, radius, ..
        } = particles;
        let position = &position[..];
        self.find(
            simd,
            near,
            from,
            histories,
            #[inline(always)]
            |eight| {
                let [x, y, z] = turned::<S>(
                    #[inline(always)]
                    |k| row(simd, position, eight[k].i()) - row(simd, position, eight[k].j()),
                );
                let sum = match alike {
                    Some(solid) => f64x8::splat(simd, solid.radius + solid.radius),
                    None => {
                        let mut sum = [0.0; ROWS];
                        for k in 0..ROWS {
                            sum[k] = radius[eight[k].i() as usize] + radius[eight[k].j() as usize];
                        }
                        f64x8::from_slice(simd, &sum)
                    }
                };
                ((x * x + y * y + z * z).simd_lt(sum * sum), [x, y, z])
            },
        )
    }
}
