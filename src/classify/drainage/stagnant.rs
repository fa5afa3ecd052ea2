//! The sieve for stagnant corners: spheres at the side walls that have not sunk.

use super::run::Run;
use crate::classify::measure::{evidence, measures};
use crate::classify::{ClassifyError, Label};
use crate::document::unit;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Threshold of the stagnant sieve: corners are stagnant if the spheres at the side walls have not
/// sunk by a diameter up to this height.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StagnantSieve {
    /// Height above the floor, in diameters of the spheres.
    #[schemars(transform = unit("").above(0.0))]
    pub height: f64,
}

impl Default for StagnantSieve {
    fn default() -> Self {
        Self { height: 3.0 }
    }
}

impl Label {
    /// Spheres leave, and others at the side walls have not sunk.
    pub const STAGNANT_CORNERS: Self = Self::new(11, "stagnant-corners", 0x98_2c_74);
}

measures! {
    /// What the stagnant sieve says; empty with fewer than two snapshots.
    struct StagnantEvidence {
        /// Height of the stagnant zone over the threshold, less 1.
        stagnant_margin: evidence("margin of the stagnant sieve", "").signed(),
    }
}

impl StagnantSieve {
    pub(super) fn check(&self) -> Result<(), ClassifyError> {
        let valid = self.height.is_finite() && self.height > 0.0;
        valid.then_some(()).ok_or_else(|| ClassifyError::Threshold {
            key: "stagnant.height",
            value: self.height,
            expected: "a number above 0".to_owned(),
        })
    }

    pub(super) fn sift(&self, run: &Run<'_>) -> StagnantEvidence {
        let height = run.stagnant_height();
        StagnantEvidence {
            stagnant_margin: height.map(|it| it / (self.height * run.diameter) - 1.0),
        }
    }
}
