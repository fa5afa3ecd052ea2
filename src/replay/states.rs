//! A run from the places of its spheres, as other programs write them.

use crate::observe::{FrameView, Observer};
use crate::record::{Outcome, Program, RunRecord};
use crate::scene::Scene;
use crate::simulation::{Flow, Milestone, MilestoneKind, Snapshot};
use ndarray::Array2;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// Largest distance of a sphere from the origin along an axis, in diameters: measurements divide
/// the space of all spheres into cells.
const FARTHEST: f64 = 1e4;

/// A state written by another program: its time, and the places of its spheres.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenState {
    /// When it is.
    pub moment: StateTime,
    /// Whether the file has numbers of the spheres; otherwise they count from 0 in order.
    pub are_numbered: bool,
    /// Number of each sphere, and its centre.
    pub spheres: Vec<(u64, [f64; 3])>,
}

/// When a state is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StateTime {
    /// At a time (s).
    Time(f64),
    /// After a number of steps, whose length the file does not give.
    Step(u64),
}

/// Why states cannot be a run.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StatesError {
    /// There is one state, or none.
    #[error("it has one state; a run needs two or more")]
    Few,
    /// Times do not increase.
    #[error("state {0} is not later than the state before; put the states in order of time")]
    Order(usize),
    /// No state has a sphere.
    #[error("no state has a sphere")]
    Empty,
    /// A sphere is too far away to be measured.
    #[error(
        "state {state}: sphere {number} is more than {FARTHEST} diameters from the origin; leave \
            it out, or give a scene in the units of the file"
    )]
    Far {
        /// The state, from 1.
        state: usize,
        /// The number of the sphere.
        number: u64,
    },
    /// A sphere is outside the walls of the scene.
    #[error(
        "state {state}: sphere {number} is outside the walls of the scene; give the scene of the \
         file, in its units"
    )]
    Outside {
        /// The state, from 1.
        state: usize,
        /// The number of the sphere.
        number: u64,
    },
    /// The spheres are larger than the space that they occupy.
    #[error(
        "state {0}: with the scene's radius, its spheres are larger than the space that they \
            occupy; give a scene in the units of the file"
    )]
    Crowded(usize),
    /// Spheres cannot be matched with the state before.
    #[error(
        "state {0} and the state before differ in their number of spheres, or only one of them \
            numbers its spheres, so that spheres cannot be matched; write an `id` for each sphere"
    )]
    Unnumbered(usize),
    /// Times are counted in steps of unknown length.
    #[error(
        "it counts steps, but a scene of spots has no time step; write times (`dump_modify ID time \
         yes` in LAMMPS), or give the scene of the file with `--scene`"
    )]
    Steps,
    /// Two spheres of a state have the same number.
    #[error("state {state} has two spheres with the number {number}")]
    Twice {
        /// The state, from 1.
        state: usize,
        /// The number.
        number: u64,
    },
}

