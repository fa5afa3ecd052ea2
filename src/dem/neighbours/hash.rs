//! Cells in a chained hash table, for spheres that may be anywhere.

use super::Reach;
use crate::particles::Particles;
use crate::particles::domain::cells_around;
use crate::particles::vector::Vector;
use std::ops::Range;

/// No sphere.
const NONE: u32 = u32::MAX;

/// The coordinates of a cell, counted in cells from the origin along x, y and z.
type CellIndex = [i64; 3];

/// Spheres in cells of one width. A cell is a chain that begins at the entry of its hash. Cells of
/// equal hash share a chain, so every sphere keeps the coordinates of its cell.
#[derive(Clone, Debug, Default)]
pub(super) struct HashedCells {
    /// The first sphere of each chain. The number of chains is a power of two.
    first: Vec<u32>,
    /// The sphere after each sphere in its chain.
    next: Vec<u32>,
    /// The cell of each sphere.
    place: Vec<CellIndex>,
    /// Whether all cells lie in one layer along x, y and z.
    flat: [bool; 3],
    /// Number of cells along each axis that is periodic.
    cells: [Option<i64>; 3],
}

impl HashedCells {
    /// Sorts the spheres into cells. Cells of columns hold spheres of any height.
    pub(super) fn fill(&mut self, particles: &Particles, width: f64, reach: Reach) {
        let domain = particles.domain;
        let periods = domain.periods();
        self.cells = periods.map(|period| Some((period? / width).max(1.0) as i64));
        let cells = self.cells;
        let along = |axis: usize, value: f64| match (periods[axis], cells[axis]) {
            (Some(period), Some(cells)) => {
                let share = value / period + 0.5;
                ((share * cells as f64) as i64).clamp(0, cells - 1)
            }
            _ => (value * (1.0 / width)).floor() as i64,
        };
        self.place.clear();
        self.place.extend(particles.position.iter().map(|&centre| {
            let centre = domain.wrapped(centre);
            let layer = match reach {
                Reach::Contact => along(2, centre.z),
                Reach::Column => 0,
            };
            [along(0, centre.x), along(1, centre.y), layer]
        }));
        self.flat = [0, 1, 2].map(|axis| {
            let mut places = self.place.iter().map(|place| place[axis]);
            let first = places.next();
            places.all(|place| Some(place) == first)
        });
        // Half of the chains stay empty.
        let chains = (2 * particles.len()).next_power_of_two();
        self.first.clear();
        self.first.resize(chains, NONE);
        self.next.clear();
        for (i, place) in self.place.iter().enumerate() {
            let first = &mut self.first[hash(*place) & (chains - 1)];
            self.next.push(*first);
            *first = i as u32;
        }
    }

    /// Calls `visit` with index, centre and radius of the spheres in the cell of sphere `i` and in
    /// the cells around it.
    #[inline]
    pub(super) fn near(
        &self,
        i: usize,
        particles: &Particles,
        mut visit: impl FnMut(u32, Vector, f64),
    ) {
        let [x, y, z] = [0, 1, 2].map(|axis| self.around(self.place[i][axis], axis));
        for z in z.into_iter().flatten() {
            for y in y.clone().into_iter().flatten() {
                for x in x.clone().into_iter().flatten() {
                    self.visit_cell([x, y, z], particles, &mut visit);
                }
            }
        }
    }

    /// A cell and its neighbours along an axis, each once.
    #[inline]
    fn around(&self, cell: i64, axis: usize) -> [Range<i64>; 2] {
        match (self.cells[axis], self.flat[axis]) {
            // A plane of cells has no neighbours above or below.
            (_, true) => [cell..cell + 1, 0..0],
            (None, false) => [cell.saturating_sub(1)..cell.saturating_add(2), 0..0],
            (Some(cells), false) => cells_around(cell as usize, cells as usize, true)
                .map(|cells| cells.start as i64..cells.end as i64),
        }
    }

    #[inline]
    fn visit_cell(
        &self,
        place: CellIndex,
        particles: &Particles,
        visit: &mut impl FnMut(u32, Vector, f64),
    ) {
        let mut j = self.first[hash(place) & (self.first.len() - 1)];
        while j != NONE {
            let at = j as usize;
            if self.place[at] == place {
                visit(j, particles.position[at], particles.radius[at]);
            }
            j = self.next[at];
        }
    }
}

/// Spreads neighbouring cells over the table (the primes of Teschner et al., 2003).
#[inline]
fn hash([x, y, z]: CellIndex) -> usize {
    let mixed =
        x.wrapping_mul(73_856_093) ^ y.wrapping_mul(19_349_663) ^ z.wrapping_mul(83_492_791);
    mixed as usize
}
