//! Comparisons: the same points and seeds of a scene or sweep with one setting after another, and
//! how far the outcome of each is from that of a reference.

mod base;
mod bootstrap;
mod disagreement;
mod majority;
mod measurement;
mod runs;
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
pub use runs::{StudyReport, StudyRuns};
pub use sample::{Cost, Sample};
pub use shift::Shift;
pub use states::{ShiftOf, States};
pub use table::{KnownRuns, RunRow, read_runs};

use crate::document::Problem;
use crate::grid::{Axis, PointError};
use crate::scene::Change;
use crate::sweep::{Job, Sweep};
use std::collections::HashMap;

/// Name of the setting that changes nothing.
pub(super) const AS_IT_IS: &str = "as it is";

/// One setting of a comparison.
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
    /// The sweep with the change: the same points and seeds, by their places.
    pub sweep: Sweep,
}

impl Setting {
    /// A setting of a base.
    ///
    /// # Errors
    /// What is wrong with it, by paths of the scene.
    pub(crate) fn new(base: &Base, name: String, change: Change) -> Result<Self, Vec<Problem>> {
        let base::Changed { sweep, note } = base.with(&change)?;
        Ok(Self {
            method: name.clone(),
            name,
            rung: None,
            change,
            note,
            sweep,
        })
    }
}

/// Settings that are compared with one of them, and the runs that this takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The settings.
    pub settings: Vec<Setting>,
    /// Place of the one that the others are compared with.
    pub reference: usize,
    /// Place of the scene as it is, which savings are counted from.
    pub as_it_is: usize,
    /// What is measured of each run.
    pub measurement: Measurement,
    /// All runs, each once: settings vary slowest, then points, then seeds.
    pub jobs: Vec<Job>,
    /// Places among the jobs of the runs of each setting, which may share some: point by point, and
    /// seed by seed.
    runs: Vec<Vec<usize>>,
}

impl Comparison {
    /// A comparison of settings of one base.
    ///
    /// # Errors
    /// The first point whose scene cannot be run. Never for settings that were checked.
    pub fn new(
        settings: Vec<Setting>,
        reference: usize,
        as_it_is: usize,
        measurement: Measurement,
    ) -> Result<Self, PointError> {
        let jobs = settings.iter().map(|setting| setting.sweep.jobs());
        let jobs = jobs.collect::<Result<_, _>>()?;
        Ok(Self::of_jobs(
            settings,
            jobs,
            reference,
            as_it_is,
            measurement,
        ))
    }

    /// The same with runs that no two settings share, so that each is timed by itself: what changes
    /// no motion, such as the search for neighbours, changes no identity of a run.
    ///
    /// # Errors
    /// Those of [`new`](Self::new).
    pub(super) fn timed(
        settings: Vec<Setting>,
        reference: usize,
        as_it_is: usize,
        measurement: Measurement,
    ) -> Result<Self, PointError> {
        let own = |setting: &Setting| {
            let jobs = setting.sweep.jobs()?.into_iter();
            let jobs = jobs.map(|job| {
                let text = format!("{} timed with {}", job.id, setting.name);
                let id = blake3::hash(text.as_bytes()).to_hex()[..job.id.len()].to_owned();
                Job { id, ..job }
            });
            Ok(jobs.collect())
        };
        let jobs = settings
            .iter()
            .map(own)
            .collect::<Result<_, PointError>>()?;
        Ok(Self::of_jobs(
            settings,
            jobs,
            reference,
            as_it_is,
            measurement,
        ))
    }

    /// The same with jobs that are there, of each setting its own, point by point.
    pub(super) fn of_jobs(
        mut settings: Vec<Setting>,
        jobs_of_settings: Vec<Vec<Job>>,
        reference: usize,
        as_it_is: usize,
        measurement: Measurement,
    ) -> Self {
        let mut places: HashMap<String, usize> = HashMap::new();
        let (mut jobs, mut runs) = (Vec::new(), Vec::new());
        for of_setting in jobs_of_settings {
            let mut own = Vec::new();
            for job in of_setting {
                let place = *places.entry(job.id.clone()).or_insert(jobs.len());
                if place == jobs.len() {
                    jobs.push(job);
                }
                own.push(place);
            }
            runs.push(own);
        }
        for (place, setting) in settings.iter_mut().enumerate() {
            let is_new = place != as_it_is && !setting.change.is_empty();
            if is_new && runs[place] == runs[as_it_is] && setting.note.is_none() {
                setting.note = Some("its runs are those of the scene as it is".to_owned());
            }
        }
        Self {
            settings,
            reference,
            as_it_is,
            measurement,
            jobs,
            runs,
        }
    }

    /// The runs of a setting, by its place, point by point and seed by seed.
    pub fn jobs_of(&self, setting: usize) -> impl Iterator<Item = &Job> + Clone {
        self.runs[setting].iter().map(|&place| &self.jobs[place])
    }

    /// Names of the settings that runs are made for, by the identities of these; of settings that
    /// share a run, the first.
    pub fn settings_of_runs(&self) -> HashMap<&str, &str> {
        let mut names = HashMap::new();
        for (place, setting) in self.settings.iter().enumerate() {
            for job in self.jobs_of(place) {
                names
                    .entry(job.id.as_str())
                    .or_insert(setting.name.as_str());
            }
        }
        names
    }

    /// The axes, which all settings have.
    pub fn axes(&self) -> &[Axis] {
        self.settings.first().map_or(&[], |it| &it.sweep.axes)
    }

    /// Number of points that each setting runs at.
    pub fn points(&self) -> usize {
        self.settings.first().map_or(0, |it| it.sweep.points())
    }

    /// Number of seeds.
    pub fn seeds(&self) -> usize {
        self.settings.first().map_or(0, |it| it.sweep.seeds.len())
    }

    /// What is measured of each run.
    pub fn quantities(&self) -> Vec<Quantity> {
        let first = self.settings.get(self.reference);
        first.map_or_else(Vec::new, |it| self.measurement.quantities(&it.sweep.scene))
    }

    /// The runs of a setting, by its place, of the rows of all jobs.
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
}
