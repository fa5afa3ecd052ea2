//! Whether the times of a scene are consistent.

use super::rounded;
use crate::document::{Problem, accepted, number};
use crate::scene::{Integrator, Output, Scene, Start, leaf, may_hold};

/// Two times count as commensurate if their ratio is a whole number within this.
const ROUNDING: f64 = 1e-6;

const FRAME_INTERVAL: &str = "time.frame_interval";

/// Largest number of frames: their observables are held in memory.
pub(super) const MOST_FRAMES: f64 = 1e7;

impl Scene {
    pub(super) fn check_times(&self, problems: &mut Vec<Problem>) {
        self.check_times_of_shaking(problems);
        let time = &self.time;
        let interval = time.frame_interval;
        if !multiple(time.duration, interval) {
            let name = "time.frame_interval";
            problems.push(not_multiple("time.duration", time.duration, name, interval));
        }
        if time.resolution.is_some() && time.integrator != Integrator::AdaptiveVerlet {
            let message = "`time.resolution` goes with `integrator = \"adaptive-verlet\"` only";
            let help = "use that integrator, or remove `resolution`";
            let problem = Problem::new("time.resolution", message).help(help);
            problems.push(problem.at_key());
        }
        let frames = time.duration / interval;
        if frames > MOST_FRAMES {
            let message = format!("the run would have {} frames", rounded(frames));
            let help = format!(
                "the maximum is {}; use a larger interval",
                number(MOST_FRAMES)
            );
            problems.push(Problem::new("time.frame_interval", message).help(help));
        }
        let snapshots = self.output.snapshot_interval;
        if snapshots > 0.0 && !multiple(snapshots, interval) {
            let unit = "time.frame_interval";
            let mut problem = not_multiple("output.snapshot_interval", snapshots, unit, interval);
            if snapshots == Output::default().snapshot_interval {
                let help = problem.help.unwrap_or_default();
                problem.help = Some(format!(
                    "{help} in [output]; a scene without the key has 1 s"
                ));
            }
            problems.push(problem);
        }
    }

    /// Events that happen at steps must not fall between them.
    pub(crate) fn check_whole_steps(&self, problems: &mut Vec<Problem>) {
        let (dt, safety_factor) = (self.time.dt, self.time.safety_factor);
        if safety_factor.is_some() {
            let message = "`time.safety_factor` goes with `dt = \"auto\"` only";
            let help = "use `dt = \"auto\"`, or remove `safety_factor`";
            let path = "time.safety_factor";
            problems.push(Problem::new(path, message).help(help).at_key());
        }
        for (path, interval) in self.intervals_of_steps() {
            if !multiple(interval, dt) {
                if path == FRAME_INTERVAL && self.times_of_shaking().is_some() {
                    problems.push(not_dividing(dt, interval));
                    continue;
                }
                problems.push(not_multiple(path, interval, "time.dt", dt));
            }
        }
    }

    /// The interval of frames and the duration (s), if the scene gives them in periods of its
    /// shaking.
    fn times_of_shaking(&self) -> Option<[f64; 2]> {
        let effects = &self.dem.effects;
        let shaking = effects.shaking.as_ref()?;
        let (interval, duration) = shaking.times(effects.gravity.as_ref())?;
        Some([interval, duration.unwrap_or(self.time.duration)])
    }

    /// Sets the times that the scene gives in periods of its shaking. A step that divides them but
    /// for its last digits becomes exact, so that frames keep their phases in long runs.
    pub(crate) fn set_times_of_shaking(&mut self) {
        let Some([interval, duration]) = self.times_of_shaking() else {
            return;
        };
        let time = &mut self.time;
        (time.frame_interval, time.duration) = (interval, duration);
        if multiple(interval, time.dt) {
            time.dt = interval / libm::round(interval / time.dt);
        }
    }

    /// A scene made by hand may hold other times than its keys say.
    fn check_times_of_shaking(&self, problems: &mut Vec<Problem>) {
        let present = [self.time.frame_interval, self.time.duration];
        if self.times_of_shaking().is_some_and(|it| it != present) {
            let message = "`time` does not hold the times that [shaking] gives in periods";
            let help = "remove `frames_per_period` and `periods`, or use `Scene::with_chosen_step`";
            let path = "shaking.frames_per_period";
            problems.push(Problem::new(path, message).help(help));
        }
    }

    /// Removes the keys that [`set_times_of_shaking`](Self::set_times_of_shaking) reads.
    pub(crate) fn forget_periods(&mut self) {
        if let Some(shaking) = &mut self.dem.effects.shaking {
            (shaking.frames_per_period, shaking.periods) = (None, None);
        }
    }

    /// The times (s) that must be whole numbers of steps, by their keys.
    pub(crate) fn intervals_of_steps(&self) -> Vec<(&'static str, f64)> {
        let mut intervals = vec![(FRAME_INTERVAL, self.time.frame_interval)];
        if let Start::Feed { interval, .. } = self.start {
            intervals.push(("start.interval", interval));
        }
        intervals
    }
}

/// A step (s) that does not divide the time (s) between frames at chosen phases of the shaking.
fn not_dividing(dt: f64, interval: f64) -> Problem {
    let steps = interval / dt;
    let message = format!(
        "`time.dt` = {} s must divide the time between frames, a period of the shaking over \
         `shaking.frames_per_period` = {} s, but there would be {} steps",
        number(dt),
        number(interval),
        rounded(steps)
    );
    let below = libm::floor(steps);
    let near = |whole: f64| accepted(interval / whole, |it| multiple(interval, it));
    let steps = [below + 1.0, below].into_iter().filter(|it| *it >= 1.0);
    let steps: Vec<String> = steps
        .filter_map(near)
        .map(|dt| format!("`dt = {dt}`"))
        .collect();
    let help = format!("use {} or `dt = \"auto\"`", steps.join(" or "));
    Problem::new("time.dt", message).help(help)
}

/// Whether `time` is a whole multiple of `unit`, at least 1.
pub(crate) fn multiple(time: f64, unit: f64) -> bool {
    let ratio = time / unit;
    let whole = libm::round(ratio);
    whole >= 1.0 && (ratio - whole).abs() <= ROUNDING * whole.min(1e3)
}

pub(super) fn not_multiple(path: &str, time: f64, unit_path: &str, unit: f64) -> Problem {
    let message = format!(
        "`{path}` = {} s must be a whole multiple of `{unit_path}` = {} s, but is {} times that",
        number(time),
        number(unit),
        rounded(time / unit)
    );
    let below = libm::floor(time / unit);
    let key = leaf(path);
    let near = |whole: f64| {
        let is_it = |it: f64| multiple(it, unit) && libm::round(it / unit) == whole;
        accepted(whole * unit, |it| is_it(it) && may_hold(path, it))
    };
    let multiples = [below, below + 1.0]
        .into_iter()
        .filter(|whole| *whole >= 1.0)
        .filter_map(near)
        .map(|time| format!("`{key} = {time}`"))
        .collect::<Vec<_>>();
    Problem::new(path, message).help(match multiples.is_empty() {
        true => format!("choose another `{key}` or another `{}`", leaf(unit_path)),
        false => format!("use {}", multiples.join(" or ")),
    })
}
