//! A silo: fixed spheres as walls and door, grains that are fed in, and when the door opens.

use crate::document::quantities::{length, place};
use crate::document::{quantity, unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Fixed spheres that stand for the walls of a silo and for its door.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Geometry {
    /// From a file (Remmers, 2009): the numbers of wall and door spheres in its first line, then x,
    /// height and radius of each sphere, the walls first.
    File {
        /// Path of the file, relative to the scene file.
        path: PathBuf,
        /// Unit of all lengths in the file.
        unit: LengthUnit,
    },
    /// Two straight walls, two slopes below them, and a door across the opening between these.
    Hopper(Hopper),
    /// A list of all fixed spheres; files are converted to this form.
    List {
        /// Spheres that never move.
        walls: Vec<FixedSphere>,
        /// Spheres that vanish when the door opens.
        #[serde(default)]
        door: Vec<FixedSphere>,
    },
}

/// Two straight walls, two slopes below them, and a door across the opening between these; all in
/// the plane y = 0, and symmetric about x = 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hopper {
    /// Distance of the walls' centres from the middle (m).
    #[schemars(transform = length("W / 2", "half the width of the silo"))]
    pub half_width: f64,
    /// Height of the top of the walls (m).
    #[schemars(transform = place("z_{top}", "top of the walls"))]
    pub top: f64,
    /// Height of the foot of the walls, where the slopes begin (m).
    #[schemars(transform = place("z_{foot}", "foot of the walls"))]
    pub foot: f64,
    /// Angle of the slopes against the horizontal (rad).
    #[schemars(transform = quantity("φ", "rad", "angle of the slopes").at_least(0.0).at_most(1.5))]
    pub slope: f64,
    /// Clear width of the opening, between the surfaces of its edges (m).
    #[schemars(transform = length("D", "clear width of the opening"))]
    pub opening: f64,
    /// Distance between neighbouring fixed spheres at most (m).
    #[schemars(transform = length("Δ_{wall}", "distance between fixed spheres"))]
    pub spacing: f64,
    /// Radius of the fixed spheres (m).
    #[schemars(transform = length("r_{wall}", "radius of the fixed spheres"))]
    pub radius: f64,
}

/// A sphere that never moves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FixedSphere {
    /// Centre (m).
    #[schemars(transform = unit("m"))]
    pub position: [f64; 3],
    /// Radius (m).
    #[schemars(transform = length("", ""))]
    pub radius: f64,
}

/// Unit of the lengths in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum LengthUnit {
    /// Metres.
    #[serde(rename = "m")]
    Metre,
    /// Centimetres.
    #[serde(rename = "cm")]
    Centimetre,
    /// Millimetres.
    #[serde(rename = "mm")]
    Millimetre,
}

impl LengthUnit {
    /// Number of these units in a metre. A whole number, so that a division by it rounds once.
    pub fn per_metre(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 100.0,
            Self::Millimetre => 1000.0,
        }
    }
}

/// The walls and the door of a silo.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FixedSpheres {
    /// Spheres that never move.
    pub walls: Vec<FixedSphere>,
    /// Spheres that vanish when the door opens.
    pub door: Vec<FixedSphere>,
}

/// Largest number of fixed spheres of a hopper.
pub(crate) const MOST_HOPPER_SPHERES: f64 = 10_000.0;

impl Geometry {
    /// All fixed spheres; empty for a file that has not been read.
    pub fn spheres(&self) -> FixedSpheres {
        match self {
            Self::File { .. } => FixedSpheres::default(),
            Self::Hopper(hopper) => hopper.spheres(),
            Self::List { walls, door } => FixedSpheres {
                walls: walls.clone(),
                door: door.clone(),
            },
        }
    }
}

impl Hopper {
    /// Distance of the edges' centres from the middle (m).
    fn edge(&self) -> f64 {
        0.5 * self.opening + self.radius
    }

    /// Height of the edges of the opening (m).
    pub fn outlet(&self) -> f64 {
        self.foot - (self.half_width - self.edge()) * libm::tan(self.slope)
    }

    /// Number of fixed spheres on the lines of the hopper.
    pub(crate) fn count(&self) -> f64 {
        let [top, foot, edge, other_edge] = self.corners();
        let steps = |from, to| self.steps(from, to) + 1.0;
        2.0 * (steps(top, foot) + steps(foot, edge)) + steps(edge, other_edge)
    }

    /// The ends (x, z) of the lines on the right: top and foot of the wall, edge of the slope; and
    /// the edge on the left.
    fn corners(&self) -> [[f64; 2]; 4] {
        let (edge, outlet) = (self.edge(), self.outlet());
        let top = [self.half_width, self.top];
        let foot = [self.half_width, self.foot];
        [top, foot, [edge, outlet], [-edge, outlet]]
    }

