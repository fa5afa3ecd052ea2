//! From a scene to a running simulation.

use super::columns::ContactColumns;
use super::frame::of_moving;
use super::guard::Limits;
use super::laws::{DemBuildError, engine};
use super::neighbours::VerletList;
use super::order;
use super::process::{Feed, Process};
use super::system::{Engine, SystemSetup};
use crate::cpu_time;
use crate::forces::effects::Targets;
use crate::particles::vector::Vector;
use crate::particles::{Particles, Sphere};
use crate::scene::{Driven, Neighbours, Rolling, Scene, Start};
use crate::simulation::{Counts, Instability, Milestone};
use crate::start;
use crate::walls::{Wall, with_joints};
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// First skin of a neighbour list for contacts, in radii of the largest sphere. The list then holds
/// for many steps and is still short.
const CONTACT_SKIN: f64 = 0.5;

/// The same for the columns of an updraught's shield, whose list grows less with its skin.
const COLUMN_SKIN: f64 = 1.0;

/// Walls count as joined within this distance, in radii of the smallest sphere: their places are
/// rounded.
const JOINED: f64 = 1e-4;

/// A running simulation.
pub struct DemSimulation {
    pub(super) engine: Box<dyn Engine>,
    /// `None` if no sphere comes or goes.
    pub(super) process: Option<Process>,
    /// Radius (m), mass (kg) and moment of inertia (kg m2) of every sphere of the scene, including
    /// spheres that are not in yet. Empty if all are alike and sorted.
    pub(super) radius: Vec<f64>,
    pub(super) mass: Vec<f64>,
    pub(super) inertia: Vec<f64>,
    dt: f64,
    pub(super) steps_per_frame: u64,
    /// Columns of positions, velocities and spins, which a frame borrows.
    pub(super) components: [[Vec<f64>; 3]; 3],
    /// Absent if the scene asks for no further column of contacts.
    pub(super) columns: Option<ContactColumns>,
    /// The threads that the engine runs on, if there are several.
    pool: Option<ThreadPool>,
}

impl DemSimulation {
    /// Places the spheres of a scene and makes it ready to run.
    ///
    /// # Errors
    /// If the spheres cannot be placed, or laws do not fit together.
    pub fn new(scene: &Scene) -> Result<Self, DemBuildError> {
        let skin = match (scene.dem.neighbours, &scene.dem.effects.updraught) {
            (Neighbours::VerletList, None) => CONTACT_SKIN,
            (Neighbours::VerletList, Some(_)) => COLUMN_SKIN,
            // These lists are built in every step.
            _ => 0.0,
        };
        Self::with_skin(scene, skin)
    }

    /// The same with another first skin of the neighbour list, in radii of the largest sphere: 0
    /// rebuilds the list at every step, a large skin lists all pairs. Only the speed depends on it:
    /// a test compares the bits.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_skin(scene: &Scene, skin: f64) -> Result<Self, DemBuildError> {
        let spheres = start::place(scene)?;
        let mean_radius = spheres.radius.iter().sum::<f64>() / spheres.radius.len() as f64;
        let alike = spheres.radius.windows(2).all(|two| two[0] == two[1]);
        let skin = skin * spheres.largest_radius();
        let mut particles = start::fixed(scene);
        let mut scalars = None;
        let mut feed = None;
        match scene.start {
            Start::Feed { interval, .. } => {
                scalars = Some(scalars_of(&spheres));
                let interval = (interval / scene.time.dt).round() as u64;
                feed = Some(Feed::new(waiting(&spheres, scene), interval));
            }
            _ => particles.append(spheres),
        }
        let present = particles.len() - particles.fixed;
        particles.domain = scene.domain();
        let process = Process::of_scene(scene, feed, present);
        let flows = process.is_some();
        let sorted = scene.spheres.count >= order::MANY;
        if sorted || flows {
            particles.number = (0..particles.fixed as u32)
                .chain(0..present as u32)
                .collect();
        }
        // Spheres that are alike have the same values in any order: one copy saves memory.
        let [radius, mass, inertia] = match sorted && alike && !flows {
            true => Default::default(),
            false => scalars.unwrap_or_else(|| scalars_of(&particles)),
        };
        let setup = SystemSetup {
            sorted,
            flows,
            ..setup(scene, &particles, skin)
        };
        let mut engine = engine(scene, setup, particles)?;
        if scene.output.ledger {
            engine.keep_ledger();
        }
        Ok(Self {
            engine,
            process,
            radius,
            mass,
            inertia,
            dt: scene.time.dt,
            steps_per_frame: scene.time.steps_per_frame(),
            components: Default::default(),
            columns: ContactColumns::new(scene, mean_radius),
            pool: None,
        })
    }

    /// Advances by a number of steps.
    ///
    /// # Errors
    /// The guard that was broken; the simulation must not be advanced any further.
    pub fn advance(&mut self, steps: u64) -> Result<(), Instability> {
        let engine = self.engine.as_mut();
        let end = engine.step() + steps;
        let process = &mut self.process;
        let mut advance = || match process {
            Some(process) => process.advance(engine, end),
            None => engine.advance(steps),
        };
        let result = match &self.pool {
            Some(pool) => pool.install(advance),
            None => advance(),
        };
        // A guard names a sphere by its index in memory.
        result.map_err(|instability| Instability {
            sphere: self.engine.particles().number_in_scene(instability.sphere),
            ..instability
        })
    }

    /// Whether all spheres are in, and all have left or are at rest for good: nothing more will
    /// happen. Always false in a scene where no sphere comes or goes.
    pub fn ended(&self) -> bool {
        self.process.as_ref().is_some_and(Process::ended)
    }

    /// How many spheres came and went, in a scene where they do.
    pub fn counts(&self) -> Option<Counts> {
        let process = self.process.as_ref()?;
        Some(process.counts(self.radius.len()))
    }

    /// Events that happened so far, in a scene where spheres come or go.
    pub fn milestones(&self) -> &[Milestone] {
        self.process.as_ref().map_or(&[], Process::milestones)
    }

    /// Radius of every sphere of the scene that moves (m), by its number.
    pub fn radius(&self) -> &[f64] {
        match self.radius.is_empty() {
            true => of_moving(&self.particles().radius, self.particles()),
            false => &self.radius,
        }
    }

    /// Mass of every sphere of the scene that moves (kg), by its number.
    pub fn mass(&self) -> &[f64] {
        match self.mass.is_empty() {
            true => of_moving(&self.particles().mass, self.particles()),
            false => &self.mass,
        }
    }

    /// Uses only instructions that every machine of this architecture has. Slower, with the same
    /// bits: a test compares the two.
    pub fn use_baseline_instructions(&mut self) {
        self.engine.use_baseline_instructions();
    }

    /// Advances on this number of threads from now on, in scenes of [`MANY`](order::MANY) spheres
    /// or more, where that pays. The bits do not depend on it.
    ///
    /// # Errors
    /// If the system cannot start threads.
    pub fn use_threads(&mut self, threads: usize) -> Result<(), ThreadPoolBuildError> {
        self.pool = match self.engine.use_threads(threads) {
            true => Some(ThreadPoolBuilder::new().num_threads(threads).build()?),
            false => None,
        };
        Ok(())
    }

    /// Processor time (s) of its threads besides the caller's.
    pub(crate) fn seconds_of_threads(&self) -> f64 {
        let pool = self.pool.iter();
        pool.flat_map(|pool| pool.broadcast(|_| cpu_time::of_this_thread()))
            .sum()
    }

    /// The spheres that are in the simulation, the fixed ones first. Fewer than
    /// [`MANY`](order::MANY) others are in the order of the scene, more are sorted by place: see
    /// [`number`](Particles::number).
    pub fn particles(&self) -> &Particles {
        self.engine.particles()
    }

    /// Steps done.
    pub fn step(&self) -> u64 {
        self.engine.step()
    }

    /// How often a sphere was moved, counting sub-steps: the cost of the run in sphere-steps.
    pub fn moves(&self) -> u64 {
        self.engine.moves()
    }

    /// Time (s).
    pub fn time(&self) -> f64 {
        self.engine.step() as f64 * self.dt
    }

    /// The neighbour list, if any pairs interact.
    pub fn list(&self) -> Option<&VerletList> {
        self.engine.list()
    }

    /// Elastic energy of all contacts (J). Asking for it never changes the motion.
    pub fn elastic_energy(&mut self) -> f64 {
        self.engine.contacts().elastic_energy
    }
}

