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
mod tests;
