//! The fall along gravity: from the highest start to what ends it.

use crate::particles::vector::Vector;
use crate::scene::{Driven, Gravity, Scene, Start, StartSphere};

/// Where nothing bounds the speeds of spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Open {
    /// They fall, and there is no floor.
    Down,
    /// They rise, and there is no lid.
    Up,
    /// They slide along x, and there is no wall.
    Aside,
    /// They fall, and pass through everything, as there is no contact law.
    Through,
    /// The swirl drives them outward, and there are no walls all around.
    Outward,
}

impl Open {
    /// Which spheres become faster without limit, and why.
    pub(crate) fn describe(self) -> &'static str {
        match self {
            Self::Down => "spheres fall with nothing below them, and no drag bounds their speed",
            Self::Up => "spheres rise with nothing above them, and no drag bounds their speed",
            Self::Aside => "spheres slide along x without a wall, and no drag bounds their speed",
            Self::Through => {
                "spheres fall through all walls without [contact], and no drag bounds their speed"
            }
            Self::Outward => "the swirl drives spheres outward without walls all around them",
        }
    }
}

/// The speeds (m/s) at the end of a free fall from rest.
pub(super) struct Fall {
    /// At the farthest wall along gravity, or at the lowest fixed or driven sphere. Where nothing
    /// ends the fall, at what stands across a part of its way.
    pub(super) impact: f64,
    /// There, or at the outlet.
    pub(super) motion: f64,
    /// Where nothing ends it, if so.
    pub(super) open: Option<Open>,
}

impl Fall {
    pub(super) fn of(scene: &Scene) -> Self {
        let gravity = scene.gravity_in_fluid();
        let Some(gravity) = gravity.filter(|it| it.acceleration != 0.0) else {
            return Self {
                impact: 0.0,
                motion: 0.0,
                open: None,
            };
        };
        let acceleration = gravity.acceleration.abs() / scene.inertial_factor();
        let speed = |height: f64| (2.0 * acceleration * height).sqrt();
        let way = Way::of(scene, &gravity);
        let highest = way.highest(scene);
        // A sphere that is not below every start cannot stop those that start beside or below it.
        let lowest_start = way.lowest(scene);
        let sphere = way.lowest_sphere(scene).filter(|it| *it < lowest_start);
        let end = match (sphere, way.end(way.floor)) {
            (Some(sphere), end) => Ok(end.map_or(sphere, |wall| wall.min(sphere))),
            (None, end) => end,
        };
        // Spheres at the outlet have passed all that could stop them.
        let to_outlet = scene.outlet_height().and_then(|outlet| {
            let lowest = way.floor.map_or(outlet, |floor| floor.min(outlet));
            let end = way.end(Some(lowest)).ok()?;
            Some(speed((highest - end).max(0.0)))
        });
        let impact = match (end, to_outlet) {
            (Ok(end), _) => speed((highest - end).max(scene.smallest_radius())),
            (Err(_), Some(to_outlet)) => to_outlet,
            (Err(_), None) => way.across(scene).map_or(0.0, speed),
        };
        let passes = scene.dem.contact.is_none().then_some(Open::Through);
        Self {
            impact,
            motion: to_outlet.map_or(impact, |speed| speed.max(impact)),
            open: match to_outlet {
                Some(_) => None,
                None => passes.or(end.err()),
            },
        }
    }
}

/// Components of the direction of gravity below this count as 0: a tilt by a right angle is given
/// to a few digits only.
const ROUNDED_TILT: f64 = 1e-5;

/// The way along which spheres fall. Heights on it are above the middle of the tank at z = 0.
struct Way {
    /// The direction from which gravity comes: its components along x and z.
    upward: [f64; 2],
    /// Distance of the walls across x from the axis (m).
    side: Option<f64>,
    /// Height of the floor (m).
    floor: Option<f64>,
}

impl Way {
    fn of(scene: &Scene, gravity: &Gravity) -> Self {
        let (sine, cosine) = libm::sincos(gravity.tilt);
        let tank = scene.tank.as_ref();
        Self {
            upward: [-sine, cosine].map(|part| match part {
                _ if part.abs() < ROUNDED_TILT => 0.0,
                // What is lighter than its fluid rises.
                _ if gravity.acceleration < 0.0 => -part,
                _ => part,
            }),
            side: tank.and_then(|tank| tank.reach()[0]),
            floor: tank.and_then(|tank| tank.floor),
        }
    }

    /// Height (m) of a place at x and z (m).
    fn height(&self, x: f64, z: f64) -> f64 {
        self.upward[0] * x + self.upward[1] * z
    }

