//! Blocks of pairs, one array per quantity.
//!
//! Vectors are stored in rows of four numbers, so that a pair finds each vector of a partner in one
//! place. Contact laws are computed for a block of pairs at once, which needs each quantity of all
//! pairs side by side. Four rows of four numbers are transposed in registers to get from one to the
//! other. This changes no number.

use super::vector::Vector;
use fearless_simd::{Simd, SimdBase, SimdCombine, SimdSplit, f64x4, f64x8};

/// Pairs in a block.
pub(crate) const BLOCK: usize = 32;

/// Four numbers side by side.
pub(crate) type VectorRow = [f64; 4];

/// One quantity of every pair in a block.
pub(crate) type BlockColumn = [f64; BLOCK];

/// The columns of one kind of row.
#[repr(align(64))]
pub(crate) struct VectorColumns(pub(crate) [BlockColumn; 3]);

/// Rows that are turned into columns, or columns into rows, at once.
pub(crate) const ROWS: usize = 8;

impl VectorColumns {
    pub(crate) const ZERO: Self = Self([[0.0; BLOCK]; 3]);

    /// Fills the columns, each with the row of its lane.
    #[inline(always)]
    pub(crate) fn fill<S: Simd>(&mut self, row: impl Fn(usize) -> f64x4<S>) {
        for at in (0..BLOCK).step_by(ROWS) {
            self.fill_from(at, &row);
        }
    }

    /// Fills the columns from `at` on, for as many lanes as rows are transposed at once.
    #[inline(always)]
    pub(crate) fn fill_from<S: Simd>(&mut self, at: usize, row: impl Fn(usize) -> f64x4<S>) {
        let [x, y, z] = turned(
            #[inline(always)]
            |k| row(at + k),
        );
        let [first, second, third] = &mut self.0;
        x.store_slice(&mut first[at..at + ROWS]);
        y.store_slice(&mut second[at..at + ROWS]);
        z.store_slice(&mut third[at..at + ROWS]);
    }

    /// Fills the columns, each with the row of its lane, and `fourth` with the fourth numbers.
    #[inline(always)]
    pub(crate) fn fill_four<S: Simd>(
        &mut self,
        fourth: &mut BlockColumn,
        row: impl Fn(usize) -> f64x4<S>,
    ) {
        let [first, second, third] = &mut self.0;
        for at in (0..BLOCK).step_by(ROWS) {
            let [x, y, z, w] = turned_four(
                #[inline(always)]
                |k| row(at + k),
            );
            x.store_slice(&mut first[at..at + ROWS]);
            y.store_slice(&mut second[at..at + ROWS]);
            z.store_slice(&mut third[at..at + ROWS]);
            w.store_slice(&mut fourth[at..at + ROWS]);
        }
    }

    /// The vector of a lane.
    #[inline(always)]
    pub(crate) fn vector(&self, k: usize) -> Vector {
        let [x, y, z] = &self.0;
        Vector::new(x[k], y[k], z[k])
    }

    /// Writes the vector of a lane.
    #[inline(always)]
    pub(crate) fn set(&mut self, k: usize, vector: Vector) {
        let [x, y, z] = &mut self.0;
        (x[k], y[k], z[k]) = (vector.x, vector.y, vector.z);
    }

    /// The rows from `at` on; their fourth numbers have no meaning.
    #[inline(always)]
    pub(crate) fn rows<S: Simd>(&self, simd: S, at: usize) -> [f64x4<S>; ROWS] {
        // The last number is arbitrary: a row with a known last number would be written in pieces,
        // which is slower to write and to read back.
        self.rows_of_four(simd, at, &self.0[1])
    }

