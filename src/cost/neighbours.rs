//! What each way to find neighbours costs (Remmers, 2009, assignments 7 and 8).

use crate::cpu_time;
use crate::dem::{DemBuildError, DemSimulation};
use crate::document::Problem;
use crate::record::Instability;
use crate::scene::{DemScene, Neighbours, Radii, Scene, Start, StartSphere};

/// Time that the spheres move on after the last one came in, before anything is measured (s).
const CALM: f64 = 1.0;
/// Steps after which all searches must have given the same bits; they are not measured.
const WARM_UP: u64 = 20;
/// Least processor time of one measurement (s).
const LEAST_TIME: f64 = 0.02;
/// Measurements of each search, of which the median counts.
const ROUNDS: usize = 7;

/// Why nothing can be measured.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// With that number of spheres it is no scene.
    #[error("with {count} spheres: {problem}")]
    Problem {
        /// Number of spheres.
        count: usize,
        /// What is wrong.
        problem: Problem,
    },
    /// The scene cannot be built.
    #[error(transparent)]
    Build(#[from] DemBuildError),
    /// A guard ended the run on the way to the state to measure in.
    #[error("the scene is unstable: {0}")]
    Unstable(#[from] Instability),
    /// The spheres do not come in before the scene's end.
    #[error(
        "{count} spheres are not in after time.duration = {duration} s: extend it, or make room \
         for them"
    )]
    NotFilled {
        /// Number of spheres.
        count: usize,
        /// Duration of the scene (s).
        duration: f64,
    },
}

/// What a step costs with one search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// The search.
    pub neighbours: Neighbours,
    /// Processor time of a step (s): the median of all measurements.
    pub step_time: f64,
}

/// A scene at a moment in which all of its spheres are in.
pub struct Moment {
    scene: Scene,
    /// Spheres that never move.
    pub fixed: usize,
}

impl Moment {
    /// The moment a while after the last of `count` spheres came into `scene`, or after its start.
    ///
    /// # Errors
    /// If the scene does not get there.
    pub fn of_scene(scene: &Scene, count: usize) -> Result<Self, StudyError> {
        let mut scene = scene.clone();
        scene.spheres.count = count;
        if let Radii::Each(radii) = &mut scene.spheres.radius {
            radii.truncate(count);
        }
        if let Some(spheres) = scene.start.list_mut() {
            spheres.truncate(count);
        }
        scene.dem.driven.retain(|driven| driven.sphere < count);
        if let Some(problem) = scene.problems().into_iter().next() {
            return Err(StudyError::Problem { count, problem });
        }
        let mut simulation = DemSimulation::new(&scene)?;
        let steps = |time: f64| ((time / scene.time.dt).round() as u64).max(1);
        while simulation.particles().len() - simulation.particles().fixed < count {
            if simulation.time() > scene.time.duration {
                let duration = scene.time.duration;
                return Err(StudyError::NotFilled { count, duration });
            }
            simulation.advance(steps(scene.time.frame_interval))?;
        }
        simulation.advance(steps(CALM))?;
        let particles = simulation.particles();
        let spheres = (particles.fixed..particles.len()).map(|i| {
            let vector = |vectors: &[crate::particles::vector::Vector]| {
                vectors.get(i).map_or([0.0; 3], |it| [it.x, it.y, it.z])
            };
            StartSphere {
                velocity: vector(&particles.velocity),
                spin: vector(&particles.spin),
                radius: Some(particles.radius[i]),
                ..StartSphere::at(vector(&particles.position))
            }
        });
        let start = Start::list(spheres.collect());
        let fixed = particles.fixed;
        Ok(Self {
            scene: Scene {
                start,
                dem: DemScene {
                    // Nobody comes or goes from here on.
                    door: None,
                    rest: None,
                    outlet: None,
                    ..scene.dem
                },
                ..scene
            },
            fixed,
        })
    }

    /// Number of spheres that move.
    pub fn spheres(&self) -> usize {
        self.scene.spheres.count
    }

    /// What a step costs with each search, measured in turn, and whether all of them gave the same
    /// bits.
    ///
    /// # Errors
    /// If a guard is broken on the way.
    pub fn measure(&self, searches: &[Neighbours]) -> Result<(Vec<Cost>, bool), StudyError> {
        let mut runs = Vec::new();
        for &neighbours in searches {
            let mut simulation = DemSimulation::new(&Scene {
                dem: DemScene {
                    neighbours,
                    ..self.scene.dem.clone()
                },
                ..self.scene.clone()
            })?;
            simulation.advance(WARM_UP)?;
            runs.push(Run {
                simulation,
                steps: 1,
                times: Vec::new(),
            });
        }
        let bits: Vec<Vec<u64>> = runs.iter().map(|run| bits(&run.simulation)).collect();
        let same_bits = bits.windows(2).all(|pair| pair[0] == pair[1]);
        for run in &mut runs {
            run.calibrate()?;
        }
        for _ in 0..ROUNDS {
            for run in &mut runs {
                run.measure()?;
            }
        }
        let costs = searches.iter().zip(&mut runs);
        let costs = costs.map(|(&neighbours, run)| Cost {
            neighbours,
            step_time: run.median(),
        });
        Ok((costs.collect(), same_bits))
    }
}

/// A simulation whose steps are timed.
struct Run {
    simulation: DemSimulation,
    /// Steps of one measurement.
    steps: u64,
    /// Times of a step (s).
    times: Vec<f64>,
}

impl Run {
    /// Processor time of so many steps (s).
    fn time(&mut self, steps: u64) -> Result<f64, StudyError> {
        let started = cpu_time::of_this_thread();
        self.simulation.advance(steps)?;
        Ok(cpu_time::of_this_thread() - started)
    }

    /// Finds how many steps take long enough to be measured.
    fn calibrate(&mut self) -> Result<(), StudyError> {
        while self.time(self.steps)? < LEAST_TIME {
            self.steps *= 2;
        }
        Ok(())
    }

    fn measure(&mut self) -> Result<(), StudyError> {
        let time = self.time(self.steps)?;
        self.times.push(time / self.steps as f64);
        Ok(())
    }

    fn median(&mut self) -> f64 {
        self.times.sort_by(f64::total_cmp);
        self.times[self.times.len() / 2]
    }
}

fn bits(simulation: &DemSimulation) -> Vec<u64> {
    let particles = simulation.particles();
    let vectors = particles.position.iter().chain(&particles.velocity);
    vectors
        .flat_map(|vector| [vector.x, vector.y, vector.z])
        .map(f64::to_bits)
        .collect()
}
