//! A box filled with spheres, and the regions in which drainages are measured.

use super::voronoi::reach_of_cells;
use super::{CellBounds, Centres, Region, voronoi_cells};
use crate::simulation::Snapshot;
use std::f64::consts::PI;

/// A box filled with spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilledBox {
    /// From the axis to the side walls along x (m).
    pub half_width: f64,
    /// From the axis to the walls along y (m).
    pub half_depth: f64,
    /// Height of the floor (m).
    pub floor: f64,
    /// Height of the highest centre at the start above the floor (m).
    pub filled: f64,
    /// Diameter of the spheres (m).
    pub diameter: f64,
}

impl FilledBox {
    /// A box filled with spheres of this diameter as in a first snapshot.
    ///
    /// * `reach`: from the axis to the walls along x and along y (m)
    pub fn new(reach: [f64; 2], floor: f64, diameter: f64, start: &Snapshot) -> Self {
        let heights = start.position.column(2).into_iter();
        let heights = heights.filter(|it| it.is_finite());
        let top = heights.copied().fold(floor, f64::max);
        Self {
            half_width: reach[0],
            half_depth: reach[1],
            floor,
            filled: top - floor,
            diameter,
        }
    }

    /// A part of the box about its axis: the share `across` of its width, all of its depth, and
    /// between two shares of the height to which it was filled.
    pub fn part(&self, across: f64, heights: [f64; 2]) -> Region {
        let [low, high] = heights.map(|share| self.floor + share * self.filled);
        let [x, y] = [across * self.half_width, self.half_depth];
        Region {
            low: [-x, -y, low],
            high: [x, y, high],
        }
    }

    /// The region in which packings are measured, the middle of the lower half: -15 d < x < 15 d
    /// and 15 d < z < 45 d in Rycroft, Wong and Bazant (2010), scaled by the half width of the box
    /// and the height of its packing.
    pub fn middle(&self) -> Region {
        self.part(0.6, [0.14, 0.41])
    }

    /// Volume of the spheres in the middle over the volume of their Voronoi cells, which end at the
    /// walls and, at the free surface, near the spheres. `None` without spheres in the middle.
    pub fn packing_fraction(&self, state: &Snapshot) -> Option<f64> {
        let centres = Centres::of(state);
        let region = self.middle();
        let heights = centres.place.iter().map(|it| it.z);
        let top = heights.fold(self.floor + self.filled, f64::max);
        let walls = CellBounds {
            low: [-self.half_width, -self.half_depth, self.floor],
            high: [self.half_width, self.half_depth, top + 0.5 * self.diameter],
            farthest: reach_of_cells(&centres, &region, self.diameter),
        };
        let cells = voronoi_cells(&centres, &walls)
            .into_iter()
            .zip(&centres.place);
        let inside = cells.filter(|(_, place)| region.contains(**place));
        let volumes: Vec<f64> = inside.map(|(cell, _)| cell.volume).collect();
        let diameter = self.diameter;
        let spheres = volumes.len() as f64 * PI / 6.0 * diameter * diameter * diameter;
        (!volumes.is_empty()).then(|| spheres / volumes.iter().sum::<f64>())
    }

    /// The region in which mixing is measured: the lower half.
    pub fn lower_half(&self) -> Region {
        self.part(1.0, [0.0, 0.5])
    }
}
