//! The spot model as a model of the program.

use super::parameters::{
    Influence, Parameters, Relaxation, Schedule, SpotOpening, Walk as WalkParameters,
};
use super::profile;
use super::{SpotFailure, SpotGuard, SpotSimulation};
use crate::particles::vector::Vector;
use crate::scene::{RelaxationMethod, Scene, Spot, SpotRelaxation, SpotSchedule, Tank};
use crate::simulation::{
    BuildError, Column, Counts, Flow, Frame, FrameView, Guard, Instability, Milestone,
    MilestoneKind, Model, PartOfStep, Profile, Simulation, StateError,
};
use crate::start;
use rayon::ThreadPoolBuildError;
use serde::{Deserialize, Serialize};
use std::io;

/// The spot model.
#[derive(Clone, Copy, Debug)]
pub struct SpotModel;

impl Model for SpotModel {
    fn work_unit(&self) -> &'static str {
        "spot-moves"
    }

    /// Spots enter all the time, and move until they reach the top of the packing.
    fn work_of(&self, scene: &Scene) -> u64 {
        let Some(spot) = &scene.spot else { return 0 };
        let duration = scene.time.duration;
        let moves_to_the_top = scene.packed_height() / spot.vertical_step;
        let rising = (moves_to_the_top / spot.move_rate).min(duration);
        let moves = spot.move_rate * rising * (duration - 0.5 * rising);
        (spot.insertion_rate * moves) as u64
    }

    fn parts_of(&self, scene: &Scene) -> Vec<PartOfStep> {
        let relaxes = |spot: &Spot| spot.relaxation.method != RelaxationMethod::Off;
        profile::parts(scene.spot.as_ref().is_some_and(relaxes))
    }

    fn build(&self, scene: &Scene) -> Result<Box<dyn Simulation>, BuildError> {
        let parameters = parameters(scene).ok_or_else(|| BuildError::new(NoBox))?;
        let spheres = start::place(scene).map_err(BuildError::new)?;
        let floor = floor(scene);
        let places: Vec<Vector> = spheres.position.iter().map(|it| *it - floor).collect();
        let simulation =
            SpotSimulation::new(parameters, &places, scene.seed).map_err(BuildError::new)?;
        Ok(Box::new(SpotDrainage {
            before: simulation.positions(),
            radius: spheres.radius,
            mass: spheres.mass,
            floor,
            interval: scene.time.frame_interval,
            frame: 0,
            milestones: Vec::new(),
            simulation,
        }))
    }
}

/// The scene was not checked.
#[derive(Debug, thiserror::Error)]
#[error("spots need [spot] and a tank with width, depth and an opening in its floor")]
struct NoBox;

/// The height of the floor (m), which the engine takes for 0.
fn floor(scene: &Scene) -> Vector {
    let floor = scene.tank.as_ref().and_then(|tank| tank.floor);
    Vector::new(0.0, 0.0, floor.unwrap_or(0.0))
}

/// The parameters of the engine for a scene.
fn parameters(scene: &Scene) -> Option<Parameters> {
    let (spot, tank) = (scene.spot.as_ref()?, scene.tank.as_ref()?);
    let diameter = 2.0 * scene.spheres.radius.mean();
    let across = spot.horizontal_step();
    Some(Parameters {
        half_width: 0.5 * tank.width?,
        half_depth: 0.5 * tank.depth?,
        orifice: orifice(tank)?,
        diameter,
        spot_radius: spot.radius,
        relaxation_radius: spot.relaxation.radius.unwrap_or(spot.radius + diameter),
        displacement_ratio: spot.displacement_ratio,
        step: [across, across, spot.vertical_step],
        insertion_rate: spot.insertion_rate,
        move_rate: spot.move_rate,
        wall_distance: scene.wall_distance_of_spots(spot),
        relaxation_strength: spot.relaxation.strength,
        removal_height: diameter,
        schedule: match spot.schedule {
            SpotSchedule::Events => Schedule::Events,
            SpotSchedule::StepsRandom => Schedule::StepsInRandomOrder,
            SpotSchedule::StepsNewestFirst => Schedule::StepsNewestFirst,
        },
        relaxation: relaxation(&spot.relaxation),
        walk: match spot.walk {
            None => WalkParameters::Unbiased,
            Some(walk) => WalkParameters::Biased {
                exponent: walk.bias,
            },
        },
        influence: match spot.weighting {
            None => Influence::Fixed,
            Some(it) => Influence::Weighted {
                volume_ratio: it.volume_ratio,
                least_count: it.least_count,
                above: it.above,
            },
        },
        reflection: spot.reflection,
    })
}

