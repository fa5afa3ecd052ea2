//! The space in which spheres move: open, or periodic along some axes.
//!
//! Positions are never wrapped: a sphere that crosses a side goes on beyond it, so that its path
//! and its potential energy stay continuous. A pair meets by its nearest images (the minimum image
//! convention; Allen and Tildesley, Computer Simulation of Liquids, 1987, section 1.5.2).

use super::block::{ROWS, VectorColumns};
use super::vector::Vector;
use fearless_simd::{Simd, SimdBase, f64x8};
use std::ops::Range;

/// Adding and subtracting this rounds to the nearest whole number, ties to even: 3/2 of 2^52, whose
/// last binary digit is 1.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// The space in which spheres move. The default is open.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Domain {
    /// Periods along x, y and z (m), and their inverses; zero along axes that are open.
    period: [f64; 3],
    inverse: [f64; 3],
}

/// How offsets between images are made, for loops that are compiled for each kind of space.
pub(crate) trait Space: Copy {
    /// This kind of space.
    fn of(domain: Domain) -> Self;

    /// The offset between the nearest images (m).
    fn nearest(self, offset: Vector) -> Vector;

    /// The same for eight offsets, in columns.
    fn nearest_of_eight<S: Simd>(self, simd: S, offset: [f64x8<S>; 3]) -> [f64x8<S>; 3];
}

/// Open space, in which every offset is as it is.
#[derive(Clone, Copy)]
pub(crate) struct OpenSpace;

impl Space for OpenSpace {
    #[inline(always)]
    fn of(_domain: Domain) -> Self {
        Self
    }

    #[inline(always)]
    fn nearest(self, offset: Vector) -> Vector {
        offset
    }

    #[inline(always)]
    fn nearest_of_eight<S: Simd>(self, _simd: S, offset: [f64x8<S>; 3]) -> [f64x8<S>; 3] {
        offset
    }
}

impl Space for Domain {
    #[inline(always)]
    fn of(domain: Domain) -> Self {
        domain
    }

    #[inline(always)]
    fn nearest(self, offset: Vector) -> Vector {
        let along = |axis: usize, offset: f64| {
            let images = (offset * self.inverse[axis] + ROUNDER) - ROUNDER;
            offset - images * self.period[axis]
        };
        Vector::new(along(0, offset.x), along(1, offset.y), along(2, offset.z))
    }

    #[inline(always)]
    fn nearest_of_eight<S: Simd>(self, simd: S, offset: [f64x8<S>; 3]) -> [f64x8<S>; 3] {
        let rounder = f64x8::splat(simd, ROUNDER);
        let [x, y, z] = offset;
        let [a, b, c] = self.inverse;
        let [k, l, m] = self.period;
        [
            x - ((x * a + rounder) - rounder) * k,
            y - ((y * b + rounder) - rounder) * l,
            z - ((z * c + rounder) - rounder) * m,
        ]
    }
}

impl Domain {
    /// A space with these periods along x, y and z (m), each above zero; open along the others.
    pub fn new(periods: [Option<f64>; 3]) -> Self {
        Self {
            period: periods.map(|period| period.unwrap_or(0.0)),
            inverse: periods.map(|period| period.map_or(0.0, |period| 1.0 / period)),
        }
    }

    /// Whether no axis is periodic.
    #[inline(always)]
    pub fn is_open(&self) -> bool {
        self.period == [0.0; 3]
    }

    /// The period along each axis (m), where it is periodic.
    pub fn periods(&self) -> [Option<f64>; 3] {
        self.period.map(|period| (period > 0.0).then_some(period))
    }

    /// From the nearest image of `other` to a place (m).
    #[inline(always)]
    pub fn offset(&self, place: Vector, other: Vector) -> Vector {
        match self.is_open() {
            true => place - other,
            false => self.nearest(place - other),
        }
    }

    /// Replaces eight offsets in the columns of a block, from `at` on, by those between the nearest
    /// images (m).
    #[inline(always)]
    pub(crate) fn wrap<S: Simd>(&self, simd: S, offset: &mut VectorColumns, at: usize) {
        if self.is_open() {
            return;
        }
        let eight = at..at + ROWS;
        let columns = (offset.0).each_ref();
        let columns = columns.map(
            #[inline(always)]
            |column| f64x8::from_slice(simd, &column[eight.clone()]),
        );
        let nearest = self.nearest_of_eight(simd, columns);
        for (column, nearest) in offset.0.iter_mut().zip(nearest) {
            nearest.store_slice(&mut column[eight.clone()]);
        }
    }

    /// The image of a place that is in the box from minus half a period to half a period (m). Along
    /// open axes it stays where it is.
    #[inline(always)]
    pub fn wrapped(&self, place: Vector) -> Vector {
        self.offset(place, Vector::ZERO)
    }
}

/// A cell and its neighbours along an axis, each once: one range, or two if they lie on both sides
/// of where a period begins.
#[inline]
pub(crate) fn cells_around(cell: usize, cells: usize, wraps: bool) -> [Range<usize>; 2] {
    let inside = cell.saturating_sub(1)..(cell + 2).min(cells);
    match (wraps && cells > 1, cell) {
        (false, _) => [inside, 0..0],
        (true, _) if cells <= 3 => [0..cells, 0..0],
        (true, 0) => [inside, cells - 1..cells],
        (true, _) if cell + 1 == cells => [inside, 0..1],
        (true, _) => [inside, 0..0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::Level;
    use proptest::prelude::*;

    proptest! {
        /// The nearest image is the nearest of the images around it, and eight at once have the
        /// same bits.
        #[test]
        fn the_nearest_image_is_the_nearest(
            period in prop::array::uniform3(prop::option::of(0.1..5.0_f64)),
            at in prop::array::uniform3(-40.0..40.0_f64),
        ) {
            let domain = Domain::new(period);
            let nearest = domain.wrapped(Vector::from(at));
            let found = [nearest.x, nearest.y, nearest.z];
            for axis in 0..3 {
                let Some(period) = period[axis] else {
                    prop_assert_eq!(found[axis], at[axis]);
                    continue;
                };
                let images = (at[axis] - found[axis]) / period;
                prop_assert!((images - images.round()).abs() < 1e-9);
                prop_assert!(found[axis].abs() <= 0.5 * period * (1.0 + 1e-12));
            }
            fearless_simd::dispatch!(Level::new(), simd => {
                let eight = domain.nearest_of_eight(simd, at.map(|it| f64x8::splat(simd, it)));
                let first = eight.map(|column| <[f64; 8]>::from(column)[0]);
                prop_assert_eq!(first, found);
                Ok(())
            })?;
        }
    }
}
