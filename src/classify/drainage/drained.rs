//! The sieve for boxes that are empty: (nearly) all spheres have left.

use super::run::DrainageRun;
use crate::classify::measure::{evidence, measures};
use crate::classify::sieve::{Sieve, Sifted, if_yes};
use crate::classify::{ClassifyError, Label, Measure, window};
use crate::document::unit;
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Threshold of the drained sieve: a box is empty if this share of its spheres has left, or if no
/// sphere is over the opening.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DrainedSieve {
    /// Share of all spheres that must have left.
    #[schemars(transform = unit("").above(0.0).at_most(1.0))]
    pub share: f64,
}

impl Default for DrainedSieve {
    fn default() -> Self {
        Self { share: 0.95 }
    }
}

measures! {
    /// Evidence of the drained sieve.
    struct DrainedEvidence {
        /// Share of the spheres that left, less the threshold.
        drained_margin: evidence("margin of the drained sieve", "").signed(),
    }
}

impl Sieve for DrainedSieve {
    type Run<'a> = DrainageRun<'a>;

    const LABELS: &'static [Label] = &[Label::EMPTIED];

    const MEASURES: &'static [Measure] = DrainedEvidence::MEASURES;

    fn check(&self, _: &Scene) -> Result<(), ClassifyError> {
        window::check_share("drained.share", self.share)
    }

    fn sift(&self, run: &mut DrainageRun<'_>) -> Sifted {
        let evidence = DrainedEvidence {
            drained_margin: Some(run.left() / run.spheres - self.share),
        };
        let is_empty = run.nothing_can_leave().then_some(Label::EMPTIED);
        Sifted {
            label: if_yes(Label::EMPTIED, evidence.drained_margin).or(is_empty),
            values: evidence.values(),
        }
    }
}
