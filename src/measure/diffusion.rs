//! Diffusion of spheres about the mean flow.

use super::bins::Bins;
use super::blocks::{Blocks, quotient};
use super::{Region, SpaceAxis};
use crate::particles::vector::Vector;
use crate::simulation::Snapshot;
use crate::statistics::Estimate;

/// Least number of spheres in a bin that counts, because four constants are fitted to it.
const FEWEST: f64 = 6.0;

/// Share of a sum of squares that counts as zero, left by rounding.
const ROUNDING: f64 = 1e-9;

/// Numbers per sphere whose products are summed: 1, its place, its displacement.
const NUMBERS: usize = 7;

/// The first of them, which make the mean flow: 1, the place.
const OF_FLOW: usize = 4;

/// Displacements of spheres about the mean flow, over the distance that they drop in the same time;
/// several pairs of snapshots of a steady flow may be added.
///
/// In each bin of start places, the mean flow is the linear function of the place that fits the
/// displacements of all pairs best by least squares: a constant mean per bin would count the shear
/// of the flow as diffusion. The sum of squares about it is divided by the number of displacements
/// minus four, the number of fitted constants. Neighbours move together: a mean flow from few pairs
/// absorbs part of their common motion. Ten pairs or more, at different times, leave at least nine
/// tenths of it.
///
/// Slow dense flows diffuse with the distance dropped, not with time, and faster over short
/// distances than later. The Peclet number needs snapshots so far apart that it no longer depends
/// on the distance (Choi, Kudrolli, Rosales and Bazant, Physical Review Letters 92, 174301 (2004)).
///
/// Spheres that leave between the snapshots do not count, so the region must not include them.
/// Intervals come from a jackknife over at most ten blocks of consecutive pairs.
#[derive(Clone, Debug, PartialEq)]
pub struct Diffusion {
    bins: Bins,
    /// For each pair of snapshots the moments of all bins.
    rows: Vec<Vec<f64>>,
}

impl Diffusion {
    /// No displacements yet; bins of about this width (m), two to three diameters, divide the
    /// region. Wider bins count the curvature of a velocity profile as diffusion.
    pub fn new(region: Region, width: f64) -> Self {
        let count = |axis: usize| {
            let count = ((region.high[axis] - region.low[axis]) / width).round();
            count.max(1.0) as usize
        };
        let counts = [0, 1, 2].map(count);
        Self {
            bins: Bins { region, counts },
            rows: Vec::new(),
        }
    }

    /// Adds the spheres that are in both snapshots, and in the region in the earlier one. Pairs
    /// come in the order of time.
    pub fn add(&mut self, before: &Snapshot, after: &Snapshot) {
        let mut moments = vec![Moments::default(); self.bins.len()];
        let spheres = before.position.rows().into_iter();
        for (before, after) in spheres.zip(after.position.rows()) {
            let start = Vector::new(before[0], before[1], before[2]);
            if let Some(bin) = self.bins.index(start)
                && !after[0].is_nan()
            {
                let displacement = [0, 1, 2].map(|axis| after[axis] - before[axis]);
                moments[bin].add(self.bins.relative_to_middle(start, bin), displacement);
            }
        }
        let numbers = moments.iter().flat_map(|it| it.0.as_flattened());
        self.rows.push(numbers.copied().collect());
    }

    /// Mean distance dropped (m).
    pub fn drop(&self) -> Option<Estimate> {
        self.estimate(|total| total.drop())
    }

    /// Mean square of the displacement about the mean flow along an axis (m2).
    pub fn mean_square(&self, axis: SpaceAxis) -> Option<Estimate> {
        self.estimate(|total| total.mean_square(axis))
    }

    /// Diffusivity along an axis over the mean velocity, D / V (m): mean square of the displacement
    /// over twice the distance dropped.
    pub fn length(&self, axis: SpaceAxis) -> Option<Estimate> {
        self.estimate(|total| quotient(total.mean_square(axis)?, 2.0 * total.drop()?))
    }

    /// Peclet number V d / D along an axis, for spheres of a diameter d (m).
    pub fn peclet(&self, axis: SpaceAxis, diameter: f64) -> Option<Estimate> {
        self.estimate(|total| quotient(2.0 * diameter * total.drop()?, total.mean_square(axis)?))
    }

