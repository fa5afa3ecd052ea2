//! A floor with an opening: a plate without thickness, with an edge all around the opening.
//!
//! A sphere touches the point of the plate that is nearest to its centre. Over the plate this is
//! the point below it, in the opening a point of the edge. So the normal turns continuously as a
//! sphere rolls over the edge, and the force has no jump. A plane joined with a cylinder has a
//! jump: a sphere that comes into reach of the second wall may overlap it deeply at once.
//!
//! The contact laws treat the edge as flat, like all walls.

use super::{ContactSurface, WallContact};
use crate::particles::math::inverse_square_root;
use crate::particles::vector::Vector;

/// A floor with a round orifice about the z axis.
#[derive(Clone, Copy, Debug)]
pub struct Orifice {
    /// Height of the floor (m).
    pub height: f64,
    /// Radius of the orifice (m).
    pub radius: f64,
}

/// A floor with a slit along y, in the middle of the tank.
#[derive(Clone, Copy, Debug)]
pub struct Slit {
    /// Height of the floor (m).
    pub height: f64,
    /// Half of the width of the slit (m).
    pub half_width: f64,
}

/// Where a centre is with respect to the nearest point of a floor.
struct Offset {
    /// How far inside the opening the centre is from its edge (m); zero outside.
    inside: f64,
    /// How far above the floor it is (m).
    above: f64,
    /// Horizontal unit vector into the opening, across its edge.
    inward: Vector,
}

impl Orifice {
    #[inline(always)]
    fn offset(&self, centre: Vector) -> Offset {
        let distance_squared = centre.x * centre.x + centre.y * centre.y;
        let inverse_distance = inverse_square_root(distance_squared);
        Offset {
            inside: or_zero(self.radius - distance_squared * inverse_distance),
            above: centre.z - self.height,
            inward: Vector::new(-centre.x, -centre.y, 0.0) * inverse_distance,
        }
    }
}

impl Slit {
    #[inline(always)]
    fn offset(&self, centre: Vector) -> Offset {
        Offset {
            inside: or_zero(self.half_width - centre.x.abs()),
            above: centre.z - self.height,
            inward: Vector::new(-1.0_f64.copysign(centre.x), 0.0, 0.0),
        }
    }
}

impl Offset {
    #[inline(always)]
    fn distance_squared(&self) -> f64 {
        self.inside * self.inside + self.above * self.above
    }

    #[inline(always)]
    fn contact(&self, radius: f64) -> WallContact {
        let distance_squared = self.distance_squared();
        let inverse_distance = inverse_square_root(distance_squared);
        let upward = Vector::new(0.0, 0.0, self.above);
        WallContact {
            touches: !(distance_squared >= radius * radius),
            overlap: radius - distance_squared * inverse_distance,
            normal: (self.inward * self.inside + upward) * inverse_distance,
        }
    }

    #[inline(always)]
    fn is_near(&self, radius: f64, margin: f64) -> bool {
        let reach = radius + margin;
        !(self.distance_squared() >= reach * reach)
    }
}

#[inline(always)]
fn or_zero(value: f64) -> f64 {
    if value < 0.0 { 0.0 } else { value }
}

impl ContactSurface for Orifice {
    #[inline(always)]
    fn contact(&self, centre: Vector, radius: f64) -> WallContact {
        self.offset(centre).contact(radius)
    }

    #[inline(always)]
    fn is_near(&self, centre: Vector, radius: f64, margin: f64) -> bool {
        self.offset(centre).is_near(radius, margin)
    }
}

impl ContactSurface for Slit {
    #[inline(always)]
    fn contact(&self, centre: Vector, radius: f64) -> WallContact {
        self.offset(centre).contact(radius)
    }

    #[inline(always)]
    fn is_near(&self, centre: Vector, radius: f64, margin: f64) -> bool {
        self.offset(centre).is_near(radius, margin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ORIFICE: Orifice = Orifice {
        height: 0.1,
        radius: 4.0,
    };
    const SLIT: Slit = Slit {
        height: 0.1,
        half_width: 4.0,
    };

    /// Points of both floors.
    fn points() -> impl Iterator<Item = (Vector, bool)> {
        let steps = || (-160..=160).map(|k| 0.05 * f64::from(k));
        let grid = steps().flat_map(move |x| steps().map(move |y| (x, y)));
        grid.flat_map(|(x, y)| {
            let point = Vector::new(x, y, 0.1);
            let solid = [x * x + y * y >= 16.0, x.abs() >= 4.0];
            [(point, false), (point, true)]
                .into_iter()
                .zip(solid)
                .filter_map(|(it, solid)| solid.then_some(it))
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        /// The contact is with the nearest point of the floor, along the line to it.
        #[test]
        fn a_contact_is_with_the_nearest_point(
            x in -6.0..6.0_f64, y in -6.0..6.0_f64, z in -0.6..0.8_f64,
        ) {
            let centre = Vector::new(x, y, z);
            for is_slit in [false, true] {
                let contact = match is_slit {
                    true => SLIT.contact(centre, 0.5),
                    false => ORIFICE.contact(centre, 0.5),
                };
                let of_floor = points().filter(|(_, slit)| *slit == is_slit);
                let least = of_floor.map(|(it, _)| (it - centre).norm()).fold(9.0, f64::min);
                prop_assert!((0.5 - contact.overlap - least).abs() < 0.06, "{contact:?} {least}");
                prop_assert!(contact.touches == (contact.overlap > 0.0));
                if contact.touches {
                    prop_assert!((contact.normal.norm() - 1.0).abs() < 1e-9);
                    let foot = centre - contact.normal * (0.5 - contact.overlap);
                    let outside = match is_slit {
                        true => foot.x.abs(),
                        false => libm::hypot(foot.x, foot.y),
                    };
                    prop_assert!((foot.z - 0.1).abs() < 1e-9 && outside > 4.0 - 1e-9);
                }
            }
        }
    }

    /// Symptom: a sphere on the axis of an orifice rested on air. Cause: the direction to the edge
    /// is undefined there, and the distance to it came out as zero.
    #[test]
    fn in_the_middle_of_an_opening_nothing_is_near() {
        for z in [-0.3, 0.1, 0.2, 0.55] {
            let centre = Vector::new(0.0, 0.0, z);
            assert!(!ORIFICE.contact(centre, 0.5).touches && !SLIT.contact(centre, 0.5).touches);
            assert!(!ORIFICE.is_near(centre, 0.5, 3.4) && !SLIT.is_near(centre, 0.5, 3.4));
        }
    }
}
