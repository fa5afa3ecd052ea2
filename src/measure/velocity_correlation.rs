//! The spatial correlation of velocity fluctuations.

use super::bins::Bins;
use super::blocks::{Blocks, quotient};
use super::{CellGrid, ProfilePoint, Region};
use crate::particles::vector::Vector;
use crate::simulation::Snapshot;
use crate::statistics::Estimate;

/// Number of radii that are tried before the best is refined.
const TRIALS: u32 = 64;

/// The correlation of the horizontal displacements of two spheres about the mean flow, over their
/// distance: <u_i u_j> / <u^2>, with the displacement u along x between two snapshots.
///
/// The mean flow is taken over all pairs of snapshots, in bins of the place. Intervals come from a
/// jackknife over at most ten blocks of consecutive pairs.
#[derive(Clone, Debug, PartialEq)]
pub struct VelocityCorrelation {
    /// Width of a bin of distances (m).
    width: f64,
    bins: usize,
    /// For each pair of snapshots: the sum of squares (m2), the number of spheres, the sums of the
    /// products (m2) at each distance, and their numbers.
    rows: Vec<Vec<f64>>,
}

/// A sphere half way between two snapshots.
struct MidwaySphere {
    place: Vector,
    /// Displacement along x (m).
    displacement: f64,
    bin: usize,
}

impl VelocityCorrelation {
    /// For spheres that are in a region half way between the snapshots of each pair. Pairs come in
    /// the order of time.
    ///
    /// * `cell`: width of the bins of the mean flow (m)
    /// * `farthest`: largest distance (m), and the number of bins
    pub fn of(
        pairs: &[(&Snapshot, &Snapshot)],
        region: Region,
        cell: f64,
        (farthest, bins): (f64, usize),
    ) -> Self {
        let count = |axis: usize| {
            let extent = region.high[axis] - region.low[axis];
            (extent / cell).round().max(1.0) as usize
        };
        let cells = Bins {
            region,
            counts: [0, 1, 2].map(count),
        };
        let moved: Vec<Vec<MidwaySphere>> = pairs.iter().map(|pair| moved(&cells, *pair)).collect();
        let mean = mean_flow(&cells, &moved);
        let width = farthest / bins as f64;
        let row = |moved: &Vec<MidwaySphere>| row(moved, &mean, (width, bins));
        Self {
            width,
            bins,
            rows: moved.iter().map(row).collect(),
        }
    }

    /// The correlation at the middle of each distance; bins without pairs are left out.
    pub fn points(&self) -> Vec<ProfilePoint> {
        let blocks = Blocks::of(&self.rows);
        let point = |bin: usize| {
            Some(ProfilePoint {
                place: self.middle(bin),
                value: blocks.estimate(|sums| self.at(sums, bin))?,
            })
        };
        (0..self.bins).filter_map(point).collect()
    }

    /// The radius R (m) of spheres whose common volume decreases with the distance r of their
    /// centres like the correlation: A (1 - 3 r / (4 R) + r^3 / (16 R^3)) + B below 2 R, else B.
    /// This is the correlation of two spheres moved by the same spots of radius R; B is the common
    /// part when the whole flow speeds up, slows down or sways. Least squares over the distances
    /// from `nearest` (m) on.
    pub fn radius(&self, nearest: f64) -> Option<Estimate> {
        Blocks::of(&self.rows).estimate(|sums| self.fitted(sums, nearest))
    }

    fn middle(&self, bin: usize) -> f64 {
        (bin as f64 + 0.5) * self.width
    }

    fn at(&self, sums: &[f64], bin: usize) -> Option<f64> {
        let square = quotient(sums[0], sums[1])?;
        let product = quotient(sums[2 + bin], sums[2 + self.bins + bin])?;
        quotient(product, square)
    }

    fn fitted(&self, sums: &[f64], nearest: f64) -> Option<f64> {
        let points = (0..self.bins).filter(|bin| self.middle(*bin) >= nearest);
        let points = points.filter_map(|bin| Some((self.middle(bin), self.at(sums, bin)?)));
        let points: Vec<(f64, f64)> = points.collect();
        let farthest = points.last()?.0;
        // The residual of A and B is orthogonal to the shape and to a constant.
        let left = |radius: f64| {
            let shape = |distance: f64| common_volume(distance / radius);
            let count = points.len() as f64;
            let mean = points.iter().map(|it| shape(it.0)).sum::<f64>() / count;
            let (mut own, mut with) = (0.0, 0.0);
            for (distance, value) in &points {
                let about_mean = shape(*distance) - mean;
                own += about_mean * about_mean;
                with += about_mean * value;
            }
            match own > 0.0 && with > 0.0 {
                true => -with * with / own,
                false => 0.0,
            }
        };
        let [least, most] = [0.51 * nearest, 2.0 * farthest];
        let trial = |k: u32| least * libm::pow(most / least, f64::from(k) / f64::from(TRIALS));
        let best = (0..=TRIALS).min_by(|a, b| left(trial(*a)).total_cmp(&left(trial(*b))))?;
        if best == 0 || best == TRIALS {
            return None;
        }
        let (mut low, mut high) = (trial(best - 1), trial(best + 1));
        while high - low > 1e-9 * high {
            let third = (high - low) / 3.0;
            match left(low + third) < left(high - third) {
                true => high -= third,
                false => low += third,
            }
        }
        Some(0.5 * (low + high))
    }
}

