//! The sieve for emptied silos: (nearly) all grains have left.

use super::outflow::Outflow;
use crate::classify::measure::{evidence, measures};
use crate::classify::sieve::{Sieve, Sifted, if_yes};
use crate::classify::{ClassifyError, Label, Measure, window};
use crate::document::unit;
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Threshold of the emptied sieve: a silo is empty if this share of its grains has left, since some
/// may lie for good in corners and on obstacles. It is also empty if the outflow has stopped (see
/// the arching sieve) and no grain is over the opening.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EmptiedSieve {
    /// Share of all grains of the scene that must have left.
    #[schemars(transform = unit("").at_least(0.0).at_most(1.0))]
    pub share: f64,
}

impl Default for EmptiedSieve {
    fn default() -> Self {
        Self { share: 0.95 }
    }
}

impl Label {
    /// (Nearly) all grains have left a silo.
    pub const EMPTIED: Self = Self::new(8, "emptied", 0xe2_bd_6c);
}

measures! {
    /// Evidence of the emptied sieve; empty in a run whose door did not open.
    struct EmptiedEvidence {
        /// Share of the grains that left, less the threshold.
        emptied_margin: evidence("margin of the emptied sieve", "").signed(),
    }
}

impl Sieve for EmptiedSieve {
    type Run<'a> = Outflow<'a>;

    const LABELS: &'static [Label] = &[Label::EMPTIED];

    const MEASURES: &'static [Measure] = EmptiedEvidence::MEASURES;

    fn check(&self, _: &Scene) -> Result<(), ClassifyError> {
        window::check_share("emptied.share", self.share)
    }

    fn sift(&self, run: &mut Outflow<'_>) -> Sifted {
        let opened = run.opened;
        let evidence = EmptiedEvidence {
            emptied_margin: opened.map(|_| run.discharged() / run.grains - self.share),
        };
        let is_drained = run.is_drained.then_some(Label::EMPTIED);
        Sifted {
            label: if_yes(Label::EMPTIED, evidence.emptied_margin).or(is_drained),
            values: evidence.values(),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::classify::silo::synthetic::{draining, judge};
    use crate::classify::{ClassifyError, Label, Sieves};

    #[test]
    fn the_share_itself_is_enough() {
        // Of 200 grains, 190 are 95 %.
        let emptied = judge(&draining(190, 1.0).at_rest(30.0));
        assert_eq!(emptied.label, Label::EMPTIED);
        assert_eq!(emptied.value("emptied_margin"), Some(0.0));
        let arching = judge(&draining(189, 1.0).at_rest(30.0));
        assert_eq!(arching.label, Label::ARCHING);
        assert!(arching.value("emptied_margin").unwrap() < 0.0);
    }

    #[test]
    fn an_empty_silo_is_empty_however_late_its_last_grain_left() {
        let verdict = judge(&draining(200, 0.05));
        assert_eq!(verdict.label, Label::EMPTIED);
        assert!(verdict.value("flowing_margin").unwrap() >= 0.0);
    }

    #[test]
    fn a_share_out_of_range_is_named() {
        let mut sieves = Sieves::default();
        sieves.emptied.share = 1.5;
        let error = sieves.check(&draining(1, 1.0).scene).unwrap_err();
        assert!(matches!(
            error,
            ClassifyError::Threshold {
                key: "emptied.share",
                ..
            }
        ));
    }
}
