//! The jobs of a sweep: every point of its grid with every seed.

use super::{Axis, Sweep};
use crate::document::{Problem, number};
use crate::refine::start;
use crate::run::{self, Progress};
use crate::scene::{Scene, Template};

/// One job of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// Identity of the run (see [`Scene::identity`]): the name of its record.
    pub id: String,
    /// Value on each axis, in the sweep's order.
    pub values: Vec<f64>,
    /// Seed.
    pub seed: u64,
    /// The resolved scene.
    pub scene: Scene,
}

impl Job {
    /// Work of the whole run, at most, in the unit of its model.
    pub fn work(&self) -> u64 {
        run::model_of(&self.scene).work_of(&self.scene)
    }

    /// Work of the run so far, estimated from its progress.
    pub fn work_at(&self, progress: &Progress) -> u64 {
        (progress.share() * self.work() as f64) as u64
    }
}

/// A point of the grid whose scene cannot be run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{}", if point.is_empty() { String::new() } else { format!("at {point}: ") },
    problems.iter().map(Problem::to_string).collect::<Vec<_>>().join("; "))]
pub struct PointError {
    /// The point, such as `radius = 0.003, omega = 6`; empty for a sweep without axes.
    pub point: String,
    /// Place of its variant, if it has one.
    pub variant: Option<usize>,
    /// What is wrong there.
    pub problems: Vec<Problem>,
}

impl Sweep {
    /// All jobs. The first axis varies slowest; the seeds of a point follow each other. Of a
    /// refined sweep those of the coarse grid, by point and seed: others
    /// [follow](Self::jobs_so_far) from labels.
    ///
    /// # Errors
    /// The first point whose scene cannot be run. Never for a sweep that [`load`](super::load)
    /// returned.
    pub fn jobs(&self) -> Result<Vec<Job>, PointError> {
        if let Some(settings) = &self.refine
            && let Ok(lattice) = self.lattice()
        {
            return self.jobs_of_runs(&start(&lattice, settings));
        }
        self.jobs_at(self.grid().flat_map(|values| {
            let seeds = self.seeds.iter();
            seeds.map(move |seed| (values.clone(), *seed))
        }))
    }

    /// The jobs of these points and seeds, in this order.
    pub(super) fn jobs_at(
        &self,
        runs: impl Iterator<Item = (Vec<f64>, u64)>,
    ) -> Result<Vec<Job>, PointError> {
        let mut scenes = PointScenes::new(&self.scene, &self.axes)?;
        let mut last: Option<(Vec<f64>, Scene)> = None;
        let mut jobs = Vec::new();
        for (values, seed) in runs {
            let scene = match last {
                Some((at, scene)) if at == values => scene,
                _ => scenes.checked(&values)?,
            };
            let of_seed = Scene {
                seed,
                ..scene.clone()
            };
            jobs.push(Job {
                id: of_seed.identity(),
                values: values.clone(),
                seed,
                scene: of_seed,
            });
            last = Some((values, scene));
        }
        Ok(jobs)
    }

    /// Number of points of the grid.
    pub fn points(&self) -> usize {
        points(&self.axes)
    }

    /// The points of the grid, in order.
    pub(crate) fn grid(&self) -> impl Iterator<Item = Vec<f64>> {
        grid(&self.axes)
    }

    /// The scene of a point of the grid, checked.
    pub(crate) fn scene_at(&self, values: &[f64]) -> Result<Scene, PointError> {
        PointScenes::new(&self.scene, &self.axes)?.checked(values)
    }
}

/// The points of a grid, in order: the first axis varies slowest.
pub(crate) fn grid(axes: &[Axis]) -> impl Iterator<Item = Vec<f64>> {
    (0..points(axes)).map(move |index| point_at(axes, index))
}

/// The point of a grid with that place in its order.
pub(super) fn point_at(axes: &[Axis], mut index: usize) -> Vec<f64> {
    let from_last = axes.iter().rev().map(|axis| {
        let value = axis.values[index % axis.values.len()];
        index /= axis.values.len();
        value
    });
    let mut values: Vec<f64> = from_last.collect();
    values.reverse();
    values
}

/// Number of points of a grid.
pub(crate) fn points(axes: &[Axis]) -> usize {
    let sizes = axes.iter().map(|axis| axis.values.len());
    sizes.fold(1, usize::saturating_mul)
}

/// The scenes of the points of a grid.
pub(crate) struct PointScenes<'a> {
    axes: &'a [Axis],
    /// One for each variant; one alone without variants.
    templates: Vec<Template>,
}

impl<'a> PointScenes<'a> {
    /// The scenes of all points, made of `scene`, whose numbers must be in their ranges.
    pub(crate) fn new(scene: &Scene, axes: &'a [Axis]) -> Result<Self, PointError> {
        let numbers = axes.iter().filter(|axis| !axis.is_of_variants());
        let keys: Vec<&str> = numbers.map(|axis| axis.key.as_str()).collect();
        let template = |scene: &Scene| {
            let template = Template::new(scene, &keys);
            template.map_err(|problem| PointError::new(&[], &[], vec![problem]))
        };
        let variants = axes.iter().flat_map(|axis| &axis.variants);
        let mut templates = variants
            .map(|variant| template(&variant.scene))
            .collect::<Result<Vec<_>, _>>()?;
        if templates.is_empty() {
            templates.push(template(scene)?);
        }
        Ok(Self { axes, templates })
    }

    /// The scene of a point. Only the ranges of its numbers are checked.
    pub(crate) fn unchecked(&mut self, values: &[f64]) -> Result<Scene, PointError> {
        let pairs = || self.axes.iter().zip(values);
        let variant = pairs().find_map(|(axis, &value)| Some((axis.variant(value)?, value)));
        let factor = |axis: &Axis| {
            let scale = variant.into_iter().flat_map(|(it, _)| &it.scale);
            let own = scale.filter(|(name, _)| *name == axis.name);
            own.map(|(_, factor)| factor).product::<f64>()
        };
        let numbers = pairs().filter(|(axis, _)| !axis.is_of_variants());
        let numbers: Vec<f64> = numbers.map(|(axis, value)| factor(axis) * value).collect();
        let template = variant.map_or(0, |(_, place)| place as usize);
        let scene = self.templates[template].with(&numbers);
        scene.map_err(|problems| PointError::new(self.axes, values, problems))
    }

    /// The scene that is run at a point.
    pub(crate) fn checked(&mut self, values: &[f64]) -> Result<Scene, PointError> {
        let scene = self.unchecked(values)?.with_chosen_step_in_range();
        scene.map_err(|problems| PointError::new(self.axes, values, problems))
    }
}

impl PointError {
    /// What is wrong at the point with these values.
    pub(crate) fn new(axes: &[Axis], values: &[f64], problems: Vec<Problem>) -> Self {
        let pairs = axes.iter().zip(values);
        let mut places = pairs.clone().filter(|(axis, _)| axis.is_of_variants());
        let variant = places.next().map(|(_, place)| *place as usize);
        let pairs: Vec<String> = pairs
            .map(|(axis, &value)| match axis.variant(value) {
                Some(variant) => format!("{} = {}", axis.name, variant.name),
                None => format!("{} = {}", axis.name, number(value)),
            })
            .collect();
        Self {
            point: pairs.join(", "),
            variant,
            problems,
        }
    }
}
