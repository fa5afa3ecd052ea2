//! A part of space in which something is measured.

use crate::particles::vector::Vector;

/// A box with sides along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// The corner with the least coordinates (m).
    pub low: [f64; 3],
    /// The corner with the largest coordinates (m).
    pub high: [f64; 3],
}

impl Region {
    /// Whether a place is in it; the lower sides belong to it.
    pub fn contains(&self, place: Vector) -> bool {
        let place = [place.x, place.y, place.z];
        (0..3).all(|axis| self.low[axis] <= place[axis] && place[axis] < self.high[axis])
    }

    /// Its volume (m3).
    pub fn volume(&self) -> f64 {
        (0..3)
            .map(|axis| self.high[axis] - self.low[axis])
            .product()
    }
}
