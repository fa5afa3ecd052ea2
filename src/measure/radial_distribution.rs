//! The radial distribution function.

use super::{CellGrid, Centres, Region};
use std::f64::consts::PI;

/// Counts of distances, from which g(r) follows; several snapshots may be added.
#[derive(Clone, Debug, PartialEq)]
pub struct RadialDistribution {
    /// Width of a bin (m).
    width: f64,
    /// Number of partners in each bin.
    counts: Vec<u64>,
    /// Number of central spheres.
    centres: u64,
    /// Central spheres per volume (1/m3), summed over snapshots, weighted by their number.
    density: f64,
}

impl RadialDistribution {
    /// No distances yet; up to `farthest` (m), in `bins` bins.
    pub fn new(farthest: f64, bins: usize) -> Self {
        Self {
            width: farthest / bins as f64,
            counts: vec![0; bins],
            centres: 0,
            density: 0.0,
        }
    }

    /// Adds a snapshot: the distances of the spheres in a region from all others.
    pub fn add(&mut self, centres: &Centres, region: &Region) {
        let farthest = self.width * self.counts.len() as f64;
        let grid = CellGrid::new(&centres.place, farthest);
        let inside = centres.place.iter().enumerate();
        let mut count = 0;
        for (own, place) in inside.filter(|(_, place)| region.contains(**place)) {
            count += 1;
            grid.within(*place, farthest, |other, away| {
                let bin = (away.norm_squared().sqrt() / self.width) as usize;
                if other != own
                    && let Some(bin) = self.counts.get_mut(bin)
                {
                    *bin += 1;
                }
            });
        }
        self.centres += count;
        self.density += count as f64 * count as f64 / region.volume();
    }

    /// The distance at the middle of each bin (m), and g there: the number of partners over the
    /// number for randomly spread spheres with the density of the region. There are no partners
    /// beyond walls, so g falls below 1 at distances that reach out of the box.
    pub fn values(&self) -> Vec<[f64; 2]> {
        let density = self.density / self.centres.max(1) as f64;
        let value = |(bin, count): (usize, &u64)| {
            let [from, to] = [bin, bin + 1].map(|edge| edge as f64 * self.width);
            let shell = 4.0 / 3.0 * PI * (to * to * to - from * from * from);
            let expected = self.centres as f64 * density * shell;
            let value = if expected > 0.0 {
                *count as f64 / expected
            } else {
                0.0
            };
            [0.5 * (from + to), value]
        };
        self.counts.iter().enumerate().map(value).collect()
    }

    /// Mean number of partners nearer than a distance (m), for whole bins.
    pub fn partners_within(&self, distance: f64) -> f64 {
        let bins = (distance / self.width).round() as usize;
        let partners: u64 = self.counts.iter().take(bins).sum();
        partners as f64 / self.centres.max(1) as f64
    }

    /// The least distance that occurs: the lower edge of the first bin with a partner (m).
    pub fn least_distance(&self) -> Option<f64> {
        let first = self.counts.iter().position(|count| *count > 0)?;
        Some(first as f64 * self.width)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::synthetic::{cubic, ideal_gas};

    #[test]
    fn of_an_ideal_gas_it_is_one() {
        let gas = ideal_gas(40_000, 20.0, "radial distribution");
        let mut distribution = RadialDistribution::new(3.0, 30);
        let region = Region {
            low: [3.0; 3],
            high: [17.0; 3],
        };
        distribution.add(&gas, &region);
        // 13,720 central spheres: in the bin from .5 to .6 about 5,200 partners, 1.4 % of noise.
        for [distance, value] in distribution.values().into_iter().skip(5) {
            assert!((value - 1.0).abs() < 0.07, "{distance}: {value}");
        }
    }

    #[test]
    fn of_a_cubic_lattice_it_has_the_shells() {
        let lattice = cubic(9);
        let mut distribution = RadialDistribution::new(2.1, 210);
        let region = Region {
            low: [2.5; 3],
            high: [6.5; 3],
        };
        distribution.add(&lattice, &region);
        assert!((distribution.least_distance().unwrap() - 1.0).abs() < 0.011);
        for (distance, partners) in [(1.05, 6.0), (1.5, 18.0), (1.8, 26.0), (2.05, 32.0)] {
            assert_eq!(distribution.partners_within(distance), partners);
        }
    }
}