    fn estimate(&self, follows: impl Fn(&Total) -> Option<f64>) -> Option<Estimate> {
        Blocks::of(&self.rows).estimate(|sums| follows(&Total::of(sums)))
    }
}

/// Sums over all bins.
#[derive(Clone, Copy, Debug, Default)]
struct Total {
    /// Squares of the displacement along each axis about the mean flow (m2).
    squares: [f64; 3],
    /// Degrees of freedom by which they are divided.
    freedom: f64,
    /// Distances dropped (m).
    drop: f64,
    spheres: f64,
}

impl Total {
    /// From the moments of all bins.
    fn of(sums: &[f64]) -> Self {
        let mut total = Self::default();
        let (rows, _) = sums.as_chunks::<NUMBERS>();
        let (bins, _) = rows.as_chunks::<NUMBERS>();
        for bin in bins {
            let bin = Moments(*bin);
            if bin.spheres() >= FEWEST {
                let (squares, constants) = bin.about_mean_flow();
                for (sum, square) in total.squares.iter_mut().zip(squares) {
                    *sum += square;
                }
                total.freedom += bin.spheres() - constants;
                total.drop += bin.drop();
                total.spheres += bin.spheres();
            }
        }
        total
    }

    fn mean_square(&self, axis: SpaceAxis) -> Option<f64> {
        quotient(self.squares[axis.index()], self.freedom)
    }

    fn drop(&self) -> Option<f64> {
        quotient(self.drop, self.spheres)
    }
}

/// Sums, over the spheres of a bin, of the products of any two of a sphere's numbers.
#[derive(Clone, Copy, Debug, Default)]
struct Moments([[f64; NUMBERS]; NUMBERS]);

impl Moments {
    fn add(&mut self, [x, y, z]: [f64; 3], [u, v, w]: [f64; 3]) {
        let numbers = [1.0, x, y, z, u, v, w];
        for (sums, one) in self.0.iter_mut().zip(numbers) {
            for (sum, other) in sums.iter_mut().zip(numbers) {
                *sum += one * other;
            }
        }
    }

    fn spheres(&self) -> f64 {
        self.0[0][0]
    }

    /// Sum of the distances dropped (m).
    fn drop(&self) -> f64 {
        -self.0[0][NUMBERS - 1]
    }

