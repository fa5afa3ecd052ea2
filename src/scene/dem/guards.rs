//! Limits beyond which a run is ended.

use crate::document::quantity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Limits beyond which a run is ended and reported as unstable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Guards {
    /// Largest overlap, in radii of the smaller partner.
    #[schemars(transform = quantity("ξ_{max} / r", "", "largest overlap, in radii").above(0.0))]
    pub overlap: f64,
    /// Largest displacement in one step, in radii of the sphere.
    #[schemars(
        transform = quantity("Δx_{max} / r", "", "largest displacement per step, in radii")
            .above(0.0)
    )]
    pub displacement: f64,
    /// Largest |x| and |y| of a centre (m). Default, if there are walls all around: twice the
    /// tank's radius, or the larger of its width and depth. Not along a period.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = quantity("x_{max}", "m", "largest |x| and |y|").above(0.0))]
    pub horizontal: Option<f64>,
    /// Largest |z| of a centre (m). Default, if there is a floor: ten times the largest of the
    /// floor's depth, the start height, and the tank's radius, or half its
    /// width or depth (1 m without any).
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = quantity("z_{guard}", "m", "largest |z|").above(0.0))]
    pub vertical: Option<f64>,
}

impl Default for Guards {
    fn default() -> Self {
        Self {
            overlap: 1.5,
            displacement: 1.0,
            horizontal: None,
            vertical: None,
        }
    }
}
