//! The fluid sieve: a surface that rises from the axis to the wall.

use super::run::TankRun;
use crate::classify::measure::{evidence, measures};
use crate::classify::sieve::{Sieve, Sifted, if_yes};
use crate::classify::{ClassifyError, Label, Measure, window};
use crate::document::unit;
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Thresholds of the fluid sieve (Rice, 2012, section 3.2).
///
/// A frame passes if each radial bin of the surface profile but `failures` of them is higher
/// than the next inner one by at least `rise` radii. An empty bin is lower than any other, and of
/// two empty neighbours none is higher. With no more comparisons than `failures`, every surface
/// would pass: the sieve does not act there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FluidSieve {
    /// Window (s).
    #[schemars(transform = unit("s").above(0.0))]
    pub window: f64,
    /// Least rise from a bin to the next outer one, in (mean) radii of the spheres.
    #[schemars(transform = unit(""))]
    pub rise: f64,
    /// Bins that may fail.
    pub failures: usize,
    /// Share of the window's frames that must pass.
    #[schemars(transform = unit("").at_least(0.0).at_most(1.0))]
    pub share: f64,
}

impl Default for FluidSieve {
    fn default() -> Self {
        Self {
            window: 1.5,
            rise: 0.1,
            failures: 1,
            share: 0.9,
        }
    }
}

impl Label {
    /// The surface rises from the axis to the wall.
    pub const FLUID: Self = Self::new(2, "fluid", 0x58_a6_e0);
}

measures! {
    /// Evidence of the fluid sieve; empty on a run too short for a yes.
    struct FluidEvidence {
        /// Largest share of passing frames of any fluid window; frames outside the steady part
        /// count as failing.
        fluid_share: evidence("share of fluid frames", ""),
        /// That share less the threshold.
        fluid_margin: evidence("margin of the fluid sieve", "").signed(),
    }
}

impl Sieve for FluidSieve {
    type Run<'a> = TankRun<'a>;

    const LABELS: &'static [Label] = &[Label::FLUID];

    const MEASURES: &'static [Measure] = FluidEvidence::MEASURES;

    fn check(&self, scene: &Scene) -> Result<(), ClassifyError> {
        window::check("fluid.window", self.window, scene.time.frame_interval)?;
        window::check_share("fluid.share", self.share)?;
        if !self.rise.is_finite() {
            return Err(ClassifyError::Threshold {
                key: "fluid.rise",
                value: self.rise,
                expected: "a number of radii".to_owned(),
            });
        }
        Ok(())
    }

    fn window(&self) -> Option<f64> {
        Some(self.window)
    }

    fn sift(&self, run: &mut TankRun<'_>) -> Sifted {
        let share = run.start.and_then(|start| self.largest_share(run, start));
        let evidence = FluidEvidence {
            fluid_share: share,
            fluid_margin: share.map(|share| share - self.share),
        };
        Sifted {
            label: if_yes(Label::FLUID, evidence.fluid_margin),
            values: evidence.values(),
        }
    }
}

impl FluidSieve {
    /// Largest share of passing frames of any window.
    fn largest_share(&self, run: &TankRun<'_>, start: usize) -> Option<f64> {
        let profile = &run.observations.profile;
        if profile.ncols() <= self.failures + 1 {
            return None;
        }
        let least = self.rise * run.radius;
        let passes: Vec<bool> = profile
            .rows()
            .into_iter()
            .skip(start)
            .map(|tops| {
                let falls = tops
                    .windows(2)
                    .into_iter()
                    .filter(|pair| !rises(pair[0], pair[1], least));
                falls.count() <= self.failures
            })
            .collect();
        window::largest_share(
            &passes,
            window::frames(self.window, run.interval),
            self.share,
        )
    }
}

/// Whether the top of a bin is at least `least` (m) above the top of the next inner one.
fn rises(inner: f32, outer: f32, least: f64) -> bool {
    match (inner.is_nan(), outer.is_nan()) {
        (_, true) => false,
        (true, false) => true,
        (false, false) => f64::from(outer) - f64::from(inner) >= least,
    }
}

#[cfg(test)]
mod tests {
    use crate::classify::tank::synthetic::{BINS, RADIUS, START, quiet};
    use crate::classify::{Label, Sieves, Verdict, classify};
    use crate::record::RunRecord;

    const FRAMES: usize = 4000;

    fn judge(record: &RunRecord) -> Verdict {
        classify(record, &Sieves::default()).unwrap()
    }

