//! The rounds of a refined sweep, chosen from labels alone.

use super::Refining;
use super::learnt::{FAILED, Learnt};
use crate::classify::{Family, LabelTable};
use crate::refine::{
    Finish, Gap, Lattice, Observations, ProbabilityMap, RefineError, Run, Settings, is_narrow,
    missing, probabilities, round_of, widths,
};
use crate::sweep::{Folder, Job, Labelling, Plan, PointError, Sweep};
use std::collections::HashSet;

/// The rounds of a refined sweep.
///
/// All rounds are chosen from labels in one order, whether their runs are in the folder already or
/// have to be made: so the same runs are chosen whatever the number of workers, interrupted or not.
#[derive(Clone, Debug)]
pub struct Refinement {
    lattice: Lattice,
    refining: Refining,
    /// Labels of the runs that are in the folder.
    known: Observations,
    /// The runs that are learnt from.
    runs: Observations,
    /// What is learnt from them, if that has been asked for.
    map: Option<ProbabilityMap>,
    table: LabelTable,
    rounds: usize,
}

/// What is done next.
#[derive(Clone, Debug, PartialEq)]
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
    /// The system gives no threads.
    #[error("cannot start the workers: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// The sweep has no table `[refine]`.
    #[error("the sweep is not refined")]
    NotRefined,
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
        let Some(refining) = &sweep.refine else {
            return Err(RefinementError::NotRefined);
        };
        let mut refinement = Self {
            lattice: sweep.lattice()?,
            refining: refining.without_runs(),
            known: Observations::new(),
            runs: Observations::new(),
            map: None,
            table: LabelTable {
                family: Family::of(&sweep.scene),
                axes: sweep.axes.iter().map(|axis| axis.name.clone()).collect(),
                rows: Vec::new(),
            },
            rounds: 0,
        };
        if !afresh {
            refinement.read(folder, sweep, workers)?;
        }
        Ok(refinement)
    }

    /// Reads the labels of the runs that are there.
    fn read(
        &mut self,
        folder: &Folder,
        sweep: &Sweep,
        workers: usize,
    ) -> Result<(), RefinementError> {
        let jobs = jobs_with_records(folder, sweep)?;
        let plan = Plan::new(folder, jobs, workers)?;
        let done: Vec<Job> = plan.labelled().cloned().collect();
        self.label(folder, sweep, &done, workers)?;
        let stored = folder.read_sweep().ok();
        let goes_on = stored.filter(|stored| stored.is_refined_like(sweep));
        let goes_on = goes_on.and_then(|stored| stored.refine);
        let given = match goes_on.filter(|stored| stored.seeds_there.is_none()) {
            Some(stored) => stored.given,
            // With another budget the runs of a whole grid may be given after all.
            None => {
                let seeds: Vec<u64> = self.known.iter().map(|(run, _)| run.seed).collect();
                self.refining.seeds_there = sweep.seeds_of_whole_grid(&seeds);
                match self.refining.seeds_there {
                    Some(_) => Vec::new(),
                    None => self.known.iter().map(|(run, _)| run.clone()).collect(),
                }
            }
        };
        for run in given {
            if let Some(label) = self.known.label(&run) {
                self.runs.add(run.clone(), label)?;
                self.refining.given.push(run);
            }
        }
        Ok(())
    }

    /// The settings by which runs are chosen.
    fn settings(&self) -> Settings {
        let settings = self.refining.settings.clone();
        let replicates = self.refining.seeds_there.unwrap_or(settings.replicates);
        Settings {
            replicates,
            ..settings
        }
    }

    /// Labels jobs from their records. Gives those without a label.
    fn label(
        &mut self,
        folder: &Folder,
        sweep: &Sweep,
        jobs: &[Job],
        workers: usize,
    ) -> Result<Vec<Run>, RefinementError> {
        for row in Labelling::new(folder, sweep, jobs, workers)?.table.rows {
            let run = Run {
                values: row.values.clone(),
                seed: row.seed,
            };
            self.known.add(run, row.verdict.label.code)?;
            self.table.rows.push(row);
        }
        let runs = jobs.iter().map(|job| Run {
            values: job.values.clone(),
            seed: job.seed,
        });
        Ok(runs.filter(|run| self.known.label(run).is_none()).collect())
    }

    /// Chooses the next round of which runs are missing. Call it when those of the round before
    /// have been [learnt](Self::learn).
    ///
    /// # Errors
    /// If a point cannot be run.
    pub fn next_step(&mut self, sweep: &mut Sweep) -> Result<Step, RefinementError> {
        let round = match self.round()? {
            Ok(round) => round,
            Err(finish) => {
                self.map()?;
                self.refining.end = Some(finish);
                sweep.refine = Some(self.refining.clone());
                return Ok(Step::Finished(finish));
            }
        };
        self.rounds += 1;
        let mut open = Vec::new();
        for run in round {
            match self.known.label(&run) {
                Some(label) => {
                    self.runs.add(run.clone(), label)?;
                    self.map = None;
                }
                None => open.push(run.clone()),
            }
            self.refining.chosen.push(run);
        }
        if open.is_empty() {
            return Ok(Step::Known);
        }
        sweep.refine = Some(self.refining.clone());
        Ok(Step::Run(sweep.jobs_of_runs(&open)?))
    }

    /// The next round, or why there is none.
    fn round(&mut self) -> Result<Result<Vec<Run>, Finish>, RefinementError> {
        let settings = self.settings();
        let missing = missing(&self.lattice, &self.runs, &settings);
        if !missing.is_empty() {
            return Ok(Ok(missing));
        }
        if self.runs.len() >= settings.budget {
            return Ok(Err(Finish::Budget));
        }
        let (lattice, runs) = (self.lattice.clone(), self.runs.clone());
        let map = self.map()?;
        if is_narrow(&lattice, &settings, map) {
            return Ok(Err(Finish::Width));
        }
        let round = round_of(&lattice, &runs, &settings, map);
        Ok(match round.is_empty() {
            true => Err(Finish::Complete),
            false => Ok(round),
        })
    }

    /// Learns from jobs that have run, all of a step: those without a record have failed.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn learn(
        &mut self,
        folder: &Folder,
        sweep: &mut Sweep,
        jobs: &[Job],
        workers: usize,
    ) -> Result<(), RefinementError> {
        for run in self.label(folder, sweep, jobs, workers)? {
            self.known.add(run.clone(), FAILED)?;
            self.refining.failed.push(run);
        }
        for job in jobs {
            let run = Run {
                values: job.values.clone(),
                seed: job.seed,
            };
            if let Some(label) = self.known.label(&run) {
                self.runs.add(run, label)?;
            }
        }
        self.map = None;
        self.map()?;
        sweep.refine = Some(self.refining.clone());
        Ok(())
    }

    /// What has been learnt; nothing before the first run.
    ///
    /// # Errors
    /// If the grid cannot be refined.
    pub fn learnt(&mut self) -> Result<Option<Learnt>, RefinementError> {
        if self.runs.is_empty() {
            return Ok(None);
        }
        Ok(Some(Learnt {
            map: self.map()?.clone(),
            lattice: self.lattice.clone(),
            runs: self.runs.clone(),
        }))
    }

    /// The largest gap between the runs.
    pub fn gap(&self) -> Option<Gap> {
        Gap::new(&self.lattice, &self.runs).ok()
    }

    /// Labels of the runs so far.
    pub fn table(&self) -> &LabelTable {
        &self.table
    }

    /// Number of rounds so far, the coarse grid among them.
    pub fn rounds(&self) -> usize {
        self.rounds
    }

    /// Number of runs that have been learnt from.
    pub fn runs(&self) -> usize {
        self.runs.len()
    }

    /// The map that has been learnt from the runs, and how wide its borders are.
    fn map(&mut self) -> Result<&ProbabilityMap, RefineError> {
        let map = match self.map.take() {
            Some(map) => map,
            None => {
                let map = probabilities(&self.lattice, &self.runs, &self.refining.settings)?;
                self.refining.widths = widths(&self.lattice, &map);
                map
            }
        };
        Ok(self.map.insert(map))
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
        let Some(refining) = &self.refine else {
            return Ok(Vec::new());
        };
        let stored = folder.read_sweep().ok();
        let goes_on = stored.filter(|stored| stored.is_refined_like(self));
        let goes_on = goes_on.and_then(|stored| stored.refine);
        if let Some(stored) = goes_on.filter(|stored| stored.seeds_there.is_none()) {
            return self.jobs_of_runs(&match refining.ends_before(&stored) {
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
        let settings = &self.refine.as_ref()?.settings;
        let is_whole = |seed: &u64| seeds.iter().filter(|it| *it == seed).count() == self.points();
        let candidates = settings.first_seed..settings.first_seed + settings.replicates;
        let count = candidates.take_while(is_whole).count() as u64;
        (count > 0 && seeds.len() > settings.budget).then_some(count)
    }

    /// Whether another sweep chooses the same runs, but for more or fewer rounds.
    fn is_refined_like(&self, other: &Self) -> bool {
        let without_end = |sweep: &Self| {
            let mut sweep = sweep.clone();
            if let Some(refining) = &mut sweep.refine {
                refining.settings.budget = 0;
                refining.settings.width = None;
            }
            sweep
        };
        let keys = without_end(self).keys_of_other_runs(&without_end(other));
        self.refine.is_some() && keys.is_empty()
    }
}

/// The jobs of all points and seeds of a refined sweep that have a record or a kept label.
fn jobs_with_records(folder: &Folder, sweep: &Sweep) -> Result<Vec<Job>, PointError> {
    let entries = std::fs::read_dir(folder.records()).into_iter().flatten();
    let id = |entry: std::io::Result<std::fs::DirEntry>| {
        let name = entry.ok()?.file_name().into_string().ok()?;
        Some(name.strip_suffix(".h5")?.to_owned())
    };
    let ids = entries
        .filter_map(id)
        .chain(folder.kept_labels().into_keys());
    let ids: HashSet<String> = ids.collect();
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
