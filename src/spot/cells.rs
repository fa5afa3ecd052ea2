//! Cells that spheres are sorted into, and the ranges of the arrays that a region covers.
//!
//! Cells follow one another along y, then x, then z. In a thin box the regions of spots span all of
//! y, so that each layer of such a region is a single range.

use crate::particles::vector::Vector;
use std::ops::Range;

/// Length of cells along x and z, in diameters.
const LENGTH: f64 = 1.0;

/// Length of cells along y, in diameters.
const LENGTH_ALONG_Y: f64 = 4.0;

/// Cells of spheres that are sorted by cell.
#[derive(Clone, Debug, Default)]
pub(crate) struct SphereCells {
    count: [usize; 3],
    /// Least corner (m).
    origin: [f64; 3],
    /// Edges of a cell (m), and their inverses.
    length: [f64; 3],
    inverse: [f64; 3],
    /// Index of the first sphere of each cell, and the number of spheres.
    first: Vec<u32>,
}

impl SphereCells {
    /// Empty cells for spheres of a diameter in a box up to a height (m).
    pub(crate) fn new(diameter: f64, [half_width, half_depth]: [f64; 2], height: f64) -> Self {
        let extent = [2.0 * half_width, 2.0 * half_depth, height + diameter];
        let wanted = [LENGTH, LENGTH_ALONG_Y, LENGTH].map(|length| length * diameter);
        let count: [usize; 3] =
            std::array::from_fn(|axis| ((extent[axis] / wanted[axis]) as usize).max(1));
        let length: [f64; 3] = std::array::from_fn(|axis| extent[axis] / count[axis] as f64);
        Self {
            count,
            origin: [-half_width, -half_depth, 0.0],
            length,
            inverse: length.map(|length| 1.0 / length),
            first: Vec::new(),
        }
    }

    /// Counts the spheres of each cell, and returns the order of the spheres by cell; spheres of
    /// one cell keep their order.
    pub(crate) fn sort(&mut self, position: &[Vector]) -> Vec<u32> {
        let [x, y, z] = self.count;
        let mut first = vec![0_u32; x * y * z + 1];
        let cell: Vec<u32> = position.iter().map(|&it| self.cell(it) as u32).collect();
        for &cell in &cell {
            first[cell as usize + 1] += 1;
        }
        for k in 1..first.len() {
            first[k] += first[k - 1];
        }
        let mut next = first.clone();
        let mut order = vec![0; position.len()];
        for (sphere, &cell) in (0..).zip(&cell) {
            let place = &mut next[cell as usize];
            order[*place as usize] = sphere;
            *place += 1;
        }
        self.first = first;
        order
    }

    /// Number of layers of cells along z, and their height (m).
    pub(crate) fn layers(&self) -> (usize, f64) {
        (self.count[2], self.length[2])
    }

    /// Index of the first sphere of a layer, or of one above all.
    pub(crate) fn first_of_layer(&self, layer: usize) -> usize {
        let cells = self.count[0] * self.count[1];
        self.first[layer.min(self.count[2]) * cells] as usize
    }

    fn cell(&self, centre: Vector) -> usize {
        let [x, y, z] = [centre.x, centre.y, centre.z];
        let index = |axis: usize, value: f64| self.along(axis, value);
        (index(2, z) * self.count[0] + index(0, x)) * self.count[1] + index(1, y)
    }

    /// Index along an axis of the cell at a coordinate, or of the nearest one.
    #[inline(always)]
    fn along(&self, axis: usize, value: f64) -> usize {
        let place = (value - self.origin[axis]) * self.inverse[axis];
        (place.max(0.0) as usize).min(self.count[axis] - 1)
    }

    /// Collects the ranges of spheres that hold all those nearer than `radius` to a centre (m).
    #[inline(always)]
    pub(crate) fn cover(&self, centre: Vector, radius: f64, ranges: &mut Vec<Range<u32>>) {
        ranges.clear();
        let (low, high) = (centre.z - radius, centre.z + radius);
        let top = self.count[2] as f64 * self.length[2];
        if high < 0.0 || low > top {
            return;
        }
        for layer in self.along(2, low)..=self.along(2, high) {
            let from = layer as f64 * self.length[2];
            let above = from - centre.z;
            let below = centre.z - (from + self.length[2]);
            let distance = above.max(below).max(0.0);
            let half_squared = radius * radius - distance * distance;
            if half_squared <= 0.0 {
                continue;
            }
            self.cover_layer(layer, centre, half_squared.sqrt(), ranges);
        }
    }

    #[inline(always)]
    fn cover_layer(&self, layer: usize, centre: Vector, half: f64, ranges: &mut Vec<Range<u32>>) {
        let columns = self.along(0, centre.x - half)..self.along(0, centre.x + half) + 1;
        let cells = self.along(1, centre.y - half)..self.along(1, centre.y + half) + 1;
        let deep = self.count[1];
        let cell =
            |column: usize, along_y: usize| (layer * self.count[0] + column) * deep + along_y;
        if cells.len() == deep {
            let range = self.first[cell(columns.start, 0)]..self.first[cell(columns.end, 0)];
            ranges.push(range);
            return;
        }
        for column in columns {
            let (from, to) = (cell(column, cells.start), cell(column, cells.end));
            ranges.push(self.first[from]..self.first[to]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spot::random::RandomStream;

    #[test]
    fn ranges_hold_all_spheres_of_a_region_once() {
        for half_depth in [2.0, 9.0] {
            let mut random = RandomStream::new("cells", 3);
            let mut along = |half: f64| (2.0 * random.uniform() - 1.0) * half;
            let mut place = || Vector::new(along(6.0), along(half_depth), 5.0 + along(5.0));
            let spheres: Vec<Vector> = (0..2000).map(|_| place()).collect();
            let mut cells = SphereCells::new(1.0, [6.0, half_depth], 10.0);
            let order = cells.sort(&spheres);
            let mut ranges = Vec::new();
            for _ in 0..50 {
                let centre = place();
                cells.cover(centre, 3.0, &mut ranges);
                let slots = || ranges.iter().flat_map(|it| it.clone());
                let near = |sphere: &Vector| (*sphere - centre).norm() < 3.0;
                let found = slots().filter(|&slot| near(&spheres[order[slot as usize] as usize]));
                assert_eq!(found.count(), spheres.iter().filter(|it| near(it)).count());
                let mut all: Vec<u32> = slots().collect();
                let count = all.len();
                all.sort_unstable();
                all.dedup();
                assert_eq!(all.len(), count);
                assert!(count < spheres.len());
            }
        }
    }
}
