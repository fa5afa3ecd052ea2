//! One evaluation: the forces and torques of everything, at the present positions and velocities.

use super::System;
use super::contacts::Among;
use super::moves::FirstTooFast;
use super::partners::Partners;
use super::share::{Known, Scenery, Share};
use super::sums::Sums;
use super::touching::come_from_far;
use crate::dem::contact::NormalLaw;
use crate::dem::friction::TangentialLaw;
use crate::dem::particles::Particles;
use crate::dem::profile::{self, Part};
use crate::dem::walls::TankWall;
use crate::simulation::Instability;
use std::ops::Range;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Evaluates all forces and torques at the present positions and velocities.
    pub(super) fn evaluate(&mut self) -> Result<(), Instability> {
        self.evaluate_contacts()?;
        self.apply_effects();
        Ok(())
    }

    /// Evaluates those of contacts alone.
    pub(super) fn evaluate_contacts(&mut self) -> Result<(), Instability> {
        self.hold_near()?;
        self.forces_of_contacts();
        self.check_overlaps()
    }

    /// Looks for near pairs if they do not hold.
    fn hold_near(&mut self) -> Result<(), Instability> {
        match self.stale || self.near.is_too_wide(self.near_age.steps) {
            true => self.refresh(),
            false => Ok(()),
        }
    }

    fn forces_of_contacts(&mut self) {
        let among = self.take_all();
        self.note_all_contacts(&among);
        self.mark_ledger();
        match self.list.is_some() {
            true => self.forces_among(&among, true),
            false => self.parts.particles.clear_forces(),
        }
        self.return_all(among);
    }

    /// Evaluates all forces, kicks for these times (s), and drifts for a time (s), if one is given;
    /// forgets the forces if they are to be cleared. Says who was too fast.
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
                if !self.parts.sorted {
                    self.check_overlaps()?;
                }
                self.cleared = clear;
                self.move_all(0..self.parts.effects.len(), kicks, drift, clear)
            }
        };
        self.check_overlaps()?;
        Ok(too_fast)
    }

    /// Forces and torques of all but contacts.
    pub(super) fn evaluate_effects(&mut self) {
        self.parts.particles.clear_forces();
        self.apply_effects();
    }

    fn apply_effects(&mut self) {
        self.prepare_effects();
        let effects = self.parts.effects.len();
        if self.ledger.is_none() {
            self.act(0..effects);
            return;
        }
        let (particles, all) = (&self.parts.particles, &self.parts.effects);
        let potential = all.iter().take_while(|it| it.energy(particles).is_some());
        let potential = potential.count();
        self.act(0..potential);
        let particles = &self.parts.particles;
        let before = [particles.force.clone(), particles.torque.clone()];
        self.act(potential..effects);
        if let Some(ledger) = &mut self.ledger {
            ledger
                .books
                .note_air([&before[0], &before[1]], &self.parts.particles);
        }
    }

    /// Makes effects ready for the present positions.
    pub(super) fn prepare_effects(&mut self) {
        if self.parts.shielded {
            let (near, particles) = (&mut self.near, &self.parts.particles);
            near.count_shielding(self.level, particles);
            self.mark(Part::Shield);
        }
        for effect in &mut self.parts.effects {
            effect.prepare(self.near.shielding());
            profile::mark(&mut self.profile, effect.part());
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
        match self.too_deep.take() {
            Some((sphere, overlap)) => {
                Err(self
                    .parts
                    .limits
                    .overlap_broken(self.step, self.parts.dt, sphere, overlap))
            }
            None => Ok(()),
        }
    }

    /// Takes out what may touch, all of it.
    pub(super) fn take_all(&mut self) -> Among {
        let mut among = Among {
            pairs: self.near.take_pairs(),
            ..Among::default()
        };
        for (all, wall) in among.walls.iter_mut().zip(&mut self.walls) {
            *all = std::mem::take(&mut wall.near);
        }
        among
    }

    pub(super) fn return_all(&mut self, among: Among) {
        self.near.return_pairs(among.pairs);
        for (wall, all) in self.walls.iter_mut().zip(among.walls) {
            wall.near = all;
        }
    }

    /// Adds the forces and torques of contacts, or evaluates those of all anew.
    pub(super) fn forces_among(&mut self, among: &Among, anew: bool) {
        if anew || !Self::REMEMBERS {
            self.forces_of(among, anew);
            return;
        }
        // Loops over contacts have the history of each beside it; that of some stands among those
        // of all.
        let entries = || among.entries.iter().copied();
        let all = exchange(&mut self.pair_history, entries());
        let mut walls = [const { Vec::new() }; TankWall::MOST];
        for ((all, wall), near) in walls.iter_mut().zip(&mut self.walls).zip(&among.walls) {
            *all = exchange(&mut wall.histories, near.iter().map(|sphere| sphere.entry));
        }
        self.forces_of(among, anew);
        put_back(&mut self.pair_history, all, entries());
        for ((all, wall), near) in walls.into_iter().zip(&mut self.walls).zip(&among.walls) {
            put_back(&mut wall.histories, all, near.iter().map(|it| it.entry));
        }
    }

    fn forces_of(&mut self, among: &Among, anew: bool) {
        let clear = anew && !std::mem::take(&mut self.cleared);
        let Particles { force, torque, .. } = &mut self.parts.particles;
        let (mut force, mut torque) = (std::mem::take(force), std::mem::take(torque));
        let scenery = self.scenery();
        let partners = Partners::all(&self.parts.particles, &self.earlier);
        let known = among.known(&mut self.pair_history, &mut self.walls);
        let too_deep = match self.division.as_mut().filter(|_| anew) {
            Some(division) => {
                let sums = [&mut force[..], &mut torque[..]];
                let too_deep =
                    division.evaluate(self.level, &scenery, partners, sums, clear, known);
                profile::mark(&mut self.profile, Part::Pairs);
                too_deep
            }
            None => {
                let (pairs, walls) = known;
                let mut share = Share {
                    partners,
                    sums: Sums {
                        first: 0,
                        force: &mut force,
                        torque: &mut torque,
                    },
                    clear,
                    buffers: &mut self.buffers,
                    crossing: Known::none(),
                    pairs,
                    walls,
                    too_deep: [None; 1 + TankWall::MOST],
                };
                share.add_contacts(self.level, &scenery, &mut self.profile);
                share.too_deep.into_iter().flatten().next()
            }
        };
        self.too_deep = self.too_deep.or(too_deep);
        (self.parts.particles.force, self.parts.particles.torque) = (force, torque);
    }

    /// What contacts depend on besides their partners and their own memory.
    pub(super) fn scenery(&self) -> Scenery<N, T> {
        Scenery {
            laws: self.laws(),
            fixed: self.parts.particles.fixed as u32,
            alike: self.alike,
            mostly_touch: self.near.mostly_touch(),
            far: come_from_far(&self.pair_history),
        }
    }
}

/// Puts the histories at these entries in the place of all, and returns those.
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
    /// histories of some contacts were read by their places among these, not by their entries among
    /// all.
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
