//! Comparisons: the same points and seeds of a scene or sweep with one setting after another, and
//! how far the outcome of each is from that of a reference.

mod base;
mod bootstrap;
mod disagreement;
mod majority;
mod measurement;
mod sample;
mod shift;
mod states;
mod table;
#[cfg(test)]
mod tests;

pub(crate) use base::Base;
pub use bootstrap::Interval;
pub use disagreement::{Disagreement, PointDisagreement};
pub use majority::{Majority, majorities};
pub use measurement::{Measured, Measurement, Quantity};
pub use sample::{Cost, Sample};
pub use shift::Shift;
pub use states::{ShiftOf, States};
pub use table::{RunRow, RunTable, RunTableError};

use crate::grid::{self, Axis, PointError, Variant, number_of_points};
use crate::scene::Change;
use crate::sweep::{Job, Sweep};
use std::collections::HashMap;

/// Name of the setting that changes nothing.
pub(super) const AS_IT_IS: &str = "as it is";

/// What a comparison knows of a setting, besides the variant that it is of the sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// Name, as in tables and sentences.
    pub name: String,
    /// Name of the line in the figure, of settings that differ in the number of one key.
    pub method: String,
    /// That key and its value.
    pub rung: Option<(String, f64)>,
    /// What it changes.
    pub change: Change,
    /// What was changed besides, and why.
    pub note: Option<String>,
}

/// Place of the scene as it is among the settings: savings are counted from it.
pub const BASE: usize = 0;

/// Settings that are compared with one of them, and the runs that this takes.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// What is run: the settings are the variants of its last axis.
    pub sweep: Sweep,
    /// The settings, in the order of that axis.
    pub settings: Vec<Setting>,
    /// Place of the one that the others are compared with.
    pub reference: usize,
    /// What is measured of each run.
    pub measurement: Measurement,
    /// All runs, each once: settings vary slowest, then points, then seeds.
    pub jobs: Vec<Job>,
    /// Places among the jobs of the runs of each setting, which may share some: point by point, and
    /// seed by seed.
    runs: Vec<Vec<usize>>,
}

impl Comparison {
    /// A comparison of settings at the points and seeds of a sweep, whose first is the scene as it
    /// is. All are compared with the one at the place `reference`.
    ///
    /// # Errors
    /// The first point whose scene cannot be run. Never for settings that were checked.
    pub(super) fn new(
        base: &Sweep,
        settings: Vec<(Setting, Variant)>,
        reference: usize,
        measurement: Measurement,
    ) -> Result<Self, PointError> {
        let (settings, variants): (Vec<_>, Vec<_>) = settings.into_iter().unzip();
        let mut comparison = Self {
            runs: Vec::new(),
            settings,
            reference,
            measurement,
            jobs: Vec::new(),
            sweep: with_variants(base, variants),
        };
        comparison.choose_runs()?;
        Ok(comparison)
    }

    /// Chooses the runs of all settings anew, after the scenes of its sweep have changed.
    ///
    /// # Errors
    /// The first point whose scene cannot be run.
    pub fn choose_runs(&mut self) -> Result<(), PointError> {
        let points: Vec<Vec<f64>> = grid::points(self.axes()).collect();
        let places = (0..self.settings.len()).map(|place| place as f64);
        let points = places.flat_map(|place| {
            let points = points.iter();
            points.map(move |values| [values.as_slice(), &[place]].concat())
        });
        let seeds = &self.sweep.seeds;
        let all = points.flat_map(|values| seeds.iter().map(move |seed| (values.clone(), *seed)));
        let all = self.sweep.jobs_at(all)?;
        self.jobs.clear();
        self.runs = vec![Vec::new(); self.settings.len()];
        self.share(all);
        Ok(())
    }

    /// Takes all runs in their order, each once.
    fn share(&mut self, all: Vec<Job>) {
        let mut places: HashMap<String, usize> = HashMap::new();
        for job in all {
            let setting = job.values.last().map_or(0, |place| *place as usize);
            let place = *places.entry(job.id.clone()).or_insert(self.jobs.len());
            if place == self.jobs.len() {
                self.jobs.push(job);
            }
            self.runs[setting].push(place);
        }
        let runs = &self.runs;
        for (place, setting) in self.settings.iter_mut().enumerate() {
            let is_new = place != BASE && !setting.change.is_empty();
            if is_new && runs[place] == runs[BASE] && setting.note.is_none() {
                setting.note = Some("its runs are those of the scene as it is".to_owned());
            }
        }
    }

    /// The runs of a setting, by its place, point by point and seed by seed.
    pub fn jobs_of(&self, setting: usize) -> impl Iterator<Item = &Job> + Clone {
        self.runs[setting].iter().map(|&place| &self.jobs[place])
    }

    /// The axes besides the settings.
    pub fn axes(&self) -> &[Axis] {
        self.sweep.axes.split_last().map_or(&[], |(_, axes)| axes)
    }

    /// The variants that the settings are.
    fn variants(&self) -> &[Variant] {
        self.sweep.axes.last().map_or(&[], |axis| &axis.variants)
    }

    /// The sweep of a setting alone, by its place: its scene, and the values that it has on the
    /// axes.
    pub fn sweep_of(&self, setting: usize) -> Sweep {
        let variant = &self.variants()[setting];
        let mut axes = self.axes().to_vec();
        for axis in &mut axes {
            let factor = variant.factor(&axis.name);
            axis.values.iter_mut().for_each(|value| *value *= factor);
        }
        Sweep {
            scene: variant.scene.clone(),
            axes,
            ..self.sweep.clone()
        }
    }

    /// Number of points that each setting runs at.
    pub fn points(&self) -> usize {
        number_of_points(self.axes())
    }

    /// Number of seeds.
    pub fn seeds(&self) -> usize {
        self.sweep.seeds.len()
    }

    /// What is measured of each run.
    pub fn quantities(&self) -> Vec<Quantity> {
        let reference = self.variants().get(self.reference);
        reference.map_or_else(Vec::new, |it| self.measurement.quantities(&it.scene))
    }

    /// The runs of a setting, by its place, from the rows of all jobs.
    pub fn sample<'a>(&self, setting: usize, rows: &'a [Option<RunRow>]) -> Sample<'a> {
        let seeds = self.seeds().max(1);
        let of_point = |places: &[usize]| {
            let rows = places.iter().map(|&place| rows.get(place)?.as_ref());
            rows.collect()
        };
        Sample {
            points: self.runs[setting].chunks(seeds).map(of_point).collect(),
        }
    }

    /// The rows that there are of a setting, with its values on the axes and seeds.
    pub(super) fn rows_of<'a>(
        &'a self,
        setting: usize,
        rows: &'a [Option<RunRow>],
    ) -> impl Iterator<Item = (Vec<f64>, u64, &'a RunRow)> {
        let points = self.sweep_of(setting).grid().collect::<Vec<_>>();
        let runs = self.sample(setting, rows).points;
        let pairs = points.into_iter().zip(runs);
        pairs.flat_map(|(values, runs)| {
            let runs = runs.into_iter().zip(&self.sweep.seeds);
            runs.filter_map(move |(run, seed)| Some((values.clone(), *seed, run?)))
        })
    }
}

/// A sweep with one more axis, of variants.
pub(super) fn with_variants(base: &Sweep, variants: Vec<Variant>) -> Sweep {
    let mut sweep = base.clone();
    sweep.axes.push(Axis::of_variants(variants));
    sweep
}
