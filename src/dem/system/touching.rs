//! Which near pairs touch. The laws are computed for these alone, unless nearly all near pairs
//! touch.

use super::contact_state::SphereProperties;
use super::partners::Partners;
use crate::dem::neighbours::{NearPair, keep_pairs};
use crate::particles::block::{BLOCK, ROWS, row, turned};
use crate::particles::domain::{Domain, OpenSpace, Space};
use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask32x8, mask64x8, u32x8};
use prefetch_index::prefetch_index;

/// Near pairs that are tested before the laws are computed for those that touch. They are few
/// enough to stay in the cache, and so many that few lanes of blocks stay empty.
pub(super) const CHUNK: usize = 512;

/// Histories of more bytes than this exceed the caches, and are prefetched.
const CACHE_BYTES: usize = 1 << 25;

/// Whether all histories together exceed the caches.
pub(super) fn exceed_caches<H>(histories: &[H]) -> bool {
    size_of_val(histories) > CACHE_BYTES
}

/// Results are written eight at a time, so the last group needs extra room.
const ROOM: usize = CHUNK + ROWS;

/// Pairs that touch, in the order of the list; or all pairs, if nearly all touch.
pub(super) struct Touching {
    pairs: [NearPair; ROOM],
    /// The last pairs to be tested, filled up to eight.
    rest: [NearPair; ROWS],
    /// Where their histories are.
    entries: [u32; ROOM],
    /// Entries of the histories of pairs that do not touch.
    apart: [u32; ROOM],
    /// Offset of the first centre from the second (m).
    offset: [[f64; ROOM]; 3],
    /// Whether histories are prefetched.
    pub(super) prefetched: bool,
}

/// A block of contacts; lanes without one repeat the last.
#[derive(Clone, Copy)]
pub(super) struct ContactLanes<'a> {
    pub(super) pairs: &'a [NearPair; BLOCK],
    pub(super) entries: Entries<'a>,
    /// Offsets of the first centres from the second (m), if they are known.
    pub(super) offset: Option<[&'a [f64; BLOCK]; 3]>,
    /// How many lanes hold a contact.
    pub(super) count: usize,
}

/// Where the histories of a block of contacts are.
#[derive(Clone, Copy)]
pub(super) enum Entries<'a> {
    /// At these indices.
    Listed(&'a [u32; BLOCK]),
    /// One after the other from this index on.
    From(usize),
}

impl Touching {
    pub(super) fn new() -> Self {
        Self {
            pairs: [NearPair::default(); ROOM],
            rest: [NearPair::default(); ROWS],
            entries: [0; ROOM],
            apart: [0; ROOM],
            offset: [[0.0; ROOM]; 3],
            prefetched: false,
        }
    }