/// What a system needs from a scene besides laws and spheres, with the skin of the neighbour list
/// (m). Spheres are not sorted in memory.
fn setup(scene: &Scene, particles: &Particles, skin: f64) -> SystemSetup {
    let tank = scene.tank.as_ref();
    let is_closed = scene.dem.door.is_some();
    let walls = with_joints(Wall::of_scene(scene), joined_within(scene));
    // Where walls join, too.
    let in_space = |wall: Wall| wall.in_space(particles.domain);
    SystemSetup {
        walls: walls.into_iter().map(in_space).collect(),
        closed_floor: tank
            .and_then(Wall::floor_with_opening)
            .filter(|_| is_closed),
        effects: scene.dem.effects.build(&Targets {
            radii: &particles.radius,
            scene: scene.facts(),
            lag: scene.time.integrator.lag() * scene.time.dt,
        }),
        shielded: scene.dem.effects.updraught.is_some(),
        driven: driven(scene),
        rolling: scene.dem.rolling.as_ref().map(Rolling::law),
        limits: Limits::new(scene, particles),
        dt: scene.time.dt,
        integrator: scene.time.integrator,
        resolution: scene.time.resolution(),
        neighbours: scene.dem.neighbours,
        skin,
        sorted: false,
        flows: false,
    }
}

/// Distance within which walls of a scene count as joined (m).
pub(super) fn joined_within(scene: &Scene) -> f64 {
    JOINED * scene.smallest_radius()
}

/// The paths of the driven spheres of a scene, in the order of the spheres.
fn driven(scene: &Scene) -> Vec<Driven> {
    let mut paths = scene.dem.driven.clone();
    paths.sort_by_key(|path| path.sphere);
    paths
}

/// Radii, masses and moments of inertia of the spheres that move.
fn scalars_of(particles: &Particles) -> [Vec<f64>; 3] {
    [&particles.radius, &particles.mass, &particles.inertia]
        .map(|values| of_moving(values, particles).to_vec())
}

/// The spheres of a scene that come in later.
fn waiting(spheres: &Particles, scene: &Scene) -> Vec<Sphere> {
    let gravity = scene.gravity_in_fluid();
    let gravity = gravity.map_or([0.0; 2], |it| it.components());
    let sphere = |i: usize| Sphere {
        number: i as u32,
        position: spheres.position[i],
        velocity: spheres.velocity[i],
        radius: spheres.radius[i],
        mass: spheres.mass[i],
        inertia: spheres.inertia.get(i).copied(),
        // Nothing else acts on it where it comes in.
        force: Vector::new(gravity[0], 0.0, gravity[1]) * spheres.mass[i],
    };
    (0..spheres.len()).map(sphere).collect()
}
