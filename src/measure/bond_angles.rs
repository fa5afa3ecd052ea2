//! Angles between the bonds of a sphere to its neighbours.

use super::{CellGrid, Centres, Region};
use crate::particles::vector::Vector;
use std::f64::consts::PI;

/// Counts of angles, from which the bond-angle distribution g3(theta) follows; several snapshots
/// may be added.
#[derive(Clone, Debug, PartialEq)]
pub struct BondAngles {
    /// Largest distance of a neighbour (m).
    cutoff: f64,
    /// Number of pairs of bonds in each bin.
    counts: Vec<u64>,
}

impl BondAngles {
    /// No angles yet; `bins` bins of equal width from 0 to pi.
    ///
    /// * `cutoff`: largest distance of a neighbour (m). Usual is the first minimum of the radial
    ///   distribution function, 1.2 to 1.4 diameters in a dense random packing.
    pub fn new(cutoff: f64, bins: usize) -> Self {
        Self {
            cutoff,
            counts: vec![0; bins],
        }
    }

    /// Adds a snapshot: the angles between each two bonds of every sphere in a region; its
    /// neighbours may be anywhere.
    pub fn add(&mut self, centres: &Centres, region: &Region) {
        let grid = CellGrid::new(&centres.place, self.cutoff);
        let mut bonds: Vec<Vector> = Vec::new();
        let inside = centres.place.iter().enumerate();
        for (own, place) in inside.filter(|(_, place)| region.contains(**place)) {
            bonds.clear();
            grid.within(*place, self.cutoff, |other, away| {
                if other != own {
                    bonds.push(away);
                }
            });
            for (first, one) in bonds.iter().enumerate() {
                for other in &bonds[..first] {
                    self.count(angle(*one, *other));
                }
            }
        }
    }

    fn count(&mut self, angle: f64) {
        let bins = self.counts.len();
        let bin = (angle / PI * bins as f64) as usize;
        // pi itself belongs to the last bin.
        let bin = bin.min(bins.saturating_sub(1));
        if let Some(count) = self.counts.get_mut(bin) {
            *count += 1;
        }
    }

    /// The angle at the middle of each bin (rad), and the density of angles there (1/rad), whose
    /// integral is 1. For uncorrelated bonds it is sin(theta) / 2.
    pub fn values(&self) -> Vec<[f64; 2]> {
        let width = PI / self.counts.len() as f64;
        let all = self.counts.iter().sum::<u64>().max(1) as f64;
        let value = |(bin, count): (usize, &u64)| {
            [(bin as f64 + 0.5) * width, *count as f64 / (all * width)]
        };
        self.counts.iter().enumerate().map(value).collect()
    }
}

/// Angle between two vectors (rad), accurate near 0 and pi too, where the arc cosine is not.
fn angle(one: Vector, other: Vector) -> f64 {
    libm::atan2(one.cross(other).norm(), one.dot(other))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::synthetic::{cubic, face_centred, ideal_gas};

    const REGION: Region = Region {
        low: [1.9; 3],
        high: [5.1; 3],
    };

    /// Share of all angles in the bin of this angle (degrees).
    fn share(angles: &BondAngles, degrees: f64) -> f64 {
        let width = PI / angles.counts.len() as f64;
        let bin = (degrees.to_radians() / width) as usize;
        angles.values()[bin.min(angles.counts.len() - 1)][1] * width
    }

    #[test]
    fn lattices_have_few_angles() {
        // No edge of a bin of 7.2 degrees is near these angles.
        let mut angles = BondAngles::new(1.01, 25);
        angles.add(&cubic(8), &REGION);
        assert!((share(&angles, 90.0) - 12.0 / 15.0).abs() < 1e-12);
        assert!((share(&angles, 180.0) - 3.0 / 15.0).abs() < 1e-12);
        // Twelve neighbours, 66 pairs of them. The nearest are at sqrt(1/2).
        let mut angles = BondAngles::new(0.75, 25);
        angles.add(&face_centred(8), &REGION);
        for (degrees, pairs) in [(60.0, 24.0), (90.0, 12.0), (120.0, 24.0), (180.0, 6.0)] {
            let share = share(&angles, degrees);
            assert!((share - pairs / 66.0).abs() < 1e-12, "{degrees}: {share}");
        }
    }

    #[test]
    fn of_an_ideal_gas_the_density_is_half_the_sine() {
        let gas = ideal_gas(40_000, 20.0, "bond angles");
        let region = Region {
            low: [1.2; 3],
            high: [18.8; 3],
        };
        let mut angles = BondAngles::new(1.2, 18);
        assert!(angles.values().iter().all(|[_, density]| *density == 0.0));
        angles.add(&gas, &region);
        let values = angles.values();
        // About 36 neighbours, and 4,400 angles, of each of 27,000 spheres.
        for [angle, density] in &values {
            let expected = 0.5 * libm::sin(*angle);
            assert!((density - expected).abs() < 4e-3, "{angle}: {density}");
        }
        let integral: f64 = values.iter().map(|it| it[1] * PI / 18.0).sum();
        assert!((integral - 1.0).abs() < 1e-12);
    }
}
