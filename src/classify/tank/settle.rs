//! The settle sieve: from when a run counts as steady.

use super::run::TankRun;
use crate::classify::measure::{evidence, measured, measures};
use crate::classify::sieve::{Sieve, Sifted};
use crate::classify::{ClassifyError, Label, Measure, window};
use crate::document::unit;
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Thresholds of the settle sieve (Rice, 2012, section 3.1).
///
/// A run is settled in a window in which no centre is above `height` and the energy of the
/// spheres (kinetic, rotational and gravitational) changes little: its change from frame to frame,
/// per millisecond and sphere, is at most `tolerance` m g R on average. The other sieves act on
/// what follows the middle of the first such window.
///
/// Fast spheres exchange energies of many m g R with the air, however steady they are. So a run
/// without such a window is settled in the first `drift_window` from which to the end of the run no
/// centre is above `height` and the energy of motion (kinetic and rotational) drifts slowly in each
/// such window: the means of its two halves differ by at most `drift` times their mean in a second.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SettleSieve {
    /// Window (s).
    #[schemars(transform = unit("s").above(0.0))]
    pub window: f64,
    /// No centre may be above this height (m) in the window.
    #[schemars(transform = unit("m"))]
    pub height: f64,
    /// Largest mean over the window of |change of the energy per sphere and millisecond| over
    /// m g R. With frames of another interval, the change is scaled to one millisecond.
    #[schemars(transform = unit("").above(0.0))]
    pub tolerance: f64,
    /// Window of the drift (s).
    #[schemars(transform = unit("s").above(0.0))]
    pub drift_window: f64,
    /// Largest |drift of the energy of motion| over that energy (1/s).
    #[schemars(transform = unit("1/s").above(0.0))]
    pub drift: f64,
}

impl Default for SettleSieve {
    fn default() -> Self {
        Self {
            window: 0.5,
            height: 0.20,
            tolerance: 1e-3,
            drift_window: 2.0,
            drift: 0.02,
        }
    }
}

impl Label {
    /// Steady, and in no state that has a name.
    pub const SETTLED: Self = Self::new(1, "settled", 0xe2_bd_6c);
}

measures! {
    /// Evidence of the settle sieve.
    struct Settling {
        /// Time from which the run counts as steady (s): the middle of the first steady window, or
        /// the beginning of the window of [steady].
        settle_time: measured("settle time", "s"),
        /// Least mean energy change of any window in which all spheres are low enough, over the
        /// tolerance; yes up to 1. Empty if there is no such window.
        settle_change: evidence("least change of energy / tolerance", ""),
        /// Of a run with no window of so small a change: drift of the energy of motion in its last
        /// drift window, over the threshold; yes up to 1. Empty if a sphere is too high in it.
        settle_drift: evidence("last drift of the energy of motion / threshold", ""),
    }
}

impl Sieve for SettleSieve {
    type Run<'a> = TankRun<'a>;

    const LABELS: &'static [Label] = &[Label::SETTLED];

    const MEASURES: &'static [Measure] = Settling::MEASURES;

    fn check(&self, scene: &Scene) -> Result<(), ClassifyError> {
        let interval = scene.time.frame_interval;
        window::check("settle.window", self.window, interval)?;
        // A drift is the difference of two halves.
        window::check_of("settle.drift_window", self.drift_window, interval, 2)?;
        let invalid = |key, value, expected: &str| ClassifyError::Threshold {
            key,
            value,
            expected: expected.to_owned(),
        };
        if self.height.is_nan() {
            return Err(invalid("settle.height", self.height, "a height in metres"));
        }
        let thresholds = [
            ("settle.tolerance", self.tolerance),
            ("settle.drift", self.drift),
        ];
        for (key, value) in thresholds {
            if !value.is_finite() || value <= 0.0 {
                return Err(invalid(key, value, "a number above 0"));
            }
        }
        Ok(())
    }

    fn window(&self) -> Option<f64> {
        Some(self.window)
    }

    fn sift(&self, run: &mut TankRun<'_>) -> Sifted {
        let (start, settling) = match run.steady {
            Some(from) => self.steady_part(run, from),
            None => self.first_steady_part(run),
        };
        run.start = start;
        Sifted {
            label: start.map(|_| Label::SETTLED),
            values: settling.values(),
        }
    }
}