/// The common volume of two spheres over the volume of one, at a distance in units of their radius.
fn common_volume(distance: f64) -> f64 {
    match distance < 2.0 {
        true => 1.0 - 0.75 * distance + distance * distance * distance / 16.0,
        false => 0.0,
    }
}

fn moved(cells: &Bins, (before, after): (&Snapshot, &Snapshot)) -> Vec<MidwaySphere> {
    let spheres = before
        .position
        .rows()
        .into_iter()
        .zip(after.position.rows());
    let moved = spheres.filter_map(|(before, after)| {
        // NaN, and so in no region, if a sphere has left.
        let middle = [0, 1, 2].map(|axis| 0.5 * (before[axis] + after[axis]));
        let place = Vector::from(middle);
        Some(MidwaySphere {
            place,
            displacement: after[0] - before[0],
            bin: cells.index(place)?,
        })
    });
    moved.collect()
}

/// The mean displacement (m) in each cell.
fn mean_flow(cells: &Bins, moved: &[Vec<MidwaySphere>]) -> Vec<f64> {
    let (mut sums, mut counts) = (vec![0.0; cells.len()], vec![0.0; cells.len()]);
    for sphere in moved.iter().flatten() {
        sums[sphere.bin] += sphere.displacement;
        counts[sphere.bin] += 1.0;
    }
    let means = sums.iter().zip(&counts);
    means
        .map(|(sum, count)| quotient(*sum, *count).unwrap_or(0.0))
        .collect()
}

fn row(moved: &[MidwaySphere], mean: &[f64], (width, bins): (f64, usize)) -> Vec<f64> {
    let places: Vec<Vector> = moved.iter().map(|it| it.place).collect();
    let strays = moved.iter().map(|it| it.displacement - mean[it.bin]);
    let strays: Vec<f64> = strays.collect();
    let mut row = vec![0.0; 2 + 2 * bins];
    row[0] = strays.iter().map(|it| it * it).sum();
    row[1] = strays.len() as f64;
    let farthest = width * bins as f64;
    let grid = CellGrid::new(&places, farthest);
    for (own, place) in places.iter().enumerate() {
        grid.within(*place, farthest, |other, away| {
            let bin = (away.norm_squared().sqrt() / width) as usize;
            if other > own && bin < bins {
                row[2 + bin] += strays[own] * strays[other];
                row[2 + bins + bin] += 1.0;
            }
        });
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::synthetic::{Random, ideal_gas};

    fn snapshot(time: f64, places: &[Vector]) -> Snapshot {
        let rows: Vec<[f64; 3]> = places.iter().map(|it| [it.x, it.y, it.z]).collect();
        crate::measure::synthetic::snapshot(time, &rows)
    }

    /// Spheres that randomly placed spots of radius 2.5 push along x, in 12 pairs of snapshots, in
    /// each of which all spheres sway by up to `sway`. One seed.
    fn correlation_of_spots(sway: f64) -> VelocityCorrelation {
        let gas = ideal_gas(6_000, 20.0, "velocity correlation");
        let mut random = Random::new("spots that push");
        let mut states = vec![snapshot(0.0, &gas.place)];
        let mut places = gas.place.clone();
        for step in 0..12 {
            let all = sway * (2.0 * random.uniform() - 1.0);
            for place in &mut places {
                place.x += all;
            }
            for _ in 0..400 {
                let spot = [(); 3].map(|()| 20.0 * random.uniform());
                let way = if random.uniform() < 0.5 { 1e-3 } else { -1e-3 };
                for (place, from) in places.iter_mut().zip(&gas.place) {
                    if (*from - Vector::from(spot)).norm() < 2.5 {
                        place.x += way;
                    }
                }
            }
            states.push(snapshot(f64::from(step + 1), &places));
        }
        let pairs: Vec<_> = states.windows(2).map(|two| (&two[0], &two[1])).collect();
        let region = Region {
            low: [3.0; 3],
            high: [17.0; 3],
        };
        VelocityCorrelation::of(&pairs, region, 7.0, (8.0, 32))
    }

    #[test]
    fn the_radius_of_spots_is_found_again() {
        let correlation = correlation_of_spots(0.0);
        let radius = correlation.radius(0.5).unwrap();
        assert!((radius.value - 2.5).abs() < 0.3, "{radius:?}");
        assert!(radius.half_width < 0.5, "{radius:?}");
        let points = correlation.points();
        assert!(points[1].value.value > 0.7 && points[31].value.value.abs() < 0.15);
    }

    /// Symptom: the radius came out twice as large. Cause: the common motion of all spheres was
    /// taken for the reach of spots.
    #[test]
    fn what_all_spheres_share_does_not_widen_the_radius() {
        let correlation = correlation_of_spots(5e-3);
        let radius = correlation.radius(0.5).unwrap();
        assert!((radius.value - 2.5).abs() < 0.3, "{radius:?}");
        let points = correlation.points();
        assert!(points[31].value.value > 0.2, "{:?}", points[31]);
    }

    #[test]
    fn nothing_follows_from_spheres_that_do_not_stray() {
        let gas = ideal_gas(200, 10.0, "velocity correlation");
        let states = [0.0, 1.0].map(|time| snapshot(time, &gas.place));
        let region = Region {
            low: [0.0; 3],
            high: [10.0; 3],
        };
        let pairs = [(&states[0], &states[1])];
        let correlation = VelocityCorrelation::of(&pairs, region, 5.0, (4.0, 8));
        assert!(correlation.radius(0.5).is_none() && correlation.points().is_empty());
    }
}
