//! A line where walls join.

use super::parallelogram::within;
use super::{ContactSurface, WallContact};
use crate::particles::vector::Vector;

/// A straight line between two points, or a single point.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// Where it begins (m).
    pub from: Vector,
    /// From there to its end (m).
    pub along: Vector,
    /// 1 / its squared length (1/m2); zero for a point.
    inverse_square: f64,
}

impl Segment {
    /// The line from a point along a vector (m), which is zero for a single point.
    pub fn new(from: Vector, along: Vector) -> Self {
        let squared = along.norm_squared();
        Self {
            from,
            along,
            inverse_square: if squared > 0.0 { 1.0 / squared } else { 0.0 },
        }
    }

    /// Its two ends (m).
    pub fn ends(&self) -> [Vector; 2] {
        [self.from, self.from + self.along]
    }

    /// The offset (m) of a place from the nearest point.
    #[inline(always)]
    fn offset(&self, place: Vector) -> Vector {
        let from_start = place - self.from;
        let share = within(from_start.dot(self.along) * self.inverse_square, 0.0, 1.0);
        from_start - self.along * share
    }
}

impl ContactSurface for Segment {
    #[inline(always)]
    fn contact(&self, centre: Vector, radius: f64) -> WallContact {
        WallContact::with_point(self.offset(centre), radius)
    }

    #[inline(always)]
    fn is_near(&self, centre: Vector, radius: f64, margin: f64) -> bool {
        let reach = radius + margin;
        !(self.offset(centre).norm_squared() >= reach * reach)
    }
}
