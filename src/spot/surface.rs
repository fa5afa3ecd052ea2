//! The height of the packing at each place.

use super::parameters::Parameters;
use crate::particles::vector::Vector;

/// Highest centres above squares of the floor, about a diameter wide.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    half: [f64; 2],
    count: [usize; 2],
    /// (m), along y first.
    height: Vec<f64>,
}

impl Surface {
    /// The surface of spheres with these centres.
    pub(crate) fn of(position: &[Vector], parameters: &Parameters) -> Self {
        let half = [parameters.half_width, parameters.half_depth];
        let count = half.map(|half| ((2.0 * half / parameters.diameter) as usize).max(1));
        let mut surface = Self {
            half,
            count,
            height: vec![0.0; count[0] * count[1]],
        };
        for centre in position {
            let index = surface.index(0, centre.x) * count[1] + surface.index(1, centre.y);
            surface.height[index] = f64::max(surface.height[index], centre.z);
        }
        surface
    }

    /// Height of the highest centre (m), 0 without spheres.
    pub(crate) fn top(&self) -> f64 {
        self.height.iter().copied().fold(0.0, f64::max)
    }

    /// The least height of the squares around a place, up to a distance along x and y (m).
    pub(crate) fn lowest(&self, place: Vector, distance: f64) -> f64 {
        let indices = |axis: usize, value: f64| {
            self.index(axis, value - distance)..=self.index(axis, value + distance)
        };
        let rows = indices(0, place.x).flat_map(|column| {
            let row = &self.height[column * self.count[1]..][..self.count[1]];
            row[indices(1, place.y)].iter().copied()
        });
        rows.fold(f64::INFINITY, f64::min)
    }

    fn index(&self, axis: usize, value: f64) -> usize {
        let share = 0.5 + 0.5 * value / self.half[axis];
        ((share.max(0.0) * self.count[axis] as f64) as usize).min(self.count[axis] - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_square_around_a_place_counts() {
        let along = |from: i32, to: i32| (from..to).map(|k| f64::from(k) + 0.5);
        let all = along(-25, 25).flat_map(|x| along(-4, 4).map(move |y| Vector::new(x, y, 9.0)));
        let mut centres: Vec<Vector> = all.collect();
        let surface = Surface::of(&centres, &Parameters::figure_2(1.0));
        assert_eq!(surface.lowest(Vector::ZERO, 2.6), 9.0);
        assert_eq!(surface.lowest(Vector::new(24.9, 3.9, 0.0), 2.6), 9.0);
        centres.retain(|it| it.x != 0.5 || it.y != 2.5);
        let surface = Surface::of(&centres, &Parameters::figure_2(1.0));
        assert_eq!(surface.lowest(Vector::ZERO, 2.6), 0.0);
        assert_eq!(surface.lowest(Vector::ZERO, 1.6), 9.0);
        assert_eq!(surface.top(), 9.0);
    }
}
