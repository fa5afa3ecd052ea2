//! Cells in a box about all spheres.

use super::Reach;
use crate::particles::Particles;
use crate::particles::domain::cells_around;
use crate::particles::vector::Vector;
use std::ops::Range;

/// Where a search reads the spheres of a cell.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Storage {
    /// In copies, which are in the order of the cells.
    Copied,
    /// In place, as spheres are in about that order anyway.
    InPlace,
}

/// Spheres sorted by cell.
#[derive(Clone, Debug, Default)]
pub(super) struct BoundedCells {
    shape: [usize; 3],
    /// Along which axes the first cell comes after the last.
    wraps: [bool; 3],
    /// Spheres of cell c are `first[c]..first[c + 1]` of the sorted arrays.
    first: Vec<u32>,
    cell_of: Vec<u32>,
    index: Vec<u32>,
    /// Copies in the order of the cells; empty if spheres are read in place.
    position: Vec<Vector>,
    radius: Vec<f64>,
}

impl BoundedCells {
    /// Sorts the spheres into cells of this width or wider (m). Cells of columns hold spheres of
    /// any height.
    pub(super) fn fill(
        &mut self,
        particles: &Particles,
        width: f64,
        reach: Reach,
        storage: Storage,
    ) {
        let count = particles.len();
        let domain = particles.domain;
        let periods = domain.periods();
        let (low, extent) = extent(particles);
        // More than a few cells per sphere would only cost time and memory.
        let most = 4 * count + 64;
        let mut width = width;
        loop {
            let height = match reach {
                Reach::Contact => extent[2],
                Reach::Column => 0.0,
            };
            let sides = [extent[0], extent[1], height];
            self.shape = [0, 1, 2].map(|axis| {
                let whole = (sides[axis] / width) as usize;
                // The last cell along a period ends where the first begins.
                match periods[axis] {
                    Some(_) => whole.max(1),
                    None => whole.saturating_add(1),
                }
            });
            let [nx, ny, nz] = self.shape;
            if nx.saturating_mul(ny).saturating_mul(nz) <= most {
                break;
            }
            // A width of zero would not grow.
            width = (1.25 * width).max(f64::MIN_POSITIVE);
        }
        let [nx, ny, nz] = self.shape;
        let inverse = [0, 1, 2].map(|axis| match periods[axis] {
            Some(period) => self.shape[axis] as f64 / period,
            None => 1.0 / width,
        });
        self.wraps = periods.map(|period| period.is_some());
        let cell =
            |offset: f64, inverse: f64, cells: usize| ((offset * inverse) as usize).min(cells - 1);
        self.cell_of.clear();
        self.cell_of
            .extend(particles.position.iter().map(|&centre| {
                let offset = domain.wrapped(centre) - low;
                let column = cell(offset.x, inverse[0], nx);
                let row = cell(offset.y, inverse[1], ny);
                let layer = cell(offset.z, inverse[2], nz);
                ((layer * ny + row) * nx + column) as u32
            }));
        self.sort(particles, storage);
    }

    /// Counting sort by cell; within a cell spheres stay in order of their index.
    fn sort(&mut self, particles: &Particles, storage: Storage) {
        let count = particles.len();
        let cells = self.shape.iter().product::<usize>();
        self.first.clear();
        self.first.resize(cells + 1, 0);
        for &cell in &self.cell_of {
            self.first[cell as usize + 1] += 1;
        }
        for cell in 0..cells {
            self.first[cell + 1] += self.first[cell];
        }
        self.index.resize(count, 0);
        let copied = storage == Storage::Copied;
        let copies = if copied { count } else { 0 };
        self.radius.resize(copies, 0.0);
        self.position.resize(copies, Vector::ZERO);
        // `first[c]` walks through its cell and ends at the start of the next one.
        for i in 0..count {
            let slot = &mut self.first[self.cell_of[i] as usize];
            let at = *slot as usize;
            *slot += 1;
            self.index[at] = i as u32;
            if copied {
                self.radius[at] = particles.radius[i];
                self.position[at] = particles.position[i];
            }
        }
        for cell in (0..cells).rev() {
            self.first[cell + 1] = self.first[cell];
        }
        self.first[0] = 0;
    }

    /// Calls `visit` with the sorted range of every row of cells around sphere `i`.
    #[inline]
    fn rows_about(&self, i: usize, mut visit: impl FnMut(Range<usize>)) {
        let [nx, ny, nz] = self.shape;
        let cell = self.cell_of[i] as usize;
        let (column, row, layer) = (cell % nx, cell / nx % ny, cell / (nx * ny));
        let columns = cells_around(column, nx, self.wraps[0]);
        let rows = cells_around(row, ny, self.wraps[1]);
        for layer in cells_around(layer, nz, self.wraps[2]).into_iter().flatten() {
            for row in rows.iter().cloned().flatten() {
                let base = (layer * ny + row) * nx;
                for columns in columns.iter().filter(|columns| !columns.is_empty()) {
                    let first = self.first[base + columns.start] as usize;
                    visit(first..self.first[base + columns.end] as usize);
                }
            }
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
        self.rows_about(i, |row| {
            let index = &self.index[row.clone()];
            if self.position.is_empty() {
                // Partners have higher indices.
                for &j in index.iter().filter(|&&j| j as usize > i) {
                    let at = j as usize;
                    visit(j, particles.position[at], particles.radius[at]);
                }
                return;
            }
            let spheres = self.position[row.clone()].iter().zip(&self.radius[row]);
            for (&j, (&centre, &radius)) in index.iter().zip(spheres) {
                visit(j, centre, radius);
            }
        });
    }
}

/// The corner with the least coordinates (m) of the smallest box that holds all spheres, and its
/// extent along each axis (m). Along a periodic axis it is the whole period.
fn extent(particles: &Particles) -> (Vector, [f64; 3]) {
    let (low, high) = bounds(&particles.position);
    let extent = high - low;
    let mut sides = [extent.x, extent.y, extent.z];
    let mut corner = [low.x, low.y, low.z];
    for (axis, period) in particles.domain.periods().into_iter().enumerate() {
        if let Some(period) = period {
            (corner[axis], sides[axis]) = (-0.5 * period, period);
        }
    }
    (corner.into(), sides)
}

/// Corners of the smallest box that holds all points.
fn bounds(points: &[Vector]) -> (Vector, Vector) {
    let mut low = Vector::new(f64::INFINITY, f64::INFINITY, f64::INFINITY);
    let mut high = -low;
    for point in points {
        low = Vector::new(low.x.min(point.x), low.y.min(point.y), low.z.min(point.z));
        high = Vector::new(
            high.x.max(point.x),
            high.y.max(point.y),
            high.z.max(point.z),
        );
    }
    (low, high)
}
