//! The search for candidate pairs, before their distances are computed.

use super::Reach;
use super::cells::{BoundedCells, Storage};
use super::hash::HashedCells;
use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::scene::Neighbours;

/// A way to find the spheres that may be near a sphere.
#[derive(Clone, Debug)]
pub(super) enum Search {
    /// Cells in a box about all spheres, of this width (m) or, if none is given, as wide as pairs
    /// reach.
    Cells(BoundedCells, Option<f64>),
    /// Cells of this width (m) in a hash table.
    Hashed(HashedCells, f64),
    /// Test all pairs.
    AllPairs,
}

impl Search {
    pub(super) fn new(neighbours: Neighbours) -> Self {
        match neighbours {
            Neighbours::VerletList => Self::Cells(BoundedCells::default(), None),
            Neighbours::Cells { length } => Self::Cells(BoundedCells::default(), Some(length)),
            Neighbours::HashedCells { length } => Self::Hashed(HashedCells::default(), length),
            Neighbours::AllPairs => Self::AllPairs,
        }
    }

    /// Whether a faster search may replace this one, which the scene does not name.
    pub(super) fn may_be_replaced(&self) -> bool {
        matches!(self, Self::Cells(_, None))
    }

    /// Sorts the spheres into cells, to find pairs of this reach up to `distance` (m): with
    /// [`Reach::Column`], up to this horizontal distance.
    pub(super) fn fill(
        &mut self,
        particles: &Particles,
        distance: f64,
        reach: Reach,
        storage: Storage,
    ) {
        // Slightly wider, so that rounding cannot put the partners of a pair two cells apart.
        let wide = |width: f64| width * (1.0 + 1e-9);
        match self {
            Self::Cells(cells, width) => {
                let width = wide(width.unwrap_or(distance));
                cells.fill(particles, width, reach, storage);
            }
            Self::Hashed(cells, width) => cells.fill(particles, wide(*width), reach),
            Self::AllPairs => {}
        }
    }

    /// Frees the memory of cells.
    pub(super) fn forget(&mut self) {
        if let Self::Cells(cells, _) = self {
            *cells = BoundedCells::default();
        }
    }

    /// Calls `visit` with index, centre and radius of all spheres that may be near sphere `i`, and
    /// of other spheres, in no order.
    #[inline]
    pub(super) fn near(
        &self,
        i: usize,
        particles: &Particles,
        mut visit: impl FnMut(u32, Vector, f64),
    ) {
        match self {
            Self::Cells(cells, _) => cells.near(i, particles, visit),
            Self::Hashed(cells, _) => cells.near(i, particles, visit),
            // Each pair is visited once, from the sphere of lower index.
            Self::AllPairs => {
                for j in particles.first_partner(i)..particles.len() {
                    visit(j as u32, particles.position[j], particles.radius[j]);
                }
            }
        }
    }
}
