//! Runs what is left of a study and keeps its table.

use super::table;
use super::{Label, Study, Theory, energy_gain};
use crate::record::{Guard, Outcome, Program, RunRecord};
use crate::scene::Integrator;
use crate::store::StoreError;
use crate::study::rows::{Completed, Rows, Table};
use crate::sweep::{Backend, Failure, Folder, Halt, Job, Wishes};
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// What became of one run of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Identity of the run.
    pub id: String,
    /// The integrator.
    pub integrator: Integrator,
    /// Value on each axis.
    pub values: Vec<f64>,
    /// Time step (s).
    pub time_step: f64,
    /// Time step over the least limit that decides, and what sets it; none if nothing does.
    pub limit: Option<(f64, String)>,
    /// What became of it.
    pub label: Label,
    /// Energy out of nothing, over its scale (see [`energy_gain`]).
    pub energy_gain: f64,
    /// The guard that ended it, with step and sphere.
    pub broken: Option<(Guard, u64, usize)>,
}

/// What became of the runs.
#[derive(Debug, Default)]
pub struct Report {
    /// The rows that there are, in the order of the study's jobs.
    pub rows: Vec<Row>,
    /// How many of them were there before.
    pub known: usize,
    /// Runs that could not be made.
    pub failures: Vec<Failure>,
    /// Runs that are left.
    pub left: usize,
    /// Processor time of the runs made now (s).
    pub cpu_seconds: f64,
}

/// Why a study was given up.
#[derive(Debug, thiserror::Error)]
pub enum TrialsError {
    /// The table cannot be written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// No more runs can be made.
    #[error(transparent)]
    Halt(#[from] Halt),
}

/// How, where and with which callbacks a study is run.
pub struct Trials<'a> {
    /// The study.
    pub study: &'a Study,
    /// Its runs.
    pub jobs: &'a [Job],
    /// The table that is kept.
    pub table: &'a Path,
    /// Who makes the runs.
    pub backend: &'a dyn Backend,
    /// What is wished of them.
    pub wishes: Wishes<'a>,
}

impl Trials<'_> {
    /// Makes the runs of which `known` has no row of the same identity, and keeps the table up to
    /// date, and beside it which build made each row. Labels of known rows follow the study's
    /// threshold.
    ///
    /// # Errors
    /// If the files cannot be read or written, or no run be made.
    pub fn run(&self, known: Vec<Row>) -> Result<Report, TrialsError> {
        let mut known: HashMap<String, Row> =
            known.into_iter().map(|row| (row.id.clone(), row)).collect();
        let known = |job: &Job| Some(self.study.labelled_again(known.remove(&job.id)?));
        let rows: Vec<Option<Row>> = self.jobs.iter().map(known).collect();
        let count = rows.iter().flatten().count();
        let mut makers = table::read_makers(self.table)?;
        makers.retain(|id, _| rows.iter().flatten().any(|row| row.id == *id));
        let folder = Folder::new(self.table.parent().unwrap_or(Path::new("")));
        let rows = Rows::new(self, self.jobs, folder, rows, makers);
        let Completed { rows, report } = rows.complete(self.backend, self.wishes);
        if let Some(error) = report.halted {
            return Err(error.into());
        }
        Ok(Report {
            known: count,
            rows: rows.into_iter().flatten().collect(),
            left: report.left,
            failures: report.failures,
            cpu_seconds: report.cpu_seconds,
        })
    }
}

impl Table for Trials<'_> {
    type Row = Row;

    fn row(&self, job: &Job, record: &RunRecord) -> Row {
        self.study.row(job, record)
    }

    fn write(
        &self,
        rows: &[Option<Row>],
        makers: &BTreeMap<String, Program>,
    ) -> Result<(), StoreError> {
        // First, so that no row has another maker than is noted, whenever the process is ended.
        table::write_makers(makers, self.table)?;
        table::write_stability(&self.study.axes, rows.iter().flatten(), self.table)
    }
}

impl Study {
    /// The row of a run that has ended.
    pub fn row(&self, job: &Job, record: &RunRecord) -> Row {
        let broken = match &record.outcome {
            Outcome::Completed => None,
            Outcome::Unstable(it) => Some((it.guard, it.step, it.sphere)),
        };
        let gain = energy_gain(record);
        let time = &job.scene.time;
        let limit = Theory::of(&job.scene).decisive;
        Row {
            id: job.id.clone(),
            integrator: time.integrator,
            values: job.values.clone(),
            time_step: time.dt,
            limit: limit.map(|limit| (time.dt / limit.seconds, limit.name.to_owned())),
            label: Label::of(broken.map(|it| it.0), gain, self.energy_gain),
            energy_gain: gain,
            broken,
        }
    }

    fn labelled_again(&self, row: Row) -> Row {
        let guard = row.broken.map(|it| it.0);
        Row {
            label: Label::of(guard, row.energy_gain, self.energy_gain),
            ..row
        }
    }
}
