//! The sieve for arches: the outflow has stopped.

use super::outflow::Outflow;
use crate::classify::measure::{evidence, measures};
use crate::classify::sieve::{Sieve, Sifted, if_yes};
use crate::classify::{ClassifyError, Label, Measure, window};
use crate::document::unit;
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Threshold of the arching sieve: the outflow has stopped if no grain left in the last window, or
/// if the run ended because all grains were at rest. It is an arch only if grains are over the
/// opening.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ArchingSieve {
    /// Window (s). A slow outflow has pauses of 1 / rate between two grains, which must be shorter.
    #[schemars(transform = unit("s").above(0.0))]
    pub window: f64,
}

impl Default for ArchingSieve {
    fn default() -> Self {
        Self { window: 2.0 }
    }
}

impl Label {
    /// The grains of a silo have stopped to leave it, and most are still in.
    pub const ARCHING: Self = Self::new(6, "arching", 0x7a_1f_4d);
}

measures! {
    /// Evidence of the arching sieve; empty in a run whose door did not open.
    struct ArchingEvidence {
        /// Time without an outflow (s): from the last grain that left, or from the opening of the
        /// door if none did, to the end of the run. A run that ended because all grains were at
        /// rest would have stayed so to its duration, and has one window at least.
        arching_pause: evidence("time without an outflow", "s"),
        /// That time over the window, less 1.
        arching_margin: evidence("margin of the arching sieve", "").signed(),
        /// Number of grains over the opening at the end; empty in a scene whose geometry has no
        /// door. Without any nothing blocks it: the remaining grains lie elsewhere.
        over_opening: evidence("grains over the opening at the end", ""),
    }
}

impl Sieve for ArchingSieve {
    type Run<'a> = Outflow<'a>;

    const LABELS: &'static [Label] = &[Label::ARCHING];

    const MEASURES: &'static [Measure] = ArchingEvidence::MEASURES;

    fn check(&self, scene: &Scene) -> Result<(), ClassifyError> {
        window::check("arching.window", self.window, scene.time.frame_interval)
    }

    fn sift(&self, run: &mut Outflow<'_>) -> Sifted {
        let pause = self.pause(run);
        let evidence = ArchingEvidence {
            arching_pause: pause,
            arching_margin: pause.map(|pause| self.margin(run, pause)),
            over_opening: run.over_opening(),
        };
        Sifted {
            label: if_yes(Label::ARCHING, evidence.arching_margin),
            values: evidence.values(),
        }
    }
}

impl ArchingSieve {
    /// Time without an outflow at the end of the run (s).
    fn pause(&self, run: &Outflow<'_>) -> Option<f64> {
        let last = run.last_exit()?;
        Some(if run.stopped {
            (run.record.scene.time.duration - last).max(self.window)
        } else {
            run.end - last
        })
    }

    /// That time over the window, less 1.
    fn margin(&self, run: &Outflow<'_>, pause: f64) -> f64 {
        // A window that ends at the last frame is whole, whatever the last digits of its times say.
        let is_window = (pause - self.window).abs() < run.tolerance();
        let pause = if is_window { self.window } else { pause };
        pause / self.window - 1.0
    }
}

#[cfg(test)]
mod tests {
    use crate::classify::silo::synthetic::{DURATION, OPENED, draining, draining_until, judge};
    use crate::classify::{Label, Sieves};

    #[test]
    fn an_arch_holds_for_a_window() {
        let arching = judge(&draining(50, 2.0));
        assert_eq!(arching.label, Label::ARCHING);
        assert_eq!(arching.value("arching_margin"), Some(0.0));
        let flowing = judge(&draining(50, 1.95));
        assert_eq!(flowing.label, Label::FLOWING);
        assert!(flowing.value("arching_margin").unwrap() < 0.0);
    }

    #[test]
    fn a_silo_that_nothing_left_is_blocked_from_its_opening_on() {
        let verdict = judge(&draining(0, 0.0));
        assert_eq!(verdict.label, Label::ARCHING);
        let pause = verdict.value("arching_pause").unwrap();
        assert!((pause - (DURATION - OPENED)).abs() < 1e-9, "{pause}");
    }

    #[test]
    fn a_run_that_came_to_rest_needs_no_whole_window() {
        let end = OPENED + 1.0;
        let verdict = judge(&draining_until(end, 5, 0.5).at_rest(end));
        assert_eq!(verdict.label, Label::ARCHING);
        // Nothing more would have happened until its duration.
        let pause = verdict.value("arching_pause").unwrap();
        assert!(pause > DURATION - end, "{pause}");
        let late = draining(5, 0.5).at_rest(DURATION - 0.1);
        assert_eq!(judge(&late).value("arching_margin"), Some(0.0));
    }

    #[test]
    fn a_window_shorter_than_a_frame_is_refused() {
        let mut sieves = Sieves::default();
        sieves.arching.window = 0.01;
        let error = sieves.check(&draining(1, 1.0).scene).unwrap_err();
        assert!(
            error.to_string().contains("`sieves.arching.window`"),
            "{error}"
        );
    }

    /// Symptom: a silo with a flat bottom that had drained but for its corners was arching. Cause:
    /// nothing asked whether any grain was over the opening.
    #[test]
    fn grains_beside_the_opening_are_no_arch() {
        let mut record = draining(180, 3.0);
        assert_eq!(judge(&record).label, Label::ARCHING);
        // 20 grains left, all of them far to the side.
        let mut last = record.snapshots[0].clone();
        last.time = DURATION;
        last.position.fill(f64::NAN);
        for grain in 0..20 {
            last.position[[grain, 0]] = 20.0 + 2.0 * grain as f64;
            last.position[[grain, 2]] = -38.0;
        }
        record.snapshots.push(last);
        let verdict = judge(&record);
        assert_eq!(verdict.label, Label::EMPTIED);
        assert_eq!(verdict.value("over_opening"), Some(0.0));
        // One that sits over it holds nothing up by itself, but something holds it.
        let last = record.snapshots.last_mut().unwrap();
        last.position[[0, 0]] = 1.0;
        assert_eq!(judge(&record).label, Label::ARCHING);
    }
}
