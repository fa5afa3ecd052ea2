//! Radii of the spheres: one value, shares of several, or a file.

use crate::document::quantities::length;
use crate::document::unit;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::path::PathBuf;

/// Radii of the spheres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Radii {
    /// Every sphere has this radius (m).
    One(#[schemars(transform = length("", ""))] f64),
    /// Shares of several radii, assigned to the spheres at random.
    Shares(Vec<RadiusShare>),
    /// One radius per sphere (m); files are converted to this form.
    Each(#[schemars(transform = length("", ""))] Vec<f64>),
    /// One radius per sphere (m), one per line, from a file.
    File {
        /// Path of the file, relative to the scene file.
        file: PathBuf,
    },
}

/// A share of the spheres with one radius.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadiusShare {
    /// Radius (m).
    #[schemars(transform = length("", ""))]
    pub radius: f64,
    /// Relative share of the number of spheres; shares need not add up to one. Some may be 0, but
    /// not all.
    #[schemars(transform = unit("").at_least(0.0))]
    pub share: f64,
}

impl Radii {
    /// The radii that occur (m); for a list, one per sphere. Empty for a file that has not been
    /// read.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Self::One(radius) => vec![*radius],
            Self::Shares(shares) => {
                let occurring = shares.iter().filter(|share| share.share > 0.0);
                occurring.map(|share| share.radius).collect()
            }
            Self::Each(radii) => radii.clone(),
            Self::File { .. } => Vec::new(),
        }
    }

    /// The shares of several radii; empty if radii are given in another way.
    pub fn shares(&self) -> &[RadiusShare] {
        match self {
            Self::Shares(shares) => shares,
            _ => &[],
        }
    }

    /// Mean radius of the spheres (m); not a number for a file that has not been read.
    pub fn mean(&self) -> f64 {
        self.mean_of(|radius| radius)
    }

    /// Mean of the squares of the radii (m2); not a number for a file that has not been read.
    pub fn mean_square(&self) -> f64 {
        self.mean_of(|radius| radius * radius)
    }

    /// Mean volume of the spheres (m3); not a number for a file that has not been read.
    pub fn mean_volume(&self) -> f64 {
        self.mean_of(|radius| 4.0 / 3.0 * PI * radius * radius * radius)
    }

    /// Cube root of the mean of r^3 (m): the radius of equal spheres of the same number and total
    /// volume; not a number for a file that has not been read.
    pub fn of_mean_volume(&self) -> f64 {
        libm::cbrt(self.mean_volume() / (4.0 / 3.0 * PI))
    }

    fn mean_of(&self, quantity: impl Fn(f64) -> f64) -> f64 {
        match self {
            Self::One(radius) => quantity(*radius),
            Self::Shares(shares) => {
                let total: f64 = shares.iter().map(|share| share.share).sum();
                let weighted = shares
                    .iter()
                    .map(|share| share.share * quantity(share.radius));
                weighted.sum::<f64>() / total
            }
            Self::Each(radii) => {
                let sum: f64 = radii.iter().map(|radius| quantity(*radius)).sum();
                sum / radii.len() as f64
            }
            Self::File { .. } => f64::NAN,
        }
    }
}
