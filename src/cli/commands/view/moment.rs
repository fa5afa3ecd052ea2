//! Which states a picture shows.

use crate::cli::exit::Failure;
use phase::observe::Snapshot;
use phase::record::{MilestoneKind, RunRecord};
use std::str::FromStr;

/// A moment of a run, as the command line names it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Moment {
    /// A time (s).
    Time(f64),
    /// Something that happened once.
    Milestone(MilestoneKind),
}

impl FromStr for Moment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let named = MilestoneKind::ALL.into_iter().find(|it| key(*it) == text);
        match (named, text.parse()) {
            (Some(kind), _) => Ok(Self::Milestone(kind)),
            (None, Ok(time)) => Ok(Self::Time(time)),
            (None, Err(_)) => Err(format!(
                "neither a time in seconds nor one of {}",
                MilestoneKind::ALL.map(key).join(", ")
            )),
        }
    }
}

/// Its name on the command line.
fn key(kind: MilestoneKind) -> String {
    kind.name().replace(' ', "-")
}

/// A time as text, with as many digits as the frames ask for.
pub(super) fn seconds(record: &RunRecord, time: f64) -> String {
    let interval = record.scene.time.frame_interval;
    let tenfold = std::iter::successors(Some(interval), |scaled| Some(10.0 * scaled));
    let digits = tenfold.take(18).position(|scaled| scaled >= 1.0 - 1e-9);
    format!("{time:.*}", digits.unwrap_or(18))
}

/// The same without zeros at its end.
pub(super) fn brief(record: &RunRecord, time: f64) -> String {
    let text = seconds(record, time);
    text.parse()
        .map_or(text, |rounded: f64| rounded.to_string())
}

/// At most that many states, spaced as evenly as possible, with the first and the last.
pub(super) fn evenly(states: &[Snapshot], most: usize) -> Vec<&Snapshot> {
    let count = states.len().min(most);
    if count < 2 {
        return states.iter().take(count).collect();
    }
    let at = |index: usize| &states[index * (states.len() - 1) / (count - 1)];
    (0..count).map(at).collect()
}

/// The states at these moments, in order of time. Times count from an origin (s).
///
/// # Errors
/// If there is no state at one of them.
pub(super) fn at<'a>(
    moments: &[Moment],
    record: &RunRecord,
    states: &'a [Snapshot],
    origin: f64,
) -> Result<Vec<&'a Snapshot>, Failure> {
    let mut shown = moments
        .iter()
        .map(|moment| match moment {
            Moment::Time(time) => nearest(*time, record, states, origin),
            Moment::Milestone(kind) => since(*kind, record, states),
        })
        .collect::<Result<Vec<_>, _>>()?;
    shown.sort_by(|a, b| a.time.total_cmp(&b.time));
    shown.dedup_by_key(|state| state.time.to_bits());
    Ok(shown)
}

/// The state nearest to a time.
fn nearest<'a>(
    time: f64,
    record: &RunRecord,
    states: &'a [Snapshot],
    origin: f64,
) -> Result<&'a Snapshot, Failure> {
    let (interval, unit) = (
        record.scene.time.frame_interval,
        record.scene.units().of_time(),
    );
    let (first, last) = (states[0].time, states[states.len() - 1].time);
    let [first, last] = [first, last].map(|end| end - origin);
    let distance = |state: &Snapshot| (state.time - origin - time).abs();
    states
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .filter(|_| time >= first - 0.5 * interval && time <= last + 0.5 * interval)
        .ok_or_else(|| {
            Failure::refused(format_args!(
                "no state at t = {time} {unit}: the record holds states from {} to {} {unit} ({} \
                 frames of {interval} {unit})",
                brief(record, first),
                brief(record, last),
                record.observations.frames()
            ))
        })
}

/// The first state since something happened, before anything else did.
fn since<'a>(
    kind: MilestoneKind,
    record: &RunRecord,
    states: &'a [Snapshot],
) -> Result<&'a Snapshot, Failure> {
    let unit = record.scene.units().of_time();
    let milestones = &record.milestones;
    let Some(milestone) = milestones.iter().find(|it| it.kind == kind) else {
        let known: Vec<String> = milestones.iter().map(|it| key(it.kind)).collect();
        return Err(Failure::refused(format_args!(
            "nothing in this run is `{}`: it has {}",
            key(kind),
            if known.is_empty() {
                "no milestones".to_owned()
            } else {
                known.join(", ")
            }
        )));
    };
    // The same instant, counted in steps and in frames, may differ in its last bits.
    let reached = |time: f64, state: &Snapshot| state.time > time - half_step(record);
    let next = milestones.iter().find(|it| it.time > milestone.time);
    states
        .iter()
        .find(|state| reached(milestone.time, state))
        .filter(|state| !next.is_some_and(|next| reached(next.time, state)))
        .ok_or_else(|| {
            let until = next.map_or(String::new(), |next| {
                format!(
                    " and before `{}` ({} {unit})",
                    key(next.kind),
                    brief(record, next.time)
                )
            });
            Failure::refused(format_args!(
                "no state after `{}` ({} {unit}){until}: store more states with `phase run \
                 --snapshot-interval`",
                key(kind),
                brief(record, milestone.time)
            ))
        })
}

/// The events between a state and the one before it.
pub(super) fn news<'a>(
    record: &'a RunRecord,
    state: &Snapshot,
) -> impl Iterator<Item = MilestoneKind> + 'a {
    let now = state.time + half_step(record);
    let states = record.states().all().iter();
    let before = states.rev().map(|state| state.time);
    let before = before.into_iter().find(|time| *time < state.time);
    let before = before.map_or(f64::NEG_INFINITY, |time| time + half_step(record));
    let news = record.milestones.iter();
    news.filter(move |it| it.time >= before && it.time < now)
        .map(|it| it.kind)
}

fn half_step(record: &RunRecord) -> f64 {
    0.5 * record.scene.time.dt
}
