//! Measurements on the record of a drainage.

use crate::measure::FilledBox;
use crate::observe::Snapshot;
use crate::record::RunRecord;
use crate::scene::Units;
use crate::simulation::MilestoneKind;

/// Share of the drainage by which a time may be off: rounding.
const ROUNDING: f64 = 1e-9;
/// Share of the run at its start that is left out by default: the flow has to develop.
const BEGINNING: f64 = 0.2;

/// A drainage: its record, its box, and the times that count.
///
/// All its times are since the opening opened: since the start, unless a door was closed.
pub struct MeasuredDrainage<'a> {
    /// The record.
    pub record: &'a RunRecord,
    /// The box and its spheres.
    pub filled_box: FilledBox,
    /// First and last time (s) of the states that count, since the opening.
    pub times: [f64; 2],
    /// When the opening opened (s), since the start of the run.
    opened: f64,
    /// The states from the opening on.
    states: &'a [Snapshot],
}

impl<'a> MeasuredDrainage<'a> {
    /// Of a record; `times`: first and last time (s) of the states that count, by default from a
    /// fifth of the run to its end.
    ///
    /// # Errors
    /// What the record lacks: walls on all sides and a floor, or snapshots.
    pub fn new(record: &'a RunRecord, times: Option<[f64; 2]>) -> Result<Self, &'static str> {
        let tank = record.scene.tank.as_ref();
        let tank = tank.filter(|tank| tank.has_sides() && tank.has_opening());
        let walls = tank.map(|tank| (tank.reach(), tank.floor));
        let Some(([Some(half_width), Some(half_depth)], Some(floor))) = walls else {
            return Err(
                "a box with an opening: `tank.width`, `tank.depth`, `tank.floor`, and \
                        `tank.orifice_radius` or `tank.slit_width`",
            );
        };
        let opened = opened(record).ok_or("a door that opens within the run")?;
        let states = record.sound_states();
        let half_step = 0.5 * record.scene.time.dt;
        let begun = states.partition_point(|it| it.time <= opened + half_step);
        let states = &states[begun.saturating_sub(1)..];
        let [start, _, ..] = states else {
            return Err("at least two snapshots: `output.snapshot_interval`");
        };
        let diameter = 2.0 * record.scene.spheres.radius.mean();
        let duration = record.scene.time.duration - opened;
        let drainage = Self {
            record,
            filled_box: FilledBox::new([half_width, half_depth], floor, diameter, start),
            times: times.unwrap_or([BEGINNING * duration, duration]),
            opened,
            states,
        };
        match drainage.flow().is_empty() {
            true => Err(
                "a state within the requested times, since the opening; give \
                         `--times` within those that `output.snapshot_interval` has kept",
            ),
            false => Ok(drainage),
        }
    }

    /// How long it drains (s).
    pub fn duration(&self) -> f64 {
        self.record.scene.time.duration - self.opened
    }

    /// A time of the run (s), since the opening.
    pub fn since_opening(&self, time: f64) -> f64 {
        time - self.opened
    }

    /// How many spheres have left, over the time (s) since the opening.
    pub fn left(&self) -> [Vec<f64>; 2] {
        let observations = &self.record.observations;
        let times = observations.time.iter().map(|it| self.since_opening(*it));
        let left = observations.discharged.iter().map(|&it| f64::from(it));
        let pairs = times.zip(left).filter(|(time, _)| *time >= 0.0);
        let (time, left) = pairs.unzip();
        [time, left]
    }

    /// The units of its scene.
    pub fn units(&self) -> Units {
        self.record.scene.units()
    }

    /// All states from the opening on, in order of time, two or more.
    pub fn states(&self) -> &'a [Snapshot] {
        self.states
    }

    /// The state at the opening.
    pub fn start(&self) -> &'a Snapshot {
        &self.states()[0]
    }

    /// The times that count (s), wider by rounding.
    pub fn window(&self) -> [f64; 2] {
        let margin = ROUNDING * self.duration();
        [self.times[0] - margin, self.times[1] + margin]
    }

    /// The times that count (s), as far as the record has them.
    pub fn held(&self) -> [f64; 2] {
        let [from, to] = self.times;
        [from.max(0.0), to.min(self.duration())]
    }

    /// The states within the times that count.
    pub fn flow(&self) -> &'a [Snapshot] {
        let states = self.states();
        let [from, to] = self.window();
        let time = |state: &Snapshot| self.since_opening(state.time);
        let first = states.partition_point(|it| time(it) < from);
        let end = states.partition_point(|it| time(it) <= to);
        &states[first..end.max(first)]
    }
}

/// When the opening of a silo or box opened (s), at the start if it has no door; none if its door
/// is closed to the end.
pub fn opened(record: &RunRecord) -> Option<f64> {
    if record.scene.dem.door.is_none() {
        return Some(0.0);
    }
    let mut milestones = record.milestones.iter();
    let opening = milestones.find(|it| it.kind == MilestoneKind::DoorOpened);
    opening.map(|it| it.time)
}
