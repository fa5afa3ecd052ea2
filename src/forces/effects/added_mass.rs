//! Added mass: the fluid about a sphere must be accelerated with it.

use super::{Effect, EffectKeys, Effects, Targets};
use crate::document::quantities::fluid_density;
use crate::document::quantity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Added mass (Lamb, Hydrodynamics (1932), section 92): a sphere in an ideal fluid moves as if its
/// mass were m + C rho V, also while it touches others. Its weight and its moment of inertia do not
/// change, and kinetic energies include the fluid's share.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AddedMass {
    /// Coefficient C (default 1/2, for a sphere far from others and from walls).
    #[serde(default = "half")]
    #[schemars(
        transform = quantity("C_m", "", "coefficient of the added mass").at_least(0.0).at_most(1e3)
    )]
    pub coefficient: f64,
    /// Density rho of the fluid (kg/m3).
    #[schemars(transform = fluid_density())]
    pub density: f64,
}

fn half() -> f64 {
    0.5
}

impl AddedMass {
    /// Added mass over mass of spheres of a density (kg/m3).
    pub(super) fn ratio(&self, density: f64) -> f64 {
        self.coefficient * self.density / density
    }
}

/// No force: spheres get the inertia of the added mass when they are placed, and the limits of the
/// time step include it in the masses.
impl EffectKeys for AddedMass {
    fn effect(&self, _: &Effects, _: &Targets<'_>) -> Option<Box<dyn Effect>> {
        None
    }
}
