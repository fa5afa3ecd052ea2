//! A run as far as the places of its spheres tell it, as other programs write them.

use crate::observe::{FrameView, Observer};
use crate::record::{Outcome, Program, RunRecord};
use crate::scene::Scene;
use crate::simulation::{Flow, Snapshot};
use ndarray::Array2;
use std::collections::{BTreeMap, BTreeSet};

/// Farthest that a sphere may be from the origin along an axis, in diameters: what is measured of
/// states divides the room that they take.
const FARTHEST: f64 = 1e4;

/// A state that another program wrote: when, and where its spheres are.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenState {
    /// When it is.
    pub moment: Moment,
    /// Number of each sphere, as the file has it, and its centre.
    pub spheres: Vec<(u64, [f64; 3])>,
}

/// When a state is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Moment {
    /// At a time (s).
    Time(f64),
    /// After so many steps, of a length that the file does not say.
    Step(u64),
}

/// Why states cannot be a run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StatesError {
    /// There is one state, or none.
    #[error("it has one state; a run needs two or more")]
    Few,
    /// Times do not grow.
    #[error("state {0} is not later than the one before")]
    Order(usize),
    /// No state has a sphere.
    #[error("no state has a sphere")]
    Empty,
    /// A sphere is so far off that nothing can be measured around it.
    #[error(
        "state {state}: sphere {number} is more than {FARTHEST} diameters from the origin; leave \
         it out, or give a scene of the units of the file"
    )]
    Far {
        /// The state, from 1.
        state: usize,
        /// The number of the sphere.
        number: u64,
    },
    /// Two spheres of a state have one number.
    #[error("state {state} has two spheres of the number {number}")]
    Twice {
        /// The state, from 1.
        state: usize,
        /// The number.
        number: u64,
    },
}

/// The record of a run of which another program wrote these states. The scene says what the file
/// does not: the tank, the radius of the spheres, and the time step, where moments are counted in
/// steps; time then begins at the first state. Spheres that are not in a state have left, or come
/// in later. Observables are those of positions; velocities are displacements since the state
/// before. A door of the scene has opened before the first state.
///
/// # Errors
/// If the states are no run.
pub fn replay_states(states: &[WrittenState], scene: &Scene) -> Result<RunRecord, StatesError> {
    let times = times(states, scene.time.dt)?;
    let numbers = numbers(states)?;
    let count = numbers.len();
    if count == 0 {
        return Err(StatesError::Empty);
    }
    check_places(states, FARTHEST * 2.0 * scene.mean_radius())?;
    let mut scene = scene.clone();
    scene.spheres.count = count;
    scene.dem.door = None;
    scene.time.duration = times.last().copied().unwrap_or_default();
    let radius = vec![scene.spheres.radius.mean(); count];
    let mass = vec![scene.spheres.shape.mass(scene.spheres.density, radius[0]); count];
    let mut observer = Observer::new(&scene, &radius);
    let mut snapshots: Vec<Snapshot> = Vec::new();
    let mut seen = vec![false; count];
    for (state, &time) in states.iter().zip(&times) {
        let mut position = Array2::from_elem((count, 3), f64::NAN);
        for (number, centre) in &state.spheres {
            let sphere = numbers[number];
            seen[sphere] = true;
            for (axis, value) in centre.iter().enumerate() {
                position[[sphere, axis]] = *value;
            }
        }
        let velocity = match snapshots.last() {
            Some(before) => (&position - &before.position) / (time - before.time),
            None => Array2::zeros((count, 3)),
        };
        let snapshot = Snapshot {
            time,
            position,
            velocity,
            spin: Array2::zeros((0, 3)),
        };
        observe(&mut observer, &snapshot, &seen, [&radius, &mass]);
        snapshots.push(snapshot);
    }
    Ok(RunRecord {
        program: Program::current(),
        outcome: Outcome::Completed,
        milestones: Vec::new(),
        observations: observer.finish(),
        snapshots,
        trajectory: Vec::new(),
        work: 0,
        cpu_seconds: f64::NAN,
        scene,
        radius,
        mass,
    })
}

/// Refuses spheres that are that far (m) or farther from the origin along an axis.
fn check_places(states: &[WrittenState], farthest: f64) -> Result<(), StatesError> {
    for (state, written) in (1..).zip(states) {
        let far = |place: &[f64; 3]| !place.iter().all(|value| value.abs() < farthest);
        let found = written.spheres.iter().find(|(_, place)| far(place));
        if let Some(&(number, _)) = found {
            return Err(StatesError::Far { state, number });
        }
    }
    Ok(())
}

/// Shows the spheres of a state to an observer.
fn observe(
    observer: &mut Observer,
    state: &Snapshot,
    seen: &[bool],
    [radius, mass]: [&Vec<f64>; 2],
) {
    let is_in = |sphere: &usize| state.position[[*sphere, 0]].is_finite();
    let present: Vec<usize> = (0..radius.len()).filter(is_in).collect();
    let column = |values: &Array2<f64>, axis: usize| -> Vec<f64> {
        let of = |sphere: &usize| values[[*sphere, axis]];
        let finite = |value: f64| if value.is_finite() { value } else { 0.0 };
        present.iter().map(of).map(finite).collect()
    };
    let [position, velocity] =
        [&state.position, &state.velocity].map(|it| [0, 1, 2].map(|axis| column(it, axis)));
    let some = |values: &[f64]| -> Vec<f64> { present.iter().map(|it| values[*it]).collect() };
    let number: Vec<u32> = present.iter().map(|it| *it as u32).collect();
    let released = seen.iter().filter(|it| **it).count();
    observer.observe(
        state.time,
        &FrameView {
            position: position.each_ref().map(Vec::as_slice),
            velocity: velocity.each_ref().map(Vec::as_slice),
            spin: None,
            radius: &some(radius),
            mass: &some(mass),
            inertia: &[],
            elastic_energy: f64::NAN,
            ledger: None,
            number: Some(&number),
            flow: Some(Flow {
                spheres: radius.len(),
                released,
                discharged: released - present.len(),
                spilled: 0,
                contacts: 0,
            }),
        },
    );
}

fn times(states: &[WrittenState], dt: f64) -> Result<Vec<f64>, StatesError> {
    let first = match states {
        [first, _, ..] => first.moment,
        _ => return Err(StatesError::Few),
    };
    let time = |state: &WrittenState| match (state.moment, first) {
        (Moment::Time(time), _) => time,
        (Moment::Step(step), Moment::Step(first)) => step.saturating_sub(first) as f64 * dt,
        (Moment::Step(step), Moment::Time(_)) => step as f64 * dt,
    };
    let times: Vec<f64> = states.iter().map(time).collect();
    match times.windows(2).position(|two| !(two[1] > two[0])) {
        Some(place) => Err(StatesError::Order(place + 2)),
        None => Ok(times),
    }
}

/// The place of each number among all.
fn numbers(states: &[WrittenState]) -> Result<BTreeMap<u64, usize>, StatesError> {
    let mut all = BTreeMap::new();
    for (place, state) in states.iter().enumerate() {
        let mut own = BTreeSet::new();
        for (number, _) in &state.spheres {
            if !own.insert(*number) {
                return Err(StatesError::Twice {
                    state: place + 1,
                    number: *number,
                });
            }
            all.insert(*number, 0);
        }
    }
    for (place, index) in all.values_mut().enumerate() {
        *index = place;
    }
    Ok(all)
}