    /// The fixed spheres. Empty if there would be too many, which the check of a scene refuses.
    fn spheres(&self) -> FixedSpheres {
        if !(self.count() <= MOST_HOPPER_SPHERES) {
            return FixedSpheres::default();
        }
        let (edge, outlet) = (self.edge(), self.outlet());
        let mut walls = Vec::new();
        for side in [-1.0, 1.0] {
            let foot = [side * self.half_width, self.foot];
            let top = [side * self.half_width, self.top];
            self.line(top, foot, &mut walls);
            let corner = walls.len();
            self.line(foot, [side * edge, outlet], &mut walls);
            // The foot belongs to both lines.
            walls.remove(corner);
        }
        let mut door = Vec::new();
        self.line([-edge, outlet], [edge, outlet], &mut door);
        // Its ends are the edges of the slopes.
        let door = door[1..door.len() - 1].to_vec();
        FixedSpheres { walls, door }
    }

    /// Spheres from one point (x, z) to another, both included, as few as the spacing allows.
    fn line(&self, from: [f64; 2], to: [f64; 2], spheres: &mut Vec<FixedSphere>) {
        let steps = self.steps(from, to) as usize;
        for step in 0..=steps {
            let share = step as f64 / steps as f64;
            let between = |axis: usize| (1.0 - share) * from[axis] + share * to[axis];
            spheres.push(FixedSphere {
                position: [between(0), 0.0, between(1)],
                radius: self.radius,
            });
        }
    }
}

impl Hopper {
    /// Number of spacings between two points (x, z).
    fn steps(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let length = libm::hypot(to[0] - from[0], to[1] - from[1]);
        // A spacing that divides the length counts as whole despite rounding.
        libm::ceil(length / self.spacing - 1e-9).max(1.0)
    }
}

/// When the grains count as at rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rest {
    /// Kinetic energy of all grains together (J), translation and rotation, below which they may be
    /// at rest. In addition, no single grain may have more than a hundredth of it or, with fewer
    /// than a hundred grains, more than its equal share. Driven spheres do not count.
    #[schemars(
        transform = quantity("E_{rest}", "J", "kinetic energy of spheres at rest").above(0.0)
    )]
    pub kinetic_energy: f64,
    /// Time for which they must stay below this energy (s). A grain at the top of its bounce is
    /// slow for an instant only: g times this time should be far above the speed of a grain with
    /// its share of the energy.
    #[serde(default = "default_hold")]
    #[schemars(
        transform = quantity("t_{rest}", "s", "time for which spheres must be slow").above(0.0)
    )]
    pub hold: f64,
}

fn default_hold() -> f64 {
    0.5
}

/// The door of a silo.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Door {
    /// Time at which it opens (s). Absent: as soon as all grains are in and at rest, which needs
    /// `rest`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = quantity("t_{door}", "s", "time at which the door opens").at_least(0.0))]
    pub opens: Option<f64>,
}

/// Where grains leave the simulation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Outlet {
    /// Height below which a grain's centre is out of the simulation (m).
    #[schemars(transform = quantity("z_{out}", "m", "height below which spheres are out"))]
    pub height: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hopper(opening: f64) -> Hopper {
        Hopper {
            half_width: 1.3,
            top: 4.0,
            foot: 1.0,
            slope: libm::atan(0.75),
            opening,
            spacing: 0.05,
            radius: 0.03,
        }
    }

    #[test]
    fn the_opening_is_as_wide_as_asked_for() {
        for opening in [0.1, 0.22, 0.5, 1.0] {
            let FixedSpheres { walls, .. } = hopper(opening).spheres();
            let lowest = walls.iter().map(|it| it.position[2]).fold(9.0, f64::min);
            let edges: Vec<_> = walls
                .iter()
                .filter(|it| it.position[2] < lowest + 1e-9)
                .collect();
            assert_eq!(edges.len(), 2);
            let clear = edges[1].position[0] - edges[0].position[0] - 2.0 * 0.03;
            assert!((clear - opening).abs() < 1e-12, "{clear} for {opening}");
        }
    }

    #[test]
    fn neighbours_are_no_farther_apart_than_the_spacing() {
        let FixedSpheres { walls, door } = hopper(0.3).spheres();
        let all: Vec<_> = walls.iter().chain(&door).collect();
        for (index, one) in all.iter().enumerate() {
            let near = all.iter().enumerate().filter(|(other, it)| {
                let [dx, _, dz] = std::array::from_fn(|k| it.position[k] - one.position[k]);
                *other != index && libm::hypot(dx, dz) < 0.05 + 1e-9
            });
            // The two tops have one neighbour each.
            assert!(near.count() >= if one.position[2] > 3.99 { 1 } else { 2 });
        }
        assert_eq!(walls.len() % 2, 0);
    }
}