fn orifice(tank: &Tank) -> Option<SpotOpening> {
    let round = tank
        .orifice_radius
        .map(|radius| SpotOpening::Circle { radius });
    round.or(tank.slit_width.map(|width| SpotOpening::Slit {
        half_width: 0.5 * width,
    }))
}

fn relaxation(relaxation: &SpotRelaxation) -> Relaxation {
    let ratio = relaxation.ratio;
    match relaxation.method {
        RelaxationMethod::EveryMove => Relaxation::EveryMove,
        RelaxationMethod::Off => Relaxation::Off,
        RelaxationMethod::AtRandom => Relaxation::AtRandom { ratio },
        RelaxationMethod::Counted => Relaxation::Counted { ratio },
        RelaxationMethod::Global => Relaxation::Global { ratio },
    }
}

/// A drainage by spots, advanced frame by frame.
struct SpotDrainage {
    simulation: SpotSimulation,
    /// Centres at the frame before (m).
    before: Vec<Option<Vector>>,
    radius: Vec<f64>,
    mass: Vec<f64>,
    floor: Vector,
    /// Time between frames (s).
    interval: f64,
    frame: u64,
    milestones: Vec<Milestone>,
}

/// The contents of a checkpoint besides the state of the spots.
#[derive(Serialize, Deserialize)]
struct DrainageState {
    spots: Vec<u8>,
    before: Vec<Option<Vector>>,
    frame: u64,
    milestones: Vec<Milestone>,
}

impl Simulation for SpotDrainage {
    fn advance_frame(&mut self) -> Result<(), Instability> {
        self.before = self.simulation.positions();
        self.frame += 1;
        let time = self.time();
        self.simulation
            .advance_to(time)
            .map_err(|failure| self.instability(failure))?;
        if self.simulation.spheres_inside() == 0 && self.milestones.is_empty() {
            let kind = MilestoneKind::Emptied;
            self.milestones.push(Milestone { kind, time });
        }
        Ok(())
    }

    fn time(&self) -> f64 {
        self.frame as f64 * self.interval
    }

    fn ended(&self) -> bool {
        self.simulation.spheres_inside() == 0
    }

    fn work(&self) -> u64 {
        self.simulation.counts().moves
    }

    fn radius(&self) -> &[f64] {
        &self.radius
    }

    fn mass(&self) -> &[f64] {
        &self.mass
    }

    fn look(&mut self, look: &mut dyn FnMut(&dyn Frame)) {
        let mut columns = SphereColumns::default();
        let now = self.simulation.positions();
        for (number, centre) in now.iter().enumerate() {
            if let Some(centre) = centre {
                let before = self.before[number].unwrap_or(*centre);
                let velocity = (*centre - before) * (1.0 / self.interval);
                columns.add(number, *centre + self.floor, velocity);
                columns.radius.push(self.radius[number]);
                columns.mass.push(self.mass[number]);
            }
        }
        look(&columns.view(self.radius.len()));
    }

    fn columns(&self) -> &[Column] {
        &[Column {
            name: "spots",
            unit: "1",
            description: "Number of spots in the packing",
        }]
    }

    fn values(&mut self) -> Vec<f64> {
        vec![self.simulation.spots().len() as f64]
    }

