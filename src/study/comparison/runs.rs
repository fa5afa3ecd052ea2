//! Makes the runs of a comparison and keeps its table.

use super::{Comparison, RunRow, table};
use crate::classify::Label;
use crate::record::{Program, RunRecord};
use crate::store::StoreError;
use crate::study::rows::{Completed, Rows, Table};
use crate::sweep::{Backend, Failure, Folder, Halt, Job, Wishes};
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;

/// How, where and with which callbacks the runs of a comparison are made.
pub struct Comparing<'a> {
    /// The comparison.
    pub comparison: &'a Comparison,
    /// The folder of results, for the table and for checkpoints.
    pub folder: &'a Folder,
    /// Lines of the table that belong to other settings or seeds, and are kept.
    pub others: &'a [csv::StringRecord],
    /// Who makes the runs.
    pub backend: &'a dyn Backend,
    /// What is wished of them.
    pub wishes: Wishes<'a>,
}

/// What became of the runs.
#[derive(Debug, Default)]
pub struct Report {
    /// The rows of the jobs; none of one that failed or is left.
    pub rows: Vec<Option<RunRow>>,
    /// How many of them were there before.
    pub known: usize,
    /// Runs that could not be made.
    pub failures: Vec<Failure>,
    /// Runs that are left.
    pub left: usize,
    /// Processor time of the runs made now (s).
    pub cpu_seconds: f64,
}

/// Why a comparison was given up.
#[derive(Debug, thiserror::Error)]
pub enum ComparingError {
    /// No more runs can be made.
    #[error(transparent)]
    Halt(#[from] Halt),
}

impl Comparing<'_> {
    /// Makes the runs of which `known` has no row, and keeps the table up to date.
    ///
    /// # Errors
    /// If the table cannot be written, or no run be made.
    pub fn run(&self, known: Vec<RunRow>) -> Result<Report, ComparingError> {
        let mut known: HashMap<String, RunRow> =
            known.into_iter().map(|row| (row.id.clone(), row)).collect();
        let jobs = &self.comparison.jobs;
        let rows: Vec<Option<RunRow>> = jobs.iter().map(|job| known.remove(&job.id)).collect();
        let count = rows.iter().flatten().count();
        let rows = Rows::new(self, jobs, self.folder.clone(), rows, BTreeMap::new());
        let Completed { rows, report } = rows.complete(self.backend, self.wishes);
        if let Some(error) = report.halted {
            return Err(error.into());
        }
        Ok(Report {
            known: count,
            rows,
            left: report.left,
            failures: report.failures,
            cpu_seconds: report.cpu_seconds,
        })
    }

    /// The table of runs in a folder of results.
    pub fn table(folder: &Folder) -> PathBuf {
        folder.root().join("runs.csv")
    }
}

impl Table for Comparing<'_> {
    type Row = RunRow;

    fn row(&self, job: &Job, record: &RunRecord) -> RunRow {
        // Sieves were checked against the scene; a record that contradicts itself has no values.
        let measured = self.comparison.measurement.measure(record);
        let (label, values) = match measured {
            Ok(measured) => (measured.label, measured.values),
            Err(_) => (
                Label::UNSTABLE,
                vec![None; self.comparison.quantities().len()],
            ),
        };
        RunRow {
            id: job.id.clone(),
            label,
            values,
            sphere_steps: job.work(),
            force_evaluations: record.work,
            cpu_seconds: record.cpu_seconds,
        }
    }

    fn write(
        &self,
        rows: &[Option<RunRow>],
        _: &BTreeMap<String, Program>,
    ) -> Result<(), StoreError> {
        table::write_runs(
            self.comparison,
            rows,
            self.others,
            &Self::table(self.folder),
        )
    }
}
