//! Refined sweeps: a coarse grid of runs, then rounds where the label is least certain.

mod borders;
mod entry;
mod learnt;
mod refinement;
mod rounds;
mod scale;

pub(super) use entry::RefineEntry;
pub use learnt::{FAILED, Learnt, label_name};
pub use refinement::{Refinement, RefinementError, Step};
pub use rounds::{Refined, RoundsError, WatchRounds};

use super::{Job, Sweep};
use crate::grid::{Axis, PointError};
use crate::refine::{
    AxisScale, Finish, Lattice, LatticeAxis, RefineError, Settings, Trial, Width, start,
};
use crate::scene::LARGEST_SEED;
use serde::{Deserialize, Serialize};

/// How far the refining of a sweep is: the runs that it has chosen, and what they tell. The results
/// folder keeps it as `progress.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Refining {
    /// What the runs follow from: see [`Sweep::basis_of_runs`].
    pub basis: String,
    /// Runs that were in the folder when refining began; they count as part of the budget.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub given: Vec<Trial>,
    /// If the folder held the whole grid when refining began, and more runs than the budget: the
    /// number of seeds that all its points had. Refining chooses among these runs alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seeds_there: Option<u64>,
    /// Runs that refining has chosen, in its order: the coarse grid first.
    pub chosen: Vec<Trial>,
    /// Of all these, runs that failed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub failed: Vec<Trial>,
    /// How well each pair of neighbouring labels is told apart, after the last round that is done.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub widths: Vec<Width>,
    /// Why no more runs are made; none while more are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<Finish>,
}

impl Refining {
    /// Refining of a sweep that has chosen nothing yet.
    pub fn new(sweep: &Sweep) -> Self {
        Self {
            basis: sweep.basis_of_runs(),
            given: Vec::new(),
            seeds_there: None,
            chosen: Vec::new(),
            failed: Vec::new(),
            widths: Vec::new(),
            end: None,
        }
    }

    /// Whether there are runs.
    pub fn has_begun(&self) -> bool {
        !(self.given.is_empty() && self.chosen.is_empty())
    }

    /// All runs, by place and seed.
    pub fn runs(&self) -> Vec<Trial> {
        let mut runs: Vec<Trial> = self.given.iter().chain(&self.chosen).cloned().collect();
        runs.sort_by(Trial::order);
        runs.dedup();
        runs
    }

    /// The border that is known worst: that with the largest mean width.
    pub fn widest(&self) -> Option<&Width> {
        let widths = self.widths.iter();
        widths.max_by(|one, other| one.mean.total_cmp(&other.mean))
    }

    /// Whether the runs and borders lie on the axes of a sweep.
    ///
    /// # Errors
    /// Why they do not.
    pub(in crate::sweep) fn check(&self, sweep: &Sweep) -> Result<(), String> {
        let axes = sweep.axes.len();
        let mut runs = [&self.given, &self.chosen, &self.failed]
            .into_iter()
            .flatten();
        if let Some(run) = runs.find(|run| run.values.len() != axes) {
            let values = run.values.len();
            return Err(format!(
                "a run has {values} values, but there are {axes} axes"
            ));
        }
        match self.widths.iter().find(|width| width.axis >= axes) {
            Some(width) => Err(format!(
                "a border is along axis {} of {axes}, counted from 0",
                width.axis
            )),
            None => Ok(()),
        }
    }
}

/// Whether refining may end with fewer rounds than with other settings that differ in nothing else.
fn ends_before(own: &Settings, other: &Settings) -> bool {
    let is_wider = match (own.width, other.width) {
        (None, _) => false,
        (Some(_), None) => true,
        (Some(own), Some(other)) => own > other,
    };
    own.budget < other.budget || is_wider
}

/// Whether there are seeds enough.
fn check_seeds(settings: &Settings) -> Result<(), String> {
    match settings.first_seed.checked_add(settings.replicates) {
        Some(end) if end <= LARGEST_SEED => Ok(()),
        _ => Err(format!(
            "the seeds would go beyond {LARGEST_SEED}, the largest one; begin with a lower one"
        )),
    }
}

impl Sweep {
    /// All places where a refined sweep may have runs: its grid, each axis in the scale in which
    /// its values are evenly spaced.
    ///
    /// # Errors
    /// If there are no axes, or if the values of one do not ascend.
    pub fn lattice(&self) -> Result<Lattice, RefineError> {
        let axes = self.axes.iter();
        let axes = axes.map(|axis| {
            LatticeAxis::new(&axis.name, axis.values.clone(), AxisScale::of(&axis.values))
        });
        Lattice::new(axes.collect::<Result<_, _>>()?)
    }

