//! The pinned sieve: a hole about the axis.

use super::run::TankRun;
use crate::classify::measure::{evidence, measures};
use crate::classify::sieve::{Sieve, Sifted, if_yes};
use crate::classify::{ClassifyError, Label, Measure, Sieves, window};
use crate::document::unit;
use crate::record::RunRecord;
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Thresholds of the pinned sieve (Rice, 2012, listing 7.3, which means the central hole, not the
/// text's two layers at the wall).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PinnedSieve {
    /// Window (s).
    #[schemars(transform = unit("s").above(0.0))]
    pub window: f64,
    /// A frame has a hole if every centre is farther than this from the axis, in (mean) radii of
    /// the spheres.
    #[schemars(transform = unit("").at_least(0.0))]
    pub hole: f64,
    /// Share of the window's frames that must have the hole.
    #[schemars(transform = unit("").at_least(0.0).at_most(1.0))]
    pub share: f64,
}

impl Default for PinnedSieve {
    fn default() -> Self {
        Self {
            window: 2.0,
            hole: 2.0,
            share: 0.5,
        }
    }
}

impl Label {
    /// A hole about the axis.
    pub const PINNED: Self = Self::new(3, "pinned", 0x2a_8a_5c);
}

measures! {
    /// Evidence of the pinned sieve; empty on a run too short for a yes.
    struct PinnedEvidence {
        /// Largest share of frames with a hole of any pinned window; frames outside the steady
        /// part count as having none.
        pinned_share: evidence("share of frames with a hole", ""),
        /// That share less the threshold.
        pinned_margin: evidence("margin of the pinned sieve", "").signed(),
    }
}

impl Sieve for PinnedSieve {
    type Run<'a> = TankRun<'a>;

    const LABELS: &'static [Label] = &[Label::PINNED];

    const MEASURES: &'static [Measure] = PinnedEvidence::MEASURES;

    fn check(&self, scene: &Scene) -> Result<(), ClassifyError> {
        window::check("pinned.window", self.window, scene.time.frame_interval)?;
        window::check_share("pinned.share", self.share)?;
        if !self.hole.is_finite() || self.hole < 0.0 {
            return Err(ClassifyError::Threshold {
                key: "pinned.hole",
                value: self.hole,
                expected: "a number of radii, 0 or more".to_owned(),
            });
        }
        Ok(())
    }

    fn window(&self) -> Option<f64> {
        Some(self.window)
    }

    fn sift(&self, run: &mut TankRun<'_>) -> Sifted {
        let share = run.start.and_then(|start| self.largest_share(run, start));
        let evidence = PinnedEvidence {
            pinned_share: share,
            pinned_margin: share.map(|share| share - self.share),
        };
        Sifted {
            label: if_yes(Label::PINNED, evidence.pinned_margin),
            values: evidence.values(),
        }
    }
}

/// What the evidence `pinned_share` of a run in a tank would be if a hole had each of these radii,
/// in radii of the spheres.
///
/// # Errors
/// The sieves cannot judge the run.
pub fn pinned_shares(
    record: &RunRecord,
    sieves: &Sieves,
    holes: &[f64],
) -> Result<Vec<Option<f64>>, ClassifyError> {
    let mut run = TankRun::new(record, sieves.spout.column(&record.scene.output)?)?;
    sieves.settle.sift(&mut run);
    let share = |hole: &f64| {
        let sieve = PinnedSieve {
            hole: *hole,
            ..sieves.pinned.clone()
        };
        sieve.largest_share(&run, run.start?)
    };
    Ok(holes.iter().map(share).collect())
}

impl PinnedSieve {
    /// Largest share of frames with a hole of any window.
    fn largest_share(&self, run: &TankRun<'_>, start: usize) -> Option<f64> {
        // Single precision, as the distances: a centre at the limit is not beyond it.
        let limit = (self.hole * run.radius) as f32;
        let distances = &run.observations.hole_radius[start..];
        let holes: Vec<bool> = distances.iter().map(|&distance| distance > limit).collect();
        window::largest_share(
            &holes,
            window::frames(self.window, run.interval),
            self.share,
        )
    }
}

#[cfg(test)]
mod tests {
    use crate::classify::tank::synthetic::{RADIUS, START, quiet};
    use crate::classify::{Label, Sieves, Verdict, classify};
    use crate::record::RunRecord;

    const FRAMES: usize = 4000;
    const WIDE: f32 = 0.02;

    fn judge(record: &RunRecord) -> Verdict {
        classify(record, &Sieves::default()).unwrap()
    }

    #[test]
    fn half_of_a_window_pins() {
        let pinned = judge(&quiet(FRAMES).with_hole(WIDE, 500..1500));
        assert_eq!(pinned.label, Label::PINNED);
        assert_eq!(pinned.value("pinned_margin"), Some(0.0));

        let almost = judge(&quiet(FRAMES).with_hole(WIDE, 500..1499));
        assert_eq!(almost.label, Label::SETTLED);
        assert_eq!(almost.value("pinned_share"), Some(0.4995));
    }

    #[test]
    fn the_window_slides() {
        let near = quiet(FRAMES)
            .with_hole(WIDE, 500..1000)
            .with_hole(WIDE, 2000..2500);
        assert_eq!(judge(&near).label, Label::PINNED);
        let far = quiet(FRAMES)
            .with_hole(WIDE, 500..1000)
            .with_hole(WIDE, 2001..2501);
        assert_eq!(judge(&far).label, Label::SETTLED);
    }

    #[test]
    fn frames_before_the_steady_part_do_not_count() {
        let early = quiet(FRAMES).with_hole(WIDE, 0..START + 999);
        assert_eq!(judge(&early).label, Label::SETTLED);
        let enough = quiet(FRAMES).with_hole(WIDE, 0..START + 1000);
        assert_eq!(judge(&enough).label, Label::PINNED);
    }

    #[test]
    fn a_hole_is_wider_than_two_radii() {
        let border = (2.0 * RADIUS) as f32;
        let at = quiet(FRAMES).with_hole(border, 0..FRAMES);
        assert_eq!(judge(&at).label, Label::SETTLED);
        let beyond = quiet(FRAMES).with_hole(border.next_up(), 0..FRAMES);
        assert_eq!(judge(&beyond).label, Label::PINNED);
    }

    #[test]
    fn a_run_too_short_for_a_yes_has_no_evidence() {
        let frames = START + 1000;
        assert!(judge(&quiet(frames)).value("pinned_share").is_some());
        assert_eq!(judge(&quiet(frames - 1)).value("pinned_share"), None);
    }
}
