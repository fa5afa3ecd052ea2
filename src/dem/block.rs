//! Blocks of pairs, one array per quantity.
//!
//! Vectors lie in memory in rows of four numbers, so that a pair finds each of a partner in one
//! place; contact laws are computed for a block of pairs at once, which needs each
//! quantity of all pairs side by side. The way from the one to the other is the transposition of
//! four rows of four numbers, in registers. No number is changed by it.

use fearless_simd::{Simd, SimdBase, SimdInto, f64x4};

/// Pairs in a block.
pub(in crate::dem) const BLOCK: usize = 32;

/// Four numbers side by side.
pub(in crate::dem) type Row = [f64; 4];

/// One quantity of every pair in a block.
pub(in crate::dem) type Column = [f64; BLOCK];

/// The columns of one kind of row.
#[repr(align(64))]
pub(in crate::dem) struct Columns(pub(in crate::dem) [Column; 4]);

impl Columns {
    pub(in crate::dem) const ZERO: Self = Self([[0.0; BLOCK]; 4]);

    /// Fills the columns with the rows of `index.len()` spheres.
    #[inline(always)]
    pub(in crate::dem) fn gather<S: Simd>(
        &mut self,
        simd: S,
        index: &[u32; BLOCK],
        row: impl Fn(usize) -> Row,
    ) {
        for at in (0..BLOCK).step_by(4) {
            let index = [index[at], index[at + 1], index[at + 2], index[at + 3]];
            let rows = [
                row(index[0] as usize).simd_into(simd),
                row(index[1] as usize).simd_into(simd),
                row(index[2] as usize).simd_into(simd),
                row(index[3] as usize).simd_into(simd),
            ];
            let [a, b, c, d] = transpose::<S>(rows);
            a.store_slice(&mut self.0[0][at..at + 4]);
            b.store_slice(&mut self.0[1][at..at + 4]);
            c.store_slice(&mut self.0[2][at..at + 4]);
            d.store_slice(&mut self.0[3][at..at + 4]);
        }
    }

    /// Fills the columns with the differences of the rows of spheres, without the fourth numbers.
    #[inline(always)]
    pub(in crate::dem) fn gather_differences<S: Simd>(
        &mut self,
        simd: S,
        index: &[[u32; BLOCK]; 2],
        row: impl Fn(usize) -> Row,
    ) {
        let [one, other] = index;
        for at in (0..BLOCK).step_by(4) {
            let difference = |k: usize| -> f64x4<S> {
                let one: f64x4<S> = row(one[at + k] as usize).simd_into(simd);
                let other: f64x4<S> = row(other[at + k] as usize).simd_into(simd);
                one - other
            };
            let rows = [difference(0), difference(1), difference(2), difference(3)];
            let [a, b, c, _] = transpose::<S>(rows);
            a.store_slice(&mut self.0[0][at..at + 4]);
            b.store_slice(&mut self.0[1][at..at + 4]);
            c.store_slice(&mut self.0[2][at..at + 4]);
        }
    }

    /// Puts one row into its place.
    pub(in crate::dem) fn set(&mut self, k: usize, row: Row) {
        for (column, value) in self.0.iter_mut().zip(row) {
            column[k] = value;
        }
    }

    /// The four rows from `at` on.
    #[inline(always)]
    pub(in crate::dem) fn rows<S: Simd>(&self, simd: S, at: usize) -> [f64x4<S>; 4] {
        let [a, b, c, d] = &self.0;
        transpose([
            f64x4::from_slice(simd, &a[at..at + 4]),
            f64x4::from_slice(simd, &b[at..at + 4]),
            f64x4::from_slice(simd, &c[at..at + 4]),
            f64x4::from_slice(simd, &d[at..at + 4]),
        ])
    }
}

/// Rows as columns. Spelled out, as closures given to array methods would be calls of functions that
/// are compiled without these vectors.
#[inline(always)]
fn transpose<S: Simd>([a, b, c, d]: [f64x4<S>; 4]) -> [f64x4<S>; 4] {
    let (ac, bd) = (a.interleave(c), b.interleave(d));
    let (low, high) = (ac.0.interleave(bd.0), ac.1.interleave(bd.1));
    [low.0, low.1, high.0, high.1]
}
