//! One axis of a sweep.

use serde::{Deserialize, Serialize};

/// One axis of a sweep: a numeric key of the scene and the values it takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Path of the key, such as `spheres.radius`.
    pub key: String,
    /// Short name, such as `radius`: the column of labels.csv.
    pub name: String,
    /// Values, in the key's SI unit.
    pub values: Vec<f64>,
}
