//! The walls of a tank.

use crate::document::quantities::{length, place};
use crate::document::quantity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The tank's walls: a cylinder, or plane sides. They have the material of the spheres, but may
/// have another coefficient of friction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tank {
    /// Radius R of the cylindrical wall (m). Absent: no cylinder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("R", "radius of the tank"))]
    pub radius: Option<f64>,
    /// Distance of two plane walls across x (m), at x = -width/2 and width/2; excludes `radius`.
    /// Absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("W", "width of the tank"))]
    pub width: Option<f64>,
    /// Distance of two plane walls across y (m), at y = -depth/2 and depth/2; excludes `radius`.
    /// Absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("W_y", "depth of the tank"))]
    pub depth: Option<f64>,
    /// Height of the floor (m). Absent: no floor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = place("z_{floor}", "height of the floor"))]
    pub floor: Option<f64>,
    /// Radius of a round orifice in the floor, about the axis (m), through which spheres leave.
    /// Absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("R_o", "radius of the orifice"))]
    pub orifice_radius: Option<f64>,
    /// Width of a slit in the floor along x (m), about the axis and across the whole depth, through
    /// which spheres leave; excludes `orifice_radius`. Absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("W_o", "width of the slit"))]
    pub slit_width: Option<f64>,
    /// Coefficient of friction between spheres and these walls. Default: as in `friction`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(
        transform = quantity("μ_w", "", "coefficient of friction at walls").at_least(0.0)
    )]
    pub friction_coefficient: Option<f64>,
}

impl Tank {
    /// Distance of its walls from the axis along x and along y (m): the radius, or half of width
    /// and depth. `None` if there is no wall.
    pub fn reach(&self) -> [Option<f64>; 2] {
        [self.width, self.depth].map(|side| self.radius.or(side.map(|side| 0.5 * side)))
    }

    /// What its walls are called in columns, in the order in which they act.
    pub(crate) fn wall_names(&self) -> impl Iterator<Item = &'static str> {
        let sides = [
            (self.width, ["left", "right"]),
            (self.depth, ["front", "back"]),
        ];
        let sides = sides.into_iter().filter(|_| self.radius.is_none());
        let sides = sides.filter_map(|(reach, names)| reach.map(|_| names));
        let floor = self.floor.map(|_| "floor").into_iter();
        floor
            .chain(self.radius.map(|_| "cylinder"))
            .chain(sides.flatten())
    }

    /// Half of the width of the opening in its floor along x (m), and its key, if there is one.
    pub fn opening(&self) -> Option<(&'static str, f64)> {
        let round = self.orifice_radius.map(|it| ("tank.orifice_radius", it));
        let slit = self.slit_width.map(|it| ("tank.slit_width", 0.5 * it));
        round.or(slit)
    }

    /// Whether its floor has an opening.
    pub fn has_opening(&self) -> bool {
        self.floor.is_some() && self.opening().is_some()
    }

    /// How far inside the opening of its floor a place is (m); negative outside, and without an
    /// opening.
    pub fn inside_opening(&self, x: f64, y: f64) -> f64 {
        let orifice = self.orifice_radius.map(|it| it - libm::hypot(x, y));
        let slit = self.slit_width.map(|it| 0.5 * it - x.abs());
        orifice.or(slit).unwrap_or(f64::NEG_INFINITY)
    }

    /// How a centre (m) is outside the tank, if it is: `outside the tank's wall`, or below its
    /// floor. Spheres below an open floor may be on their way out, at an angle of up to 45 degrees.
    pub(crate) fn outside(&self, [x, y, z]: [f64; 3], is_closed: bool) -> Option<&'static str> {
        let beyond = |place: f64, reach: Option<f64>| reach.is_some_and(|it| place.abs() >= it);
        let wall = match (self.radius, self.reach()) {
            (Some(radius), _) => x * x + y * y >= radius * radius,
            (None, [width, depth]) => beyond(x, width) || beyond(y, depth),
        };
        let may_be_leaving = |depth: f64| !is_closed && self.inside_opening(x, y) > -depth;
        let below = |floor: f64| z <= floor && !may_be_leaving(floor - z);
        match self.floor {
            _ if wall => Some("outside the tank's wall"),
            Some(floor) if below(floor) => Some("below the tank's floor"),
            _ => None,
        }
    }

    /// Whether it has plane sides.
    pub fn has_sides(&self) -> bool {
        self.width.is_some() || self.depth.is_some()
    }

    /// Area enclosed by its walls (m2), if they are closed.
    pub fn area(&self) -> Option<f64> {
        let round = self.radius.map(|radius| PI * radius * radius);
        let sides = self.width.zip(self.depth);
        round.or(sides.map(|(width, depth)| width * depth))
    }
}