    /// The block from `at` on, of `found` contacts in all.
    #[inline(always)]
    pub(super) fn block(&self, at: usize, found: usize) -> ContactLanes<'_> {
        const FITS: &str = "a block lies within the room";
        let all = at..at + BLOCK;
        let [x, y, z] = &self.offset;
        ContactLanes {
            pairs: self.pairs[all.clone()].try_into().expect(FITS),
            entries: Entries::Listed(self.entries[all.clone()].try_into().expect(FITS)),
            offset: Some([
                x[all.clone()].try_into().expect(FITS),
                y[all.clone()].try_into().expect(FITS),
                z[all].try_into().expect(FITS),
            ]),
            count: (found - at).min(BLOCK),
        }
    }

    /// The first [`BLOCK`] of these contacts, or all if there are fewer. Whether they touch is left
    /// to the laws. The history of the first is at `from`.
    #[inline(always)]
    pub(super) fn first_of<'a>(
        &'a mut self,
        near: &'a [NearPair],
        from: usize,
    ) -> ContactLanes<'a> {
        let Some(pairs) = near.first_chunk() else {
            self.pairs[..near.len()].copy_from_slice(near);
            for (entry, at) in self.entries.iter_mut().zip(from..from + near.len()) {
                *entry = at as u32;
            }
            self.fill_up(near.len());
            return ContactLanes {
                offset: None,
                ..self.block(0, near.len())
            };
        };
        ContactLanes {
            pairs,
            entries: Entries::From(from),
            offset: None,
            count: BLOCK,
        }
    }

    /// Finds the pairs that touch among at most [`CHUNK`] pairs, and returns their number. The
    /// history of the first pair is at `from`. Pairs that do not touch lose their histories.
    /// `alike` holds the properties of all spheres, if they are alike.
    #[inline(always)]
    pub(super) fn find<S: Simd, H: Default>(
        &mut self,
        simd: S,
        near: &[NearPair],
        from: usize,
        histories: &mut [H],
        partners: &Partners<'_>,
        alike: Option<SphereProperties>,
    ) -> usize {
        // Compiled for each kind of space: open space computes nothing for images.
        match partners.domain.is_open() {
            true => self.find_in::<OpenSpace, S, H>(simd, near, from, histories, partners, alike),
            false => self.find_in::<Domain, S, H>(simd, near, from, histories, partners, alike),
        }
    }

    #[inline(always)]
    fn find_in<D: Space, S: Simd, H: Default>(
        &mut self,
        simd: S,
        near: &[NearPair],
        from: usize,
        histories: &mut [H],
        partners: &Partners<'_>,
        alike: Option<SphereProperties>,
    ) -> usize {
        const { assert!(CHUNK.is_multiple_of(BLOCK)) };
        let (mut found, mut apart) = (0, 0);
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
            let (mut touch, offset) = touches::<D, S>(simd, eight, partners, alike);
            let mut bits = touch.to_bitmask();
            if contacts.len() < ROWS {
                bits &= (1 << contacts.len()) - 1;
                touch = mask64x8::from_bitmask(simd, bits);
            }
            let all = found..found + ROWS;
            let kept = keep_pairs(simd, eight, bits, &mut self.pairs[all.clone()]);
            for (column, lanes) in self.offset.iter_mut().zip(offset) {
                lanes.compress(touch).store_slice(&mut column[all.clone()]);
            }
            if size_of::<H>() > 0 {
                if self.prefetched {
                    prefetch_histories(histories, first);
                }
                keep_entries(simd, first, bits, &mut self.entries[all]);
                let others = &mut self.apart[apart..apart + ROWS];
                let apart_bits = (1 << contacts.len()) - 1 - bits;
                keep_entries(simd, first, apart_bits, others);
                apart += contacts.len() - kept;
            }
            found += kept;
        }
        // Not in the loop above, where this branch would be unpredictable.
        self.clear_histories(apart, histories);
        self.fill_up(found);
        found
    }

    /// Clears the histories of the first `apart` pairs that do not touch.
    #[inline(always)]
    fn clear_histories<H: Default>(&self, apart: usize, histories: &mut [H]) {
        if size_of::<H>() > 0 {
            for &entry in &self.apart[..apart] {
                histories[entry as usize] = H::default();
            }
        }
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
}

/// Which of the pairs touch, and all their offsets (m).
#[inline(always)]
fn touches<D: Space, S: Simd>(
    simd: S,
    pairs: &[NearPair; ROWS],
    partners: &Partners<'_>,
    alike: Option<SphereProperties>,
) -> (mask64x8<S>, [f64x8<S>; 3]) {
    let (position, radius) = (partners.position, partners.radius);
    let offset = turned::<S>(
        #[inline(always)]
        |k| row(simd, position, pairs[k].i()) - row(simd, position, pairs[k].j()),
    );
    let [x, y, z] = D::of(partners.domain).nearest_of_eight(simd, offset);
    let sum = match alike {
        Some(properties) => f64x8::splat(simd, properties.radius + properties.radius),
        None => {
            let mut sum = [0.0; ROWS];
            for k in 0..ROWS {
                sum[k] = radius[pairs[k].i() as usize] + radius[pairs[k].j() as usize];
            }
            f64x8::from_slice(simd, &sum)
        }
    };
    ((x * x + y * y + z * z).simd_lt(sum * sum), [x, y, z])
}

/// Prefetches the histories of the next eight pairs.
#[inline(always)]
fn prefetch_histories<H>(histories: &[H], first: usize) {
    const LINE: usize = 64;
    for entry in (first..first + ROWS).step_by(LINE / size_of::<H>().clamp(1, LINE)) {
        prefetch_index(histories, entry);
    }
}