    /// Sums of squares of the displacement along each axis about its linear function of the place,
    /// and the number of constants of this function. Axes along which the places do not differ,
    /// such as the depth of a plane flow, have no slope.
    fn about_mean_flow(&self) -> ([f64; 3], f64) {
        let mut rest = self.0;
        let mut constants = 0.0;
        // Gaussian elimination: each number of the flow is projected out of those after it.
        for own in 0..OF_FLOW {
            let pivot = rest[own];
            if pivot[own] <= ROUNDING * self.0[own][own] {
                continue;
            }
            constants += 1.0;
            for row in &mut rest[own + 1..] {
                let share = row[own] / pivot[own];
                for (sum, of_pivot) in row.iter_mut().zip(pivot) {
                    *sum -= share * of_pivot;
                }
            }
        }
        ([4, 5, 6].map(|it| rest[it][it]), constants)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::synthetic::{Random, snapshot};

    const REGION: Region = Region {
        low: [-10.0, -4.0, 50.0],
        high: [10.0, 4.0, 70.0],
    };

    /// Spheres with a mean displacement that depends on the place, plus a random walk with a
    /// standard deviation along each axis.
    fn walk(
        random: &mut Random,
        count: usize,
        mean: impl Fn([f64; 3]) -> [f64; 3],
        deviation: [f64; 3],
    ) -> [Snapshot; 2] {
        let sides = [[-12.0, 12.0], [-4.0, 4.0], [45.0, 75.0]];
        let mut place = || sides.map(|[low, high]| low + random.uniform() * (high - low));
        let before: Vec<[f64; 3]> = (0..count).map(|_| place()).collect();
        let mut moved = |place: &[f64; 3]| {
            let mean = mean(*place);
            std::array::from_fn(|axis| place[axis] + mean[axis] + deviation[axis] * random.normal())
        };
        let after: Vec<[f64; 3]> = before.iter().map(&mut moved).collect();
        [snapshot(80.0, &before), snapshot(90.0, &after)]
    }

    #[test]
    fn intervals_cover_the_diffusivity_of_a_random_walk_with_drift() {
        let mut random = Random::new("random walk");
        let (fall, deviation) = (4.0, [0.16, 0.1, 0.23]);
        let mut covered = [0; 4];
        for _ in 0..100 {
            let mut diffusion = Diffusion::new(REGION, 8.0);
            assert_eq!(diffusion.drop(), None);
            for _ in 0..8 {
                let [before, mut after] = walk(&mut random, 1500, |_| [0.1, 0.0, -fall], deviation);
                after.position.row_mut(5).fill(f64::NAN);
                diffusion.add(&before, &after);
            }
            let covers = |it: Estimate, value: f64| {
                let relative = it.half_width / it.value;
                assert!(relative < 0.1, "{it:?}");
                usize::from((it.value - value).abs() < it.half_width)
            };
            let square = |axis: usize| deviation[axis] * deviation[axis];
            covered[0] += covers(diffusion.mean_square(SpaceAxis::Y).unwrap(), square(1));
            covered[1] += covers(
                diffusion.length(SpaceAxis::X).unwrap(),
                square(0) / (2.0 * fall),
            );
            covered[2] += covers(
                diffusion.peclet(SpaceAxis::Z, 1.0).unwrap(),
                2.0 * fall / square(2),
            );
            covered[3] += covers(diffusion.drop().unwrap(), fall);
        }
        // 100 intervals of 95 %, with a standard deviation of 2.2.
        assert!(
            covered.iter().all(|it| (88..=100).contains(it)),
            "{covered:?}"
        );
    }

    #[test]
    fn shear_is_no_diffusion() {
        let mut random = Random::new("sheared walk");
        let sheared =
            |[x, y, z]: [f64; 3]| [-0.02 * x, 0.1 * y, -1.0 - 0.5 * x.abs() - 0.1 * z + 0.3 * y];
        // Ten bins, so that none has the edge at x = 0 inside.
        let mut squares = |deviation| {
            let [before, after] = walk(&mut random, 60_000, sheared, deviation);
            let mut diffusion = Diffusion::new(REGION, 2.0);
            diffusion.add(&before, &after);
            [SpaceAxis::X, SpaceAxis::Y, SpaceAxis::Z]
                .map(|axis| diffusion.mean_square(axis).unwrap().value)
        };
        for square in squares([0.0; 3]) {
            assert!(square.abs() < 1e-12, "{square}");
        }
        for square in squares([0.1; 3]) {
            assert!((square / 0.01 - 1.0).abs() < 0.03, "{square}");
        }
    }

    #[test]
    fn a_plane_flow_has_no_depth() {
        let mut random = Random::new("plane walk");
        let shear = |[x, _, z]: [f64; 3]| [0.0, 0.0, -4.0 - 0.3 * x + 0.1 * z];
        let [mut before, mut after] = walk(&mut random, 60_000, shear, [0.1; 3]);
        for snapshot in [&mut before, &mut after] {
            snapshot.position.column_mut(1).fill(0.0);
        }
        let mut diffusion = Diffusion::new(REGION, 2.0);
        diffusion.add(&before, &after);
        for (axis, expected) in [
            (SpaceAxis::X, 0.01),
            (SpaceAxis::Y, 0.0),
            (SpaceAxis::Z, 0.01),
        ] {
            let square = diffusion.mean_square(axis).unwrap().value;
            assert!((square - expected).abs() < 3e-4, "{axis:?}: {square}");
        }
        assert_eq!(diffusion.peclet(SpaceAxis::Y, 1.0), None);
    }

    #[test]
    fn bins_with_few_spheres_do_not_count() {
        let mut random = Random::new("few spheres");
        let [before, after] = walk(&mut random, 20, |_| [0.0, 0.0, -1.0], [0.1; 3]);
        let mut diffusion = Diffusion::new(REGION, 1.0);
        diffusion.add(&before, &after);
        assert_eq!(diffusion.peclet(SpaceAxis::X, 1.0), None);
        assert_eq!(diffusion.drop(), None);
    }
}
