//! The order of the spheres in the arrays, and what stays valid until the next sorting.
//!
//! Spheres are sorted by cell, and neighbour lists are made, when a sphere has moved so far that
//! the lists could miss a pair. Until then only the positions change.

use super::cells::SphereCells;
use super::guard::Fault;
use super::neighbours::NeighbourLists;
use super::parameters::{Parameters, Relaxation};
use super::region::NOWHERE;
use super::slack::Slack;
use super::surface::Surface;
use crate::particles::block::ROWS;
use crate::particles::vector::Vector;
use fearless_simd::Level;
use std::ops::Range;

/// What the sorting of spheres depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sorting<'a> {
    pub(crate) level: Level,
    pub(crate) parameters: &'a Parameters,
    pub(crate) slack: Slack,
}

/// The result of sorting.
#[derive(Clone, Debug)]
pub(crate) struct Arrangement {
    /// Number of spheres, including those that have left since.
    pub(crate) spheres: usize,
    /// Number of each sphere in the start packing.
    pub(crate) id: Vec<u32>,
    /// Centres at the time of sorting (m).
    pub(crate) reference: Vec<Vector>,
    pub(crate) neighbours: NeighbourLists,
    /// Squares of distances from the references (m2). If one is exceeded, the spheres must be
    /// sorted before the next move.
    pub(crate) farthest_squared: Vec<f64>,
    pub(crate) cells: SphereCells,
    slack: Slack,
    surface: Surface,
    /// Height of the highest centre (m), 0 without spheres.
    pub(crate) top: f64,
}

impl Arrangement {
    /// Sorts spheres and finds their neighbours. `position` is padded for vector instructions.
    pub(crate) fn sorted(
        sorting: Sorting<'_>,
        (position, id): (&mut Vec<Vector>, Vec<u32>),
        neighbours: NeighbourLists,
    ) -> Result<Self, Fault> {
        position.truncate(id.len());
        let mut cells = cells_for(sorting.parameters, position);
        let order = cells.sort(position);
        let id = order.iter().map(|&sphere| id[sphere as usize]).collect();
        let mut sorted = Vec::with_capacity(order.len() + ROWS);
        sorted.extend(order.iter().map(|&sphere| position[sphere as usize]));
        fill_up(&mut sorted);
        position.clone_from(&sorted);
        Self::of(sorting, (sorted, id), (cells, neighbours))
    }

    /// The arrangement that spheres had when they were sorted to these references.
    pub(crate) fn restored(
        sorting: Sorting<'_>,
        (mut reference, id): (Vec<Vector>, Vec<u32>),
    ) -> Result<Self, Fault> {
        let mut cells = cells_for(sorting.parameters, &reference);
        cells.sort(&reference);
        fill_up(&mut reference);
        let parts = (cells, NeighbourLists::new());
        Self::of(sorting, (reference, id), parts)
    }

    fn of(
        sorting: Sorting<'_>,
        (reference, id): (Vec<Vector>, Vec<u32>),
        (cells, mut neighbours): (SphereCells, NeighbourLists),
    ) -> Result<Self, Fault> {
        let Sorting {
            level,
            parameters,
            slack,
        } = sorting;
        let spheres = &reference[..id.len()];
        if parameters.relaxation != Relaxation::Off {
            let reach: Vec<f64> = spheres.iter().map(|&it| slack.reach(it)).collect();
            neighbours.find(level, &cells, &reference, &reach)?;
        }
        let farthest = spheres.iter().map(|&it| slack.before_a_move(slack.at(it)));
        let farthest_squared = farthest.map(|it| it * it).collect();
        let surface = Surface::of(spheres, parameters);
        Ok(Self {
            spheres: id.len(),
            top: surface.top(),
            surface,
            id,
            reference,
            neighbours,
            farthest_squared,
            cells,
            slack,
        })
    }

    /// Ranges of slots that hold all spheres nearer than `radius` to a centre (m).
    #[inline(always)]
    pub(crate) fn cover(&self, centre: Vector, radius: f64, ranges: &mut Vec<Range<u32>>) {
        let slack = self.slack.near_to(centre, 2.0 * radius);
        self.cells.cover(centre, radius + slack, ranges);
    }

    /// The surface of the packing at the last sorting.
    pub(crate) fn surface(&self) -> &Surface {
        &self.surface
    }
}

fn cells_for(parameters: &Parameters, position: &[Vector]) -> SphereCells {
    let height = position.iter().fold(0.0, |most: f64, it| most.max(it.z));
    let halves = [parameters.half_width, parameters.half_depth];
    SphereCells::new(parameters.diameter, halves, height)
}

fn fill_up(position: &mut Vec<Vector>) {
    let filled = position.len() + ROWS;
    position.resize(filled, NOWHERE);
}
