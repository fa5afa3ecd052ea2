//! The jobs of a sweep: every point of its grid with every seed.

use super::Sweep;
use super::study::RunScenes;
use crate::grid::{self, PointError};
use crate::refine::start;
use crate::run::{self, Progress};
use crate::scene::{Integrator, Scene};
use std::fmt;
use std::sync::Arc;

/// One job of a sweep.
#[derive(Clone, Debug)]
pub struct Job {
    /// Identity of the run: the name of its record. That of the [scene](Scene::identity), unless
    /// runs are [timed](super::StudyRuns::Timed).
    pub id: String,
    /// Value on each axis, in the sweep's order.
    pub values: Vec<f64>,
    /// Seed.
    pub seed: u64,
    work: u64,
    integrator: Integrator,
    scene: JobScene,
}

/// Where the scene of a job comes from.
#[derive(Clone)]
enum JobScene {
    /// It belongs to no sweep.
    Alone(Arc<Scene>),
    /// It is made from the values and the seed: a million of them would fill the memory.
    OfSweep(Arc<RunScenes>),
}

impl fmt::Debug for JobScene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Alone(scene) => scene.fmt(f),
            Self::OfSweep(_) => f.write_str("of the sweep"),
        }
    }
}

impl Job {
    /// A job of a scene that belongs to no sweep.
    pub fn alone(id: String, values: Vec<f64>, scene: Scene) -> Self {
        Self {
            id,
            values,
            seed: scene.seed,
            work: work_of(&scene),
            integrator: scene.time.integrator,
            scene: JobScene::Alone(Arc::new(scene)),
        }
    }

    /// The resolved scene, made anew with each call (some microseconds).
    pub fn scene(&self) -> Scene {
        match &self.scene {
            JobScene::Alone(scene) => scene.as_ref().clone(),
            JobScene::OfSweep(scenes) => Scene {
                seed: self.seed,
                ..scenes.at(&self.values).expect("it was made with the job")
            },
        }
    }

    /// The integrator of the scene.
    pub(crate) fn integrator(&self) -> Integrator {
        self.integrator
    }

    /// Work of the whole run, at most, in the unit of its model.
    pub fn work(&self) -> u64 {
        self.work
    }

    /// Work of the run so far, estimated from its progress.
    pub fn work_at(&self, progress: &Progress) -> u64 {
        (progress.share() * self.work() as f64) as u64
    }
}

fn work_of(scene: &Scene) -> u64 {
    run::model_of(scene).work_of(scene)
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
        let scenes = Arc::new(RunScenes::new(self)?);
        let mut last: Option<(Vec<f64>, Scene)> = None;
        let mut jobs = Vec::new();
        for (values, seed) in runs {
            let scene = match last {
                Some((at, scene)) if at == values => scene,
                _ => scenes.at(&values)?,
            };
            let of_seed = Scene {
                seed,
                ..scene.clone()
            };
            jobs.push(Job {
                id: self.id_of_run(&of_seed, &values),
                values: values.clone(),
                seed,
                work: work_of(&of_seed),
                integrator: of_seed.time.integrator,
                scene: JobScene::OfSweep(Arc::clone(&scenes)),
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
