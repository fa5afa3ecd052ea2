//! The part of a run that a rule looks at.

use crate::document::Problem;
use crate::record::RunRecord;
use crate::scene::{RuleWindow, Scene};
use std::ops::Range;

/// About how many values of a column the windows of a rule read.
const MOST_VALUES: usize = 20_000_000;

/// Share of a time by which it may be rounded.
const ROUNDING: f64 = 1e-9;

impl RuleWindow {
    /// What is wrong with it for runs of a scene.
    pub(super) fn check(&self, path: &str, scene: &Scene) -> Result<(), Problem> {
        let refuse = |key: &str, message: &str, help: &str| {
            let path = format!("{path}.{key}");
            Err(Problem::new(path, message).help(help))
        };
        let given = [
            self.last.is_some(),
            self.from.or(self.to).is_some(),
            self.any.is_some(),
            self.steady,
        ];
        if given.into_iter().filter(|it| *it).count() != 1 {
            let message = "the part of the run is not said in one way";
            return Err(Problem::new(path, message).help(
                "give `last`, or `from` and `to`, or `any`, or `steady = true`; for the whole run \
                 leave `over` out",
            ));
        }
        if self.steady && scene.steady.is_none() {
            let message = "runs of this scene do not end when they are steady";
            return refuse(
                "steady",
                message,
                "add [steady] to the scene, or use `last`",
            );
        }
        let end = scene.time.duration;
        if self.to.is_some_and(|to| to <= self.from.unwrap_or(0.0)) {
            return refuse("to", "`to` is not after `from`", "give a later time");
        }
        let times = [
            ("last", self.last),
            ("from", self.from),
            ("to", self.to),
            ("any", self.any),
        ];
        for (key, time) in times {
            if time.is_some_and(|it| it > end * (1.0 + ROUNDING)) {
                let message = format!("runs end after {end} s");
                return refuse(
                    key,
                    &message,
                    "use a shorter time, or run the scene for longer",
                );
            }
        }
        Ok(())
    }

    /// What is wrong with it for a measure, which is one number of a run.
    pub(super) fn check_is_one(&self, path: &str) -> Result<(), Problem> {
        let message = "a measure is one number, and there are many windows";
        let problem = Problem::new(format!("{path}.any"), message);
        match self.any {
            Some(_) => Err(problem.help("use `last`, or `from` and `to`")),
            None => Ok(()),
        }
    }

    /// The windows of a run that `any` means, by the frames at which they begin. Those of a long
    /// run begin so many frames apart that all together are read in a moment.
    pub(super) fn windows(&self, record: &RunRecord) -> Vec<Range<usize>> {
        let time = &record.observations.time;
        let (Some(length), Some(end)) = (self.any, time.last()) else {
            return Vec::new();
        };
        let slack = end * ROUNDING;
        let last = time.partition_point(|it| *it <= end - length + slack);
        let frames = |start: usize| {
            let until = time[start] + length + slack;
            start..time.partition_point(|it| *it <= until)
        };
        let longest = if last == 0 { 0 } else { frames(0).len() };
        let apart = (last * longest).div_ceil(MOST_VALUES).max(1);
        (0..last).step_by(apart).map(frames).collect()
    }

    /// The frames of a run; none if it has not the whole part.
    pub(super) fn frames(&self, record: &RunRecord) -> Range<usize> {
        let time = &record.observations.time;
        let end = time.last().copied().unwrap_or(0.0);
        let slack = end * ROUNDING;
        let last = match &record.scene.steady {
            Some(steady) if self.steady && record.is_steady() == Some(true) => Some(steady.window),
            _ if self.steady => return 0..0,
            _ => self.last,
        };
        let (from, to) = match last {
            Some(last) => (end - last, end),
            None => (self.from.unwrap_or(0.0), self.to.unwrap_or(end)),
        };
        if from < -slack || to > end + slack {
            return 0..0;
        }
        let first = time.partition_point(|it| *it < from - slack);
        first..time.partition_point(|it| *it <= to + slack)
    }
}
