//! The walls of a scene as the engine sees them.

use super::{
    ContactSurface, Cylinder, Orifice, Parallelogram, Plane, Revolved, Slit, WallContact,
    WallSurface,
};
use crate::particles::Domain;
use crate::particles::vector::Vector;
use crate::scene::{Scene, SceneWall, Tank};
use std::fmt;

/// What messages call a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WallName {
    /// The floor of the tank.
    Floor,
    /// The floor of the tank, which has an opening.
    FloorAroundOpening,
    /// The cylinder of the tank.
    Cylinder,
    /// A side of the tank.
    Side,
    /// An entry of the list of walls, by its place from 0.
    Listed(usize),
}

impl fmt::Display for WallName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Floor => formatter.write_str("floor"),
            Self::FloorAroundOpening => formatter.write_str("floor around its opening"),
            Self::Cylinder | Self::Side => formatter.write_str("wall of the tank"),
            Self::Listed(place) => write!(formatter, "wall `wall[{place}]`"),
        }
    }
}

impl WallName {
    /// Whether it belongs to the tank.
    pub fn is_of_tank(self) -> bool {
        !matches!(self, Self::Listed(_))
    }
}

/// How a wall slides in itself, while its surface stays where it is.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceMotion {
    /// Velocity (m/s), the same everywhere.
    pub velocity: Vector,
    /// Angular velocity (rad/s), about an axis through `centre` (m).
    pub spin: Vector,
    /// A point of that axis (m).
    pub centre: Vector,
}

impl SurfaceMotion {
    /// The velocity (m/s) of the wall at a place. Across a normal, because the surface stays.
    #[inline(always)]
    fn at(&self, place: Vector, normal: Vector) -> Vector {
        let velocity = self.velocity + self.spin.cross(place - self.centre);
        velocity.perpendicular_to(normal)
    }

    /// The velocity (m/s) of the wall where a sphere of this radius (m) touches it.
    #[inline(always)]
    pub fn at_contact(&self, centre: Vector, radius: f64, contact: &WallContact) -> Vector {
        let place = centre - contact.normal * (radius - contact.overlap);
        self.at(place, contact.normal)
    }
}

/// A wall.
#[derive(Clone, Copy, Debug)]
pub struct Wall {
    /// What spheres touch.
    pub surface: WallSurface,
    /// What messages call it.
    pub name: WallName,
    /// Coefficient of friction, if it differs from the spheres' own.
    pub friction_coefficient: Option<f64>,
    /// The point about which its torque is measured (m): one of its axis, if it has one.
    pub centre: Vector,
    /// How it slides in itself. `None` at rest.
    pub motion: Option<SurfaceMotion>,
    /// Its middle along the periodic axes (m) along which it ends, in a space that it spans. It is
    /// the same everywhere along them, and spheres meet it there.
    pub middle: [Option<f64>; 3],
    /// How often its forces count: once; less often where walls join, each of which counts there.
    pub weight: f64,
    /// How often they count as soon as the door is open: never if the wall is the door.
    pub weight_when_open: f64,
}

impl Wall {
    /// A wall at rest, with the friction of the spheres.
    pub fn new(surface: WallSurface, name: WallName) -> Self {
        Self {
            surface,
            name,
            friction_coefficient: None,
            centre: Vector::ZERO,
            motion: None,
            middle: [None; 3],
            weight: 1.0,
            weight_when_open: 1.0,
        }
    }

    /// The walls of a scene at the start: of its tank, then those that it lists.
    pub fn of_scene(scene: &Scene) -> Vec<Self> {
        let is_closed = scene.dem.door.is_some();
        let tank = scene.tank.iter();
        let tank = tank.flat_map(|tank| Self::of_tank(tank, is_closed));
        let listed = scene.dem.walls.iter().enumerate();
        let listed = listed.filter_map(|(place, wall)| Self::listed(place, wall));
        let all = tank.chain(listed);
        all.map(|wall| wall.in_space(scene.domain())).collect()
    }

    /// The wall in a space of this kind, which it spans along its periodic axes.
    pub(crate) fn in_space(self, domain: Domain) -> Self {
        let points = match self.surface {
            WallSurface::Parallelogram(plate) => plate.corners().to_vec(),
            WallSurface::Segment(line) => line.ends().to_vec(),
            WallSurface::Revolved(surface) if surface.ends.iter().all(|end| end.is_finite()) => {
                let ends = surface.ends.map(|end| surface.profile_at(end));
                ends.map(|[_, along]| surface.base + surface.axis * along)
                    .to_vec()
            }
            _ => Vec::new(),
        };
        let mut middle = [None; 3];
        for (axis, _) in (0..3)
            .zip(domain.periods())
            .filter(|(_, period)| period.is_some())
        {
            let along = points.iter().map(|point| [point.x, point.y, point.z][axis]);
            let sum: f64 = along.sum();
            middle[axis] = (!points.is_empty()).then(|| sum / points.len() as f64);
        }
        Self { middle, ..self }
    }

