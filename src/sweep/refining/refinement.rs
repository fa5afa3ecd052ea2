//! The rounds of a refined sweep, chosen from labels alone.

use super::learnt::{FAILED, Learnt, found};
use super::{Refining, ends_before};
use crate::classify::LabelTable;
use crate::grid::PointError;
use crate::refine::{
    Finish, Gap, Observations, RefineError, Round, Rounds, Settings, Trial, widths,
};
use crate::refusal::Refusal;
use crate::sweep::{Folder, Job, Labelling, Plan, PlanError, Sweep};

/// The rounds of a refined sweep.
///
/// All rounds are chosen from labels in one order, whether their runs are in the folder already or
/// have to be made: so the same runs are chosen whatever the number of workers, interrupted or not.
#[derive(Clone, Debug)]
pub struct Refinement {
    refining: Refining,
    /// The runs that are in the folder.
    known: Known,
    /// What is chosen and learnt from.
    rounds: Rounds,
    /// Number of rounds so far.
    count: usize,
    /// The runs of the latest round.
    latest: Vec<Trial>,
}

/// Runs of a folder that have labels.
#[derive(Clone, Debug)]
struct Known {
    runs: Observations,
    table: LabelTable,
}

/// What is done next.
#[derive(Clone, Debug)]
pub enum Step {
    /// These jobs of the round are run.
    Run(Vec<Job>),
    /// All runs of the round are there already: the next one is chosen.
    Known,
    /// Nothing.
    Finished(Finish),
}

