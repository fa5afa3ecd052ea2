//! Regions that runs may have missed.

use super::lattice::square_distance;
use super::{Lattice, Observations, RefineError};

/// The largest part of the lattice without a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// Value on each axis of the place farthest from all runs.
    pub values: Vec<f64>,
    /// Distance from there to the nearest run. Axes have length 1, in their scales.
    ///
    /// A region of one label that contains a ball of more than this radius about a place of the
    /// lattice has been run at least once. Smaller regions may have been missed.
    pub radius: f64,
}

impl Gap {
    /// The largest gap between runs.
    ///
    /// # Errors
    /// If there are no runs, or if one does not lie on the axes.
    pub fn new(lattice: &Lattice, runs: &Observations) -> Result<Self, RefineError> {
        if runs.is_empty() {
            return Err(RefineError::no_runs());
        }
        let mut squares = vec![f64::INFINITY; lattice.places()];
        for (run, _) in runs.iter() {
            let unit = lattice.unit_of(&run.values)?;
            for (place, square) in squares.iter_mut().enumerate() {
                *square = square.min(square_distance(lattice.unit(place), &unit));
            }
        }
        let farthest = (1..squares.len()).fold(0, |best, place| {
            if squares[place] > squares[best] {
                place
            } else {
                best
            }
        });
        Ok(Self {
            values: lattice.values(farthest),
            radius: squares[farthest].sqrt(),
        })
    }
}
