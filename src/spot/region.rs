//! The spheres in a region, found many at a time.

use crate::particles::block::{ROWS, turned};
use crate::particles::vector::Vector;
use fearless_simd::{Simd, SimdBase, SimdMask, mask32x8, u32x8};
use std::ops::Range;

/// Place (m) far from all regions and spheres. It pads arrays to whole vectors and replaces spheres
/// that have left.
pub(crate) const NOWHERE: Vector = Vector::new(0.0, 0.0, -1e100);

/// Collects the slots of the spheres in some ranges that are nearer to a centre than a radius (m),
/// in order. The positions are padded with at least `ROWS` vectors.
#[inline(always)]
pub(crate) fn collect<S: Simd>(
    simd: S,
    position: &[Vector],
    ranges: &[Range<u32>],
    (centre, radius): (Vector, f64),
    found: &mut Vec<u32>,
) {
    let most: usize = ranges.iter().map(|range| range.len()).sum();
    if found.len() < most + ROWS {
        found.resize(most + ROWS, 0);
    }
    let lanes = u32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
    let mut count = 0;
    for range in ranges {
        for at in range.clone().step_by(ROWS) {
            let rows = &position[at as usize..at as usize + ROWS];
            let [x, y, z] = turned(
                #[inline(always)]
                |k| rows[k].simd(simd),
            );
            let (dx, dy, dz) = (x - centre.x, y - centre.y, z - centre.z);
            let near = (dx * dx + dy * dy + dz * dz).simd_lt(radius * radius);
            let rest = (range.end - at).min(ROWS as u32);
            let bits = near.to_bitmask() & ((1 << rest) - 1);
            (lanes + at)
                .compress(mask32x8::from_bitmask(simd, bits))
                .store_slice(&mut found[count..count + ROWS]);
            count += bits.count_ones() as usize;
        }
    }
    found.truncate(count);
}
