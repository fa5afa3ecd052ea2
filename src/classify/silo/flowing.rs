//! The sieve for silos that flow: grains are leaving when the run ends.

use super::outflow::Outflow;
use crate::classify::{ClassifyError, window};
use crate::document::unit;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Thresholds of the flowing sieve: a silo flows if at least `least` grains left in the last window.
/// One that was opened less than a window before the end counts what left since.
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

impl FlowingSieve {
    pub(in crate::classify) fn check(&self, interval: f64) -> Result<(), ClassifyError> {
        window::check("flowing.window", self.window, interval)?;
        if self.least == 0 {
            return Err(ClassifyError::Threshold {
                key: "flowing.least",
                value: 0.0,
                expected: "a number of grains, 1 or more".to_owned(),
            });
        }
        Ok(())
    }

    /// Number of grains that left in the last window.
    pub(super) fn count(&self, run: &Outflow<'_>) -> Option<f64> {
        let from = run.opened?.max(run.end - self.window);
        Some(run.discharged() - run.discharged_by(from))
    }

    /// That number over the threshold, less 1.
    pub(super) fn margin(&self, run: &Outflow<'_>) -> Option<f64> {
        Some(self.count(run)? / self.least as f64 - 1.0)
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
        assert_eq!(verdict.label, Label::Flowing);
        let count = verdict.silo().unwrap().evidence.flowing_count.unwrap();
        assert!(count >= 1.0);

        let mut sieves = Sieves::default();
        sieves.flowing.least = count as usize;
        assert_eq!(classify(&record, &sieves).unwrap().label, Label::Flowing);
        sieves.flowing.least += 1;
        let trickle = classify(&record, &sieves).unwrap();
        // Too few for a flow, and not stopped for a window.
        assert_eq!(trickle.label, Label::Unsettled);
        assert!(trickle.silo().unwrap().evidence.flowing_margin.unwrap() < 0.0);
    }

    #[test]
    fn a_door_that_opened_just_before_the_end_says_nothing() {
        let late = draining_until(OPENED + 1.0, 0, 0.0);
        let verdict = judge(&late);
        assert_eq!(verdict.label, Label::Unsettled);
        let evidence = &verdict.silo().unwrap().evidence;
        assert_eq!(evidence.flowing_count, Some(0.0));
        assert!(evidence.arching_margin.unwrap() < 0.0);
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
