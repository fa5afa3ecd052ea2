//! The spout sieve: spheres that keep rising in the middle.

use super::run::TankRun;
use crate::classify::measure::{evidence, measures};
use crate::classify::sieve::{Sieve, Sifted};
use crate::classify::{ClassifyError, Label, Measure, window};
use crate::document::unit;
use crate::scene::{Output, Scene};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Thresholds of the spout sieve (Rice, 2012, section 3.4).
///
/// The earliest window decides in every frame of which at least `least` spheres rise, and fewer
/// than the share `large` of all: for a small spout if they are fewer than the share `small` in
/// every frame, else for a large one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SpoutSieve {
    /// Window (s).
    #[schemars(transform = unit("s").above(0.0))]
    pub window: f64,
    /// Rise speed relative to the mean, in radii per second; one of the scene's
    /// `output.rise_speeds`.
    #[schemars(transform = unit("1/s"))]
    pub rise_speed: f64,
    /// Distance from the axis over R; one of the scene's `output.rise_radii`.
    #[schemars(transform = unit("").above(0.0))]
    pub radius: f64,
    /// Least number of rising spheres in every frame.
    pub least: usize,
    /// A small spout stays below this share of all spheres in every frame.
    #[schemars(transform = unit("").at_least(0.0).at_most(1.0))]
    pub small: f64,
    /// A spout stays below this share of all spheres in every frame; more is chaos.
    #[schemars(transform = unit("").at_least(0.0).at_most(1.0))]
    pub large: f64,
}

impl Default for SpoutSieve {
    fn default() -> Self {
        Self {
            window: 2.0,
            rise_speed: 10.0,
            radius: 0.75,
            least: 5,
            small: 0.125,
            large: 0.25,
        }
    }
}

impl Label {
    /// A few spheres rise in the middle.
    pub const SMALL_SPOUT: Self = Self::new(4, "small-spout", 0x98_2c_74);

    /// Many spheres rise in the middle.
    pub const LARGE_SPOUT: Self = Self::new(5, "large-spout", 0x3a_14_57);
}

measures! {
    /// Evidence of the spout sieve; empty where the run leaves no room for a window.
    struct SpoutEvidence {
        /// Largest share of frames that qualify as a spout of any spout window.
        spout_share: evidence("share of frames with a spout", ""),
        /// Longest time without a frame that does not qualify as a spout, over the window, less 1.
        spout_margin: evidence("margin of the spout sieve", "").signed(),
        /// Largest number of rising spheres in the window that decided for a spout, over all
        /// spheres: a small spout below the threshold `small`. Empty without a spout.
        spout_peak: evidence("most rising spheres / $n$", ""),
    }
}

impl Sieve for SpoutSieve {
    type Run<'a> = TankRun<'a>;

    const LABELS: &'static [Label] = &[Label::SMALL_SPOUT, Label::LARGE_SPOUT];

    const MEASURES: &'static [Measure] = SpoutEvidence::MEASURES;

    fn check(&self, scene: &Scene) -> Result<(), ClassifyError> {
        window::check("spout.window", self.window, scene.time.frame_interval)?;
        for (key, share) in [("spout.small", self.small), ("spout.large", self.large)] {
            if share.is_nan() || share < 0.0 {
                return Err(ClassifyError::Threshold {
                    key,
                    value: share,
                    expected: "a share of the spheres, 0 or more".to_owned(),
                });
            }
        }
        self.column(&scene.output).map(|_| ())
    }

    fn window(&self) -> Option<f64> {
        Some(self.window)
    }

    fn sift(&self, run: &mut TankRun<'_>) -> Sifted {
        let found = run.start.map(|start| self.earliest(run, start));
        let (label, evidence) = found.unwrap_or_default();
        Sifted {
            label,
            values: evidence.values(),
        }
    }
}

impl SpoutSieve {
    /// Where the observable `rising` holds what this sieve needs: its indices of the distance
    /// and of the speed.
    pub(super) fn column(&self, output: &Output) -> Result<(usize, usize), ClassifyError> {
        let place = |key, value, list, counted: &[f64]| {
            let found = counted.iter().position(|&it| it == value);
            found.ok_or_else(|| ClassifyError::NotCounted {
                key,
                value,
                list,
                counted: counted.to_vec(),
            })
        };
        Ok((
            place("radius", self.radius, "rise_radii", &output.rise_radii)?,
            place(
                "rise_speed",
                self.rise_speed,
                "rise_speeds",
                &output.rise_speeds,
            )?,
        ))
    }

    /// Looks for the earliest window with a spout from frame `start` on: its label, if there is
    /// one.
    fn earliest(&self, run: &TankRun<'_>, start: usize) -> (Option<Label>, SpoutEvidence) {
        let window = window::frames(self.window, run.interval);
        let count = run.count as f64;
        let below = |rising: usize, share: f64| (rising as f64) < share * count;
        // A rise takes two frames, so the first one counted is that into the second.
        let rising: Vec<usize> = run
            .rising
            .iter()
            .skip(start + 1)
            .map(|&it| usize::from(it))
            .collect();
        if rising.len() < window {
            return Default::default();
        }
        let qualifies: Vec<bool> = rising
            .iter()
            .map(|&it| it >= self.least && below(it, self.large))
            .collect();

        let (mut stretch, mut longest, mut deciding) = (0, 0, None);
        for (frame, &qualified) in qualifies.iter().enumerate() {
            stretch = if qualified { stretch + 1 } else { 0 };
            longest = longest.max(stretch);
            if stretch == window && deciding.is_none() {
                deciding = Some(&rising[frame + 1 - window..=frame]);
            }
        }
        let peak = deciding.and_then(|window| window.iter().copied().max());
        let peak = peak.map(|peak| peak as f64 / count);
        // By the stored evidence, so that it tells the label for any threshold.
        let label = peak.map(|peak| match peak < self.small {
            true => Label::SMALL_SPOUT,
            false => Label::LARGE_SPOUT,
        });
        let evidence = SpoutEvidence {
            spout_share: window::largest_share(&qualifies, window, 1.0),
            spout_margin: Some(longest as f64 / window as f64 - 1.0),
            spout_peak: peak,
        };
        (label, evidence)
    }
}

