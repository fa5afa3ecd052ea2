//! Periodic sides.

use super::{FixedSpheres, Geometry};
use crate::document::quantities::length;
use crate::particles::Domain;
use crate::particles::vector::Vector;
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Periodic sides: what leaves on one side comes in on the opposite one, and spheres meet across
/// them. A box of these lengths about the origin then stands for endless space. Positions in
/// records go on beyond the box, so that paths are whole; pictures and exports show the images
/// inside the box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Periodic {
    /// Period along x (m): at least twice the sum of the two largest radii that may meet, fixed
    /// spheres included, as a pair may meet across one side only. Default: open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("L_x", "period along x"))]
    pub x: Option<f64>,
    /// Period along y (m). Default: open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("L_y", "period along y"))]
    pub y: Option<f64>,
    /// Period along z (m), the axis of the tank. Default: open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("L_z", "period along z"))]
    pub z: Option<f64>,
}

impl Periodic {
    /// The periods along x, y and z (m).
    pub fn periods(&self) -> [Option<f64>; 3] {
        [self.x, self.y, self.z]
    }
}

impl Scene {
    /// The space in which the spheres move.
    pub fn domain(&self) -> Domain {
        let periodic = self.dem.periodic.unwrap_or_default();
        Domain::new(periodic.periods())
    }

    /// Its fixed spheres, at their images in the box of a periodic space.
    pub fn fixed_in_box(&self) -> FixedSpheres {
        let domain = self.domain();
        let mut fixed = self.dem.geometry.as_ref().map(Geometry::spheres);
        for sphere in fixed
            .iter_mut()
            .flat_map(|it| it.walls.iter_mut().chain(&mut it.door))
        {
            let Vector { x, y, z, .. } = domain.wrapped(sphere.position.into());
            sphere.position = [x, y, z];
        }
        fixed.unwrap_or_default()
    }

    /// Cross-section (m2) of the tank or of the periodic box, if it is closed.
    pub fn cross_section(&self) -> Option<f64> {
        let tank = self.tank.as_ref();
        let [x, y, _] = self.domain().periods();
        let width = x.or(tank.and_then(|tank| tank.width));
        let depth = y.or(tank.and_then(|tank| tank.depth));
        let sides = width.zip(depth).map(|(width, depth)| width * depth);
        sides.or(tank.and_then(|tank| tank.area()))
    }
}
