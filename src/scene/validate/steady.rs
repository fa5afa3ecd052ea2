//! Whether runs of a scene can become steady.

use crate::document::{Problem, at_least, number};
use crate::scene::Scene;
use crate::statistics::LEAST_VALUES;

impl Scene {
    pub(super) fn check_steady(&self, problems: &mut Vec<Problem>) {
        let Some(steady) = &self.steady else { return };
        let mut refuse = |path: &str, message: String, help: String| {
            problems.push(Problem::new(path, message).help(help));
        };
        if self.spot.is_some() || self.has_flow() {
            let message = match self.spot {
                Some(_) => "[steady] uses energy and rotation, which spots do not have",
                None => {
                    "[steady] uses the rotation and the mean height of spheres that stay, but here \
                        they come or go"
                }
            };
            let help = "remove [steady]: the run ends at its duration, or when nothing is left to \
                        happen";
            refuse("steady", message.to_owned(), help.to_owned());
            return;
        }
        let time = &self.time;
        let window = steady.frames_of_window(time.frame_interval);
        let frames = window.saturating_add(1);
        if frames < LEAST_VALUES as u64 {
            let message = format!(
                "`steady.window` = {} s has {frames} frames of `time.frame_interval` = {} s, too \
                    few to detect a trend",
                number(steady.window),
                number(time.frame_interval),
            );
            let least = (LEAST_VALUES - 1) as f64 * time.frame_interval;
            let help = format!(
                "use `window = {}` or more, or a shorter `frame_interval`",
                at_least(least)
            );
            refuse("steady.window", message, help);
        }
        if steady.window > time.duration {
            let message = format!(
                "`steady.window` = {} s is longer than the run, `time.duration` = {} s, which \
                 could never become steady",
                number(steady.window),
                number(time.duration),
            );
            let help = "use a longer duration: the run ends as soon as it is steady";
            refuse("steady.window", message, help.to_owned());
        }
        if steady.check_interval > time.duration {
            let message = format!(
                "`steady.check_interval` = {} s is longer than the run, `time.duration` = {} s, \
                 which would never be checked",
                number(steady.check_interval),
                number(time.duration),
            );
            refuse(
                "steady.check_interval",
                message,
                "use a shorter one".to_owned(),
            );
            return;
        }
        let check = steady.frames_per_check(time.frame_interval);
        let last = time.frames() / check * check;
        if steady.window <= time.duration && last < window {
            let message = format!(
                "the last check, after {} s, comes before `steady.window` = {} s is over, so that \
                 the run could never become steady",
                number(last as f64 * time.frame_interval),
                number(steady.window),
            );
            let help = "use a shorter `check_interval`, or a longer `time.duration`";
            refuse("steady.check_interval", message, help.to_owned());
        }
    }
}
