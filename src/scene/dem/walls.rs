//! Walls that a scene lists one by one.

use crate::document::quantities::{length, place};
use crate::document::{quantity, unit};
use crate::particles::vector::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A wall: one of the shapes below, without thickness. Spheres touch it from both sides, and at its
/// edges and rims; a plane from the side of its normal only. Where walls join, a sphere is held
/// once. It has the material of the spheres.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneWall {
    /// Its name in the columns of `output.walls`. Default: `wall_` and its place in the list, from
    /// 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// An endless plane.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plane: Option<PlaneWall>,
    /// A plate with four edges: a rectangle, or a parallelogram.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plate: Option<PlateWall>,
    /// A disc, or a ring.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disc: Option<DiscWall>,
    /// A tube, open at both ends. Discs can close it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cylinder: Option<CylinderWall>,
    /// A cone, or a frustum, open at both ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cone: Option<ConeWall>,
    /// Coefficient of friction between spheres and this wall. Default: as in `friction`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(
        transform = quantity("μ_w", "", "coefficient of friction at walls").at_least(0.0)
    )]
    pub friction_coefficient: Option<f64>,
    /// Velocity (m/s) with which a plane, a plate or a disc slides in its plane, and a cylinder
    /// along its axis. Its place does not change, as for a belt. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = unit("m/s"))]
    pub velocity: Option<[f64; 3]>,
    /// Angular velocity (rad/s) with which a disc, a cylinder or a cone turns about its axis, and a
    /// plane about its normal through `point`; counter-clockwise seen from where the axis leads.
    /// Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = quantity("ω_w", "rad/s", "angular velocity of a wall"))]
    pub angular_velocity: Option<f64>,
    /// Whether it goes away when `door` opens.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_door: bool,
}

/// An endless plane, with the spheres on the side of its normal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaneWall {
    /// A point of it (m).
    #[schemars(transform = unit("m"))]
    pub point: [f64; 3],
    /// Its normal, of any length, towards the spheres.
    #[schemars(transform = unit(""))]
    pub normal: [f64; 3],
    /// Angle (rad) by which it is turned about `tilt_axis` through `point`.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(transform = quantity("θ_w", "rad", "tilt of a wall"))]
    pub tilt: f64,
    /// The axis of `tilt`, of any length.
    #[serde(default = "along_y", skip_serializing_if = "is_along_y")]
    #[schemars(transform = unit(""))]
    pub tilt_axis: [f64; 3],
}

/// A plate between two edges that meet at a corner, and two edges parallel to them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlateWall {
    /// A corner (m).
    #[schemars(transform = unit("m"))]
    pub corner: [f64; 3],
    /// From there to the end of one edge (m).
    #[schemars(transform = unit("m"))]
    pub first_edge: [f64; 3],
    /// From there to the end of the other edge (m).
    #[schemars(transform = unit("m"))]
    pub second_edge: [f64; 3],
    /// Angle (rad) by which it is turned about `tilt_axis` through `corner`.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(transform = quantity("θ_w", "rad", "tilt of a wall"))]
    pub tilt: f64,
    /// The axis of `tilt`, of any length.
    #[serde(default = "along_y", skip_serializing_if = "is_along_y")]
    #[schemars(transform = unit(""))]
    pub tilt_axis: [f64; 3],
}

/// A disc, or a ring if it has a hole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DiscWall {
    /// Its centre (m).
    #[schemars(transform = unit("m"))]
    pub centre: [f64; 3],
    /// Its axis, of any length.
    #[serde(default = "along_z")]
    #[schemars(transform = unit(""))]
    pub axis: [f64; 3],
    /// Its radius (m).
    #[schemars(transform = length("R_w", "radius of a wall"))]
    pub radius: f64,
    /// Radius (m) of its hole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("R_h", "radius of the hole in a wall"))]
    pub hole_radius: Option<f64>,
}

/// A tube.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CylinderWall {
    /// Centre (m) of the end where it begins.
    #[serde(default)]
    #[schemars(transform = unit("m"))]
    pub base: [f64; 3],
    /// Its axis, of any length, from there to the other end.
    #[serde(default = "along_z")]
    #[schemars(transform = unit(""))]
    pub axis: [f64; 3],
    /// Its radius (m).
    #[schemars(transform = length("R_w", "radius of a wall"))]
    pub radius: f64,
    /// Its length (m). Default: endless in both directions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("L_w", "length of a wall"))]
    pub length: Option<f64>,
}

/// A cone, or a frustum if both radii are above 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConeWall {
    /// Centre (m) of the end where it begins.
    #[serde(default)]
    #[schemars(transform = unit("m"))]
    pub base: [f64; 3],
    /// Its axis, of any length, from there to the other end.
    #[serde(default = "along_z")]
    #[schemars(transform = unit(""))]
    pub axis: [f64; 3],
    /// Its radius (m) where it begins.
    #[schemars(transform = place("R_w", "radius of a wall").at_least(0.0))]
    pub radius: f64,
    /// Its radius (m) at the other end.
    #[schemars(transform = place("R_e", "radius of a wall at its end").at_least(0.0))]
    pub end_radius: f64,
    /// Its length (m) along the axis; excludes `angle`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("L_w", "length of a wall"))]
    pub length: Option<f64>,
    /// The angle (rad) between it and its axis, from which its length follows; excludes `length`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(
        transform = quantity("α_w", "rad", "angle between a cone and its axis")
            .above(0.0)
            .at_most(std::f64::consts::FRAC_PI_2)
    )]
    pub angle: Option<f64>,
}

