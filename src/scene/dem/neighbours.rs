//! How the pairs that may touch are found.

use crate::document::quantities::length;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the pairs that may touch are found. Only the speed depends on it: every search gives the
/// same motion, bit for bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "search", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Neighbours {
    /// A list that holds until a sphere has moved far enough (Verlet, 1967), made from cells. The
    /// fastest.
    #[default]
    VerletList,
    /// Every sphere against every other in every step: time grows with the square of their number.
    AllPairs,
    /// Square cells, refilled in every step: a sphere can only touch those in its own cell and in
    /// the cells about it (Remmers, 2009).
    Cells {
        /// Side L of a cell (m), at least the largest sum of the radii of two spheres that may
        /// touch.
        #[schemars(transform = length("L", "side of a cell"))]
        length: f64,
    },
    /// As `cells`, with the cells in a chained hash table. Its memory depends only on the number of
    /// spheres, not on their distances: for unbounded domains.
    HashedCells {
        /// Side L of a cell (m), at least the largest sum of the radii of two spheres that may
        /// touch.
        #[schemars(transform = length("L", "side of a cell"))]
        length: f64,
    },
}

impl Neighbours {
    /// Name, as in a scene file.
    pub fn name(self) -> &'static str {
        match self {
            Self::VerletList => "verlet-list",
            Self::AllPairs => "all-pairs",
            Self::Cells { .. } => "cells",
            Self::HashedCells { .. } => "hashed-cells",
        }
    }

    /// Side of a cell (m), if the scene gives it.
    pub fn length(self) -> Option<f64> {
        match self {
            Self::Cells { length } | Self::HashedCells { length } => Some(length),
            Self::VerletList | Self::AllPairs => None,
        }
    }
}