    /// The largest height (m) of a place between -x and x, and between two heights z (m).
    fn top(&self, x: f64, z: [f64; 2]) -> f64 {
        let [along_x, along_z] = self.upward;
        along_x.abs() * x + (along_z * z[0]).max(along_z * z[1])
    }

    /// Height (m) of the corner of walls and a floor at which the fall ends.
    fn end(&self, floor: Option<f64>) -> Result<f64, Open> {
        let [along_x, along_z] = self.upward;
        let wall = match self.side {
            _ if along_x == 0.0 => 0.0,
            Some(side) => -along_x.abs() * side,
            None => return Err(Open::Aside),
        };
        let floor = match floor {
            _ if along_z == 0.0 => 0.0,
            _ if along_z < 0.0 => return Err(Open::Up),
            Some(floor) => along_z * floor,
            None => return Err(Open::Down),
        };
        Ok(wall + floor)
    }

    /// How far (m) spheres fall in the part of the way that a wall or the floor ends.
    fn across(&self, scene: &Scene) -> Option<f64> {
        let [along_x, along_z] = self.upward;
        let upward = [
            self.side.map_or(0.0, |_| along_x),
            self.floor.map_or(0.0, |_| along_z.max(0.0)),
        ];
        let part = Self { upward, ..*self };
        let end = part.end(part.floor).ok()?;
        let height = (part.highest(scene) - end).max(scene.smallest_radius());
        (upward != [0.0; 2]).then_some(height)
    }

    /// The largest height (m) of a centre at the start.
    fn highest(&self, scene: &Scene) -> f64 {
        let side = self.side.unwrap_or(0.0);
        match &scene.start {
            Start::Random { z_min, z_max, .. } => self.top(side, [*z_min, *z_max]),
            Start::List { .. } => {
                let free = scene.free_listed();
                let heights = free.map(|(_, it)| self.height(it.position[0], it.position[2]));
                heights.reduce(f64::max).unwrap_or(0.0)
            }
            Start::Feed {
                position, spread, ..
            } => {
                let [x, _, z] = *position;
                self.height(x, z) + self.upward[0].abs() * spread
            }
            Start::Packing {} => {
                let floor = self.floor.unwrap_or(0.0);
                self.top(side, [floor, floor + scene.packed_height()])
            }
            Start::File { .. } => 0.0,
        }
    }

    /// The least height (m) of a centre at the start.
    fn lowest(&self, scene: &Scene) -> f64 {
        let upward = self.upward.map(|part| -part);
        -Self { upward, ..*self }.highest(scene)
    }

    /// The least height (m) of what holds spheres: of listed walls, and of the centres of fixed
    /// spheres and of driven ones on their paths. Without an outlet, doors do not count, as they
    /// open. A driven sphere that moves on and on along gravity counts where it starts, as the fall
    /// is the same as seen from it; one that moves away sideways does not count.
    fn lowest_sphere(&self, scene: &Scene) -> Option<f64> {
        let has_door = scene.dem.door.is_none() || scene.outlet_height().is_some();
        let fixed = scene.dem.geometry.as_ref().map(|it| it.spheres());
        let fixed = fixed.iter().flat_map(|it| {
            let door = it.door.iter().filter(|_| has_door);
            it.walls.iter().chain(door)
        });
        let fixed = fixed.map(|it| self.height(it.position[0], it.position[2]));
        let listed: &[StartSphere] = match &scene.start {
            Start::List { spheres } => spheres,
            _ => &[],
        };
        let staying = scene.dem.driven.iter().filter(|path| self.stays(path));
        let driven = staying.filter_map(|path| {
            let [x, _, z] = listed.get(path.sphere)?.position;
            Some(self.height(x, z) + self.lowest_swing(path))
        });
        let walls = scene
            .dem
            .walls
            .iter()
            .filter(|wall| has_door || !wall.is_door);
        let upward = Vector::new(self.upward[0], 0.0, self.upward[1]);
        let walls = walls.filter_map(|wall| wall.lowest(upward));
        fixed.chain(driven).chain(walls).reduce(f64::min)
    }

    /// Whether a driven sphere moves along gravity alone, but for its swing.
    fn stays(&self, path: &Driven) -> bool {
        let [x, y, z] = path.velocity;
        let across = self.upward[1] * x - self.upward[0] * z;
        let fastest = x.abs().max(z.abs());
        y == 0.0 && across.abs() <= ROUNDED_TILT * fastest
    }

    /// The least height (m) of a path above its start.
    fn lowest_swing(&self, path: &Driven) -> f64 {
        let swing = self.height(path.amplitude[0], path.amplitude[2]);
        if path.angular_frequency == 0.0 {
            return 0.0;
        }
        -swing.abs() - swing * libm::sin(path.phase)
    }
}
