//! The drag of air on a sphere: force from the difference of two velocities.

use crate::document::quantity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Drag law and the form of its quadratic part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drag {
    /// Linear coefficient, with the unit that `law` says.
    #[serde(default)]
    #[schemars(
        transform = quantity("M_1", "kg/(m² s)", "linear drag coefficient")
            .at_least(0.0)
            .unit_where("law", "diameter", "kg/(m s)")
            .unit_where("law", "constant", "kg/s")
    )]
    pub linear: f64,
    /// Quadratic coefficient, with the unit that `law` says.
    #[serde(default)]
    #[schemars(
        transform = quantity("M_2", "kg/m³", "quadratic drag coefficient")
            .at_least(0.0)
            .unit_where("law", "constant", "kg/m")
    )]
    pub quadratic: f64,
    /// How the coefficients scale with the sphere.
    pub law: DragLaw,
    /// Whether the quadratic part is a vector law or acts component by component.
    #[serde(default)]
    pub form: DragForm,
}

/// How drag scales with the sphere of radius r: F = c1 dv + c2 |dv| dv.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DragLaw {
    /// By cross-section (Rice, 2012, eqs. 22 and 23): c1 = linear pi r^2 with `linear` in
    /// kg/(m2 s), c2 = quadratic pi r^2 with `quadratic` in kg/m3.
    CrossSection,
    /// By diameter D = 2r (Rice, 2012, eqs. 26 and 27): c1 = linear D with `linear` in kg/(m s),
    /// c2 = quadratic D^2 with `quadratic` in kg/m3.
    Diameter,
    /// The same force on every sphere: c1 = linear in kg/s, c2 = quadratic in kg/m.
    Constant,
}

/// Form of the quadratic drag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DragForm {
    /// |dv| dv: isotropic, as physics has it.
    #[default]
    Vector,
    /// dv_x |dv_x| and so on: each component by itself, as the thesis ran it.
    Component,
}

impl Drag {
    /// Coefficients (c1 in kg/s, c2 in kg/m) for a sphere of radius `radius` (m).
    pub fn coefficients(&self, radius: f64) -> (f64, f64) {
        let diameter = 2.0 * radius;
        match self.law {
            DragLaw::CrossSection => {
                let area = std::f64::consts::PI * radius * radius;
                (self.linear * area, self.quadratic * area)
            }
            DragLaw::Diameter => (self.linear * diameter, self.quadratic * diameter * diameter),
            DragLaw::Constant => (self.linear, self.quadratic),
        }
    }
}
