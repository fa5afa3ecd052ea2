//! The state of a process: what changes while it runs. The rest follows from the scene.

use super::leak::PlanePoint;
use super::{LeakWatch, Process};
use crate::simulation::Milestone;
use crate::simulation::StateError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The state of a process.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::dem) struct ProcessState {
    /// Spheres that the feed let in; the others wait in the order of the scene.
    fed: usize,
    /// Whether a door is still to open.
    is_closed: bool,
    /// Step since which the spheres have been slow.
    slow_since: Option<u64>,
    /// Number and position of each disc at the latest check of the walls.
    watched: Vec<(u32, PlanePoint)>,
    /// Numbers of the spheres below a floor with an opening.
    below: BTreeSet<u32>,
    milestones: Vec<Milestone>,
    discharged: usize,
    spilled: usize,
    ended: bool,
}

impl ProcessState {
    /// Whether a door is still to open.
    pub(in crate::dem) fn is_closed(&self) -> bool {
        self.is_closed
    }
}

impl Process {
    /// The present state.
    pub(in crate::dem) fn state(&self) -> ProcessState {
        ProcessState {
            fed: self.feed.released(),
            is_closed: self.door.is_some(),
            slow_since: self.rest.as_ref().and_then(|rest| rest.since),
            watched: self
                .leak
                .as_ref()
                .map_or_else(Vec::new, |leak| leak.before.clone()),
            below: self
                .floor
                .as_ref()
                .map_or_else(BTreeSet::new, |floor| floor.below.clone()),
            milestones: self.milestones.clone(),
            discharged: self.discharged,
            spilled: self.spilled,
            ended: self.ended,
        }
    }

    /// Checks that a state belongs to this process, which has just begun.
    pub(in crate::dem) fn accepts(&self, state: &ProcessState) -> Result<(), StateError> {
        let fits = state.fed <= self.feed.waiting()
            && self.feed.released() == 0
            && (self.door.is_some() || !state.is_closed);
        match fits {
            true => Ok(()),
            false => Err(StateError("it feeds other spheres or has another door")),
        }
    }

    /// Continues from an accepted state.
    pub(in crate::dem) fn restore(&mut self, state: ProcessState) {
        self.feed.skip(state.fed);
        if self.door.is_some() && !state.is_closed {
            self.door = None;
            self.leak.iter_mut().for_each(LeakWatch::open_door);
        }
        if let Some(rest) = &mut self.rest {
            rest.since = state.slow_since;
        }
        if let Some(leak) = &mut self.leak {
            leak.before = state.watched;
        }
        if let Some(floor) = &mut self.floor {
            floor.below = state.below;
        }
        self.milestones = state.milestones;
        self.discharged = state.discharged;
        self.spilled = state.spilled;
        self.ended = state.ended;
    }
}
