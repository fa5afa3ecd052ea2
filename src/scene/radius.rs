//! Radii of the spheres: one value, shares of several, or a file.

use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Radii of the spheres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Radii {
    /// Every sphere has this radius (m).
    One(f64),
    /// Shares of several radii, dealt to the spheres at random.
    Shares(Vec<RadiusShare>),
    /// One radius per sphere (m), one per line, from a file.
    File {
        /// Path of the file, relative to the scene file.
        file: PathBuf,
    },
    /// One radius per sphere (m); what a file is resolved to.
    Each(Vec<f64>),
}

/// A share of the spheres with one radius.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RadiusShare {
    /// Radius (m).
    pub radius: f64,
    /// Relative share of the number of spheres; shares need not add up to one.
    pub share: f64,
}
