//! What is measured of the record of a drainage.

use crate::measure::FilledBox;
use crate::observe::Snapshot;
use crate::record::RunRecord;
use crate::scene::Units;

/// Share of the run at its start that is left out, where nothing else is asked for: the flow has to
/// develop.
const BEGINNING: f64 = 0.2;

/// A drainage: its record, its box, and the times that count.
pub struct Drainage<'a> {
    /// The record.
    pub record: &'a RunRecord,
    /// The box and its spheres.
    pub filled_box: FilledBox,
    /// First and last time (s) of the states that count.
    pub times: [f64; 2],
}

impl<'a> Drainage<'a> {
    /// Of a record; `times`: first and last time (s) of the states that count, by default from a
    /// fifth of the run to its end.
    ///
    /// # Errors
    /// What the record lacks: walls on all sides and a floor, or snapshots.
    pub fn new(record: &'a RunRecord, times: Option<[f64; 2]>) -> Result<Self, &'static str> {
        let tank = record.scene.tank.as_ref();
        let walls = tank.map(|tank| (tank.reach(), tank.floor));
        let Some(([Some(half_width), Some(half_depth)], Some(floor))) = walls else {
            return Err("a box: `tank.width`, `tank.depth` and `tank.floor`");
        };
        let [start, _, ..] = record.sound_states() else {
            return Err("at least two snapshots: `output.snapshot_interval`");
        };
        let diameter = 2.0 * record.scene.spheres.radius.mean();
        let duration = record.scene.time.duration;
        Ok(Self {
            record,
            filled_box: FilledBox::new([half_width, half_depth], floor, diameter, start),
            times: times.unwrap_or([BEGINNING * duration, duration]),
        })
    }

    /// The units of its scene.
    pub fn units(&self) -> Units {
        self.record.scene.units()
    }

    /// All states, in order of time, two or more.
    pub fn states(&self) -> &'a [Snapshot] {
        self.record.sound_states()
    }

    /// The state at the start.
    pub fn start(&self) -> &'a Snapshot {
        &self.states()[0]
    }

    /// The states within the times that count.
    pub fn flow(&self) -> &'a [Snapshot] {
        let states = self.states();
        let half_step = 0.5 * self.record.scene.time.dt;
        let first = states.partition_point(|it| it.time < self.times[0] - half_step);
        let end = states.partition_point(|it| it.time <= self.times[1] + half_step);
        &states[first..end.max(first)]
    }
}
