//! How a sweep is refined.

use super::RefineError;
use super::model::{LabelModel, Margins, Propagation, Regression};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which runs are made: first a coarse grid, then rounds where the labels are least certain. The
/// table `[refine]` of a sweep file, with all defaults filled in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Largest number of runs in total. Refining ends when they are made.
    pub budget: usize,
    /// Wanted mean width of the 95 % band of every border, as a share of the axis that it crosses.
    /// Refining ends when all bands are this narrow. Absent: the whole budget is spent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width: Option<f64>,
    /// Number of values of each axis in the coarse grid at the start: one number for all axes, or
    /// one for each (default 6).
    #[serde(default = "default_start")]
    pub start: Vec<usize>,
    /// Runs in one round (default 8). Labels of a round do not change its other runs.
    #[serde(default = "default_round")]
    pub round: usize,
    /// Largest number of seeds per place (default 3). A place is run again only if its neighbours
    /// are less informative: where labels change with the seed, and the places are far apart.
    #[serde(default = "default_replicates")]
    pub replicates: u64,
    /// The first seed (default 1); replicates have the following seeds.
    #[serde(default = "default_first_seed")]
    pub first_seed: u64,
    /// Share of the runs after the start that go to the places farthest from all runs (default
    /// 0.125), to find regions that the coarse grid missed.
    #[serde(default = "default_exploring")]
    pub exploring: f64,
    /// How probabilities of labels are learnt from runs (default `propagation`).
    #[serde(default)]
    pub model: ModelKind,
}

/// How probabilities of labels are learnt from runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ModelKind {
    /// Gaussian process regression.
    Regression,
    /// Gaussian process regression of the margins of rules, where labels are by rules alone.
    Margins,
    /// Gaussian process classification by expectation propagation.
    #[default]
    Propagation,
}

impl ModelKind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Regression, Self::Margins, Self::Propagation];

    /// Its name, as in a sweep file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Regression => "regression",
            Self::Margins => "margins",
            Self::Propagation => "propagation",
        }
    }

    /// The model.
    pub fn model(self) -> &'static dyn LabelModel {
        match self {
            Self::Regression => &Regression,
            Self::Margins => &Margins,
            Self::Propagation => &Propagation,
        }
    }
}

fn default_start() -> Vec<usize> {
    vec![6]
}

fn default_round() -> usize {
    8
}

fn default_replicates() -> u64 {
    3
}

fn default_first_seed() -> u64 {
    1
}

fn default_exploring() -> f64 {
    0.125
}

impl Settings {
    /// The defaults with this budget of runs.
    pub fn with_budget(budget: usize) -> Self {
        Self {
            budget,
            width: None,
            start: default_start(),
            round: default_round(),
            replicates: default_replicates(),
            first_seed: default_first_seed(),
            exploring: default_exploring(),
            model: ModelKind::default(),
        }
    }

    /// Checks the ranges of all settings for a lattice with this number of axes.
    ///
    /// # Errors
    /// The first setting that is out of its range.
    pub fn check(&self, axes: usize) -> Result<(), RefineError> {
        let share = |value: f64| (0.0..=1.0).contains(&value);
        let checks = [
            ("budget", self.budget > 0, "must be 1 or more"),
            ("width", self.width.is_none_or(share), "must be from 0 to 1"),
            (
                "start",
                self.start.len() == 1 || self.start.len() == axes,
                "must have one number, or one for each axis",
            ),
            (
                "start",
                self.start.iter().all(|count| *count > 0),
                "must be 1 or more",
            ),
            ("round", self.round > 0, "must be 1 or more"),
            ("replicates", self.replicates > 0, "must be 1 or more"),
            ("exploring", share(self.exploring), "must be from 0 to 1"),
        ];
        match checks.into_iter().find(|(_, fits, _)| !fits) {
            Some((key, _, reason)) => Err(RefineError::setting(key, reason)),
            None => Ok(()),
        }
    }

    /// Number of values of an axis at the start.
    pub(super) fn start_on(&self, axis: usize) -> usize {
        *self.start.get(axis).unwrap_or(&self.start[0])
    }
}
