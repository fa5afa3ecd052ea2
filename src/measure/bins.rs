//! A region divided into equal boxes.

use super::Region;
use crate::particles::vector::Vector;

/// Bins of one size that fill a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bins {
    pub(super) region: Region,
    /// Number of bins along each axis, one or more.
    pub(super) counts: [usize; 3],
}

impl Bins {
    /// Number of all bins.
    pub(super) fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// The bin of a place, if the region contains it.
    pub(super) fn index(&self, place: Vector) -> Option<usize> {
        if !self.region.contains(place) {
            return None;
        }
        let place = [place.x, place.y, place.z];
        let along = |axis: usize| {
            let bin = ((place[axis] - self.region.low[axis]) / self.width(axis)) as usize;
            // Rounding may give the upper edge.
            bin.min(self.counts[axis] - 1)
        };
        Some((along(0) * self.counts[1] + along(1)) * self.counts[2] + along(2))
    }

    /// A place relative to the middle of a bin (m).
    pub(super) fn relative_to_middle(&self, place: Vector, index: usize) -> [f64; 3] {
        let [_, depth, height] = self.counts;
        let bin = [
            index / height / depth,
            index / height % depth,
            index % height,
        ];
        let middle = [0, 1, 2].map(|axis| self.middle(axis, bin[axis]));
        [
            place.x - middle[0],
            place.y - middle[1],
            place.z - middle[2],
        ]
    }

    /// Width of a bin along an axis (m).
    pub(super) fn width(&self, axis: usize) -> f64 {
        (self.region.high[axis] - self.region.low[axis]) / self.counts[axis] as f64
    }

    /// The middle of the bin of this number along an axis (m).
    pub(super) fn middle(&self, axis: usize, bin: usize) -> f64 {
        self.region.low[axis] + (bin as f64 + 0.5) * self.width(axis)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_bin_has_its_middle() {
        let bins = Bins {
            region: Region {
                low: [-1.0, 0.0, 2.0],
                high: [1.0, 0.3, 6.0],
            },
            counts: [4, 3, 2],
        };
        for index in 0..bins.len() {
            let [a, b, c] = [index / 6, index / 2 % 3, index % 2];
            let middle = [a, b, c].into_iter().enumerate();
            let middle: Vec<f64> = middle.map(|(axis, bin)| bins.middle(axis, bin)).collect();
            let place = Vector::new(middle[0], middle[1], middle[2]);
            assert_eq!(bins.index(place), Some(index));
            assert_eq!(bins.relative_to_middle(place, index), [0.0; 3]);
        }
        assert_eq!(bins.index(Vector::new(-1.0, 0.0, 2.0)), Some(0));
        // The largest number below .3, over a width of .1 that is rounded down.
        let last = Vector::new(0.0, 0.3_f64.next_down(), 2.0);
        assert_eq!(bins.index(last), Some(16));
        assert_eq!(bins.index(Vector::new(0.0, 0.3, 2.0)), None);
        assert_eq!(bins.index(Vector::new(0.0, f64::NAN, 2.0)), None);
    }
}
