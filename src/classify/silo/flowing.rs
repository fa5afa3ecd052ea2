//! The sieve for silos that flow: grains are leaving when the run ends.

use super::outflow::Outflow;
use crate::classify::measure::{evidence, measures};
use crate::classify::sieve::{Sieve, Sifted, if_yes};
use crate::classify::{ClassifyError, Label, Measure, window};
use crate::document::unit;
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Thresholds of the flowing sieve: a silo flows if at least `least` grains left in the last
/// window. One that was opened less than a window before the end counts what left since.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FlowingSieve {
    /// Window (s).
    #[schemars(transform = unit("s").above(0.0))]
    pub window: f64,
    /// Least number of grains in the window.
    #[schemars(range(min = 1))]
    pub least: usize,
}

impl Default for FlowingSieve {
    fn default() -> Self {
        Self {
            window: 2.0,
            least: 1,
        }
    }
}

impl Label {
    /// Grains are leaving a silo when the run ends.
    pub const FLOWING: Self = Self::new(7, "flowing", 0x3f_92_d2);
}

measures! {
    /// Evidence of the flowing sieve; empty in a run whose door did not open.
    struct FlowingEvidence {
        /// Number of grains that left in the last window.
        flowing_count: evidence("grains in the last window", ""),
        /// That number over the threshold, less 1.
        flowing_margin: evidence("margin of the flowing sieve", "").signed(),
    }
}

impl Sieve for FlowingSieve {
    type Run<'a> = Outflow<'a>;

    const LABELS: &'static [Label] = &[Label::FLOWING];

    const MEASURES: &'static [Measure] = FlowingEvidence::MEASURES;

    fn check(&self, scene: &Scene) -> Result<(), ClassifyError> {
        window::check("flowing.window", self.window, scene.time.frame_interval)?;
        if self.least == 0 {
            return Err(ClassifyError::Threshold {
                key: "flowing.least",
                value: 0.0,
                expected: "a number of grains, 1 or more".to_owned(),
            });
        }
        Ok(())
    }

    fn sift(&self, run: &mut Outflow<'_>) -> Sifted {
        let count = run.opened.map(|opened| {
            let from = opened.max(run.end - self.window);
            run.discharged() - run.discharged_by(from)
        });
        let evidence = FlowingEvidence {
            flowing_count: count,
            flowing_margin: count.map(|count| count / self.least as f64 - 1.0),
        };
        Sifted {
            label: if_yes(Label::FLOWING, evidence.flowing_margin),
            values: evidence.values(),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::classify::silo::synthetic::{OPENED, draining, draining_until, judge};
    use crate::classify::{Label, Sieves, classify};

    #[test]
    fn enough_grains_in_the_last_window_are_a_flow() {
        let record = draining(50, 0.0);
        let verdict = judge(&record);
        assert_eq!(verdict.label, Label::FLOWING);
        let count = verdict.value("flowing_count").unwrap();
        assert!(count >= 1.0);

        let mut sieves = Sieves::default();
        sieves.flowing.least = count as usize;
        assert_eq!(classify(&record, &sieves).unwrap().label, Label::FLOWING);
        sieves.flowing.least += 1;
        let trickle = classify(&record, &sieves).unwrap();
        // Too few for a flow, and not stopped for a window.
        assert_eq!(trickle.label, Label::UNSETTLED);
        assert!(trickle.value("flowing_margin").unwrap() < 0.0);
    }

    #[test]
    fn a_door_that_opened_just_before_the_end_says_nothing() {
        let late = draining_until(OPENED + 1.0, 0, 0.0);
        let verdict = judge(&late);
        assert_eq!(verdict.label, Label::UNSETTLED);
        let evidence = &verdict;
        assert_eq!(evidence.value("flowing_count"), Some(0.0));
        assert!(evidence.value("arching_margin").unwrap() < 0.0);
    }

    #[test]
    fn at_least_one_grain_is_asked_for() {
        let mut sieves = Sieves::default();
        sieves.flowing.least = 0;
        let error = sieves.check(&draining(1, 1.0).scene).unwrap_err();
        assert!(
            error.to_string().contains("`sieves.flowing.least`"),
            "{error}"
        );
    }
}
