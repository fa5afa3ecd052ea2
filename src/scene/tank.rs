//! The walls of a tank.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The tank's walls, of the same material as the spheres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tank {
    /// Radius R of the cylindrical wall (m). Absent: no cylinder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Height of the floor (m). Absent: no floor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub floor: Option<f64>,
}
