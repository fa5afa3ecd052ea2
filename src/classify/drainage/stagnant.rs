//! The sieve for stagnant corners: spheres at the side walls that have not sunk.

use super::run::DrainageRun;
use crate::classify::measure::{evidence, measures};
use crate::classify::sieve::{Sieve, Sifted, if_yes};
use crate::classify::{ClassifyError, Label, Measure};
use crate::document::unit;
use crate::scene::Scene;
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
    /// Evidence of the stagnant sieve; empty with fewer than two snapshots.
    struct StagnantEvidence {
        /// Height of the stagnant zone over the threshold, less 1.
        stagnant_margin: evidence("margin of the stagnant sieve", "").signed(),
    }
}

impl Sieve for StagnantSieve {
    type Run<'a> = DrainageRun<'a>;

    const LABELS: &'static [Label] = &[Label::STAGNANT_CORNERS];

    const MEASURES: &'static [Measure] = StagnantEvidence::MEASURES;

    fn check(&self, _: &Scene) -> Result<(), ClassifyError> {
        let valid = self.height.is_finite() && self.height > 0.0;
        valid.then_some(()).ok_or_else(|| ClassifyError::Threshold {
            key: "stagnant.height",
            value: self.height,
            expected: "a number above 0".to_owned(),
        })
    }

    fn sift(&self, run: &mut DrainageRun<'_>) -> Sifted {
        let height = run.stagnant_height();
        let evidence = StagnantEvidence {
            stagnant_margin: height.map(|it| it / (self.height * run.diameter) - 1.0),
        };
        Sifted {
            label: if_yes(Label::STAGNANT_CORNERS, evidence.stagnant_margin),
            values: evidence.values(),
        }
    }
}