impl SettleSieve {
    /// A run that is steady from this frame on by the scene's own test. It is settled there unless
    /// a sphere is too high in every window since then.
    fn steady_part(&self, run: &TankRun<'_>, from: usize) -> (Option<usize>, Settling) {
        let (_, least) = self.first_window(run, &self.high(run), from);
        let start = least.map(|_| from);
        let settling = Settling {
            settle_time: start.map(|frame| run.time(frame)),
            settle_change: least,
            settle_drift: None,
        };
        (start, settling)
    }

    /// Whether a sphere is too high (1, else 0), at each frame but the first.
    fn high(&self, run: &TankRun<'_>) -> Vec<f64> {
        // Single precision, as the heights: a centre at the limit is not above it.
        let limit = self.height as f32;
        let heights = run.observations.height_max.iter().skip(1);
        heights.map(|&z| f64::from(u8::from(z > limit))).collect()
    }

    /// The first window from a frame on that is steady and low, counted from that frame, and the
    /// least evidence of any that is low.
    fn first_window(
        &self,
        run: &TankRun<'_>,
        high: &[f64],
        from: usize,
    ) -> (Option<usize>, Option<f64>) {
        let window = window::frames(self.window, run.interval);
        let changes = changes(run);
        let [changes, high] = [&changes[..], high].map(|it| it.get(from..).unwrap_or_default());
        let sums = window::sums(changes, window).into_iter();
        let evidence = sums.map(|change| change / window as f64 / self.tolerance);
        first_steady(evidence, window::sums(high, window))
    }

    /// Looks for the first steady window of a run: the first frame of the steady part.
    fn first_steady_part(&self, run: &TankRun<'_>) -> (Option<usize>, Settling) {
        let window = window::frames(self.window, run.interval);
        let high = self.high(run);
        let (start, least) = self.first_window(run, &high, 0);
        // Changes and drifts are counted from the second frame.
        let middle = |window: usize| move |first: usize| 1 + first + window / 2;
        let mut start = start.map(middle(window));

        let mut drift = None;
        if start.is_none() {
            let window = window::frames(self.drift_window, run.interval);
            let drifts = drifts(run, window).into_iter();
            let drifts = drifts.map(|drift| drift / self.drift);
            (start, drift) = steady_to_the_end(drifts, window::sums(&high, window));
            start = start.map(middle(window));
        }
        let settling = Settling {
            settle_time: start.map(|frame| run.time(frame)),
            settle_change: least,
            settle_drift: drift,
        };
        (start, settling)
    }
}

/// The first window that is steady and low, and the least evidence of any that is low. Evidence up
/// to 1 is steady; a window is low in which the number of frames with a sphere too high is zero.
fn first_steady(
    evidence: impl Iterator<Item = f64>,
    highs: Vec<f64>,
) -> (Option<usize>, Option<f64>) {
    let (mut start, mut least) = (None, None);
    let windows = evidence.zip(highs).enumerate();
    for (first, (value, _)) in windows.filter(|(_, (_, high))| *high == 0.0) {
        least = Some(least.map_or(value, |least: f64| least.min(value)));
        if start.is_none() && value <= 1.0 {
            start = Some(first);
        }
    }
    (start, least)
}

/// The first window from which on all are steady and low, and the evidence of the last one if it is
/// low.
fn steady_to_the_end(
    evidence: impl Iterator<Item = f64>,
    highs: Vec<f64>,
) -> (Option<usize>, Option<f64>) {
    let windows: Vec<(f64, f64)> = evidence.zip(highs).collect();
    let not_steady = |&(value, high): &(f64, f64)| value > 1.0 || high > 0.0;
    let first = windows
        .iter()
        .rposition(not_steady)
        .map_or(0, |last| last + 1);
    let last = windows.last().filter(|(_, high)| *high == 0.0);
    let start = (first < windows.len()).then_some(first);
    (start, last.map(|(value, _)| *value))
}

/// |Drift of the energy of motion| over that energy (1/s) in each window, from the second frame on:
/// from the means of its first and its last half.
fn drifts(run: &TankRun<'_>, window: usize) -> Vec<f64> {
    let observations = run.observations;
    let energies = (1..run.frames()).map(|frame| {
        f64::from(observations.kinetic[frame]) + f64::from(observations.rotational[frame])
    });
    let half = window / 2;
    let sums = window::sums(&energies.collect::<Vec<f64>>(), half);
    // Between the middles of both halves.
    let apart = window - half;
    let time = apart as f64 * run.interval;
    let pairs = sums.iter().zip(sums.iter().skip(apart));
    pairs
        .map(|(&first, &last)| match first + last > 0.0 {
            true => 2.0 * (last - first).abs() / (first + last) / time,
            false => 0.0,
        })
        .collect()
}