    fn save(&self, to: &mut dyn io::Write) -> io::Result<()> {
        let state = DrainageState {
            spots: self.simulation.save().map_err(io::Error::other)?,
            before: self.before.clone(),
            frame: self.frame,
            milestones: self.milestones.clone(),
        };
        let written = postcard::to_io(&state, to);
        written.map(drop).map_err(io::Error::other)
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), StateError> {
        let Ok((state, [])) = postcard::take_from_bytes::<DrainageState>(state) else {
            return Err(StateError::OTHER_FORM);
        };
        if state.before.len() != self.radius.len() {
            return Err(StateError("its number of spheres differs"));
        }
        let parameters = self.simulation.parameters().clone();
        self.simulation = SpotSimulation::restore(parameters, &state.spots)
            .map_err(|_| StateError("its spots belong to another scene"))?;
        self.before = state.before;
        self.frame = state.frame;
        self.milestones = state.milestones;
        Ok(())
    }

    fn counts(&self) -> Option<Counts> {
        Some(Counts {
            all: self.radius.len(),
            placed: self.radius.len(),
            released: self.radius.len(),
            discharged: self.simulation.spheres_left(),
            spilled: 0,
            is_closed: false,
            can_leave: true,
        })
    }

    fn milestones(&self) -> &[Milestone] {
        &self.milestones
    }

    fn use_threads(&mut self, threads: usize) -> Result<(), ThreadPoolBuildError> {
        self.simulation.use_threads(threads)
    }

    fn keep_profile(&mut self) {
        self.simulation.keep_profile();
    }

    fn profile(&self) -> Option<&Profile> {
        self.simulation.profile()
    }
}

impl SpotDrainage {
    /// The report of a broken guard. For a spot, it names the sphere next to it.
    fn instability(&self, failure: SpotFailure) -> Instability {
        let distance = |centre: &Vector| (*centre - failure.place).norm_squared();
        let nearest = || {
            let inside = self.before.iter().enumerate();
            let inside = inside.filter_map(|(number, it)| Some((number, distance(it.as_ref()?))));
            inside.min_by(|(_, one), (_, other)| one.total_cmp(other))
        };
        let sphere = failure.sphere.map(|it| it as usize);
        let Vector { x, y, z, .. } = failure.place;
        Instability {
            guard: match failure.guard {
                SpotGuard::NotANumber => Guard::NotANumber,
                SpotGuard::Displacement => Guard::Displacement,
                SpotGuard::Crowded => Guard::Crowded,
                SpotGuard::EmptySpot => Guard::EmptySpot,
            },
            step: failure.moves,
            time: failure.time,
            sphere: sphere.or_else(|| nearest().map(|(it, _)| it)).unwrap_or(0),
            detail: format!("{}; at ({x:.4}, {y:.4}, {z:.4}) m", failure.detail),
        }
    }
}

/// The spheres that are inside, by columns.
#[derive(Default)]
struct SphereColumns {
    position: [Vec<f64>; 3],
    velocity: [Vec<f64>; 3],
    radius: Vec<f64>,
    mass: Vec<f64>,
    number: Vec<u32>,
}

impl SphereColumns {
    fn add(&mut self, number: usize, centre: Vector, velocity: Vector) {
        let both = [(&mut self.position, centre), (&mut self.velocity, velocity)];
        for (columns, it) in both {
            for (column, component) in columns.iter_mut().zip([it.x, it.y, it.z]) {
                column.push(component);
            }
        }
        self.number.push(number as u32);
    }

    fn view(&self, spheres: usize) -> FrameView<'_> {
        FrameView {
            position: [&self.position[0], &self.position[1], &self.position[2]],
            velocity: [&self.velocity[0], &self.velocity[1], &self.velocity[2]],
            spin: None,
            radius: &self.radius,
            mass: &self.mass,
            inertia: &[],
            elastic_energy: 0.0,
            ledger: None,
            number: Some(&self.number),
            flow: Some(Flow {
                spheres,
                released: spheres,
                discharged: spheres - self.number.len(),
                spilled: 0,
                contacts: 0,
            }),
        }
    }
}
