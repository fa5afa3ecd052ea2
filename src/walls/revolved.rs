//! A line that turned about an axis: disc, annulus, tube, cone, frustum, circle.

use super::parallelogram::within;
use super::{ContactSurface, WallContact};
use crate::particles::math::inverse_square_root;
use crate::particles::vector::Vector;

/// The surface over which a straight line passes while it turns about an axis that lies in one
/// plane with it. Spheres touch it from both sides and at its rims.
///
/// In the half plane of the axis and a centre, the contact is with the nearest point of the line.
/// A centre on the axis of a tube that is narrower than its sphere touches it all around: the
/// forces across the axis then cancel.
#[derive(Clone, Copy, Debug)]
pub struct Revolved {
    /// A point of the axis (m).
    pub base: Vector,
    /// Unit vector along the axis.
    pub axis: Vector,
    /// Distance (m) from the axis of the line's point at the height of the base.
    pub radius: f64,
    /// Unit vector along the line: across the axis and along it.
    pub direction: [f64; 2],
    /// Where the line begins and ends, along itself from that point (m). May be infinite.
    pub ends: [f64; 2],
}

impl Revolved {
    /// The surface of the line between two places of the half plane: each how far from the axis,
    /// and how far along it from the base (m).
    pub fn between(base: Vector, axis: Vector, from: [f64; 2], to: [f64; 2]) -> Self {
        let (across, along) = (to[0] - from[0], to[1] - from[1]);
        let length = libm::hypot(across, along);
        let direction = match length > 0.0 {
            true => [across / length, along / length],
            false => [0.0, 1.0],
        };
        Self {
            base: base + axis * from[1],
            axis,
            radius: from[0],
            direction,
            ends: [0.0, length],
        }
    }

    /// A tube without ends.
    pub fn endless(base: Vector, axis: Vector, radius: f64) -> Self {
        Self {
            base,
            axis,
            radius,
            direction: [0.0, 1.0],
            ends: [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    /// A circle about an axis, of this radius (m).
    pub fn circle(centre: Vector, axis: Vector, radius: f64) -> Self {
        Self::between(centre, axis, [radius, 0.0], [radius, 0.0])
    }

    /// The place of its line at a length (m) along it.
    pub fn profile_at(&self, length: f64) -> [f64; 2] {
        let [across, along] = self.direction;
        [self.radius + across * length, along * length]
    }

    /// The offset (m) of a place from the nearest point, and the square of its length (m2), which
    /// is right on the axis too, where the offset has no direction.
    #[inline(always)]
    fn offset(&self, place: Vector) -> (Vector, f64) {
        let from_base = place - self.base;
        let height = from_base.dot(self.axis);
        let aside = from_base - self.axis * height;
        let squared = aside.norm_squared();
        let inverse = inverse_square_root(squared);
        let distance = squared * inverse;
        let [across, along] = self.direction;
        let [from, to] = self.ends;
        let length = within((distance - self.radius) * across + height * along, from, to);
        let out = distance - (self.radius + across * length);
        let up = height - along * length;
        let offset = aside * (inverse * out) + self.axis * up;
        (offset, out * out + up * up)
    }
}

impl ContactSurface for Revolved {
    #[inline(always)]
    fn contact(&self, centre: Vector, radius: f64) -> WallContact {
        let (offset, distance_squared) = self.offset(centre);
        WallContact::of_offset(offset, distance_squared, radius)
    }

    #[inline(always)]
    fn is_near(&self, centre: Vector, radius: f64, margin: f64) -> bool {
        let reach = radius + margin;
        !(self.offset(centre).1 >= reach * reach)
    }
}
