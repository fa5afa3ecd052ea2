//! Walls: one file each. A wall says where a sphere touches it; the contact laws do the rest.

mod cylinder;
mod opening;
mod plane;

pub use cylinder::Cylinder;
pub use opening::{Orifice, Slit};
pub use plane::Plane;

use super::profile::StepPart;
use crate::particles::vector::Vector;
use crate::scene::Tank;

/// Where a sphere is with respect to a wall.
#[derive(Clone, Copy, Debug)]
pub struct WallContact {
    /// Whether it touches. If not, the rest is finite but meaningless.
    pub touches: bool,
    /// Overlap (m, positive).
    pub overlap: f64,
    /// Unit normal into the tank.
    pub normal: Vector,
}

/// A wall at rest.
pub trait Wall: Copy + Send + 'static {
    /// The contact of a sphere at this position. It has no branches, because loops over blocks of
    /// spheres call it.
    fn contact(&self, centre: Vector, radius: f64) -> WallContact;

    /// Whether a sphere at this position touches the wall, or may after a displacement of `margin`
    /// (m).
    fn is_near(&self, centre: Vector, radius: f64, margin: f64) -> bool;
}

/// A wall of a tank, of any kind. Loops over contacts are compiled for each kind; all other code
/// uses this type.
#[derive(Clone, Copy, Debug)]
pub enum TankWall {
    /// The floor, without an opening or with a closed one.
    Floor(Plane),
    /// A floor with a round orifice.
    Orifice(Orifice),
    /// A floor with a slit.
    Slit(Slit),
    /// The cylindrical wall.
    Cylinder(Cylinder),
    /// One of up to four sides.
    Side(Plane),
}

impl TankWall {
    /// The largest number of walls of a tank: a floor and four sides.
    pub const MOST: usize = 5;

    /// The walls of a tank, in the order in which they act: the floor first. An opening in it is
    /// closed or open.
    pub fn of_tank(tank: &Tank, is_closed: bool) -> Vec<Self> {
        let open = || Self::floor_with_opening(tank).filter(|_| !is_closed);
        let whole = |height| Self::Floor(Plane::floor(height));
        let floor = open().or(tank.floor.map(whole));
        if let Some(radius) = tank.radius {
            let cylinder = Self::Cylinder(Cylinder { radius });
            return floor.into_iter().chain([cylinder]).collect();
        }
        let axes = [Vector::new(1.0, 0.0, 0.0), Vector::new(0.0, 1.0, 0.0)];
        let sides = axes
            .into_iter()
            .zip(tank.reach())
            .filter_map(|(axis, reach)| Some(Plane::sides(axis, reach?).map(Self::Side)));
        floor.into_iter().chain(sides.flatten()).collect()
    }

    /// The floor of a tank that has an opening in it.
    pub fn floor_with_opening(tank: &Tank) -> Option<Self> {
        let height = tank.floor?;
        let orifice = |radius| Self::Orifice(Orifice { height, radius });
        let slit = |width| {
            let half_width = 0.5 * width;
            Self::Slit(Slit { height, half_width })
        };
        (tank.orifice_radius.map(orifice)).or(tank.slit_width.map(slit))
    }

    /// Its name in messages.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Floor(_) => "floor",
            Self::Orifice(_) | Self::Slit(_) => "floor around its opening",
            Self::Cylinder(_) | Self::Side(_) => "wall of the tank",
        }
    }

    /// The part of a step to which its forces belong.
    pub fn part(&self) -> StepPart {
        match self {
            Self::Floor(_) | Self::Orifice(_) | Self::Slit(_) => StepPart::Floor,
            Self::Cylinder(_) => StepPart::Cylinder,
            Self::Side(_) => StepPart::Sides,
        }
    }
}

impl Wall for TankWall {
    #[inline(always)]
    fn contact(&self, centre: Vector, radius: f64) -> WallContact {
        match self {
            Self::Floor(wall) | Self::Side(wall) => wall.contact(centre, radius),
            Self::Cylinder(wall) => wall.contact(centre, radius),
            Self::Orifice(wall) => wall.contact(centre, radius),
            Self::Slit(wall) => wall.contact(centre, radius),
        }
    }

    #[inline(always)]
    fn is_near(&self, centre: Vector, radius: f64, margin: f64) -> bool {
        match self {
            Self::Floor(wall) | Self::Side(wall) => wall.is_near(centre, radius, margin),
            Self::Cylinder(wall) => wall.is_near(centre, radius, margin),
            Self::Orifice(wall) => wall.is_near(centre, radius, margin),
            Self::Slit(wall) => wall.is_near(centre, radius, margin),
        }
    }
}
