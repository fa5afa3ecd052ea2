//! The surfaces that a wall may have.

use super::{Cylinder, Orifice, Parallelogram, Plane, Revolved, Segment, Slit};
use crate::particles::math::inverse_square_root;
use crate::particles::vector::Vector;

/// Where a sphere is with respect to a wall.
#[derive(Clone, Copy, Debug)]
pub struct WallContact {
    /// Whether it touches. If not, the rest is finite but meaningless.
    pub touches: bool,
    /// Overlap (m, positive).
    pub overlap: f64,
    /// Unit normal, from the wall to the sphere.
    pub normal: Vector,
}

impl WallContact {
    /// The contact of a sphere of this radius (m) with a point, from which `offset` (m) leads to
    /// its centre. A centre at the point counts as touching, without a direction.
    #[inline(always)]
    pub(super) fn with_point(offset: Vector, radius: f64) -> Self {
        Self::of_offset(offset, offset.norm_squared(), radius)
    }

    /// The same with the square of the distance (m2).
    #[inline(always)]
    pub(super) fn of_offset(offset: Vector, distance_squared: f64, radius: f64) -> Self {
        let inverse_distance = inverse_square_root(distance_squared);
        Self {
            touches: !(distance_squared >= radius * radius),
            overlap: radius - distance_squared * inverse_distance,
            normal: offset * inverse_distance,
        }
    }
}

/// A surface that spheres touch.
pub trait ContactSurface: Copy + Send + 'static {
    /// The contact of a sphere at this position. It has no branches, because loops over blocks of
    /// spheres call it.
    fn contact(&self, centre: Vector, radius: f64) -> WallContact;

    /// Whether a sphere at this position touches the surface, or may after a displacement of
    /// `margin` (m).
    fn is_near(&self, centre: Vector, radius: f64, margin: f64) -> bool;

    /// The point of the surface that is nearest to a place.
    fn foot(&self, place: Vector) -> Vector {
        let contact = self.contact(place, 0.0);
        place + contact.normal * contact.overlap
    }
}

/// A surface of any kind. Loops over contacts are compiled for each kind of a tank's surfaces; all
/// other code uses this type.
#[derive(Clone, Copy, Debug)]
pub enum WallSurface {
    /// A half space.
    Plane(Plane),
    /// The inside of an endless cylinder about the z axis.
    Cylinder(Cylinder),
    /// A floor with a round orifice.
    Orifice(Orifice),
    /// A floor with a slit.
    Slit(Slit),
    /// A plate with four edges.
    Parallelogram(Parallelogram),
    /// A line that turned about an axis: a disc, a tube, a cone, or a circle where such walls join.
    Revolved(Revolved),
    /// A line where walls join, or a point of it.
    Segment(Segment),
}

/// Calls a method of the surface, of whatever kind.
macro_rules! of_surface {
    ($surface:expr, $wall:ident => $call:expr) => {
        match $surface {
            WallSurface::Plane($wall) => $call,
            WallSurface::Cylinder($wall) => $call,
            WallSurface::Orifice($wall) => $call,
            WallSurface::Slit($wall) => $call,
            WallSurface::Parallelogram($wall) => $call,
            WallSurface::Revolved($wall) => $call,
            WallSurface::Segment($wall) => $call,
        }
    };
}

impl ContactSurface for WallSurface {
    #[inline(always)]
    fn contact(&self, centre: Vector, radius: f64) -> WallContact {
        of_surface!(self, surface => surface.contact(centre, radius))
    }

    #[inline(always)]
    fn is_near(&self, centre: Vector, radius: f64, margin: f64) -> bool {
        of_surface!(self, surface => surface.is_near(centre, radius, margin))
    }
}
