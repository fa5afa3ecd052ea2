//! The sieve for openings that are blocked: spheres are over the opening, and none leaves.

use super::run::DrainageRun;
use crate::classify::measure::{evidence, measures};
use crate::classify::sieve::{Sieve, Sifted, if_yes};
use crate::classify::{ClassifyError, Label, Measure, window};
use crate::document::unit;
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Threshold of the blocked sieve: an opening is blocked if no sphere left in the last window,
/// though some are over it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BlockedSieve {
    /// Window (s).
    #[schemars(transform = unit("s").above(0.0))]
    pub window: f64,
}

impl Default for BlockedSieve {
    fn default() -> Self {
        Self { window: 4.0 }
    }
}

impl Label {
    /// Spheres are over an opening, and none leaves.
    pub const BLOCKED: Self = Self::new(12, "blocked", 0x3a_14_57);
}

measures! {
    /// Evidence of the blocked sieve.
    struct BlockedEvidence {
        /// Number of spheres that left in the last window.
        blocked_count: evidence("spheres in the last window", ""),
        /// 1/2 less that number: yes from 0 on.
        blocked_margin: evidence("margin of the blocked sieve", "").signed(),
        /// Number of spheres over the opening at the end.
        spheres_over_opening: evidence("spheres over the opening at the end", ""),
    }
}

impl Sieve for BlockedSieve {
    type Run<'a> = DrainageRun<'a>;

    const LABELS: &'static [Label] = &[Label::BLOCKED];

    const MEASURES: &'static [Measure] = BlockedEvidence::MEASURES;

    fn check(&self, scene: &Scene) -> Result<(), ClassifyError> {
        window::check("blocked.window", self.window, scene.time.frame_interval)
    }

    fn window(&self) -> Option<f64> {
        Some(self.window)
    }

    fn sift(&self, run: &mut DrainageRun<'_>) -> Sifted {
        let count = run.left_in_last(self.window);
        let evidence = BlockedEvidence {
            blocked_count: Some(count),
            blocked_margin: Some(0.5 - count),
            spheres_over_opening: run.over_opening(),
        };
        let is_over = evidence.spheres_over_opening != Some(0.0);
        Sifted {
            label: if_yes(Label::BLOCKED, evidence.blocked_margin).filter(|_| is_over),
            values: evidence.values(),
        }
    }
}