/// Writes the entries of the pairs that `which` selects; `first` is the entry of the first pair.
#[inline(always)]
fn keep_entries<S: Simd>(simd: S, first: usize, which: u64, list: &mut [u32]) {
    let mut entries = [0; ROWS];
    for k in 0..ROWS {
        entries[k] = (first + k) as u32;
    }
    let which = mask32x8::from_bitmask(simd, which);
    u32x8::from_slice(simd, &entries)
        .compress(which)
        .store_slice(list);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::particles::Particles;
    use crate::particles::vector::Vector;
    use fearless_simd::Level;
    use proptest::prelude::*;

    /// Spheres of radii from 0.5 to 1 in a row, each at this distance along x from the one before.
    fn spheres(gaps: &[f64]) -> Particles {
        let mut x = 0.0;
        let place = |gap: &f64| {
            x += gap;
            Vector::new(x, 0.5 * x, -x)
        };
        Particles {
            position: gaps.iter().map(place).collect(),
            radius: (0..gaps.len())
                .map(|k| 0.5 + 0.1 * (k % 6) as f64)
                .collect(),
            ..Particles::default()
        }
    }

    proptest! {
        /// The result equals a test pair by pair: the same pairs in the same order, with their
        /// histories. The other histories are cleared.
        #[test]
        fn pairs_that_touch_are_found(
            gaps in prop::collection::vec(0.1..1.5, 1..120),
            from in 0..3_usize,
        ) {
            let particles = spheres(&gaps);
            let last = gaps.len() as u32;
            let near: Vec<NearPair> = (1..last).map(|j| NearPair::new(j - 1, j)).collect();
            let mut histories: Vec<u32> = (0..(from + near.len()) as u32).map(|k| k + 1).collect();
            let mut touching = Touching::new();
            let filter = |touching: &mut Touching, histories: &mut Vec<u32>| {
                fearless_simd::dispatch!(Level::new(), simd => {
                    {
                        let all = Partners::all(&particles, &[]);
                        touching.find(simd, &near, from, histories, &all, None)
                    }
                })
            };
            let found = filter(&mut touching, &mut histories);
            let touch = |pair: &NearPair| {
                let [i, j] = pair.sides().map(|i| i as usize);
                let offset = particles.position[i] - particles.position[j];
                let sum = particles.radius[i] + particles.radius[j];
                offset.norm_squared() < sum * sum
            };
            let expected: Vec<usize> = (0..near.len()).filter(|&k| touch(&near[k])).collect();
            prop_assert_eq!(found, expected.len());
            for (at, &k) in expected.iter().enumerate() {
                prop_assert_eq!(touching.pairs[at], near[k]);
                prop_assert_eq!(touching.entries[at] as usize, from + k);
            }
            for (k, pair) in near.iter().enumerate() {
                let kept = histories[from + k] == (from + k + 1) as u32;
                prop_assert_eq!(kept, touch(pair));
            }
            prop_assert!(histories[..from].iter().zip(1..).all(|(&it, k)| it == k));
            // All pairs as they are.
            for at in (0..near.len()).step_by(BLOCK) {
                let lanes = touching.first_of(&near[at..], from + at);
                let entry = |k: usize| match lanes.entries {
                    Entries::Listed(entries) => entries[k] as usize,
                    Entries::From(first) => first + k,
                };
                prop_assert_eq!(lanes.count, (near.len() - at).min(BLOCK));
                prop_assert!(lanes.offset.is_none());
                for k in 0..BLOCK {
                    let which = at + k.min(lanes.count - 1);
                    prop_assert_eq!(lanes.pairs[k], near[which]);
                    prop_assert_eq!(entry(k), from + which);
                }
            }
            let found = filter(&mut touching, &mut histories);
            // The lanes of the last block that have no pair repeat the last one.
            for at in (0..found).step_by(BLOCK) {
                let lanes = touching.block(at, found);
                prop_assert_eq!(lanes.count, (found - at).min(BLOCK));
                for k in lanes.count..BLOCK {
                    prop_assert_eq!(lanes.pairs[k], lanes.pairs[lanes.count - 1]);
                    let of_lane = |k: usize| lanes.offset.map(|it| it[0][k]);
                    prop_assert_eq!(of_lane(k), of_lane(lanes.count - 1));
                }
            }
        }
    }
}
