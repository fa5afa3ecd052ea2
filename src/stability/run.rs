//! Runs what is left of a study and keeps its table.

use super::table;
use super::{Label, Study, Theory, energy_gain};
use crate::record::{Guard, Outcome, Program};
use crate::run::{self, RunError};
use crate::scene::Integrator;
use crate::store::StoreError;
use crate::sweep::{Failure, Job, panic_message, work};
use std::collections::{BTreeMap, HashMap};
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

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

/// Something that happened. Events come from different threads.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// A run has ended.
    Finished(&'a Job, &'a Row),
    /// A run could not be made.
    Failed(&'a Job, &'a Failure),
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
    /// The system gives no threads.
    #[error("cannot start the workers: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// How, where and with which callbacks a study is run.
pub struct Trials<'a> {
    /// The study.
    pub study: &'a Study,
    /// Its runs.
    pub jobs: &'a [Job],
    /// The table that is kept.
    pub table: &'a Path,
    /// Number of runs at the same time.
    pub workers: usize,
    /// When set, runs under way are given up, and no more are started.
    pub stop: &'a AtomicBool,
    /// Is told what happens.
    pub watch: &'a (dyn Fn(Event<'_>) + Sync),
}

/// Time between two writings of the table.
const BETWEEN_WRITINGS: Duration = Duration::from_secs(5);

impl Trials<'_> {
    /// Makes the runs of which `known` has no row of the same identity, and keeps the table up to
    /// date, and beside it which build made each row. Labels of known rows follow the study's
    /// threshold.
    ///
    /// # Errors
    /// If the files cannot be read or written, or there are no threads.
    pub fn run(&self, known: Vec<Row>) -> Result<Report, TrialsError> {
        let mut known: HashMap<String, Row> =
            known.into_iter().map(|row| (row.id.clone(), row)).collect();
        let rows: Vec<Option<Row>> = self
            .jobs
            .iter()
            .map(|job| Some(self.labelled_again(known.remove(&job.id)?)))
            .collect();
        let count = rows.iter().flatten().count();
        let mut makers = table::read_makers(self.table)?;
        makers.retain(|id, _| rows.iter().flatten().any(|row| row.id == *id));
        let pending: Vec<usize> = (0..rows.len())
            .filter(|&index| rows[index].is_none())
            .collect();
        let state = Mutex::new(State {
            rows,
            makers,
            failures: Vec::new(),
            cpu_seconds: 0.0,
            written: Instant::now(),
            halted: None,
        });
        work::each(self.workers, &pending, |&index| {
            if !self.stop.load(Ordering::Relaxed) && lock(&state).halted.is_none() {
                self.make(index, &state);
            }
        })?;
        let state = state.into_inner().unwrap_or_else(PoisonError::into_inner);
        self.write(&state)?;
        if let Some(error) = state.halted {
            return Err(error.into());
        }
        let rows: Vec<Row> = state.rows.into_iter().flatten().collect();
        Ok(Report {
            known: count,
            left: self.jobs.len() - rows.len() - state.failures.len(),
            rows,
            failures: state.failures,
            cpu_seconds: state.cpu_seconds,
        })
    }

    /// Makes one run and notes what became of it.
    fn make(&self, index: usize, state: &Mutex<State>) {
        let job = &self.jobs[index];
        let reason = match catch_unwind(AssertUnwindSafe(|| self.row(job))) {
            Ok(Ok((row, cpu_seconds))) => {
                (self.watch)(Event::Finished(job, &row));
                return self.keep(index, row, cpu_seconds, &mut lock(state));
            }
            Ok(Err(RunError::Interrupted)) => return,
            Ok(Err(RunError::Build(error))) => error.to_string(),
            Err(panic) => format!("a bug in phase: {}", panic_message(&*panic)),
        };
        let failure = Failure::new(job, reason);
        (self.watch)(Event::Failed(job, &failure));
        lock(state).failures.push(failure);
    }

    /// Notes a row, and writes the table if that was not done for a while.
    fn keep(&self, index: usize, row: Row, cpu_seconds: f64, state: &mut State) {
        state.makers.insert(row.id.clone(), Program::current());
        state.rows[index] = Some(row);
        state.cpu_seconds += cpu_seconds;
        if state.written.elapsed() >= BETWEEN_WRITINGS {
            state.halted = self.write(state).err();
            state.written = Instant::now();
        }
    }

    /// The row of a run, and its processor time (s).
    fn row(&self, job: &Job) -> Result<(Row, f64), RunError> {
        let record = run::run(&job.scene, &mut |_| {
            if self.stop.load(Ordering::Relaxed) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        })?;
        let broken = match &record.outcome {
            Outcome::Completed => None,
            Outcome::Unstable(it) => Some((it.guard, it.step, it.sphere)),
        };
        let gain = energy_gain(&record);
        let time = &job.scene.time;
        let limit = Theory::of(&job.scene).decisive;
        let row = Row {
            id: job.id.clone(),
            integrator: time.integrator,
            values: job.values.clone(),
            time_step: time.dt,
            limit: limit.map(|limit| (time.dt / limit.seconds, limit.name.to_owned())),
            label: self.label(broken.map(|it| it.0), gain),
            energy_gain: gain,
            broken,
        };
        Ok((row, record.cpu_seconds))
    }

    fn labelled_again(&self, row: Row) -> Row {
        Row {
            label: self.label(row.broken.map(|it| it.0), row.energy_gain),
            ..row
        }
    }

    fn label(&self, guard: Option<Guard>, gain: f64) -> Label {
        Label::of(guard, gain, self.study.energy_gain)
    }

    fn write(&self, state: &State) -> Result<(), StoreError> {
        // First, so that no row has another maker than is noted, whenever the process is ended.
        table::write_makers(&state.makers, self.table)?;
        table::write_stability(&self.study.axes, state.rows.iter().flatten(), self.table)
    }
}

/// What the workers fill together.
struct State {
    /// By index of the job.
    rows: Vec<Option<Row>>,
    /// Builds that made them, by identity, as far as known.
    makers: BTreeMap<String, Program>,
    failures: Vec<Failure>,
    cpu_seconds: f64,
    written: Instant,
    halted: Option<StoreError>,
}

/// Locks the state; a panic elsewhere leaves only whole entries in it.
fn lock(state: &Mutex<State>) -> MutexGuard<'_, State> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}