/// |Change of energy| over M g R per millisecond (M: mass of all spheres), into each frame but
/// the first.
fn changes(run: &TankRun<'_>) -> Vec<f64> {
    let observations = run.observations;
    let energy = |frame: usize| {
        f64::from(observations.kinetic[frame])
            + f64::from(observations.rotational[frame])
            + f64::from(observations.gravitational[frame])
    };
    let milliseconds = run.interval / 1e-3;
    let unit = run.mass * run.gravity * run.tank_radius * milliseconds;
    (1..run.frames())
        .map(|frame| (energy(frame) - energy(frame - 1)).abs() / unit)
        .collect()
}

#[cfg(test)]
mod tests {
    use crate::classify::tank::synthetic::{ENERGY_UNIT, START, quiet};
    use crate::classify::{ClassifyError, Label, Sieves, Verdict, classify};
    use crate::record::RunRecord;

    fn judge(record: &RunRecord) -> Verdict {
        classify(record, &Sieves::default()).unwrap()
    }

    /// A quiet run whose energy jumps to and fro in all frames, by this over m g R per sphere.
    fn restless(jump: f64) -> RunRecord {
        let mut record = quiet(1000);
        let energies = &mut record.observations.kinetic;
        for energy in energies.iter_mut().skip(1).step_by(2) {
            *energy = (256.0 * ENERGY_UNIT * jump) as f32;
        }
        record
    }

    #[test]
    fn a_run_settles_in_the_middle_of_its_first_steady_window() {
        let verdict = judge(&quiet(1000));
        assert_eq!(verdict.label, Label::SETTLED);
        assert_eq!(verdict.value("settle_time"), Some(START as f64 * 1e-3));
        assert_eq!(verdict.value("settle_change"), Some(0.0));
    }

    #[test]
    fn a_window_needs_all_its_frames() {
        // A change into each of 500 frames, that is 501 frames.
        assert_eq!(judge(&quiet(501)).label, Label::SETTLED);
        let short = judge(&quiet(500));
        assert_eq!(short.label, Label::UNSETTLED);
        assert_eq!(short.value("settle_change"), None);
        assert_eq!(judge(&quiet(0)).label, Label::UNSETTLED);
    }

    #[test]
    fn energy_changes_count_up_to_the_tolerance() {
        for (jump, label) in [(0.99e-3, Label::SETTLED), (1.01e-3, Label::UNSETTLED)] {
            let verdict = judge(&restless(jump));
            assert_eq!(verdict.label, label);
            let change = verdict.value("settle_change").unwrap();
            assert!((change - jump / 1e-3).abs() < 1e-5, "{change}");
        }
    }

    /// A run of fast spheres, a thousand m g R each, that gain this share of their energy in a
    /// second while it jumps to and fro.
    fn fast(gain: f64) -> RunRecord {
        let mut record = quiet(4000);
        let energies = &mut record.observations.kinetic;
        for (frame, energy) in energies.iter_mut().enumerate() {
            let jump = 4e-3 * (frame % 2) as f64;
            let own = 1000.0 * (1.0 + gain * (frame as f64 - 1000.0) * 1e-3);
            *energy = (256.0 * ENERGY_UNIT * (own + jump)) as f32;
        }
        record
    }

    /// Steel at the wall of a fast vortex was unsettled for ever, though its energy stood still to
    /// a thousandth: its changes were measured by m g R, a seven hundredth of that energy.
    #[test]
    fn fast_spheres_settle_by_their_own_energy() {
        for (gain, label) in [
            (0.0, Label::SETTLED),
            (0.019, Label::SETTLED),
            (-0.019, Label::SETTLED),
            (0.5, Label::UNSETTLED),
        ] {
            let verdict = judge(&fast(gain));
            assert_eq!(verdict.label, label, "{gain}");
            assert!(verdict.value("settle_change").unwrap() > 1.0, "{gain}");
            let drift = verdict.value("settle_drift").unwrap();
            assert_eq!(drift <= 1.0, label == Label::SETTLED, "{gain}: {drift}");
        }
        assert_eq!(judge(&fast(0.0)).value("settle_time"), Some(1001.0 * 1e-3));
        // Where changes are small by m g R, nothing else is looked at.
        assert_eq!(judge(&quiet(4000)).value("settle_drift"), None);
    }

