//! A run of a silo as its sieves read it: what left when.

use crate::classify::ClassifyError;
use crate::observe::Observations;
use crate::record::{MilestoneKind, RunRecord};
use crate::scene::Start;

/// A run of a silo as its sieves read it.
pub(in crate::classify) struct Outflow<'a> {
    pub(super) record: &'a RunRecord,
    pub(super) observations: &'a Observations,
    /// Number of grains of the scene, those included that are not in yet or have left.
    pub(super) grains: f64,
    /// Time at which all grains counted as at rest behind the closed door (s).
    pub(super) rest: Option<f64>,
    /// Time from which grains can leave while none comes in (s): that at which the door opened, in
    /// a scene without a door that at which the last grain came in.
    pub(super) opened: Option<f64>,
    /// Whether the run ended because all grains in the open silo were at rest.
    pub(super) stopped: bool,
    /// Time of the last frame (s).
    pub(super) end: f64,
}

impl<'a> Outflow<'a> {
    /// The run of a record whose observables have equal lengths.
    pub(super) fn new(record: &'a RunRecord) -> Result<Self, ClassifyError> {
        let observations = &record.observations;
        if observations.discharged.len() != observations.frames() {
            let message = "it does not count the grains that left";
            return Err(ClassifyError::Inconsistent(message.to_owned()));
        }
        let scene = &record.scene;
        let beginning = match (&scene.dem.door, &scene.start) {
            (Some(_), _) => Some(MilestoneKind::DoorOpened),
            (None, Start::Feed { .. }) => Some(MilestoneKind::Filled),
            (None, _) => None,
        };
        let milestones = &record.milestones;
        // What came before the opening, and what after it.
        let (before, opened, after) = match beginning {
            None => (&[][..], Some(0.0), &milestones[..]),
            Some(kind) => match milestones.iter().position(|it| it.kind == kind) {
                Some(at) => {
                    let opened = Some(milestones[at].time);
                    (&milestones[..at], opened, &milestones[at + 1..])
                }
                None => (&milestones[..], None, &[][..]),
            },
        };
        let mut rests = before.iter();
        Ok(Self {
            record,
            observations,
            grains: record.radius.len() as f64,
            rest: rests
                .find(|it| it.kind == MilestoneKind::AtRest)
                .map(|it| it.time),
            opened,
            stopped: after.iter().any(|it| it.kind == MilestoneKind::AtRest),
            end: observations.time.last().copied().unwrap_or(0.0),
        })
    }

    /// Number of grains that had left at the end.
    pub(super) fn discharged(&self) -> f64 {
        self.observations
            .discharged
            .last()
            .map_or(0.0, |&it| f64::from(it))
    }

    /// The first frame at which this number of grains had left.
    pub(super) fn frame_of(&self, number: f64) -> Option<usize> {
        let discharged = &self.observations.discharged;
        // A share of all grains need not be a whole number; its last digits do not matter.
        let number = number - 1e-6;
        discharged.iter().position(|&it| f64::from(it) >= number)
    }

    /// Time of the last frame by which the last grain had left that did (s), or of the opening.
    pub(super) fn last_exit(&self) -> Option<f64> {
        let opened = self.opened?;
        let left = self.discharged();
        let last = self.frame_of(left).filter(|_| left > 0.0);
        Some(last.map_or(opened, |frame| self.observations.time[frame].max(opened)))
    }

    /// Number of grains that had left by a time (s), or at the first frame after it.
    pub(super) fn discharged_by(&self, time: f64) -> f64 {
        let frame = self
            .observations
            .time
            .partition_point(|&it| it < time - self.tolerance());
        let discharged = &self.observations.discharged;
        discharged
            .get(frame)
            .map_or_else(|| self.discharged(), |&it| f64::from(it))
    }

    /// Number of grains over the opening at the end: above the door's discs, no farther aside than
    /// these reach.
    pub(super) fn over_opening(&self) -> Option<f64> {
        self.opened?;
        let fixed = self.record.scene.dem.geometry.as_ref()?.spheres();
        let ends = |sign: f64| {
            let door = fixed.door.iter();
            door.map(|disc| disc.position[0] + sign * disc.radius)
                .reduce(if sign < 0.0 { f64::min } else { f64::max })
        };
        let (left, right) = (ends(-1.0)?, ends(1.0)?);
        let heights = fixed.door.iter().map(|disc| disc.position[2]);
        let bottom = heights.reduce(f64::min)?;
        let last = self.record.snapshots.last()?;
        let grains = last.position.rows().into_iter();
        // One that has left is nowhere (NaN).
        let over = grains.filter(|at| (left..=right).contains(&at[0]) && at[2] > bottom);
        Some(over.count() as f64)
    }

    /// Times that differ by less are equal: half a time step.
    pub(super) fn tolerance(&self) -> f64 {
        0.5 * self.record.scene.time.dt
    }
}
