//! The jobs of a sweep: every point of its grid with every seed.

use super::Sweep;
use crate::grid::{self, PointError, PointScenes};
use crate::refine::start;
use crate::run::{self, Progress};
use crate::scene::Scene;

/// One job of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// Identity of the run: the name of its record. That of the [scene](Scene::identity), unless
    /// runs are [timed](super::StudyRuns::Timed).
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
    pub(crate) fn jobs_at(
        &self,
        runs: impl Iterator<Item = (Vec<f64>, u64)>,
    ) -> Result<Vec<Job>, PointError> {
        let mut scenes = PointScenes::new(&self.scene, &self.axes)?;
        let mut last: Option<(Vec<f64>, Scene)> = None;
        let mut jobs = Vec::new();
        for (values, seed) in runs {
            let scene = match last {
                Some((at, scene)) if at == values => scene,
                _ => self.scene_of_run(&mut scenes, &values)?,
            };
            let of_seed = Scene {
                seed,
                ..scene.clone()
            };
            jobs.push(Job {
                id: self.id_of_run(&of_seed, &values),
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
        grid::number_of_points(&self.axes)
    }

    /// The points of the grid, in order.
    pub(crate) fn grid(&self) -> impl Iterator<Item = Vec<f64>> {
        grid::points(&self.axes)
    }
}