    /// A drift window of one frame has no halves, and found nothing without a word.
    #[test]
    fn a_drift_window_of_one_frame_is_refused() {
        let mut sieves = Sieves::default();
        for (window, is_refused) in [(1e-3, true), (2e-3, false)] {
            sieves.settle.drift_window = window;
            let found = classify(&quiet(1000), &sieves);
            let key = found.err().map(|error| match error {
                ClassifyError::Threshold { key, .. } => key,
                other => panic!("{other}"),
            });
            assert_eq!(key, is_refused.then_some("settle.drift_window"));
        }
    }

    /// The energy of spheres that fall and bounce has a maximum, about which it drifts slowly.
    #[test]
    fn fast_spheres_that_slow_down_again_do_not_settle() {
        let mut record = fast(0.0);
        for (frame, energy) in record.observations.kinetic.iter_mut().enumerate() {
            let time = frame as f64 * 1e-3 - 1.5;
            *energy *= (1.0 - 0.2 * time * time) as f32;
        }
        let verdict = judge(&record);
        assert_eq!(verdict.label, Label::UNSETTLED);
        assert!(verdict.value("settle_drift").unwrap() > 1.0);
    }

    #[test]
    fn fast_spheres_above_the_height_do_not_settle() {
        let mut record = fast(0.0);
        record.observations.height_max.fill(0.3);
        assert_eq!(judge(&record).label, Label::UNSETTLED);
        assert_eq!(judge(&record).value("settle_drift"), None);
    }

    #[test]
    fn all_three_energies_count_and_the_elastic_does_not() {
        for name in ["kinetic", "rotational", "gravitational", "elastic"] {
            let mut record = quiet(1000);
            let energies = std::mem::take(&mut restless(2e-3).observations.kinetic);
            *record.observations.scalar_mut(name).unwrap() = energies;
            let settled = judge(&record).label == Label::SETTLED;
            assert_eq!(settled, name == "elastic", "{name}");
        }
    }

    #[test]
    fn changes_are_per_millisecond_whatever_the_frames() {
        let mut record = restless(4e-3);
        record.scene.time.frame_interval = 5e-3;
        let change = judge(&record).value("settle_change").unwrap();
        assert!((change - 0.8).abs() < 1e-5, "{change}");
    }

    #[test]
    fn one_jump_delays_the_run_until_its_window_tolerates_it() {
        // On average over 500 frames this is 1.2 times the tolerance: the window must begin
        // after the frame it leads into.
        let mut record = quiet(2000);
        record.observations.gravitational[300..].fill((256.0 * ENERGY_UNIT * 0.6) as f32);
        assert_eq!(judge(&record).value("settle_time"), Some(551.0 * 1e-3));
    }

    #[test]
    fn a_sphere_may_be_at_the_height_but_not_above() {
        let mut record = quiet(2000);
        record.observations.height_max.fill(0.2);
        assert_eq!(
            judge(&record).value("settle_time"),
            Some(START as f64 * 1e-3)
        );
        record.observations.height_max[400] = 0.200_001;
        assert_eq!(judge(&record).value("settle_time"), Some(651.0 * 1e-3));
        record.observations.height_max.fill(0.3);
        let high = judge(&record);
        assert_eq!(high.label, Label::UNSETTLED);
        assert_eq!(high.value("settle_change"), None);
    }

    #[test]
    fn without_gravity_there_is_no_energy_scale() {
        let mut record = quiet(1000);
        record.scene.dem.effects.gravity = None;
        let error = classify(&record, &Sieves::default()).unwrap_err();
        assert!(matches!(error, ClassifyError::NoEnergyScale { .. }));
        assert!(
            error.to_string().contains("`gravity.acceleration`"),
            "{error}"
        );
    }

    #[test]
    fn spheres_without_a_tank_are_judged_by_no_sieve() {
        let mut record = quiet(1000);
        record.scene.tank = None;
        let verdict = classify(&record, &Sieves::default()).unwrap();
        assert_eq!(verdict.label, Label::STABLE);
        let unstable = classify(&record.unstable(), &Sieves::default()).unwrap();
        assert_eq!(unstable.label, Label::UNSTABLE);
    }

    #[test]
    fn thresholds_out_of_range_are_named() {
        let mut sieves = Sieves::default();
        sieves.settle.tolerance = 0.0;
        let error = sieves.check(&quiet(0).scene).unwrap_err();
        assert_eq!(
            error.to_string(),
            "`sieves.settle.tolerance` is 0, but must be a number above 0"
        );
    }
}
