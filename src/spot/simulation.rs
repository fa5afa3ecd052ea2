//! A simulation of drainage by spots.

use super::arrangement::Arrangement;
use super::guard::{Fault, SpotFailure};
use super::model::{Scratch, SpotRules};
use super::neighbours::NeighbourLists;
use super::parameters::{Parameters, Schedule};
use super::profile::{Clock, DrainagePart};
use super::random::RandomStream;
use super::region::NOWHERE;
use super::slack::Wear;
use super::state::{SpotCounts, SpotError, SpotState};
use super::threads::Workers;
use super::walk::MovingSpot;
use crate::particles::block::ROWS;
use crate::particles::vector::Vector;
use crate::scene::STICKING_OUT;
use crate::simulation::Profile;
use rayon::ThreadPoolBuildError;

/// Names of the streams of random numbers for spots and for relaxations.
pub(super) const STREAMS: [&str; 2] = ["spot walk", "spot relaxation"];

/// A simulation of drainage by spots.
///
/// The same parameters, positions and seed give the same bits, independent of the number of
/// threads, of the times at which it is observed, and of saving and restoring in between.
#[derive(Debug)]
pub struct SpotSimulation {
    pub(super) model: SpotRules,
    pub(super) arrangement: Arrangement,
    /// Centres in order of the arrangement (m), padded for vector instructions.
    pub(super) position: Vec<Vector>,
    pub(super) spots: Vec<MovingSpot>,
    pub(super) scratch: Scratch,
    pub(super) random: [RandomStream; 2],
    pub(super) counts: SpotCounts,
    pub(super) next_event: f64,
    pub(super) steps: u64,
    /// Number of spots now inside that move in the lower part of the next step.
    pub(super) lower: usize,
    pub(super) workers: Workers,
    seed: u64,
    time: f64,
    left: Vec<Option<Vector>>,
}

impl SpotSimulation {
    /// A simulation that starts from these centres (m).
    ///
    /// # Errors
    ///
    /// If a parameter is invalid, or if spheres are outside the box or crowded.
    pub fn new(parameters: Parameters, position: &[Vector], seed: u64) -> Result<Self, SpotError> {
        parameters.check()?;
        check_positions(&parameters, position)?;
        let model = SpotRules::new(parameters);
        let mut random = STREAMS.map(|name| RandomStream::new(name, seed));
        let next_event = random[0].exponential() / model.parameters.insertion_rate;
        let mut sorted = position.to_vec();
        let ids = (0..position.len() as u32).collect();
        let spheres = (&mut sorted, ids);
        let arrangement = Arrangement::sorted(model.sorting(), spheres, NeighbourLists::new());
        let counts = SpotCounts::default();
        let arrangement = arrangement
            .map_err(|fault| SpotError::Failure(Box::new(failure(fault, None, &counts, 0.0))))?;
        Ok(Self {
            model,
            arrangement,
            position: sorted,
            spots: Vec::new(),
            scratch: Scratch::default(),
            random,
            counts,
            next_event,
            steps: 0,
            lower: 0,
            workers: Workers::default(),
            seed,
            time: 0.0,
            left: vec![None; position.len()],
        })
    }

    /// Lets everything happen up to a time (s).
    ///
    /// # Errors
    ///
    /// If a guard breaks. The state then belongs to no time and is only good for inspection.
    pub fn advance_to(&mut self, time: f64) -> Result<(), SpotFailure> {
        self.scratch.clock.enter();
        let advanced = match self.model.parameters.schedule {
            Schedule::Events => self.events_until(time),
            Schedule::StepsInRandomOrder | Schedule::StepsNewestFirst => self.steps_until(time),
        };
        self.scratch.clock.leave();
        advanced?;
        self.time = self.time.max(time);
        Ok(())
    }

    /// Begins to measure the times of the parts of a drainage. Never changes the motion.
    pub(super) fn keep_profile(&mut self) {
        self.scratch.clock = Clock::started();
    }

    /// The measured times.
    pub(super) fn profile(&self) -> Option<&Profile> {
        self.scratch.clock.profile()
    }

    /// Up to which time everything has happened (s).
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Parameters of this simulation.
    pub fn parameters(&self) -> &Parameters {
        &self.model.parameters
    }

    /// Centres of the spheres in order of their numbers (m); `None` for spheres that have left.
    pub fn positions(&self) -> Vec<Option<Vector>> {
        let mut positions = vec![None; self.left.len()];
        for (id, &position) in self.arrangement.id.iter().zip(&self.position) {
            if self.left[*id as usize].is_none() {
                positions[*id as usize] = Some(position);
            }
        }
        positions
    }

    /// Where spheres were when they left (m), in order of their numbers; `None` for spheres inside.
    pub fn left(&self) -> &[Option<Vector>] {
        &self.left
    }

    /// Number of spheres inside.
    pub fn spheres_inside(&self) -> usize {
        self.left.iter().filter(|it| it.is_none()).count()
    }

    /// Number of spheres that have left through the orifice.
    pub fn spheres_left(&self) -> usize {
        self.left.len() - self.spheres_inside()
    }

    /// The spots.
    pub fn spots(&self) -> &[MovingSpot] {
        &self.spots
    }

    /// What has happened so far.
    pub fn counts(&self) -> &SpotCounts {
        &self.counts
    }

    /// Lets steps, relaxations of all spheres and sorting use this number of threads.
    ///
    /// # Errors
    /// If the system cannot start threads.
    pub fn use_threads(&mut self, threads: usize) -> Result<(), ThreadPoolBuildError> {
        self.workers = Workers::new(threads)?;
        Ok(())
    }

