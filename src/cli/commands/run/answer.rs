//! What `phase run` says of a run that has ended.

use crate::cli::format;
use phase::classify::{ClassifyError, Rules, Sieves, Verdict, classify};
use phase::dem::timestep::StepMargin;
use phase::record::{Milestone, MilestoneKind, Outcome, RunRecord};
use phase::run::model_of;
use phase::scene::Start;
use phase::simulation::Instability;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// What `--json` prints.
#[derive(Serialize)]
pub(super) struct Answer<'a> {
    record: &'a Path,
    seed: u64,
    outcome: &'static str,
    /// What ended an unstable run.
    instability: Option<&'a Instability>,
    seconds: f64,
    cpu_seconds: f64,
    sphere_steps: u64,
    frames: usize,
    /// Time step (s), over the limit above which it is refused, and the name of that limit.
    dt: Option<f64>,
    dt_over_limit: Option<f64>,
    limit: Option<&'static str>,
    /// What happened once, and when (s), where spheres come or go.
    milestones: Vec<Milestone>,
    /// What should have happened and did not.
    unmet: Vec<String>,
    /// The label by the rules of the scene's file, and their evidence and measures; none without
    /// rules.
    label: Option<&'static str>,
    measures: BTreeMap<&'static str, Option<f64>>,
    /// Time (s) and every scalar observable of the last frame, in the units of the record.
    last_frame: BTreeMap<&'a str, f64>,
    /// Time (s) of the checkpoint that the run went on from; none if it began at its start.
    pub(super) resumed_from: Option<f64>,
    /// Whether a job that was run again gave the bits of the sweep's record; none without one.
    pub(super) same_bits: Option<bool>,
}

impl<'a> Answer<'a> {
    pub(super) fn new(
        record: &'a RunRecord,
        verdict: Option<&Verdict>,
        seconds: f64,
        path: &'a Path,
    ) -> Self {
        let observations = &record.observations;
        let mut last_frame = BTreeMap::new();
        last_frame.extend(observations.time.last().map(|time| ("time", *time)));
        for series in observations.scalars() {
            let last = series.values.last();
            last_frame.extend(last.map(|value| (series.name, f64::from(*value))));
        }
        let (outcome, instability) = match &record.outcome {
            Outcome::Completed => ("completed", None),
            Outcome::Unstable(instability) => ("unstable", Some(instability)),
        };
        let standing = StepMargin::decisive(&record.scene);
        Self {
            record: path,
            seed: record.scene.seed,
            outcome,
            instability,
            seconds,
            cpu_seconds: record.cpu_seconds,
            sphere_steps: record.work,
            frames: observations.frames(),
            dt: (!record.scene.is_external()).then_some(record.scene.time.dt),
            dt_over_limit: standing.map(|it| it.ratio),
            limit: standing.map(|it| it.limit.name),
            milestones: record.milestones.clone(),
            unmet: unmet(record),
            label: verdict.map(|it| it.label.name),
            measures: verdict.into_iter().flat_map(values).collect(),
            last_frame,
            resumed_from: None,
            same_bits: None,
        }
    }
}

/// The label of a run by the rules of its scene's file, if it has any.
pub(super) fn labelled(record: &RunRecord) -> Result<Option<Verdict>, ClassifyError> {
    let has_rules = !Rules::of(&record.scene).is_empty();
    let verdict = has_rules.then(|| classify(record, &Sieves::default()));
    verdict.transpose()
}

/// The measures of a verdict by their names.
fn values(verdict: &Verdict) -> impl Iterator<Item = (&'static str, Option<f64>)> {
    let names = verdict.family.measures().map(|measure| measure.name);
    names.zip(verdict.values.iter().copied())
}

/// What a run should have done and did not.
fn unmet(record: &RunRecord) -> Vec<String> {
    let scene = &record.scene;
    let happened = |kind| record.milestones.iter().any(|it| it.kind == kind);
    let last = |series: &[f32]| series.last().map_or(0.0, |count| *count);
    let (observations, all) = (&record.observations, record.radius.len());
    let mut unmet = Vec::new();
    if matches!(scene.start, Start::Feed { .. }) && !happened(MilestoneKind::Filled) {
        unmet.push(format!(
            "NOT FILLED: {} of {all} spheres entered; the inlet was blocked, or the run ended too \
             early",
            last(&observations.released)
        ));
    }
    if scene.dem.rest.is_some()
        && !happened(MilestoneKind::AtRest)
        && !happened(MilestoneKind::Emptied)
    {
        unmet.push("NEVER AT REST".to_owned());
    }
    if scene.dem.door.is_some() && !happened(MilestoneKind::DoorOpened) {
        unmet.push("THE DOOR NEVER OPENED".to_owned());
    }
    if record.is_steady() == Some(false) {
        unmet.push("NOT STEADY: the run reached its duration first".to_owned());
    }
    let spilled = last(&observations.spilled);
    if spilled > 0.0 {
        unmet.push(format!(
            "SPILLED: {spilled} spheres left before the door opened, over the rim or past the silo"
        ));
    }
    unmet
}

/// How the run ended, and the state of its last frame.
pub(super) fn summary(record: &RunRecord, verdict: Option<&Verdict>, seconds: f64) -> String {
    let observations = &record.observations;
    let steps = record.work as f64;
    let mut text = match &record.outcome {
        Outcome::Completed => "completed".to_owned(),
        Outcome::Unstable(instability) => format!("unstable: {instability}"),
    };
    text += &format!("\n  {:<14} {}", "took", format::duration(seconds));
    if !record.scene.is_external() {
        let rate = steps / record.cpu_seconds.max(1e-9);
        let unit = model_of(&record.scene).work_unit();
        text += &format!(" ({})", format::rate(rate, unit));
    }
    text += &format!("\n  {:<14} {}", "frames", observations.frames());
    for milestone in &record.milestones {
        text += &format!(
            "\n  {:<14} at {}",
            milestone.kind.name(),
            format::time(milestone.time)
        );
    }
    for unmet in unmet(record) {
        text += &format!("\n  {unmet}");
    }
    if let Some(verdict) = verdict {
        text += &format!("\n  {:<14} {}", "label", verdict.label.name);
        for (name, value) in values(verdict) {
            let value = value.map_or("undefined".to_owned(), |value| format!("{value:.4e}"));
            text += &format!("\n  {name:<14} {value:>11}");
        }
    }
    if let Some(time) = observations.time.last() {
        text += &match record.scene.unit_of_time() {
            "s" => format!("\nlast frame, at {}", format::time(*time)),
            "1" => format!("\nlast frame, at {time:e}"),
            unit => format!("\nlast frame, at {time:e} {unit}"),
        };
    }
    for series in observations.scalars() {
        // Without spheres there are no means.
        if let Some(value) = series.values.last().filter(|value| value.is_finite()) {
            let value = format!("{value:.4e}");
            text += &format!(
                "\n  {:<14} {value:>11} {:<6} {}",
                series.name, series.unit, series.description
            );
        }
    }
    text
}
