//! Pairs of spheres in lists.

use crate::particles::block::ROWS;
use fearless_simd::{Simd, SimdBase, SimdMask, mask64x8, u64x8};
use std::cmp::Ordering;

/// A pair that may touch. Both indices form one number, and lists are sorted by this number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C, align(8))]
pub struct NearPair {
    // On little-endian machines these are the halves of that number in memory.
    second: u32,
    first: u32,
}

impl NearPair {
    /// The pair of a sphere of lower index and another one.
    #[inline(always)]
    pub fn new(i: u32, j: u32) -> Self {
        Self {
            first: i,
            second: j,
        }
    }

    /// The sphere of lower index.
    #[inline(always)]
    pub fn i(self) -> u32 {
        self.first
    }

    /// The other sphere.
    #[inline(always)]
    pub fn j(self) -> u32 {
        self.second
    }

    /// The pair as one number.
    #[inline(always)]
    pub(in crate::dem) fn word(self) -> u64 {
        u64::from(self.first) << 32 | u64::from(self.second)
    }

    /// The pair of a number made by [`Self::word`].
    #[inline(always)]
    pub(in crate::dem) fn of_word(word: u64) -> Self {
        Self::new((word >> 32) as u32, word as u32)
    }

    /// Both spheres.
    pub fn sides(self) -> [u32; 2] {
        [self.i(), self.j()]
    }
}

impl Ord for NearPair {
    fn cmp(&self, other: &Self) -> Ordering {
        self.word().cmp(&other.word())
    }
}

impl PartialOrd for NearPair {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Writes the pairs that `which` selects among eight to the front of a list. The entries after them
/// are arbitrary. Returns how many pairs are selected.
#[inline(always)]
pub(in crate::dem) fn keep_pairs<S: Simd>(
    simd: S,
    pairs: &[NearPair; ROWS],
    which: u64,
    list: &mut [NearPair],
) -> usize {
    let mut words = [0; ROWS];
    for k in 0..ROWS {
        words[k] = pairs[k].word();
    }
    u64x8::from_slice(simd, &words)
        .compress(mask64x8::from_bitmask(simd, which))
        .store_slice(&mut words);
    let list = &mut list[..ROWS];
    for k in 0..ROWS {
        list[k] = NearPair::of_word(words[k]);
    }
    which.count_ones() as usize
}
