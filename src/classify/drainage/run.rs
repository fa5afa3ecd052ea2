//! The parts of a record that the sieves of a drainage use.

use crate::measure::stagnant_height;
use crate::observe::{Observations, Snapshot};
use crate::record::RunRecord;
use crate::scene::Tank;

/// A drainage, as its sieves see it.
pub(in crate::classify) struct DrainageRun<'a> {
    pub(super) observations: &'a Observations,
    /// Number of spheres at the start.
    pub(super) spheres: f64,
    /// Diameter of the spheres (m).
    pub(super) diameter: f64,
    /// From the axis to the side walls along x (m).
    pub(super) half_width: f64,
    /// Height of the floor (m).
    pub(super) floor: f64,
    /// Half of the width of the opening (m).
    opening: f64,
    /// Whether the opening is round.
    is_round: bool,
    /// States of all spheres, in order of time.
    pub(super) snapshots: &'a [Snapshot],
}

impl<'a> DrainageRun<'a> {
    pub(super) fn new(record: &'a RunRecord) -> Self {
        let tank = record.scene.tank.clone().unwrap_or_default();
        Self {
            observations: &record.observations,
            spheres: record.radius.len() as f64,
            diameter: 2.0 * record.scene.spheres.radius.mean(),
            half_width: tank.reach()[0].unwrap_or(0.0),
            floor: tank.floor.unwrap_or(0.0),
            opening: tank.opening().map_or(0.0, |(_, half)| half),
            is_round: is_round(&tank),
            snapshots: record.sound_states(),
        }
    }

    /// Spheres that left until the end.
    pub(super) fn left(&self) -> f64 {
        last(&self.observations.discharged)
    }

    /// Spheres that left in the last so many seconds.
    pub(super) fn left_in_last(&self, window: f64) -> f64 {
        let time = &self.observations.time;
        let end = time.last().copied().unwrap_or(0.0);
        let first = time.partition_point(|it| *it < end - window * (1.0 + 1e-9));
        let before = self.observations.discharged.get(first).copied();
        self.left() - f64::from(before.unwrap_or(0.0))
    }

    /// Number of spheres over the opening at the end; none without a snapshot.
    pub(super) fn over_opening(&self) -> Option<f64> {
        let end = self.snapshots.last()?;
        let is_over = |row: ndarray::ArrayView1<'_, f64>| match self.is_round {
            true => row[0] * row[0] + row[1] * row[1] < self.opening * self.opening,
            false => row[0].abs() < self.opening,
        };
        let over = end.position.rows().into_iter().filter(|row| is_over(*row));
        Some(over.count() as f64)
    }

    /// Height of the stagnant zone at the side walls above the floor (m), from first to last
    /// snapshot; none with fewer than two.
    pub(super) fn stagnant_height(&self) -> Option<f64> {
        let [first, .., last] = self.snapshots else {
            return None;
        };
        Some(stagnant_height(
            first,
            last,
            self.diameter,
            self.half_width,
            self.floor,
        ))
    }
}

fn is_round(tank: &Tank) -> bool {
    tank.orifice_radius.is_some()
}

fn last(values: &[f32]) -> f64 {
    values.last().map_or(0.0, |&it| f64::from(it))
}