    /// A wall of the list, at this place. `None` without a shape.
    fn listed(place: usize, wall: &SceneWall) -> Option<Self> {
        let PlacedWall {
            surface,
            centre,
            axis,
        } = PlacedWall::of(wall)?;
        let motion = SurfaceMotion {
            velocity: wall.velocity.unwrap_or_default().into(),
            spin: axis * wall.angular_velocity.unwrap_or(0.0),
            centre,
        };
        Some(Self {
            friction_coefficient: wall.friction_coefficient,
            centre,
            motion: wall.moves().then_some(motion),
            weight_when_open: if wall.is_door { 0.0 } else { 1.0 },
            ..Self::new(surface, WallName::Listed(place))
        })
    }

    /// The walls of a tank, in the order in which they act: the floor first. An opening in it is
    /// closed or open.
    pub fn of_tank(tank: &Tank, is_closed: bool) -> Vec<Self> {
        let open = || Self::floor_with_opening(tank).filter(|_| !is_closed);
        let whole = |height| Self::new(WallSurface::Plane(Plane::floor(height)), WallName::Floor);
        let floor = open().or(tank.floor.map(whole));
        let around = match tank.radius {
            Some(radius) => {
                let surface = WallSurface::Cylinder(Cylinder { radius });
                vec![Self::new(surface, WallName::Cylinder)]
            }
            None => Self::sides_of(tank).collect(),
        };
        let walls = floor.into_iter().chain(around);
        walls.map(|wall| wall.with_friction_of(tank)).collect()
    }

    fn sides_of(tank: &Tank) -> impl Iterator<Item = Self> {
        let axes = [Vector::new(1.0, 0.0, 0.0), Vector::new(0.0, 1.0, 0.0)];
        let sides = axes.into_iter().zip(tank.reach());
        let sides = sides.filter_map(|(axis, reach)| Some(Plane::sides(axis, reach?)));
        let side = |plane| Self::new(WallSurface::Plane(plane), WallName::Side);
        sides.flatten().map(side)
    }

    /// The floor of a tank that has an opening in it.
    pub fn floor_with_opening(tank: &Tank) -> Option<Self> {
        let height = tank.floor?;
        let orifice = |radius| WallSurface::Orifice(Orifice { height, radius });
        let slit = |width| {
            let half_width = 0.5 * width;
            WallSurface::Slit(Slit { height, half_width })
        };
        let surface = (tank.orifice_radius.map(orifice)).or(tank.slit_width.map(slit))?;
        Some(Self::new(surface, WallName::FloorAroundOpening).with_friction_of(tank))
    }

    fn with_friction_of(self, tank: &Tank) -> Self {
        Self {
            friction_coefficient: tank.friction_coefficient,
            ..self
        }
    }

    /// The contact of a sphere at this position.
    #[inline(always)]
    pub fn contact(&self, centre: Vector, radius: f64) -> WallContact {
        self.surface.contact(self.level(centre), radius)
    }

    /// Whether a sphere at this position touches it, or may after a displacement of `margin` (m).
    #[inline(always)]
    pub fn is_near(&self, centre: Vector, radius: f64, margin: f64) -> bool {
        self.surface.is_near(self.level(centre), radius, margin)
    }

    /// A centre, moved to the wall's [middle](Self::middle).
    #[inline(always)]
    fn level(&self, centre: Vector) -> Vector {
        let [x, y, z] = self.middle;
        Vector::new(
            x.unwrap_or(centre.x),
            y.unwrap_or(centre.y),
            z.unwrap_or(centre.z),
        )
    }

    /// Its velocity (m/s) where a sphere of this radius (m) touches it.
    #[inline(always)]
    pub fn velocity(&self, centre: Vector, radius: f64, contact: &WallContact) -> Vector {
        let at = |motion: &SurfaceMotion| motion.at_contact(centre, radius, contact);
        self.motion.as_ref().map_or(Vector::ZERO, at)
    }

    /// Its angular velocity (rad/s).
    pub fn spin(&self) -> Vector {
        self.motion.map_or(Vector::ZERO, |motion| motion.spin)
    }
}

/// A surface of the list, with the axis about which it may turn.
struct PlacedWall {
    surface: WallSurface,
    /// A point of the axis (m).
    centre: Vector,
    /// Unit vector.
    axis: Vector,
}

impl PlacedWall {
    fn of(wall: &SceneWall) -> Option<Self> {
        let plane = wall.plane.as_ref().map(|it| {
            let centre = it.point.into();
            let axis = it.unit_normal();
            let plane = Plane {
                normal: axis,
                place: axis.dot(centre),
            };
            (WallSurface::Plane(plane), centre, axis)
        });
        let plate = wall.plate.as_ref().map(|it| {
            let plate = Parallelogram::new(it.corner.into(), it.edges());
            (
                WallSurface::Parallelogram(plate),
                plate.corner,
                plate.normal(),
            )
        });
        let ended = wall.ends().map(|(base, axis, [from, to])| {
            let surface = Revolved::between(base, axis, from, to);
            (WallSurface::Revolved(surface), base, axis)
        });
        let endless = wall.cylinder.as_ref().map(|it| {
            let (base, axis) = (it.base.into(), Vector::from(it.axis).unit());
            let surface = Revolved::endless(base, axis, it.radius);
            (WallSurface::Revolved(surface), base, axis)
        });
        let found = plane.or(plate).or(ended).or(endless);
        found.map(|(surface, centre, axis)| Self {
            surface,
            centre,
            axis,
        })
    }
}
