//! How long spheres keep their neighbours.

use super::{CellGrid, Centres, Region};
use crate::particles::vector::Vector;
use crate::simulation::Snapshot;
use std::collections::BTreeMap;

/// The neighbours of spheres at a start, and how many of them are still neighbours later.
#[derive(Clone, Debug)]
pub struct NeighbourRetention {
    /// Largest distance of a neighbour (m).
    cutoff: f64,
    /// Heights of all spheres at the start (m).
    start: Vec<f64>,
    /// Spheres in the region and each of their neighbours, by numbers.
    bonds: Vec<[usize; 2]>,
}

/// Neighbours kept by spheres that dropped about equally far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Retained {
    /// Mean distance that they dropped (m), a sphere counting with each of its neighbours.
    pub drop: f64,
    /// Share of the neighbours at the start that still are neighbours.
    pub share: f64,
    /// Number of the neighbours at the start.
    pub neighbours: usize,
}

impl NeighbourRetention {
    /// Notes the neighbours of the spheres that are in a region at the start; these may be outside.
    ///
    /// * `cutoff`: largest distance of a neighbour (m), usually 1.3 diameters
    pub fn new(start: &Snapshot, region: &Region, cutoff: f64) -> Self {
        let centres = Centres::of(start);
        let grid = CellGrid::new(&centres.place, cutoff);
        let mut bonds = Vec::new();
        for (own, place) in centres.place.iter().enumerate() {
            if region.contains(*place) {
                grid.within(*place, cutoff, |other, _| {
                    if other != own {
                        bonds.push([own, other].map(|it| centres.number[it]));
                    }
                });
            }
        }
        Self {
            cutoff,
            start: start.position.column(2).to_vec(),
            bonds,
        }
    }

    /// Neighbours kept at a later snapshot, among pairs of spheres that are both still there, in
    /// bins of this width (m) of the distance that the sphere in the region has dropped, which may
    /// be negative. Bins without pairs are left out.
    pub fn by_drop(&self, later: &Snapshot, width: f64) -> Vec<Retained> {
        let rows = later.position.rows().into_iter();
        let later: Vec<Vector> = rows
            .map(|row| Vector::new(row[0], row[1], row[2]))
            .collect();
        // By bins: sums of the distances dropped, numbers of neighbours, numbers that are kept.
        let mut bins: BTreeMap<i64, (f64, usize, usize)> = BTreeMap::new();
        for &[own, other] in &self.bonds {
            let (Some(place), Some(partner)) = (later.get(own), later.get(other)) else {
                continue;
            };
            let squared = (*partner - *place).norm_squared();
            if squared.is_nan() {
                continue;
            }
            let drop = self.start[own] - place.z;
            let bin = bins.entry((drop / width).floor() as i64).or_default();
            bin.0 += drop;
            bin.1 += 1;
            bin.2 += usize::from(squared <= self.cutoff * self.cutoff);
        }
        let retained = |(drop, neighbours, kept): (f64, usize, usize)| Retained {
            drop: drop / neighbours as f64,
            share: kept as f64 / neighbours as f64,
            neighbours,
        };
        bins.into_values().map(retained).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::synthetic::{cubic, snapshot};

    const REGION: Region = Region {
        low: [1.5; 3],
        high: [5.5; 3],
    };

    fn lattice() -> Vec<[f64; 3]> {
        let places = cubic(8).place.into_iter();
        places.map(|it| [it.x, it.y, it.z]).collect()
    }

    #[test]
    fn a_block_that_slides_keeps_the_neighbours_within_it() {
        let start = lattice();
        let retention = NeighbourRetention::new(&snapshot(0.0, &start), &REGION, 1.3);
        let [same] = retention.by_drop(&snapshot(1.0, &start), 1.0)[..] else {
            panic!("one bin");
        };
        // 64 spheres with six neighbours.
        let expected = Retained {
            drop: 0.0,
            share: 1.0,
            neighbours: 384,
        };
        assert_eq!(same, expected);
        // Spheres right of x = 3.5 fall by 2.25: at the plane each sphere loses one of six.
        let fall = |it: &[f64; 3]| [it[0], it[1], it[2] - if it[0] > 3.5 { 2.25 } else { 0.0 }];
        let later: Vec<[f64; 3]> = start.iter().map(fall).collect();
        let bins = retention.by_drop(&snapshot(1.0, &later), 1.0);
        assert_eq!(
            bins.iter().map(|it| it.drop).collect::<Vec<_>>(),
            [0.0, 2.25]
        );
        for bin in bins {
            // Of the 32 spheres in two layers, one layer is at the plane.
            assert_eq!((bin.neighbours, bin.share), (192, 176.0 / 192.0));
        }
    }

    #[test]
    fn pairs_of_which_one_is_gone_do_not_count() {
        let start = lattice();
        let retention = NeighbourRetention::new(&snapshot(0.0, &start), &REGION, 1.3);
        let mut later = start.clone();
        for it in &mut later {
            // All rise a little, and one of the region is gone.
            it[2] += 0.01;
        }
        later[3 * 64 + 3 * 8 + 3] = [f64::NAN; 3];
        let [bin] = retention.by_drop(&snapshot(1.0, &later), 1.0)[..] else {
            panic!("one bin");
        };
        assert_eq!((bin.neighbours, bin.share), (384 - 12, 1.0));
        assert!((bin.drop + 0.01).abs() < 1e-12);
        later.fill([f64::NAN; 3]);
        assert!(retention.by_drop(&snapshot(1.0, &later), 1.0).is_empty());
    }
}
