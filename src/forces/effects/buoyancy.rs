//! Buoyancy: the displaced fluid pushes a sphere against gravity.

use super::gravity::GravityForce;
use super::{Effect, EffectKeys, Effects, SceneFacts, Targets};
use crate::document::Problem;
use crate::document::quantities::fluid_density;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Buoyancy in a fluid (Archimedes): the weight of the fluid that a sphere displaces, against
/// gravity; needs `gravity`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Buoyancy {
    /// Density of the fluid (kg/m3).
    #[schemars(transform = fluid_density())]
    pub density: f64,
}

impl Buoyancy {
    /// Buoyancy over weight of spheres of a density (kg/m3).
    pub(super) fn ratio(&self, density: f64) -> f64 {
        self.density / density
    }
}

impl EffectKeys for Buoyancy {
    /// F = -rho_fluid V g = -(rho_fluid / rho) m g. A constant force limits no time step.
    fn effect(&self, all: &Effects, targets: &Targets<'_>) -> Option<Box<dyn Effect>> {
        let ratio = self.ratio(targets.scene.density);
        let acceleration = all.gravity.as_ref()?.components().map(|it| -ratio * it);
        Some(Box::new(GravityForce { acceleration }))
    }

    fn problems(&self, all: &Effects, _: &SceneFacts) -> Vec<Problem> {
        if all.gravity.is_some() {
            return Vec::new();
        }
        let message = "[buoyancy] acts against gravity, but there is no [gravity]";
        let help = "add [gravity] with `acceleration`, or remove [buoyancy]";
        vec![Problem::new("buoyancy", message).help(help)]
    }
}
