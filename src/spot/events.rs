//! Insertions and moves in the order of time: section 2 of Rycroft, Wong and Bazant (2010). Their
//! listing has the two branches swapped.

use super::guard::{Fault, SpotFailure};
use super::parameters::Relaxation;
use super::simulation::SpotSimulation;
use super::walk::MovingSpot;
use crate::particles::vector::Vector;

impl SpotSimulation {
    /// Lets all insertions and moves up to a time happen (s).
    pub(super) fn events_until(&mut self, time: f64) -> Result<(), SpotFailure> {
        loop {
            let global = self.next_global_relaxation();
            // Written so that a NaN time ends it too.
            if !(global.min(self.next_event) <= time) {
                return Ok(());
            }
            let (now, done) = if global <= self.next_event {
                (global, self.relax_all())
            } else {
                (self.next_event, self.event())
            };
            done.map_err(|fault| self.failure(fault, now))?;
        }
    }

    /// Time of the next relaxation of all spheres (s); infinite if there is none.
    fn next_global_relaxation(&self) -> f64 {
        match self.model.parameters.relaxation {
            Relaxation::Global { ratio } => {
                let next = self.counts.global_relaxations + 1;
                next as f64 * ratio as f64 / self.model.parameters.move_rate
            }
            _ => f64::INFINITY,
        }
    }

    /// The insertion or move whose time has come.
    fn event(&mut self) -> Result<(), Fault> {
        let insertion = self.model.parameters.insertion_rate;
        let rate = insertion + self.spots.len() as f64 * self.model.parameters.move_rate;
        let [walk, _] = &mut self.random;
        if walk.uniform() * rate < insertion || self.spots.is_empty() {
            self.insert();
        } else {
            let index = walk.below(self.spots.len());
            if !self.move_spot(index)? {
                self.spots.swap_remove(index);
                self.counts.removed += 1;
            }
        }
        let rate = insertion + self.spots.len() as f64 * self.model.parameters.move_rate;
        self.next_event += self.random[0].exponential() / rate;
        Ok(())
    }

    /// Inserts a spot at the centre of the orifice.
    pub(super) fn insert(&mut self) {
        self.counts.inserted += 1;
        self.spots.push(MovingSpot {
            position: Vector::ZERO,
            moves: 0,
        });
    }

    /// Moves a spot, and relaxes around it. False if the spot is to be removed.
    fn move_spot(&mut self, index: usize) -> Result<bool, Fault> {
        let random = self.random[0].uniform();
        let chance = self.relaxation_chance();
        self.sort_if_stale()?;
        let spot = &mut self.spots[index];
        let (arrangement, scratch) = (&self.arrangement, &mut self.scratch);
        let spheres = (arrangement, &mut self.position[..]);
        let Some(relaxed) = self
            .model
            .make_move(spheres, scratch, spot, [random, chance])?
        else {
            return Ok(false);
        };
        self.counts.moves += 1;
        self.scratch.clock.count_move();
        self.counts.relaxations += u64::from(relaxed);
        self.count_left();
        Ok(true)
    }

    /// A random number that decides about the relaxation after a move, if the method needs one.
    pub(super) fn relaxation_chance(&mut self) -> f64 {
        match self.model.parameters.relaxation {
            Relaxation::AtRandom { .. } => self.random[1].uniform(),
            _ => 0.0,
        }
    }
}