#[cfg(test)]
mod tests {
    use crate::classify::tank::synthetic::{START, quiet};
    use crate::classify::{ClassifyError, Label, Sieves, Verdict, classify};
    use crate::record::RunRecord;

    const FRAMES: usize = 5000;

    fn judge(record: &RunRecord) -> Verdict {
        classify(record, &Sieves::default()).unwrap()
    }

    #[test]
    fn every_frame_of_a_window_must_qualify() {
        let spout = judge(&quiet(FRAMES).with_rising(5, 500..2500));
        assert_eq!(spout.label, Label::SMALL_SPOUT);
        assert_eq!(spout.value("spout_share"), Some(1.0));
        assert_eq!(spout.value("spout_margin"), Some(0.0));
        assert_eq!(spout.value("spout_peak"), Some(5.0 / 256.0));

        let short = judge(&quiet(FRAMES).with_rising(5, 500..2499));
        assert_eq!(short.label, Label::SETTLED);
        assert_eq!(short.value("spout_share"), Some(0.9995));
        assert!(short.value("spout_margin").unwrap() < 0.0);
        assert_eq!(short.value("spout_peak"), None);

        let gap = judge(
            &quiet(FRAMES)
                .with_rising(5, 500..4000)
                .with_rising(4, 2000..2001),
        );
        assert_eq!(gap.label, Label::SETTLED);
        assert_eq!(gap.value("spout_share"), Some(0.9995));
        assert_eq!(gap.value("spout_margin"), Some(1999.0 / 2000.0 - 1.0));
    }

    #[test]
    fn the_counts_decide_at_their_borders() {
        // n/8 = 32 and n/4 = 64.
        for (count, label) in [
            (4, Label::SETTLED),
            (5, Label::SMALL_SPOUT),
            (31, Label::SMALL_SPOUT),
            (32, Label::LARGE_SPOUT),
            (63, Label::LARGE_SPOUT),
            (64, Label::SETTLED),
        ] {
            let record = quiet(FRAMES).with_rising(count, 0..FRAMES);
            assert_eq!(judge(&record).label, label, "{count}");
        }
    }

    #[test]
    fn one_frame_makes_a_spout_large() {
        let record = quiet(FRAMES)
            .with_rising(10, 0..FRAMES)
            .with_rising(32, 1000..1001);
        assert_eq!(judge(&record).label, Label::LARGE_SPOUT);
        assert_eq!(judge(&record).value("spout_peak"), Some(0.125));
    }

    #[test]
    fn the_earliest_window_decides() {
        let decided = START + 1 + 2000;
        let after = quiet(FRAMES)
            .with_rising(10, 0..FRAMES)
            .with_rising(40, decided..FRAMES);
        assert_eq!(judge(&after).label, Label::SMALL_SPOUT);
        let within = quiet(FRAMES)
            .with_rising(10, 0..FRAMES)
            .with_rising(40, decided - 1..FRAMES);
        assert_eq!(judge(&within).label, Label::LARGE_SPOUT);
        // Chaos delays the earliest window.
        let chaos = after.with_rising(64, decided - 1..decided);
        assert_eq!(judge(&chaos).label, Label::LARGE_SPOUT);
    }

    #[test]
    fn a_rise_takes_two_frames() {
        let frames = START + 1 + 2000;
        let enough = quiet(frames).with_rising(10, 0..frames);
        assert_eq!(judge(&enough).label, Label::SMALL_SPOUT);
        let short = judge(&quiet(frames - 1).with_rising(10, 0..frames - 1));
        assert_eq!(short.label, Label::SETTLED);
        assert_eq!(short.value("spout_share"), None);
        assert_eq!(short.value("spout_margin"), None);
    }

    #[test]
    fn thresholds_choose_among_what_was_counted() {
        let mut sieves = Sieves::default();
        sieves.spout.rise_speed = 20.0;
        sieves.spout.radius = 0.5;
        let mut record = quiet(FRAMES);
        let counts = &mut record.observations.rising;
        counts
            .slice_each_axis_mut(|axis| match axis.axis.index() {
                1 => ndarray::Slice::from(0..1),
                2 => ndarray::Slice::from(2..3),
                _ => ndarray::Slice::from(..),
            })
            .fill(10);
        assert_eq!(judge(&record).label, Label::SETTLED);
        assert_eq!(
            classify(&record, &sieves).unwrap().label,
            Label::SMALL_SPOUT
        );

        sieves.spout.rise_speed = 12.0;
        let error = classify(&record, &sieves).unwrap_err();
        assert!(matches!(error, ClassifyError::NotCounted { .. }));
        assert!(error.to_string().contains("12"), "{error}");
        assert!(error.to_string().contains("[5.0, 10.0, 20.0]"), "{error}");
    }
}
