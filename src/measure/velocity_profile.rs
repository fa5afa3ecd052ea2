//! Profiles of the downward velocity.

use super::bins::Bins;
use super::blocks::{Blocks, quotient};
use super::{Region, SpaceAxis};
use crate::particles::vector::Vector;
use crate::simulation::Snapshot;
use crate::statistics::Estimate;

/// Downward velocities of the spheres in a region, in bins along an axis; several pairs of
/// consecutive snapshots may be added. Spheres that leave between the two do not count: a region
/// that includes them misses the fastest.
///
/// Intervals come from a jackknife over at most ten blocks of consecutive pairs; a block should be
/// longer than the correlation time of velocities.
#[derive(Clone, Debug, PartialEq)]
pub struct VelocityProfile {
    axis: SpaceAxis,
    bins: Bins,
    /// For each pair of snapshots the sums of the velocities (m/s) in the bins, then the numbers of
    /// spheres.
    rows: Vec<Vec<f64>>,
}

/// A measured value at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfilePoint {
    /// The middle of the bin (m).
    pub place: f64,
    /// The value there.
    pub value: Estimate,
}

impl VelocityProfile {
    /// No velocities yet; one or more bins of equal width divide the region along the axis.
    pub fn new(axis: SpaceAxis, region: Region, bins: usize) -> Self {
        let mut counts = [1; 3];
        counts[axis.index()] = bins;
        Self {
            axis,
            bins: Bins { region, counts },
            rows: Vec::new(),
        }
    }

    /// Adds the spheres that are in both snapshots, and in the region half way between them. Pairs
    /// come in the order of time.
    pub fn add(&mut self, before: &Snapshot, after: &Snapshot) {
        let bins = self.bins();
        let mut row = vec![0.0; 2 * bins];
        let interval = after.time - before.time;
        let spheres = before.position.rows().into_iter();
        for (before, after) in spheres.zip(after.position.rows()) {
            let middle = [0, 1, 2].map(|axis| 0.5 * (before[axis] + after[axis]));
            // NaN, and so in no region, if a sphere has left.
            if let Some(bin) = self.bins.index(Vector::from(middle)) {
                row[bin] += (before[2] - after[2]) / interval;
                row[bins + bin] += 1.0;
            }
        }
        self.rows.push(row);
    }

    /// Mean downward velocity (m/s) of the spheres in each bin that has any.
    pub fn values(&self) -> Vec<ProfilePoint> {
        self.points(|sums, bin| self.velocity(sums, bin))
    }

    /// The same divided by the mean of the whole region.
    pub fn normalized(&self) -> Vec<ProfilePoint> {
        self.points(|sums, bin| quotient(self.velocity(sums, bin)?, self.mean_of(sums)?))
    }

    /// Mean downward velocity (m/s) of the spheres in the region.
    pub fn mean(&self) -> Option<Estimate> {
        Blocks::of(&self.rows).estimate(|sums| self.mean_of(sums))
    }

    fn points(&self, value: impl Fn(&[f64], usize) -> Option<f64>) -> Vec<ProfilePoint> {
        let blocks = Blocks::of(&self.rows);
        let point = |bin| {
            let value = blocks.estimate(|sums| value(sums, bin))?;
            let place = self.place(bin);
            Some(ProfilePoint { place, value })
        };
        (0..self.bins()).filter_map(point).collect()
    }

    fn mean_of(&self, sums: &[f64]) -> Option<f64> {
        let (velocities, spheres) = sums.split_at(self.bins());
        quotient(velocities.iter().sum(), spheres.iter().sum())
    }

    /// Mean velocity (m/s) in a bin, from sums of rows.
    pub(super) fn velocity(&self, sums: &[f64], bin: usize) -> Option<f64> {
        quotient(sums[bin], sums[self.bins() + bin])
    }

    /// The middle of a bin (m).
    pub(super) fn place(&self, bin: usize) -> f64 {
        self.bins.middle(self.axis.index(), bin)
    }

    /// Width of a bin (m).
    pub(super) fn width(&self) -> f64 {
        self.bins.width(self.axis.index())
    }

    pub(super) fn bins(&self) -> usize {
        self.bins.len()
    }

    pub(super) fn region(&self) -> &Region {
        &self.bins.region
    }

    pub(super) fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::synthetic::{Random, falling};

    const REGION: Region = Region {
        low: [-5.0, -1.0, 0.0],
        high: [5.0, 1.0, 4.0],
    };

    fn fall(random: &mut Random, speed: impl Fn([f64; 3], &mut Random) -> f64) -> [Snapshot; 2] {
        falling(random, 4000, [[-5.0, 5.0], [-1.0, 1.0], [-4.0, 4.0]], speed)
    }

    #[test]
    fn velocities_are_found_where_they_are() {
        let mut random = Random::new("velocity profile");
        let [before, mut after] = fall(&mut random, |[x, _, _], _| 3.0 + x.floor());
        // One sphere has left.
        after.position.row_mut(17).fill(f64::NAN);
        let mut profile = VelocityProfile::new(SpaceAxis::X, REGION, 10);
        assert!(profile.values().is_empty() && profile.mean().is_none());
        profile.add(&before, &after);
        for (bin, point) in profile.values().into_iter().enumerate() {
            assert_eq!(point.place, bin as f64 - 4.5);
            assert!((point.value.value - (bin as f64 - 2.0)).abs() < 1e-9);
            assert_eq!(point.value.half_width, f64::INFINITY);
        }
        // Bins above all spheres are left out.
        let above = Region {
            high: [5.0, 1.0, 8.0],
            ..REGION
        };
        let mut upwards = VelocityProfile::new(SpaceAxis::Z, above, 8);
        upwards.add(&before, &after);
        assert_eq!(upwards.values().len(), 4);
    }

    #[test]
    fn a_profile_across_the_depth_is_normalized() {
        let mut random = Random::new("normalized profile");
        let mut profile = VelocityProfile::new(SpaceAxis::Y, REGION, 4);
        for pair in 0..20 {
            // The flow as a whole fluctuates, its shape does not.
            let flow = 1.0 + 0.5 * f64::from(pair % 3);
            let [before, after] = fall(&mut random, |[_, y, _], _| flow * (1.0 - y * y));
            profile.add(&before, &after);
        }
        for point in profile.normalized() {
            // Mean of 1 - y^2 over the bin, over the mean for the whole depth.
            let expected = (1.0 - point.place * point.place - 1.0 / 48.0) / (2.0 / 3.0);
            let Estimate { value, half_width } = point.value;
            assert!((value - expected).abs() < 0.02, "{point:?}");
            assert!(half_width > 1e-3 && half_width < 0.02, "{point:?}");
        }
        assert!(profile.mean().unwrap().half_width > 0.05);
    }

    #[test]
    fn intervals_cover_the_velocity() {
        let mut random = Random::new("intervals of velocities");
        let (mut covered, mut all) = (0, 0);
        for _ in 0..20 {
            let mut profile = VelocityProfile::new(SpaceAxis::X, REGION, 20);
            for _ in 0..10 {
                let [before, after] = fall(&mut random, |_, random| 2.0 + random.normal());
                profile.add(&before, &after);
            }
            for point in profile.values() {
                all += 1;
                covered += usize::from((point.value.value - 2.0).abs() < point.value.half_width);
            }
        }
        // 400 intervals of 95 %: 380, with a standard deviation of 4.4.
        assert_eq!(all, 400);
        assert!((368..=393).contains(&covered), "{covered}");
    }
}