    /// Refines a sweep whose file has no table `[refine]`, with the defaults. A place has as many
    /// seeds as the file has, or the default number if that is one.
    ///
    /// # Errors
    /// Why it cannot be refined.
    pub fn refine_by_default(&mut self) -> Result<(), String> {
        if self.axes.is_empty() {
            return Err(entry::NO_AXES.to_owned());
        }
        if self.axes.iter().any(Axis::is_of_variants) {
            return Err(entry::VARIANTS.to_owned());
        }
        let is_row = |pair: &[u64]| pair[0] + 1 == pair[1];
        let (Some(&first), true) = (self.seeds.first(), self.seeds.windows(2).all(is_row)) else {
            return Err(
                "refining needs seeds that follow each other; give `seeds.first` and \
                        `seeds.count`, or one --seed"
                    .to_owned(),
            );
        };
        let jobs = self.points().saturating_mul(self.seeds.len());
        let mut settings = Settings::with_budget(jobs.div_ceil(10));
        if self.seeds.len() > 1 {
            settings.replicates = self.seeds.len() as u64;
        }
        settings.first_seed = first;
        check_seeds(&settings)?;
        self.refine_with(settings, true)
            .map_err(|error| error.to_string())
    }

    /// Begins the seeds of a refined sweep with another one.
    ///
    /// # Errors
    /// If the seeds would go beyond the largest one.
    pub fn refine_from_seed(&mut self, first: u64) -> Result<(), String> {
        let Some(settings) = &self.refine else {
            return Ok(());
        };
        let settings = Settings {
            first_seed: first,
            ..settings.clone()
        };
        check_seeds(&settings)?;
        self.refine_with(settings, false)
            .map_err(|error| error.to_string())
    }

    /// Refines the sweep with these settings; `by_default` raises the budget to half as many runs
    /// again as the coarse grid has, so that some are left for the borders.
    fn refine_with(&mut self, mut settings: Settings, by_default: bool) -> Result<(), RefineError> {
        for axis in &mut self.axes {
            axis.values.sort_by(f64::total_cmp);
        }
        let lattice = self.lattice()?;
        if by_default {
            let coarse = start(&lattice, &settings).len();
            settings.budget = settings.budget.max(coarse + coarse.div_ceil(2));
        }
        settings.check(self.axes.len())?;
        let first = settings.first_seed;
        self.seeds = (first..first.saturating_add(settings.replicates)).collect();
        self.refine = Some(settings);
        Ok(())
    }

    /// Hexadecimal digits that stand for everything which the runs that refining chooses follow
    /// from, beside their labels: the scene, the axes, the seeds and the settings, but for how many
    /// rounds are made. With another basis other runs are chosen from the start.
    pub fn basis_of_runs(&self) -> String {
        let settings = self.refine.as_ref().map(|settings| Settings {
            budget: 0,
            width: None,
            ..settings.clone()
        });
        let basis = (self.scene.identity(), &self.axes, &self.seeds, settings);
        let text = serde_json::to_vec(&basis).expect("a sweep holds no map with odd keys");
        blake3::hash(&text).to_hex()[..16].to_owned()
    }

    /// The axes along which borders are crossed: the vertical one of the diagram first.
    pub fn axes_of_borders(&self) -> Vec<usize> {
        let place = |name: &Option<String>| {
            let name = name.as_ref()?;
            let mut axes = self.axes.iter();
            axes.position(|axis| axis.name == *name || axis.key == *name)
        };
        let [x, y, panels] = [&self.plot.x, &self.plot.y, &self.plot.panels].map(place);
        let all = 0..self.axes.len();
        let free = |axis: &usize| ![x, panels].contains(&Some(*axis));
        let before = usize::from(x.is_none() && self.axes.len() > 1);
        let first = y.or_else(|| all.clone().filter(free).nth(before));
        let first = first.unwrap_or(0);
        let others = all.filter(|axis| *axis != first);
        std::iter::once(first).chain(others).collect()
    }

    /// The jobs of a refined sweep that have been chosen so far, by point and seed; all jobs of one
    /// that is not refined.
    ///
    /// # Errors
    /// Those of [`jobs`](Self::jobs).
    pub fn jobs_so_far(&self, refining: Option<&Refining>) -> Result<Vec<Job>, PointError> {
        match refining {
            Some(refining) if refining.has_begun() => self.jobs_of_runs(&refining.runs()),
            _ => self.jobs(),
        }
    }

    /// The jobs of runs of a refined sweep, those of points and seeds that the sweep still has.
    pub(super) fn jobs_of_runs(&self, runs: &[Trial]) -> Result<Vec<Job>, PointError> {
        let is_there = |run: &&Trial| {
            let mut values = self.axes.iter().zip(&run.values);
            self.seeds.contains(&run.seed) && values.all(|(axis, it)| axis.values.contains(it))
        };
        let runs = runs.iter().filter(is_there);
        self.jobs_at(runs.map(|run| (run.values.clone(), run.seed)))
    }
}