/// Why a sweep cannot be refined.
#[derive(Debug, thiserror::Error)]
pub enum RefinementError {
    /// The grid cannot be refined.
    #[error(transparent)]
    Refine(#[from] RefineError),
    /// A point cannot be run.
    #[error(transparent)]
    Point(#[from] PointError),
    /// The runs of the folder cannot be planned.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The system gives no threads.
    #[error("cannot start the workers: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// The sweep has no table `[refine]`.
    #[error("the sweep is not refined")]
    NotRefined,
}

impl Refusal for RefinementError {
    fn is_refusal(&self) -> bool {
        match self {
            Self::Refine(_) | Self::Point(_) | Self::NotRefined => true,
            Self::Plan(error) => error.is_refusal(),
            Self::Threads(_) => false,
        }
    }
}

impl Refinement {
    /// The rounds of a sweep with what is in its folder: nothing counts if it is run `afresh`.
    ///
    /// Runs that the folder held before the sweep was refined are given, and part of the budget. If
    /// they are the whole grid, and more than the budget, refining chooses among them instead,
    /// which teaches nearly as much and takes far less time than to learn from all.
    ///
    /// # Errors
    /// Why the sweep cannot be refined.
    pub fn new(
        folder: &Folder,
        sweep: &Sweep,
        afresh: bool,
        workers: usize,
    ) -> Result<Self, RefinementError> {
        let Some(settings) = &sweep.refine else {
            return Err(RefinementError::NotRefined);
        };
        let mut refining = Refining::new(sweep);
        let mut known = Known::none(sweep);
        let mut given = Vec::new();
        if !afresh {
            let jobs = jobs_with_records(folder, sweep)?;
            let plan = Plan::new(folder, jobs, workers)?;
            let done: Vec<Job> = plan.labelled().cloned().collect();
            known.label(folder, sweep, &done, workers)?;
            (refining.seeds_there, given) = known.given(folder, sweep);
        }
        let settings = Settings {
            replicates: refining.seeds_there.unwrap_or(settings.replicates),
            ..settings.clone()
        };
        let mut rounds = Rounds::new(sweep.lattice()?, settings)?;
        for run in given {
            if let Some(found) = known.runs.found(&run) {
                rounds.learn(run.clone(), found.clone())?;
                refining.given.push(run);
            }
        }
        Ok(Self {
            refining,
            known,
            rounds,
            count: 0,
            latest: Vec::new(),
        })
    }

    /// Chooses the next round of which runs are missing. Call it when those of the round before
    /// have been [learnt](Self::learn).
    ///
    /// # Errors
    /// If a point cannot be run.
    pub fn next_step(&mut self, sweep: &Sweep) -> Result<Step, RefinementError> {
        let round = match self.rounds.next_round()? {
            Round::Runs(round) => round,
            Round::Finished(finish) => {
                self.note_widths()?;
                self.refining.end = Some(finish);
                return Ok(Step::Finished(finish));
            }
        };
        self.count += 1;
        self.latest.clone_from(&round);
        let mut open = Vec::new();
        for run in round {
            match self.known.runs.found(&run) {
                Some(found) => self.rounds.learn(run.clone(), found.clone())?,
                None => open.push(run.clone()),
            }
            self.refining.chosen.push(run);
        }
        if open.is_empty() {
            return Ok(Step::Known);
        }
        Ok(Step::Run(sweep.jobs_of_runs(&open)?))
    }

    /// All jobs of the latest round, in an order that does not depend on which are known.
    ///
    /// # Errors
    /// If a point cannot be run.
    pub fn round(&self, sweep: &Sweep) -> Result<Vec<Job>, PointError> {
        sweep.jobs_of_runs(&self.latest)
    }

    /// Learns from jobs that have run, all of a step: those without a record have failed.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn learn(
        &mut self,
        folder: &Folder,
        sweep: &Sweep,
        jobs: &[Job],
        workers: usize,
    ) -> Result<(), RefinementError> {
        for run in self.known.label(folder, sweep, jobs, workers)? {
            self.known.runs.add(run.clone(), FAILED)?;
            self.refining.failed.push(run);
        }
        for job in jobs {
            let run = run_of(job);
            if let Some(found) = self.known.runs.found(&run) {
                self.rounds.learn(run, found.clone())?;
            }
        }
        Ok(self.note_widths()?)
    }

    /// Notes how wide the borders are by now.
    fn note_widths(&mut self) -> Result<(), RefineError> {
        let lattice = self.rounds.lattice().clone();
        self.refining.widths = widths(&lattice, self.rounds.map()?);
        Ok(())
    }

    /// What has been learnt; nothing before the first run.
    ///
    /// # Errors
    /// If the grid cannot be refined.
    pub fn learnt(&mut self) -> Result<Option<Learnt>, RefinementError> {
        if self.rounds.runs().is_empty() {
            return Ok(None);
        }
        Ok(Some(Learnt {
            map: self.rounds.map()?.clone(),
            lattice: self.rounds.lattice().clone(),
            runs: self.rounds.runs().clone(),
        }))
    }

    /// How far refining is.
    pub fn refining(&self) -> &Refining {
        &self.refining
    }

    /// The largest gap between the runs.
    pub fn gap(&self) -> Option<Gap> {
        Gap::new(self.rounds.lattice(), self.rounds.runs()).ok()
    }

    /// Labels of the runs so far.
    pub fn table(&self) -> &LabelTable {
        &self.known.table
    }

    /// Number of rounds so far, the coarse grid among them.
    pub fn rounds(&self) -> usize {
        self.count
    }

    /// Number of runs that have been learnt from.
    pub fn runs(&self) -> usize {
        self.rounds.runs().len()
    }
}

impl Known {
    /// Nothing of a sweep.
    fn none(sweep: &Sweep) -> Self {
        Self {
            runs: Observations::new(),
            table: LabelTable {
                family: sweep.family(),
                axes: sweep.axes.iter().map(|axis| axis.name.clone()).collect(),
                variants: sweep.variants(),
                rows: Vec::new(),
            },
        }
    }

    /// Labels jobs from their records. Gives those without a label.
    fn label(
        &mut self,
        folder: &Folder,
        sweep: &Sweep,
        jobs: &[Job],
        workers: usize,
    ) -> Result<Vec<Trial>, RefinementError> {
        for row in Labelling::new(folder, sweep, jobs, workers)?.table.rows {
            let run = Trial {
                values: row.values.clone(),
                seed: row.seed,
            };
            self.runs.add(run, found(&row))?;
            self.table.rows.push(row);
        }
        let runs = jobs.iter().map(run_of);
        Ok(runs.filter(|run| self.runs.label(run).is_none()).collect())
    }

