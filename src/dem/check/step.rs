//! The time step: whether it is stable, and the one that follows from a scene (`dt = "auto"`).

use crate::dem::timestep;
use crate::document::{Problem, accepted, number};
use crate::scene::{Scene, may_hold, multiple};

/// Default of `time.safety_factor`: the step divided by the smallest limit.
///
/// Altair's EDEM advises a fifth of the Rayleigh time for dense packings ("Estimate Simulation
/// Time" in its help). A fifth of the limit of twelve contacts, t_c / (2.015 sqrt(6)) with the
/// duration t_c of a Hertz contact, resolves the shortest contact with about 25 steps; a linear
/// contact, with t_c = pi / w, with 19.
pub(crate) const SAFETY_FACTOR: f64 = 0.2;

/// Steps per frame that can be counted exactly.
const MOST_STEPS: f64 = 9e15;

/// A frame is divided into at most this many parts to fit the feed's interval.
const MOST_PARTS: u32 = 1000;

/// Largest relative distance of a number of parts from a whole number: so small that no number of
/// parts fits by chance, and that a million steps still add up.
const ROUNDING: f64 = 1e-9;

impl Scene {
    pub(super) fn check_time_step(&self, problems: &mut Vec<Problem>) {
        let Some(limit) = timestep::largest_stable(self) else {
            return;
        };
        let dt = self.time.dt;
        if dt <= limit.seconds {
            return;
        }
        let message = format!(
            "`time.dt` = {} s is {:.3} times the {} limit of {:.3e} s, above which the motion is \
             unstable (limit: {}; impacts at up to {:.3} m/s)",
            number(dt),
            dt / limit.seconds,
            limit.name,
            limit.seconds,
            limit.explanation,
            timestep::fastest_impact(self),
        );
        // A round number of steps per frame, with some accuracy as well as stability.
        let frame = self.time.frame_interval;
        let parts = self.parts_of_a_frame().unwrap_or(libm::round(frame / dt));
        let steps = parts * round_up(2.0 * frame / (limit.seconds * parts));
        let intervals = self.intervals_of_steps();
        let divides = |dt: f64| intervals.iter().all(|(_, time)| multiple(*time, dt));
        let fits = |dt: f64| dt <= limit.seconds && divides(dt) && may_hold("time.dt", dt);
        let advised = accepted(frame / steps, fits);
        let help = match &advised {
            Some(dt) => {
                format!("use `dt = {dt}` or less: {steps} steps per frame, at most half the limit")
            }
            None => "use half the limit; if that is too short, use softer contacts or larger \
                     spheres"
                .to_owned(),
        };
        let most = match advised {
            Some(_) => frame / steps,
            None => 0.5 * limit.seconds,
        };
        problems.push(Problem::new("time.dt", message).help(help).at_most(most));
    }

    /// The largest step that divides all intervals and keeps `safety_factor` of every limit (s).
    pub(super) fn chosen_step(&self, safety_factor: f64) -> Result<f64, Problem> {
        let refuse = |message: String, help: &str| {
            let help = format!("{help}, or give `dt` as a number");
            Problem::new("time.dt", message).help(help)
        };
        if let Some(reason) = timestep::unbounded_speed(self) {
            let message = format!("`dt = \"auto\"` finds no fastest speed: {reason}");
            return Err(Problem::new("time.dt", message).help("give `dt` as a number"));
        }
        let least = timestep::least(self).ok_or_else(|| {
            let message =
                "`dt = \"auto\"` finds no limit of the time step: nothing in the scene sets one";
            Problem::new("time.dt", message).help("give `dt` as a number")
        })?;
        let frame = self.time.frame_interval;
        let parts = self.parts_of_a_frame().ok_or_else(|| {
            let times = self.intervals_of_steps().into_iter();
            let times = times.map(|(key, time)| format!("`{key}` = {} s", number(time)));
            let message = format!(
                "`dt = \"auto\"` finds no step that divides {}",
                times.collect::<Vec<_>>().join(" and ")
            );
            refuse(message, "make one a whole multiple of the other")
        })?;
        let longest = safety_factor * least.seconds;
        let mut steps = libm::ceil(frame / longest / parts).max(1.0) * parts;
        // The quotient may have been rounded down to a whole number.
        if frame / steps > longest {
            steps += parts;
        }
        if steps > MOST_STEPS {
            let message = format!(
                "`dt = \"auto\"` would make {steps:.0e} steps per frame for the {} limit of \
                 {:.3e} s",
                least.name, least.seconds
            );
            return Err(refuse(message, "use a shorter `frame_interval`"));
        }
        Ok(frame / steps)
    }

    /// The least number of equal parts of a frame such that every interval that must be a whole
    /// number of steps is a whole number of parts.
    fn parts_of_a_frame(&self) -> Option<f64> {
        let frame = self.time.frame_interval;
        let is_whole = |parts: f64| {
            let whole = libm::round(parts);
            whole >= 1.0 && (parts - whole).abs() <= ROUNDING * whole
        };
        let intervals = self.intervals_of_steps();
        (1..=MOST_PARTS).map(f64::from).find(|parts| {
            intervals
                .iter()
                .all(|(_, time)| is_whole(parts * time / frame))
        })
    }
}

/// The next of 1, 2, 5, 10, 20, 50 and so on.
fn round_up(value: f64) -> f64 {
    let mut decade = 1.0;
    while 10.0 * decade < value {
        decade *= 10.0;
    }
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * decade);
    steps
        .into_iter()
        .find(|step| *step >= value)
        .unwrap_or(value)
}
