//! One evaluation: the forces and torques of everything, at the present positions and velocities.

use super::System;
use super::candidates::Candidates;
use super::contact_task::{ContactSettings, ContactSlice, ContactTask};
use super::moves::FirstTooFast;
use super::partners::Partners;
use super::sums::Sums;
use super::touching::come_from_far;
use crate::dem::profile::{self, Part};
use crate::dem::walls::TankWall;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::particles::Particles;
use crate::simulation::Instability;
use std::ops::Range;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Evaluates all forces and torques at the present positions and velocities.
    pub(super) fn evaluate(&mut self) -> Result<(), Instability> {
        self.evaluate_contacts()?;
        self.apply_effects();
        Ok(())
    }

    /// Evaluates forces and torques of contacts alone.
    pub(super) fn evaluate_contacts(&mut self) -> Result<(), Instability> {
        self.hold_near()?;
        self.forces_of_contacts();
        self.check_overlaps()
    }

    /// Looks for near pairs if the present ones do not hold.
    fn hold_near(&mut self) -> Result<(), Instability> {
        match self.neighbours.stale
            || self
                .neighbours
                .near
                .is_too_wide(self.neighbours.near_age.steps)
        {
            true => self.refresh(),
            false => Ok(()),
        }
    }

    fn forces_of_contacts(&mut self) {
        let candidates = self.take_candidates();
        self.note_all_contacts(&candidates);
        self.mark_ledger();
        match self.neighbours.list.is_some() {
            true => self.forces_of_candidates(&candidates, true),
            false => self.particles.clear_forces(),
        }
        self.return_candidates(candidates);
    }

    /// Evaluates all forces, kicks for these times (s), and drifts for a time (s), if one is given;
    /// clears the forces if asked. Returns the first sphere beyond its speed limit.
    ///
    /// Where an overlap is too deep in a large scene, its spheres are moved all the same, on
    /// however many threads.
    pub(super) fn evaluate_and_move(
        &mut self,
        kicks: &[f64],
        drift: Option<f64>,
        clear: bool,
    ) -> Result<FirstTooFast, Instability> {
        self.hold_near()?;
        self.prepare_effects();
        let too_fast = match drift {
            Some(drift) if clear && self.streams() => self.stream(kicks, drift),
            _ => {
                self.forces_of_contacts();
                if !self.setup.sorted {
                    self.check_overlaps()?;
                }
                self.step.forces_are_zero = clear;
                self.move_all(0..self.setup.effects.len(), kicks, drift, clear)
            }
        };
        self.check_overlaps()?;
        Ok(too_fast)
    }

    /// Forces and torques of all but contacts.
    pub(super) fn evaluate_effects(&mut self) {
        self.particles.clear_forces();
        self.apply_effects();
    }

    fn apply_effects(&mut self) {
        self.prepare_effects();
        let effects = self.setup.effects.len();
        if self.ledger.is_none() {
            self.act(0..effects);
            return;
        }
        let (particles, all) = (&self.particles, &self.setup.effects);
        let potential = all
            .iter()
            .take_while(|(_, it)| it.energy(particles).is_some());
        let potential = potential.count();
        self.act(0..potential);
        let particles = &self.particles;
        let before = [particles.force.clone(), particles.torque.clone()];
        self.act(potential..effects);
        if let Some(ledger) = &mut self.ledger {
            ledger
                .books
                .note_air([&before[0], &before[1]], &self.particles);
        }
    }

    /// Makes effects ready for the present positions.
    pub(super) fn prepare_effects(&mut self) {
        if self.setup.shielded {
            let (near, particles) = (&mut self.neighbours.near, &self.particles);
            near.count_shielding(self.level, particles);
            self.mark(Part::Shield);
        }
        for (place, effect) in &mut self.setup.effects {
            effect.prepare(self.neighbours.near.shielding());
            profile::mark(&mut self.profile, Part::Effect(*place));
        }
    }

    /// Adds the forces and torques of some effects.
    fn act(&mut self, effects: Range<usize>) {
        if !effects.is_empty() {
            self.move_all(effects, &[], None, false);
        }
    }

    /// Reports a contact that the latest forces found too deep.
    pub(super) fn check_overlaps(&mut self) -> Result<(), Instability> {
        match self.step.too_deep.take() {
            Some((sphere, overlap)) => Err(self.setup.limits.overlap_broken(
                self.step.number,
                self.setup.dt,
                sphere,
                overlap,
            )),
            None => Ok(()),
        }
    }

    /// Takes all candidates out of the system, to borrow them beside it.
    pub(super) fn take_candidates(&mut self) -> Candidates {
        let mut candidates = Candidates {
            pairs: self.neighbours.near.take_pairs(),
            ..Candidates::default()
        };
        for (all, wall) in candidates.walls.iter_mut().zip(&mut self.walls) {
            *all = std::mem::take(&mut wall.near);
        }
        candidates
    }

    pub(super) fn return_candidates(&mut self, candidates: Candidates) {
        self.neighbours.near.return_pairs(candidates.pairs);
        for (wall, all) in self.walls.iter_mut().zip(candidates.walls) {
            wall.near = all;
        }
    }

    /// Adds the forces and torques of contacts, or evaluates those of all anew.
    pub(super) fn forces_of_candidates(&mut self, candidates: &Candidates, anew: bool) {
        if anew || !Self::HAS_HISTORY {
            self.forces_of(candidates, anew);
            return;
        }
        // The kernels expect the history of each contact at its own place; those of some contacts
        // stand among those of all.
        let entries = || candidates.entries.iter().copied();
        let all = exchange(&mut self.pair_history, entries());
        let mut walls = [const { Vec::new() }; TankWall::MOST];
        for ((all, wall), near) in walls.iter_mut().zip(&mut self.walls).zip(&candidates.walls) {
            *all = exchange(&mut wall.histories, near.iter().map(|sphere| sphere.entry));
        }
        self.forces_of(candidates, anew);
        put_back(&mut self.pair_history, all, entries());
        for ((all, wall), near) in walls
            .into_iter()
            .zip(&mut self.walls)
            .zip(&candidates.walls)
        {
            put_back(&mut wall.histories, all, near.iter().map(|it| it.entry));
        }
    }

    fn forces_of(&mut self, candidates: &Candidates, anew: bool) {
        let clear = anew && !std::mem::take(&mut self.step.forces_are_zero);
        let Particles { force, torque, .. } = &mut self.particles;
        let (mut force, mut torque) = (std::mem::take(force), std::mem::take(torque));
        let settings = self.settings();
        let partners = Partners::all(&self.particles, &self.earlier);
        let known = candidates.with_histories(&mut self.pair_history, &mut self.walls);
        let too_deep = match self.division.as_mut().filter(|_| anew) {
            Some(division) => {
                let sums = [&mut force[..], &mut torque[..]];
                let too_deep =
                    division.evaluate(self.level, &settings, partners, sums, clear, known);
                profile::mark(&mut self.profile, Part::Pairs);
                too_deep
            }
            None => {
                let (pairs, walls) = known;
                let mut task = ContactTask {
                    partners,
                    sums: Sums {
                        first: 0,
                        force: &mut force,
                        torque: &mut torque,
                    },
                    clear,
                    buffers: &mut self.buffers,
                    crossing: ContactSlice::none(),
                    pairs,
                    walls,
                    too_deep: [None; 1 + TankWall::MOST],
                };
                task.add_contacts(self.level, &settings, &mut self.profile);
                task.too_deep.into_iter().flatten().next()
            }
        };
        self.step.too_deep = self.step.too_deep.or(too_deep);
        (self.particles.force, self.particles.torque) = (force, torque);
    }

    /// What a contact force depends on besides the two spheres and their history.
    pub(super) fn settings(&self) -> ContactSettings<N, T> {
        ContactSettings {
            laws: self.laws(),
            fixed: self.particles.fixed as u32,
            alike: self.alike,
            mostly_touch: self.neighbours.near.mostly_touch(),
            far: come_from_far(&self.pair_history),
        }
    }
}