    /// The rows from `at` on, with their fourth numbers.
    #[inline(always)]
    pub(crate) fn rows_of_four<S: Simd>(
        &self,
        simd: S,
        at: usize,
        fourth: &BlockColumn,
    ) -> [f64x4<S>; ROWS] {
        let [first, second, third] = &self.0;
        let (first, second, third, fourth) = (
            &first[at..at + ROWS],
            &second[at..at + ROWS],
            &third[at..at + ROWS],
            &fourth[at..at + ROWS],
        );
        if <S::f64s as SimdBase<S>>::LEN < ROWS {
            let four = |column: &[f64]| f64x4::from_slice(simd, column);
            let half = |x: &[f64], y: &[f64], z: &[f64], w: &[f64]| {
                transpose([four(x), four(y), four(z), four(w)])
            };
            let [a, b, c, d] = half(&first[..4], &second[..4], &third[..4], &fourth[..4]);
            let [e, f, g, h] = half(&first[4..], &second[4..], &third[4..], &fourth[4..]);
            [a, b, c, d, e, f, g, h]
        } else {
            let eight = |column: &[f64]| f64x8::from_slice(simd, column);
            let (x, y, z, w) = (eight(first), eight(second), eight(third), eight(fourth));
            let (low, more_low) = (x.zip_low(z), y.zip_low(w));
            let (high, more_high) = (x.zip_high(z), y.zip_high(w));
            let (a, b) = low.zip_low(more_low).split();
            let (c, d) = low.zip_high(more_low).split();
            let (e, f) = high.zip_low(more_high).split();
            let (g, h) = high.zip_high(more_high).split();
            [a, b, c, d, e, f, g, h]
        }
    }
}

/// Rows as columns, without their fourth numbers.
#[inline(always)]
pub(crate) fn turned<S: Simd>(row: impl Fn(usize) -> f64x4<S>) -> [f64x8<S>; 3] {
    let [x, y, z, _] = turned_four(row);
    [x, y, z]
}

/// Rows as columns. Spelled out, because closures passed to array methods would be compiled without
/// the wide instruction set.
#[inline(always)]
fn turned_four<S: Simd>(row: impl Fn(usize) -> f64x4<S>) -> [f64x8<S>; 4] {
    let (a, b, c, d) = (row(0), row(1), row(2), row(3));
    let (e, f, g, h) = (row(4), row(5), row(6), row(7));
    if <S::f64s as SimdBase<S>>::LEN < ROWS {
        let [x, y, z, w] = transpose([a, b, c, d]);
        let [more_x, more_y, more_z, more_w] = transpose([e, f, g, h]);
        [
            x.combine(more_x),
            y.combine(more_y),
            z.combine(more_z),
            w.combine(more_w),
        ]
    } else {
        let (ab, cd, ef, gh) = (a.combine(b), c.combine(d), e.combine(f), g.combine(h));
        let (even, more_even) = (ab.unzip_low(cd), ef.unzip_low(gh));
        let (odd, more_odd) = (ab.unzip_high(cd), ef.unzip_high(gh));
        [
            even.unzip_low(more_even),
            odd.unzip_low(more_odd),
            even.unzip_high(more_even),
            odd.unzip_high(more_odd),
        ]
    }
}

/// Four rows as columns.
#[inline(always)]
fn transpose<S: Simd>([a, b, c, d]: [f64x4<S>; 4]) -> [f64x4<S>; 4] {
    let (ab, cd) = (a.interleave(b), c.interleave(d));
    let [(x, y), (z, w)] = [ab.0.split(), ab.1.split()];
    let [(more_x, more_y), (more_z, more_w)] = [cd.0.split(), cd.1.split()];
    [
        x.combine(more_x),
        y.combine(more_y),
        z.combine(more_z),
        w.combine(more_w),
    ]
}

/// The row of one of the vectors.
#[inline(always)]
pub(crate) fn row<S: Simd>(simd: S, vectors: &[Vector], i: u32) -> f64x4<S> {
    vectors[i as usize].simd(simd)
}

/// The positions of the bits that are set.
#[inline(always)]
pub(crate) fn ones(mut bits: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(
        #[inline(always)]
        move || {
            let place = (bits != 0).then(|| bits.trailing_zeros() as usize);
            bits &= bits.wrapping_sub(1);
            place
        },
    )
}
