//! How far spheres overlap: the packing badness (Rycroft, Wong and Bazant, 2010, section 5).

use super::{CellGrid, Centres, Region};

/// Overlaps of the spheres in a region; several snapshots may be added.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Badness {
    spheres: u64,
    squares: f64,
    overlaps: f64,
}

impl Badness {
    /// Adds the spheres of a snapshot whose centres are in a region, of one diameter (m).
    pub fn add(&mut self, centres: &Centres, diameter: f64, region: &Region) {
        let grid = CellGrid::new(&centres.place, diameter);
        let inside = centres.place.iter().enumerate();
        for (own, place) in inside.filter(|(_, place)| region.contains(**place)) {
            self.spheres += 1;
            grid.within(*place, diameter, |other, away| {
                if other != own {
                    let overlap = 1.0 - away.norm_squared().sqrt() / diameter;
                    self.squares += overlap * overlap;
                    // Its partner counts the other half.
                    self.overlaps += 0.5 * overlap;
                }
            });
        }
    }

    /// As printed in the paper: sum over the overlapping partners of a sphere of (delta/d)^2, mean
    /// over spheres. `None` if no sphere was in the region.
    pub fn as_printed(&self) -> Option<f64> {
        self.of_each(self.squares)
    }

    /// Sum of delta/d over overlapping pairs, each counted once, per sphere. The numbers in the
    /// paper cannot follow from its formula, but are close to these. `None` if no sphere was in the
    /// region.
    pub fn of_pairs(&self) -> Option<f64> {
        self.of_each(self.overlaps)
    }

    fn of_each(&self, sum: f64) -> Option<f64> {
        (self.spheres > 0).then(|| sum / self.spheres as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::synthetic::cubic;

    #[test]
    fn of_a_compressed_lattice_it_has_a_closed_form() {
        let lattice = cubic(7);
        let region = Region {
            low: [1.5; 3],
            high: [4.5; 3],
        };
        let mut badness = Badness::default();
        assert_eq!((badness.as_printed(), badness.of_pairs()), (None, None));
        badness.add(&lattice, 1.0, &region);
        let none = Some(0.0);
        assert_eq!((badness.as_printed(), badness.of_pairs()), (none, none));
        // Six partners at a distance of 1 = .9 of the diameter.
        let mut badness = Badness::default();
        badness.add(&lattice, 1.0 / 0.9, &region);
        assert!((badness.as_printed().unwrap() - 6.0 * 0.01).abs() < 1e-12);
        assert!((badness.of_pairs().unwrap() - 3.0 * 0.1).abs() < 1e-12);
    }
}
