//! Makes the runs of a comparison and keeps its table while they end.

use super::table::{KnownRuns, RunRow, write_makers, write_runs};
use super::{Comparison, Measured};
use crate::classify::Label;
use crate::record::{Program, RunRecord};
use crate::resume::{Checkpoints, DEFAULT_INTERVAL};
use crate::store::StoreError;
use crate::sweep::{Backend, Batch, Folder, Halt, Job, Report, Results, Wishes};
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Time between two writings of a table.
const BETWEEN_WRITINGS: Duration = Duration::from_secs(5);

/// How, where and with which callbacks the runs of a study are made.
pub struct StudyRuns<'a> {
    /// What is run.
    pub comparison: &'a Comparison,
    /// The folder of results, for the table and for checkpoints.
    pub folder: &'a Folder,
    /// Who makes the runs.
    pub backend: &'a dyn Backend,
    /// What is wished of them.
    pub wishes: Wishes<'a>,
}

/// What became of the runs of a study.
#[derive(Debug, Default)]
pub struct StudyReport {
    /// The rows of the jobs; none of one that failed or is left.
    pub rows: Vec<Option<RunRow>>,
    /// How many of them were there before.
    pub known: usize,
    /// What became of the others.
    pub made: Report,
}

impl StudyRuns<'_> {
    /// Makes the runs of which no row is known, and keeps the table up to date, and beside it which
    /// build made each row.
    ///
    /// # Errors
    /// If a file cannot be written, or no run be made.
    pub fn run(&self, known: KnownRuns) -> Result<StudyReport, Halt> {
        let jobs = &self.comparison.jobs;
        let rows = known.rows.into_iter().map(|row| (row.id.clone(), row));
        let mut rows: HashMap<String, RunRow> = rows.collect();
        let rows: Vec<Option<RunRow>> = jobs.iter().map(|job| rows.remove(&job.id)).collect();
        let pending = jobs.iter().zip(&rows).filter(|(_, row)| row.is_none());
        let pending: Vec<&Job> = pending.map(|(job, _)| job).collect();
        let ids = jobs.iter().map(|job| job.id.as_str()).enumerate();
        let table = Table {
            of: self,
            places: ids.map(|(place, id)| (id, place)).collect(),
            others: known.others,
            state: Mutex::new(State {
                rows,
                makers: known.makers,
                written: Instant::now(),
            }),
        };
        let known = jobs.len() - pending.len();
        let mut made = Batch::new(pending, &table, self.wishes).run_on(self.backend);
        let written = table.write(&table.lock());
        if let Some(error) = made.halted.take() {
            return Err(error);
        }
        written?;
        let state = table.state.into_inner();
        let rows = state.unwrap_or_else(PoisonError::into_inner).rows;
        Ok(StudyReport { rows, known, made })
    }

    /// The table of runs in a folder of results.
    pub fn table(folder: &Folder) -> PathBuf {
        folder.root().join("runs.csv")
    }

    fn row(&self, job: &Job, record: &RunRecord) -> RunRow {
        let comparison = self.comparison;
        let measured = comparison.measurement.measure(record);
        // Sieves were checked against the scene; a record that contradicts itself has no values.
        let measured = measured.unwrap_or_else(|_| Measured {
            label: Label::UNSTABLE,
            values: vec![None; comparison.quantities().len()],
        });
        RunRow {
            id: job.id.clone(),
            label: measured.label,
            values: measured.values,
            sphere_steps: job.work(),
            force_evaluations: record.work,
            cpu_seconds: record.cpu_seconds,
        }
    }
}

/// The table of a study while its runs are made.
struct Table<'a> {
    of: &'a StudyRuns<'a>,
    /// Places of the jobs, by identity.
    places: HashMap<&'a str, usize>,
    /// Lines of the table that belong to other settings or seeds.
    others: Vec<csv::StringRecord>,
    state: Mutex<State>,
}

/// What workers fill together.
struct State {
    /// By place of the job.
    rows: Vec<Option<RunRow>>,
    makers: BTreeMap<String, Program>,
    written: Instant,
}

impl Table<'_> {
    fn write(&self, state: &State) -> Result<(), StoreError> {
        let path = StudyRuns::table(self.of.folder);
        // First, so that no row has another maker than is noted, whenever the process is ended.
        write_makers(&state.makers, &path)?;
        write_runs(self.of.comparison, &state.rows, &self.others, &path)
    }

    /// Locks the state; a panic elsewhere leaves only whole entries in it.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Results for Table<'_> {
    fn have_own_files(&self) -> bool {
        // They are rows of one table.
        false
    }

    fn keep(&self, job: &Job, record: &RunRecord) -> Result<(), StoreError> {
        let row = self.of.row(job, record);
        let mut state = self.lock();
        state.makers.insert(job.id.clone(), Program::current());
        let place = self.places.get(job.id.as_str());
        if let Some(place) = place.and_then(|at| state.rows.get_mut(*at)) {
            *place = Some(row);
        }
        if state.written.elapsed() >= BETWEEN_WRITINGS {
            self.write(&state)?;
            state.written = Instant::now();
        }
        Ok(())
    }

    fn checkpoints(&self, job: &Job) -> Checkpoints {
        self.of.folder.checkpoints(&job.id, DEFAULT_INTERVAL)
    }
}
