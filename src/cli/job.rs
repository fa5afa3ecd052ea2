//! A job of a sweep, as `--json` names it, and what is printed while jobs run.

use super::format;
use super::progress::Progress;
use phase::grid::Axis;
use phase::record::RunRecord;
use phase::run;
use phase::sweep::{Event, Failure, Job};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// A job of a sweep, and what went wrong with it.
#[derive(Serialize)]
pub(super) struct NamedJob {
    id: String,
    /// Values by the names of the axes.
    point: BTreeMap<String, Value>,
    seed: u64,
    reason: String,
}

impl NamedJob {
    /// The jobs of a sweep with these axes.
    pub(super) fn all(axes: &[Axis], jobs: &[Failure]) -> Vec<Self> {
        let named = |job: &Failure| Self {
            id: job.id.clone(),
            point: point(axes, &job.values),
            seed: job.seed,
            reason: job.reason.clone(),
        };
        jobs.iter().map(named).collect()
    }
}

/// The unit in which the work of jobs is counted.
pub(super) fn unit_of(jobs: &[Job]) -> &'static str {
    let first = jobs.first();
    first.map_or("", |job| run::model_of(&job.scene()).work_unit())
}

/// Values by the names of their axes; variants are named.
pub(super) fn point(axes: &[Axis], values: &[f64]) -> BTreeMap<String, Value> {
    let value = |(axis, &value): (&Axis, &f64)| match axis.variant(value) {
        Some(variant) => (axis.name.clone(), variant.name.as_str().into()),
        None => (axis.name.clone(), value.into()),
    };
    axes.iter().zip(values).map(value).collect()
}

/// Prints what happened to a job. `name` gives its name, `ended` describes a run that ended.
pub(super) fn tell(
    event: Event<'_>,
    progress: &Progress<'_>,
    name: &dyn Fn(&Job) -> String,
    ended: &dyn Fn(&Job, &RunRecord) -> String,
) {
    let named = |job: &Job| format!("{} (job {})", name(job), job.id);
    match event {
        Event::Started(_) => {}
        Event::Elsewhere(job) => {
            let name = named(job);
            progress.detail(format_args!("another process is running it: {name}"));
        }
        Event::Made(job) => {
            let name = named(job);
            progress.detail(format_args!("another process has made it: {name}"));
            progress.job_done(job.work());
        }
        Event::Waiting(jobs) => progress.note(format_args!(
            "waiting for {} that other processes are making",
            format::count(jobs, "job")
        )),
        Event::Resumed(job, work) => {
            progress.skip(work);
            let job = named(job);
            progress.detail(format_args!("resumed from its checkpoint: {job}"));
        }
        Event::CheckpointRefused(job, error) => progress.note(format_args!(
            "job {} starts from the beginning: {error}",
            job.id
        )),
        Event::NoCheckpoint(job, error) => {
            progress.note(format_args!(
                "cannot write a checkpoint of job {}: {error}",
                job.id
            ));
        }
        Event::Advanced(_, work) => progress.advance(work),
        Event::Finished(job, record, left) => {
            progress.detail(format_args!("{}", ended(job, record)));
            progress.job_done(left);
        }
        Event::Failed(job, failure) => {
            progress.detail(format_args!("failed: {}: {}", named(job), failure.reason));
            progress.job_done(job.work());
        }
    }
}
