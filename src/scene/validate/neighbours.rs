//! Whether the cells of a scene are wide enough.

use crate::document::{Problem, number};
use crate::scene::{Geometry, Scene};

impl Scene {
    /// The least side of a cell (m) with which all pairs that may touch are found in neighbouring
    /// cells: the largest distance from which two spheres act on each other. This is the largest
    /// sum of two radii or, with an updraught, the width of the column that a sphere shields.
    pub fn least_cell_length(&self) -> f64 {
        let largest = self.radius_range().1;
        let fixed = self.dem.geometry.as_ref().map(Geometry::spheres);
        let fixed = fixed
            .iter()
            .flat_map(|fixed| fixed.walls.iter().chain(&fixed.door));
        // Two fixed spheres do not interact.
        largest + fixed.map(|sphere| sphere.radius).fold(largest, f64::max)
    }

    pub(super) fn check_neighbours(&self, problems: &mut Vec<Problem>) {
        let (Some(length), least) = (self.dem.neighbours.length(), self.least_cell_length()) else {
            return;
        };
        if length < least {
            let message = format!(
                "cells of {} m miss contacts: spheres whose centres are {} m apart may touch, and \
                 only neighbouring cells are searched",
                number(length),
                number(least)
            );
            let help = format!("use `length = {}` or more", number(least));
            problems.push(Problem::new("neighbours.length", message).help(help));
        }
    }
}
