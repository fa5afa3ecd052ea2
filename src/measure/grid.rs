//! Which centres are near a place: a grid of cells.

use crate::particles::vector::Vector;
use crate::simulation::Snapshot;

/// The centres of the spheres that are in, and their numbers in the scene.
#[derive(Clone, Debug, Default)]
pub struct Centres {
    /// Centres (m).
    pub place: Vec<Vector>,
    /// Number of each sphere.
    pub number: Vec<usize>,
}

impl Centres {
    /// The spheres of a snapshot that are in.
    pub fn of(snapshot: &Snapshot) -> Self {
        let mut centres = Self::default();
        for (number, row) in snapshot.position.rows().into_iter().enumerate() {
            if !row[0].is_nan() {
                centres.place.push(Vector::new(row[0], row[1], row[2]));
                centres.number.push(number);
            }
        }
        centres
    }
}

/// Cells over centres, which find those near a place in constant time.
#[derive(Clone, Debug)]
pub struct CellGrid<'a> {
    place: &'a [Vector],
    corner: Vector,
    width: f64,
    sizes: [usize; 3],
    /// Where the spheres of each cell begin in `order`, and where the last cell ends.
    start: Vec<u32>,
    order: Vec<u32>,
}

/// Largest number of cells per centre: wider cells suffice if centres are far apart.
const CELLS_PER_CENTRE: f64 = 4.0;

impl<'a> CellGrid<'a> {
    /// A grid for searches of about this distance (m). No centre may be NaN.
    pub fn new(place: &'a [Vector], distance: f64) -> Self {
        let (mut low, mut high) = (Vector::ZERO, Vector::ZERO);
        if let Some(first) = place.first() {
            (low, high) = (*first, *first);
        }
        for it in place {
            low = Vector::new(low.x.min(it.x), low.y.min(it.y), low.z.min(it.z));
            high = Vector::new(high.x.max(it.x), high.y.max(it.y), high.z.max(it.z));
        }
        let extent = high - low;
        let cells =
            |width: f64| [extent.x, extent.y, extent.z].map(|it| (it / width).floor() + 1.0);
        let mut width = distance;
        let most = CELLS_PER_CENTRE * place.len() as f64 + 64.0;
        while cells(width).iter().product::<f64>() > most {
            width *= 1.25;
        }
        let mut grid = Self {
            place,
            corner: low,
            width,
            sizes: cells(width).map(|it| it as usize),
            start: Vec::new(),
            order: vec![0; place.len()],
        };
        grid.sort();
        grid
    }

    /// Counting sort of the centres by cell, in the order of their indices within each.
    fn sort(&mut self) {
        let cells: usize = self.sizes.iter().product();
        let mut start = vec![0_u32; cells + 1];
        let cell_of: Vec<usize> = self
            .place
            .iter()
            .map(|it| self.index(self.cell(*it)))
            .collect();
        for cell in &cell_of {
            start[cell + 1] += 1;
        }
        for cell in 0..cells {
            start[cell + 1] += start[cell];
        }
        let mut next = start.clone();
        for (sphere, cell) in cell_of.iter().enumerate() {
            self.order[next[*cell] as usize] = sphere as u32;
            next[*cell] += 1;
        }
        self.start = start;
    }

    /// Number of centres.
    pub(super) fn len(&self) -> usize {
        self.place.len()
    }

    fn cell(&self, place: Vector) -> [usize; 3] {
        let from = place - self.corner;
        let along = [from.x, from.y, from.z];
        std::array::from_fn(|axis| {
            let cell = (along[axis] / self.width).max(0.0) as usize;
            cell.min(self.sizes[axis] - 1)
        })
    }

    fn index(&self, [a, b, c]: [usize; 3]) -> usize {
        (a * self.sizes[1] + b) * self.sizes[2] + c
    }

    /// Calls `found` with the index of every centre at most `distance` (m) from a place, and with
    /// the vector from the place to it.
    pub fn within(&self, place: Vector, distance: f64, mut found: impl FnMut(usize, Vector)) {
        if self.place.is_empty() {
            return;
        }
        let reach = Vector::new(distance, distance, distance);
        let (low, high) = (self.cell(place - reach), self.cell(place + reach));
        for a in low[0]..=high[0] {
            for b in low[1]..=high[1] {
                let first = self.start[self.index([a, b, low[2]])] as usize;
                let last = self.start[self.index([a, b, high[2]]) + 1] as usize;
                for &sphere in &self.order[first..last] {
                    let away = self.place[sphere as usize] - place;
                    if away.norm_squared() <= distance * distance {
                        found(sphere as usize, away);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_grid_finds_what_a_search_of_all_finds(
            places in prop::collection::vec((-3.0..3.0, -1.0..1.0, 0.0..9.0), 0..200),
            at in (-4.0..4.0, -2.0..2.0, -1.0..10.0),
            distance in 0.01..4.0,
        ) {
            let vector = |(x, y, z)| Vector::new(x, y, z);
            let places: Vec<Vector> = places.into_iter().map(vector).collect();
            let at = vector(at);
            let grid = CellGrid::new(&places, 1.0);
            let mut found = Vec::new();
            grid.within(at, distance, |sphere, away| {
                assert_eq!(away, places[sphere] - at);
                found.push(sphere);
            });
            found.sort_unstable();
            let near = |it: &usize| (places[*it] - at).norm_squared() <= distance * distance;
            prop_assert_eq!(found, (0..places.len()).filter(near).collect::<Vec<_>>());
        }
    }
}
