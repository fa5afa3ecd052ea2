//! The part of a run that a rule looks at.

use crate::document::{Problem, unit};
use crate::record::RunRecord;
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The part of a run that a rule looks at: `{ last = 2.0 }`, `{ from = 1.0, to = 3.0 }` or
/// `{ steady = true }`. In a run that is shorter nothing is known.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RuleWindow {
    /// The time before the end (s).
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = unit("s").above(0.0))]
    pub last: Option<f64>,
    /// From this time on (s).
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = unit("s").at_least(0.0))]
    pub from: Option<f64>,
    /// Until this time (s). Absent: the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = unit("s").above(0.0))]
    pub to: Option<f64>,
    /// The steady part at the end, of a scene whose runs end when they are steady.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub steady: bool,
}

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
            self.steady,
        ];
        if given.into_iter().filter(|it| *it).count() != 1 {
            let message = "the part of the run is not said in one way";
            return Err(Problem::new(path, message).help(
                "give `last`, or `from` and `to`, or `steady = true`; for the whole run leave \
                 `over` out",
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
        for (key, time) in [("last", self.last), ("from", self.from), ("to", self.to)] {
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