/// Replaces all histories by those at these entries, and returns all.
fn exchange<H: Copy>(histories: &mut Vec<H>, entries: impl Iterator<Item = u32>) -> Vec<H> {
    let some = entries.map(|entry| histories[entry as usize]).collect();
    std::mem::replace(histories, some)
}

/// Puts all histories back, with those at these entries as they are now.
fn put_back<H: Copy>(histories: &mut Vec<H>, all: Vec<H>, entries: impl Iterator<Item = u32>) {
    let some = std::mem::replace(histories, all);
    for (entry, history) in entries.zip(some) {
        histories[entry as usize] = history;
    }
}

#[cfg(test)]
mod tests {
    use super::{exchange, put_back};

    /// Symptom: springs of an island of adaptive Verlet were those of other contacts. Cause: the
    /// histories of some contacts were read by their places among these contacts, not by their
    /// entries among all.
    #[test]
    fn some_contacts_find_their_histories_among_all() {
        let (mut histories, entries) = (vec![10, 11, 12, 13, 14], [1, 4]);
        let all = exchange(&mut histories, entries.into_iter());
        assert_eq!(histories, [11, 14]);
        histories[1] = 24;
        put_back(&mut histories, all, entries.into_iter());
        assert_eq!(histories, [10, 11, 12, 13, 24]);
    }
}