impl PlaneWall {
    /// Its unit normal, tilted.
    pub(crate) fn unit_normal(&self) -> Vector {
        let normal = Vector::from(self.normal).unit();
        normal.turned_about(self.tilt_axis.into(), self.tilt)
    }
}

impl PlateWall {
    /// Its edges (m), tilted.
    pub(crate) fn edges(&self) -> [Vector; 2] {
        [self.first_edge, self.second_edge]
            .map(|edge| Vector::from(edge).turned_about(self.tilt_axis.into(), self.tilt))
    }
}

impl ConeWall {
    /// Its length (m), if it has one.
    pub(crate) fn height(&self) -> Option<f64> {
        let of_angle = |angle: f64| (self.radius - self.end_radius).abs() / libm::tan(angle);
        self.length.or(self.angle.map(of_angle))
    }
}

impl SceneWall {
    /// The keys of its shapes.
    pub(crate) fn shapes(&self) -> impl Iterator<Item = &'static str> {
        let shapes = [
            ("plane", self.plane.is_some()),
            ("plate", self.plate.is_some()),
            ("disc", self.disc.is_some()),
            ("cylinder", self.cylinder.is_some()),
            ("cone", self.cone.is_some()),
        ];
        shapes
            .into_iter()
            .filter_map(|(key, is_there)| is_there.then_some(key))
    }

    /// What its torque is about, in words.
    pub(crate) fn torque_centre(&self) -> &'static str {
        match self.shapes().next() {
            Some("plane") => "its `point`",
            Some("plate") => "its `corner`",
            Some("disc") => "its `centre`",
            _ => "its `base`",
        }
    }

    /// The same wall without its name, which does not change the motion.
    pub(crate) fn without_name(&self) -> Self {
        Self {
            name: None,
            ..self.clone()
        }
    }

    /// The same wall without friction of its own, at rest.
    pub(crate) fn without_friction(&self) -> Self {
        Self {
            friction_coefficient: None,
            velocity: None,
            angular_velocity: None,
            ..self.clone()
        }
    }

    /// Whether it slides in itself.
    pub(crate) fn moves(&self) -> bool {
        self.velocity.is_some_and(|it| it != [0.0; 3])
            || self.angular_velocity.is_some_and(|it| it != 0.0)
    }

    /// Its fastest speed (m/s) within this distance (m) of the axis of a plane.
    pub(crate) fn fastest(&self, reach: f64) -> f64 {
        let speed = Vector::from(self.velocity.unwrap_or_default()).norm();
        let radius = [
            self.disc.as_ref().map(|it| it.radius),
            self.cylinder.as_ref().map(|it| it.radius),
            self.cone.as_ref().map(|it| it.radius.max(it.end_radius)),
        ];
        let radius = radius.into_iter().flatten().next().unwrap_or(reach);
        speed.max(self.angular_velocity.unwrap_or(0.0).abs() * radius)
    }

    /// Its least height (m) along the unit vector `upward`. `None` for what cannot end a fall:
    /// endless cylinders, and planes that face down.
    pub(crate) fn lowest(&self, upward: Vector) -> Option<f64> {
        let height = |place: Vector| place.dot(upward);
        if let Some(plane) = &self.plane {
            let faces_up = plane.unit_normal().dot(upward) > 0.0;
            return faces_up.then(|| height(plane.point.into()));
        }
        if let Some(plate) = &self.plate {
            let ([a, b], corner) = (plate.edges(), Vector::from(plate.corner));
            let corners = [corner, corner + a, corner + b, corner + a + b];
            return corners.into_iter().map(height).reduce(f64::min);
        }
        let (base, axis, ends) = self.ends()?;
        let (along, axis) = (axis.dot(upward), axis);
        let aside = (1.0 - along * along).max(0.0).sqrt();
        let end = |[radius, length]: [f64; 2]| height(base + axis * length) - radius * aside;
        ends.into_iter().map(end).reduce(f64::min)
    }

    /// Of a wall about an axis that has ends: a point of the axis (m), its unit vector, and for
    /// both ends the radius and the place along the axis (m).
    pub(crate) fn ends(&self) -> Option<(Vector, Vector, [[f64; 2]; 2])> {
        let of = |base: [f64; 3], axis: [f64; 3], ends| {
            (Vector::from(base), Vector::from(axis).unit(), ends)
        };
        let disc = self.disc.as_ref().map(|it| {
            let hole = it.hole_radius.unwrap_or(0.0);
            of(it.centre, it.axis, [[hole, 0.0], [it.radius, 0.0]])
        });
        let cylinder = self.cylinder.as_ref().and_then(|it| {
            let ends = [[it.radius, 0.0], [it.radius, it.length?]];
            Some(of(it.base, it.axis, ends))
        });
        let cone = self.cone.as_ref().and_then(|it| {
            let ends = [[it.radius, 0.0], [it.end_radius, it.height()?]];
            Some(of(it.base, it.axis, ends))
        });
        disc.or(cylinder).or(cone)
    }

    /// What it is called, at this place of the list.
    pub fn called(&self, place: usize) -> String {
        self.name.clone().unwrap_or_else(|| format!("wall_{place}"))
    }
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

fn along_y() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

fn is_along_y(axis: &[f64; 3]) -> bool {
    *axis == along_y()
}

fn along_z() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}
