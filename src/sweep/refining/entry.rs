//! The table `[refine]` as a sweep file writes it.

use super::scale;
use crate::document::{Problem, unit};
use crate::grid::Axis;
use crate::grid::{MOST_JOBS, SeedsEntry, spacing::MOST_VALUES};
use crate::refine::{ModelKind, RefineError, Settings, start};
use crate::scene::LARGEST_SEED;
use crate::sweep::Sweep;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Why a sweep without axes is not refined.
pub(super) const NO_AXES: &str = "a sweep without axes has no borders to refine: add `[[axis]]`";

/// Why a sweep with variants is not refined.
pub(super) const VARIANTS: &str =
    "a sweep with variants is not refined: they have no order along which labels change";

/// Most parts of a step.
const MOST_PARTS: usize = 100;

/// Which runs of the grid are made: first a coarse grid, then rounds of runs where the label is
/// least certain, until the borders are known to a wanted width or a budget of runs is spent.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(in crate::sweep) struct RefineEntry {
    /// Most runs in total, those that the results folder already holds among them. Refining ends
    /// when they are made (default: a tenth of the points of the axes, at least half as many again
    /// as the coarse grid has).
    #[schemars(range(min = 1))]
    budget: Option<usize>,
    /// Into how many parts every step of an axis is cut: points between those of the axes, where
    /// runs may be made too. One number for all axes, or one for each. 100 are the most.
    finer: Parts,
    /// Wanted mean width of the 95 % band of every border, as a share of the axis that it crosses.
    /// Refining ends when all are as narrow (default: none, so that the budget is spent).
    #[schemars(transform = unit("").above(0.0).at_most(1.0))]
    width: Option<f64>,
    /// Number of values of each axis in the coarse grid: one number for all axes, or one for each.
    #[schemars(inner(range(min = 1)))]
    start: Vec<usize>,
    /// Runs in one round. Labels of a round do not change its other runs.
    #[schemars(range(min = 1))]
    round: usize,
    /// Most seeds that one point is run with, from `seeds.first` on. A point that has been run is
    /// run again only where its neighbours tell less: where labels change with the seed.
    #[schemars(range(min = 1))]
    pub(in crate::sweep) replicates: u64,
    /// Share of the runs after the coarse grid that go to the points farthest from all runs, to
    /// find regions that the coarse grid has missed.
    #[schemars(transform = unit("").at_least(0.0).at_most(1.0))]
    exploring: f64,
    /// How probabilities of labels are learnt from runs.
    model: ModelKind,
}