/// The record of a run whose states another program wrote. The scene adds what the file lacks: the
/// tank, the radius of the spheres, and the time step if times are counted in steps. A door of the
/// scene opens at the time that the scene gives. Without such a time, or if the first counted step
/// is not 0, the door is open and steps are counted from the first. Spheres that are not in a state
/// have left, or come in later. Observables follow from positions; velocities are displacements
/// since the previous state.
///
/// # Errors
/// If the states cannot be a run.
pub fn replay_states(states: &[WrittenState], scene: &Scene) -> Result<RunRecord, StatesError> {
    let times = times(states, scene)?;
    check_numbers(states)?;
    let numbers = numbers(states)?;
    let count = numbers.len();
    if count == 0 {
        return Err(StatesError::Empty);
    }
    check_places(states, scene)?;
    let mut scene = scene.clone();
    scene.spheres.count = count;
    let has_clock = matches!(states[0].moment, StateTime::Time(_) | StateTime::Step(0));
    scene.dem.door = (scene.dem.door).filter(|door| has_clock && door.opens.is_some());
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
        milestones: opening(&scene, &times),
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

/// When the door of a scene opens, if within these times (s).
fn opening(scene: &Scene, times: &[f64]) -> Vec<Milestone> {
    let opens = scene.dem.door.as_ref().and_then(|door| door.opens);
    let within = opens.filter(|opens| times.last().is_some_and(|last| opens <= last));
    let milestone = within.map(|time| Milestone {
        kind: MilestoneKind::DoorOpened,
        time,
    });
    milestone.into_iter().collect()
}

/// Refuses states whose spheres cannot be matched with the state before. An empty state means that
/// all have left.
fn check_numbers(states: &[WrittenState]) -> Result<(), StatesError> {
    let filled = (1..).zip(states).filter(|(_, it)| !it.spheres.is_empty());
    let filled: Vec<(usize, &WrittenState)> = filled.collect();
    let bad = filled.windows(2).find(|two| {
        let [(_, before), (_, after)] = [two[0], two[1]];
        let is_same = before.spheres.len() == after.spheres.len();
        before.are_numbered != after.are_numbered || !(after.are_numbered || is_same)
    });
    match bad {
        Some(two) => Err(StatesError::Unnumbered(two[1].0)),
        None => Ok(()),
    }
}

/// Refuses spheres far from the origin, outside the walls of the scene, or too many for their
/// space.
fn check_places(states: &[WrittenState], scene: &Scene) -> Result<(), StatesError> {
    let diameter = 2.0 * scene.mean_radius();
    let far = |place: &[f64; 3]| !place.iter().all(|it| it.abs() < FARTHEST * diameter);
    for (state, written) in (1..).zip(states) {
        let find = |bad: &dyn Fn(&[f64; 3]) -> bool| {
            let found = written.spheres.iter().find(|(_, place)| bad(place));
            found.map(|&(number, _)| number)
        };
        if let Some(number) = find(&far) {
            return Err(StatesError::Far { state, number });
        }
        if let Some(number) = find(&|place| is_beside(scene, place, diameter)) {
            return Err(StatesError::Outside { state, number });
        }
        if is_crowded(written, diameter) {
            return Err(StatesError::Crowded(state));
        }
    }
    Ok(())
}

/// Whether a place is a diameter (m) or more outside the side walls of a scene, above its floor.
fn is_beside(scene: &Scene, [x, y, z]: &[f64; 3], diameter: f64) -> bool {
    let Some(tank) = &scene.tank else {
        return false;
    };
    let out = |wall: Option<f64>, place: f64| wall.is_some_and(|wall| place > wall + diameter);
    let [half_width, half_depth] = tank.reach();
    let beside = out(half_width, x.abs()) || out(half_depth, y.abs());
    beside && tank.floor.is_none_or(|floor| *z > floor)
}

/// Whether the total volume of a state's spheres exceeds the box about them.
fn is_crowded(state: &WrittenState, diameter: f64) -> bool {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (_, place) in &state.spheres {
        for axis in 0..3 {
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
    }
    let room: f64 = (0..3)
        .map(|axis| high[axis] - low[axis] + diameter)
        .product();
    let sphere = PI / 6.0 * diameter * diameter * diameter;
    !state.spheres.is_empty() && state.spheres.len() as f64 * sphere > room
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

fn times(states: &[WrittenState], scene: &Scene) -> Result<Vec<f64>, StatesError> {
    let dt = scene.time.dt;
    let counts = |it: &WrittenState| matches!(it.moment, StateTime::Step(_));
    if scene.spot.is_some() && states.iter().any(counts) {
        return Err(StatesError::Steps);
    }
    let first = match states {
        [first, _, ..] => first.moment,
        _ => return Err(StatesError::Few),
    };
    let time = |state: &WrittenState| match (state.moment, first) {
        (StateTime::Time(time), _) => time,
        (StateTime::Step(step), StateTime::Step(first)) => step.saturating_sub(first) as f64 * dt,
        (StateTime::Step(step), StateTime::Time(_)) => step as f64 * dt,
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
