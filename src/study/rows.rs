//! The rows of a study, one for each run, in a table that is kept while runs end.

use crate::record::{Program, RunRecord};
use crate::resume::{Checkpoints, DEFAULT_INTERVAL};
use crate::store::StoreError;
use crate::sweep::{Backend, Batch, Folder, Job, Report, Results, Wishes};
use std::collections::{BTreeMap, HashMap};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Time between two writings of a table.
const BETWEEN_WRITINGS: Duration = Duration::from_secs(5);

/// What a study makes of its runs.
pub(super) trait Table: Sync {
    /// What is kept of a run.
    type Row: Send;

    /// The row of a run.
    fn row(&self, job: &Job, record: &RunRecord) -> Self::Row;

    /// Writes the rows that there are, in the order of the jobs, and beside them which build made
    /// each, by the identities of the runs.
    fn write(
        &self,
        rows: &[Option<Self::Row>],
        makers: &BTreeMap<String, Program>,
    ) -> Result<(), StoreError>;
}

/// The rows of a study while its runs are made.
pub(super) struct Rows<'a, T: Table> {
    table: &'a T,
    jobs: &'a [Job],
    /// Places of the jobs, by identity.
    places: HashMap<&'a str, usize>,
    /// Where runs leave checkpoints.
    folder: Folder,
    state: Mutex<State<T::Row>>,
}

/// What there is when the workers are done.
pub(super) struct Completed<R> {
    /// By index of the job.
    pub(super) rows: Vec<Option<R>>,
    pub(super) report: Report,
}

/// What the workers fill together.
struct State<R> {
    /// By index of the job.
    rows: Vec<Option<R>>,
    makers: BTreeMap<String, Program>,
    written: Instant,
}

impl<'a, T: Table> Rows<'a, T> {
    /// The rows of jobs, those that are known among them with the builds that made them.
    pub(super) fn new(
        table: &'a T,
        jobs: &'a [Job],
        folder: Folder,
        rows: Vec<Option<T::Row>>,
        makers: BTreeMap<String, Program>,
    ) -> Self {
        let state = State {
            rows,
            makers,
            written: Instant::now(),
        };
        let ids = jobs.iter().map(|job| job.id.as_str()).enumerate();
        Self {
            table,
            jobs,
            places: ids.map(|(place, id)| (id, place)).collect(),
            folder,
            state: Mutex::new(state),
        }
    }

    /// Has a backend make the runs whose row is not known, and returns all rows.
    pub(super) fn complete(self, backend: &dyn Backend, wishes: Wishes<'_>) -> Completed<T::Row> {
        let known: Vec<bool> = self.lock().rows.iter().map(Option::is_some).collect();
        let pending = self.jobs.iter().zip(known).filter(|(_, known)| !known);
        let batch = Batch::new(pending.map(|(job, _)| job), &self, wishes);
        let mut report = batch.run_on(backend);
        let written = self.write(&self.lock());
        report.halted = report.halted.or(written.err().map(Into::into));
        let state = self.state.into_inner();
        let rows = state.unwrap_or_else(PoisonError::into_inner).rows;
        Completed { rows, report }
    }

    fn write(&self, state: &State<T::Row>) -> Result<(), StoreError> {
        self.table.write(&state.rows, &state.makers)
    }

    /// Locks the state; a panic elsewhere leaves only whole entries in it.
    fn lock(&self) -> MutexGuard<'_, State<T::Row>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T: Table> Results for Rows<'_, T> {
    fn have_own_files(&self) -> bool {
        // They are rows of one table.
        false
    }

    fn keep(&self, job: &Job, record: &RunRecord) -> Result<(), StoreError> {
        let row = self.table.row(job, record);
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
        self.folder.checkpoints(&job.id, DEFAULT_INTERVAL)
    }
}