    /// The runs that are given when refining begins: those that it began with if it goes on, or
    /// else all that are there. Of a whole grid of more runs than the budget none are given: the
    /// number of seeds of its points comes first then, and refining chooses among them.
    fn given(&self, folder: &Folder, sweep: &Sweep) -> (Option<u64>, Vec<Trial>) {
        if let Some(stored) = goes_on(folder, sweep) {
            return (None, stored.given);
        }
        // With another budget the runs of a whole grid may be given after all.
        let seeds: Vec<u64> = self.runs.iter().map(|(run, _)| run.seed).collect();
        match sweep.seeds_of_whole_grid(&seeds) {
            Some(seeds) => (Some(seeds), Vec::new()),
            None => (None, self.runs.iter().map(|(run, _)| run.clone()).collect()),
        }
    }
}

/// The place and seed of a job.
fn run_of(job: &Job) -> Trial {
    Trial {
        values: job.values.clone(),
        seed: job.seed,
    }
}

impl Sweep {
    /// The jobs that a refined sweep is sure to have, of those that its folder has a record or a
    /// kept label of: all of them, as they are given; but none if refining chooses among those of
    /// a whole grid. Where it goes on, those that it began with, and those that it chose if it does
    /// not end earlier now. None of another sweep.
    ///
    /// # Errors
    /// If a point cannot be run.
    pub fn jobs_given_by(&self, folder: &Folder) -> Result<Vec<Job>, PointError> {
        let Some(settings) = &self.refine else {
            return Ok(Vec::new());
        };
        if let Some(stored) = goes_on(folder, self) {
            let before = folder.read_sweep().ok().and_then(|sweep| sweep.refine);
            let may_end_earlier = before.is_none_or(|before| ends_before(settings, &before));
            return self.jobs_of_runs(&match may_end_earlier {
                true => stored.given,
                false => stored.runs(),
            });
        }
        let mut jobs = jobs_with_records(folder, self)?;
        let seeds: Vec<u64> = jobs.iter().map(|job| job.seed).collect();
        if self.seeds_of_whole_grid(&seeds).is_some() {
            jobs.clear();
        }
        Ok(jobs)
    }

    /// Number of seeds, from the first on, that every point of the grid has a run of, if there is
    /// one and the runs are more than the budget. `seeds` holds the seed of each run that is there.
    fn seeds_of_whole_grid(&self, seeds: &[u64]) -> Option<u64> {
        let settings = self.refine.as_ref()?;
        let is_whole = |seed: &u64| seeds.iter().filter(|it| *it == seed).count() == self.points();
        let candidates = settings.first_seed..settings.first_seed + settings.replicates;
        let count = candidates.take_while(is_whole).count() as u64;
        (count > 0 && seeds.len() > settings.budget).then_some(count)
    }
}

/// How far the refining is that goes on in a folder: with the same basis, and not among the runs of
/// a whole grid, which may be given with another budget.
fn goes_on(folder: &Folder, sweep: &Sweep) -> Option<Refining> {
    let stored = folder.read_refining(sweep).ok()??;
    (stored.seeds_there.is_none() && stored.has_begun()).then_some(stored)
}

/// The jobs of all points and seeds of a refined sweep that have a record or a kept label.
fn jobs_with_records(folder: &Folder, sweep: &Sweep) -> Result<Vec<Job>, PointError> {
    // A folder that cannot be read is refused where its records are looked at.
    let mut ids = folder.recorded().unwrap_or_default();
    ids.extend(folder.kept_labels().into_keys());
    if ids.is_empty() {
        return Ok(Vec::new());
    }
    let runs = sweep.grid().flat_map(|values| {
        let seeds = sweep.seeds.iter();
        seeds.map(move |seed| (values.clone(), *seed))
    });
    let mut jobs = sweep.jobs_at(runs)?;
    jobs.retain(|job| ids.contains(&job.id));
    Ok(jobs)
}