/// Into how many parts steps are cut.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
enum Parts {
    /// Those of all axes.
    OfAll(#[schemars(range(min = 1))] usize),
    /// Those of each axis, in the order of the axes.
    OfEach(#[schemars(inner(range(min = 1)))] Vec<usize>),
}

impl Parts {
    /// Into how many parts the steps of each axis are cut, with the place of the number in the
    /// file.
    fn of_axes(&self, axes: usize) -> Result<Vec<(usize, String)>, Problem> {
        const PATH: &str = "refine.finer";
        let parts: Vec<(usize, String)> = match self {
            Self::OfAll(parts) => vec![(*parts, PATH.to_owned()); axes],
            Self::OfEach(each) if each.len() == axes => {
                let places = (0..axes).map(|axis| format!("{PATH}[{axis}]"));
                each.iter().copied().zip(places).collect()
            }
            Self::OfEach(each) => return Err(not_one_for_each(PATH, each.len(), axes)),
        };
        match parts.iter().find(|(parts, _)| *parts > MOST_PARTS) {
            None => Ok(parts),
            Some((parts, path)) => {
                let message = format!("{parts} parts of each step are too many");
                Err(Problem::new(path.clone(), message).help(format!("{MOST_PARTS} are the most")))
            }
        }
    }
}

/// The problem of a list that has neither one number nor one for each axis.
fn not_one_for_each(path: &str, numbers: usize, axes: usize) -> Problem {
    let message = format!("`{path}` has {numbers} numbers, but the sweep has {axes} axes");
    Problem::new(path, message).help("give one number for all axes, or one for each")
}

impl Default for RefineEntry {
    fn default() -> Self {
        let Settings {
            start,
            round,
            replicates,
            exploring,
            model,
            ..
        } = Settings::with_budget(1);
        Self {
            budget: None,
            finer: Parts::OfAll(1),
            width: None,
            start,
            round,
            replicates,
            exploring,
            model,
        }
    }
}

impl RefineEntry {
    /// The seeds of a refined sweep: the first of the file, and those that follow.
    pub(in crate::sweep) fn seeds(
        &self,
        seeds: Option<&SeedsEntry>,
        problems: &mut Vec<Problem>,
    ) -> Vec<u64> {
        let first = seeds.map_or(1, |seeds| seeds.first_of_refined(problems));
        let mut refuse = |path: &str, message: String, help: &str| {
            problems.push(Problem::new(path, message).help(help));
            Vec::new()
        };
        if self.replicates > MOST_JOBS as u64 {
            let message = format!("{} seeds of a point are too many", self.replicates);
            let help = format!("{MOST_JOBS} jobs are the most");
            return refuse("refine.replicates", message, &help);
        }
        if first.saturating_add(self.replicates) > LARGEST_SEED {
            let message = format!("the seeds would go beyond {LARGEST_SEED}, the largest one");
            return refuse("seeds.first", message, "begin with a lower one");
        }
        (first..first + self.replicates).collect()
    }

    /// Puts values between those of the axes of the sweep, and refines it. Its axes and seeds are
    /// right.
    pub(in crate::sweep) fn refine(&self, sweep: &mut Sweep, problems: &mut Vec<Problem>) {
        if let Err(problem) = self.try_refine(sweep) {
            problems.push(problem);
        }
    }

    fn try_refine(&self, sweep: &mut Sweep) -> Result<(), Problem> {
        if sweep.axes.is_empty() {
            let help = "give each axis `key` and `values`, or remove the table";
            return Err(Problem::new("refine", NO_AXES).help(help));
        }
        if sweep.axes.iter().any(Axis::is_of_variants) {
            let help = "remove [refine], or make a file for each variant";
            return Err(Problem::new("refine", VARIANTS).help(help));
        }
        if let Some(bad) = self.start.iter().position(|count| *count == 0) {
            let message = "the coarse grid needs at least one value of each axis";
            return Err(Problem::new(format!("refine.start[{bad}]"), message)
                .help("use 1 or more, such as 6"));
        }
        if self.model == ModelKind::Margins && !sweep.family().has_rules_alone() {
            let message = "margins are learnt where labels are by rules alone";
            let help = "give labels in [[label]], without `labels`; or remove `model`";
            return Err(Problem::new("refine.model", message).help(help));
        }
        let broken = |error: RefineError| Problem::new("refine", error.to_string());
        let axes = sweep.axes.len();
        if self.start.len() != 1 && self.start.len() != axes {
            return Err(not_one_for_each("refine.start", self.start.len(), axes));
        }
        let parts_of_axes = self.finer.of_axes(axes)?;
        let of_axes = sweep.points();
        for (axis, (parts, path)) in sweep.axes.iter_mut().zip(&parts_of_axes) {
            axis.values.sort_by(f64::total_cmp);
            let steps = axis.values.len().saturating_sub(1);
            let count = steps.saturating_mul(*parts) + 1;
            if count > MOST_VALUES {
                let message = format!("the axis `{}` would have {count} values", axis.name);
                let help = format!("{MOST_VALUES} are the most; cut its steps into fewer parts");
                return Err(Problem::new(path.clone(), message).help(help));
            }
            axis.values = scale::finer(&axis.values, *parts).map_err(|_| {
                let message = format!(
                    "values of the axis `{}` are too close to be cut into {parts} parts",
                    axis.name
                );
                Problem::new(path.clone(), message).help("cut steps into fewer parts")
            })?;
        }
        let jobs_of = |points: usize| points.saturating_mul(sweep.seeds.len());
        let jobs = jobs_of(sweep.points());
        if jobs > MOST_JOBS && jobs_of(of_axes) <= MOST_JOBS {
            let mut parts: Vec<String> = parts_of_axes
                .iter()
                .map(|(parts, _)| parts.to_string())
                .collect();
            parts.dedup();
            let message = format!(
                "steps cut into {} parts make a grid of {jobs} jobs",
                parts.join(", ")
            );
            let help = format!("{MOST_JOBS} are the most; cut steps into fewer parts");
            return Err(Problem::new("refine.finer", message).help(help));
        }
        if jobs > MOST_JOBS {
            // Refused with the grid as a whole.
            return Ok(());
        }
        let settings = Settings {
            budget: self.budget.unwrap_or_else(|| of_axes.div_ceil(10)),
            width: self.width,
            start: self.start.clone(),
            round: self.round,
            replicates: self.replicates,
            first_seed: sweep.seeds.first().copied().unwrap_or(1),
            exploring: self.exploring,
            model: self.model,
        };
        let coarse = start(&sweep.lattice().map_err(broken)?, &settings).len();
        if let Some(budget) = self.budget.filter(|budget| *budget < coarse) {
            let message = format!("the coarse grid alone has {coarse} runs, more than {budget}");
            let help = format!("use {coarse} or more, or a smaller `refine.start`");
            return Err(Problem::new("refine.budget", message).help(help));
        }
        sweep
            .refine_with(settings, self.budget.is_none())
            .map_err(broken)
    }
}