    /// A run with this surface, inner bin first, in all frames.
    fn surface(tops: [f32; BINS]) -> RunRecord {
        let mut record = quiet(FRAMES);
        for mut row in record.observations.profile.rows_mut() {
            row.assign(&ndarray::arr1(&tops));
        }
        record
    }

    #[test]
    fn nine_tenths_of_a_window_make_a_fluid() {
        let fluid = judge(&quiet(FRAMES).with_fluid(1000..2350));
        assert_eq!(fluid.label, Label::FLUID);
        assert_eq!(fluid.value("fluid_margin"), Some(0.0));

        let almost = judge(&quiet(FRAMES).with_fluid(1000..2349));
        assert_eq!(almost.label, Label::SETTLED);
        assert_eq!(almost.value("fluid_share"), Some(1349.0 / 1500.0));
        assert!(almost.value("fluid_margin").unwrap() < 0.0);
    }

    #[test]
    fn hits_must_lie_in_one_window() {
        // 1350 hits within 1500 frames, then within 1501.
        let near = quiet(FRAMES).with_fluid(1000..1675).with_fluid(1825..2500);
        assert_eq!(judge(&near).label, Label::FLUID);
        let far = quiet(FRAMES).with_fluid(1000..1675).with_fluid(1826..2501);
        assert_eq!(judge(&far).label, Label::SETTLED);
    }

    #[test]
    fn frames_before_the_steady_part_do_not_count() {
        let early = quiet(FRAMES).with_fluid(0..START + 1349);
        assert_eq!(judge(&early).label, Label::SETTLED);
        // No whole window needs to have passed.
        let enough = quiet(FRAMES).with_fluid(0..START + 1350);
        assert_eq!(judge(&enough).label, Label::FLUID);
    }

    #[test]
    fn a_run_too_short_for_a_yes_has_no_evidence() {
        let frames = START + 1350;
        assert!(judge(&quiet(frames)).value("fluid_share").is_some());
        assert_eq!(judge(&quiet(frames - 1)).value("fluid_share"), None);
        assert_eq!(judge(&quiet(frames - 1)).value("fluid_margin"), None);
    }

    #[test]
    fn one_bin_may_fail() {
        let slope = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0].map(|step| step * 1e-3);
        assert_eq!(judge(&surface(slope)).label, Label::FLUID);
        let mut one = slope;
        one[4] = 0.010;
        assert_eq!(judge(&surface(one)).label, Label::FLUID);
        let mut two = one;
        two[1] = 0.002;
        assert_eq!(judge(&surface(two)).label, Label::SETTLED);
    }

    #[test]
    fn a_step_counts_from_a_tenth_of_the_radius() {
        for (step, label) in [(1.001, Label::FLUID), (0.999, Label::SETTLED)] {
            let step = step * 0.1 * RADIUS as f32;
            let tops = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0].map(|bin| bin * step);
            assert_eq!(judge(&surface(tops)).label, label);
        }
    }

    #[test]
    fn an_empty_bin_is_lowest_and_two_empty_neighbours_fail() {
        let empty = f32::NAN;
        let hole = [empty, 0.001, 0.002, 0.003, 0.004, 0.005, 0.006, 0.007];
        assert_eq!(judge(&surface(hole)).value("fluid_share"), Some(1.0));
        // Below the bin inside it, above that outside: one failure.
        let gap = [0.0, 0.001, 0.002, empty, 0.004, 0.005, 0.006, 0.007];
        assert_eq!(judge(&surface(gap)).value("fluid_share"), Some(1.0));
        let wide_gap = [0.0, 0.001, empty, empty, 0.004, 0.005, 0.006, 0.007];
        assert_eq!(judge(&surface(wide_gap)).value("fluid_share"), Some(0.0));
        let wide_hole = [empty, empty, 0.002, 0.003, 0.004, 0.005, 0.006, 0.007];
        assert_eq!(judge(&surface(wide_hole)).value("fluid_share"), Some(1.0));
        let wider_hole = [empty, empty, empty, 0.003, 0.004, 0.005, 0.006, 0.007];
        assert_eq!(judge(&surface(wider_hole)).value("fluid_share"), Some(0.0));
    }

    #[test]
    fn too_few_bins_to_fail_are_no_fluid() {
        let mut record = quiet(FRAMES);
        record.observations.profile = ndarray::Array2::zeros((FRAMES, 2));
        let verdict = judge(&record);
        assert_eq!(verdict.label, Label::SETTLED);
        assert_eq!(verdict.value("fluid_share"), None);
    }
}