    /// The complete state, for [`Self::restore`].
    ///
    /// # Errors
    ///
    /// If it cannot be serialised.
    pub fn save(&self) -> Result<Vec<u8>, SpotError> {
        let spheres = self.arrangement.spheres;
        let state = SpotState {
            seed: self.seed,
            time: self.time,
            next_event: self.next_event,
            steps: self.steps,
            spots: self.spots.clone(),
            position: self.position[..spheres].to_vec(),
            reference: self.arrangement.reference[..spheres].to_vec(),
            id: self.arrangement.id.clone(),
            left: self.left.clone(),
            wear: self.scratch.wear,
            lower: self.lower as u32,
            counts: self.counts,
            drawn: [self.random[0].drawn(), self.random[1].drawn()],
        };
        postcard::to_stdvec(&(&self.model.parameters, state))
            .map_err(|error| SpotError::Checkpoint(error.to_string()))
    }

    /// The simulation whose state was saved, with the same parameters.
    ///
    /// # Errors
    ///
    /// If the bytes are not such a state, or have other parameters.
    pub fn restore(parameters: Parameters, bytes: &[u8]) -> Result<Self, SpotError> {
        let (saved, mut state): (Parameters, SpotState) = postcard::from_bytes(bytes)
            .map_err(|error| SpotError::Checkpoint(error.to_string()))?;
        if saved != parameters {
            return Err(SpotError::OtherParameters);
        }
        parameters.check()?;
        state.check().map_err(SpotError::Checkpoint)?;
        let model = SpotRules::new(parameters);
        let spheres = (state.reference, state.id);
        let arrangement = Arrangement::restored(model.sorting(), spheres)
            .map_err(|fault| failure(fault, None, &state.counts, state.time))
            .map_err(|failure| SpotError::Failure(Box::new(failure)))?;
        let filled = state.position.len() + ROWS;
        state.position.resize(filled, NOWHERE);
        let [walk, relaxation] = state.drawn;
        let resumed = |name: &str, drawn| RandomStream::resumed(name, state.seed, drawn);
        Ok(Self {
            model,
            arrangement,
            position: state.position,
            spots: state.spots,
            scratch: Scratch {
                wear: state.wear,
                ..Scratch::default()
            },
            random: [resumed(STREAMS[0], walk), resumed(STREAMS[1], relaxation)],
            counts: state.counts,
            next_event: state.next_event,
            steps: state.steps,
            lower: state.lower as usize,
            workers: Workers::default(),
            seed: state.seed,
            time: state.time,
            left: state.left,
        })
    }

    /// Sorts the spheres if they must be sorted before the next move.
    pub(super) fn sort_if_stale(&mut self) -> Result<(), Fault> {
        match self.scratch.wear.stale {
            true => self.sort(),
            false => Ok(()),
        }
    }

    /// Begins a step, and sorts the spheres if they would have to be sorted during it.
    pub(super) fn sort_if_worn(&mut self) -> Result<(), Fault> {
        if self.scratch.wear.worn {
            self.sort()?;
        }
        self.scratch.wear.begin_step();
        Ok(())
    }

    fn sort(&mut self) -> Result<(), Fault> {
        self.scratch.clock.begin_whole();
        let spheres = self.arrangement.spheres;
        let mut ids = Vec::with_capacity(spheres);
        let mut position = Vec::with_capacity(spheres + ROWS);
        for (id, place) in self.arrangement.id.iter().zip(&self.position) {
            if place.z > NOWHERE.z {
                ids.push(*id);
                position.push(*place);
            }
        }
        let neighbours = std::mem::replace(&mut self.arrangement.neighbours, NeighbourLists::new());
        let (sorting, spheres) = (self.model.sorting(), (&mut position, ids));
        self.arrangement = self
            .workers
            .install(|| Arrangement::sorted(sorting, spheres, neighbours))?;
        self.position = position;
        self.scratch.wear = Wear::default();
        self.counts.sorts += 1;
        self.scratch.clock.end_whole(DrainagePart::Order);
        Ok(())
    }

    /// Counts the spheres that have left.
    pub(super) fn count_left(&mut self) {
        for (slot, place) in self.scratch.left.drain(..) {
            let id = self.arrangement.id[slot as usize];
            self.left[id as usize] = Some(place);
        }
    }

    /// The public report of a broken guard.
    pub(super) fn failure(&self, fault: Fault, time: f64) -> SpotFailure {
        failure(fault, Some(&self.arrangement.id), &self.counts, time)
    }
}

fn failure(fault: Fault, ids: Option<&[u32]>, counts: &SpotCounts, time: f64) -> SpotFailure {
    let id = |slot: u32| ids.and_then(|ids| ids.get(slot as usize).copied());
    SpotFailure {
        guard: fault.guard,
        moves: counts.moves,
        time,
        place: fault.place,
        sphere: fault.slot.and_then(id),
        detail: fault.detail,
    }
}

fn check_positions(parameters: &Parameters, position: &[Vector]) -> Result<(), SpotError> {
    if position.len() > (u32::MAX / 64) as usize {
        return Err(SpotError::TooMany(position.len()));
    }
    let least = (0.5 - STICKING_OUT) * parameters.diameter;
    let [x, y] = [parameters.half_width, parameters.half_depth].map(|half| half - least);
    let inside =
        |it: &Vector| it.x.abs() <= x && it.y.abs() <= y && it.z >= least && it.z.is_finite();
    match position.iter().position(|it| !inside(it)) {
        Some(sphere) => Err(SpotError::Outside {
            sphere,
            place: position[sphere],
        }),
        None => Ok(()),
    }
}
