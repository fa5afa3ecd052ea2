//! One evaluation of all forces and torques, at the present positions and velocities.

use super::candidates::Candidates;
use super::contact_laws::Laws;
use super::contact_task::{ContactSettings, ContactTask};
use super::moves::{FirstTooFast, Motion};
use super::partners::Partners;
use super::sums::Sums;
use super::touching::exceed_caches;
use super::{NeighbourState, System};
use crate::dem::bodies::SphereRows;
use crate::dem::profile::{self, StepPart};
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::particles::vector::Vector;
use crate::simulation::Instability;
use std::ops::Range;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Evaluates all forces and torques at the present positions and velocities. They belong to the
    /// moment `at` of the present step: 0 is its start, 1 its end.
    pub(super) fn evaluate(&mut self, at: f64) -> Result<(), Instability> {
        self.evaluate_contacts()?;
        self.apply_effects(at);
        Ok(())
    }

    /// Evaluates forces and torques of contacts alone.
    pub(super) fn evaluate_contacts(&mut self) -> Result<(), Instability> {
        self.hold_near()?;
        self.forces_of_contacts();
        self.check_overlaps()
    }

    /// Finds the near pairs again, if the present list does not hold.
    fn hold_near(&mut self) -> Result<(), Instability> {
        let NeighbourState {
            near,
            stale,
            near_age,
            ..
        } = &self.neighbours;
        match *stale || near.is_too_wide(near_age.steps) {
            true => self.refresh(),
            false => Ok(()),
        }
    }

    fn forces_of_contacts(&mut self) {
        self.note_all_contacts();
        self.mark_ledger();
        if self.neighbours.list.is_none() {
            self.particles.clear_forces();
            return;
        }
        let clear = !std::mem::take(&mut self.step.forces_are_zero);
        let settings = self.settings();
        let mut spheres = SphereRows::new(&mut self.particles, &[]);
        let (partners, [force, torque]) = Partners::of(&mut spheres, &self.earlier);
        let sums = Sums {
            first: 0,
            clear,
            force,
            torque,
        };
        let candidates = Candidates::all(
            self.neighbours.near.pairs(),
            &mut self.pair_history,
            &mut self.walls,
        );
        let too_deep = match &mut self.division {
            Some(division) => {
                let found = division.evaluate(self.level, &settings, partners, sums, candidates);
                profile::mark(&mut self.profile, StepPart::Pairs);
                found
            }
            None => {
                let mut task = ContactTask::of_all(partners, sums, candidates, &mut self.buffers);
                task.add_contacts(self.level, &settings, &mut self.profile);
                task.too_deep.map(|(_, found)| found)
            }
        };
        self.step.too_deep = self.step.too_deep.or(too_deep);
        self.add_rolling();
    }

    /// Evaluates all forces, of the moment `at` as in [`evaluate`](Self::evaluate), and moves all
    /// spheres. Returns the first sphere beyond its speed limit.
    ///
    /// If an overlap is too deep in a large scene, its spheres are moved nevertheless, for any
    /// number of threads.
    pub(super) fn evaluate_and_move(
        &mut self,
        at: f64,
        motion: Motion<'_>,
    ) -> Result<FirstTooFast, Instability> {
        self.hold_near()?;
        self.prepare_effects(at);
        let too_fast = match motion {
            Motion {
                kicks,
                drift: Some(drift),
                clear: true,
            } if self.streams() => self.stream(kicks, drift),
            _ => {
                self.forces_of_contacts();
                if !self.setup.sorted {
                    self.check_overlaps()?;
                }
                self.step.forces_are_zero = motion.clear;
                self.move_all(0..self.setup.effects.len(), motion)
            }
        };
        self.check_overlaps()?;
        Ok(too_fast)
    }

    /// Evaluates forces and torques of the effects alone, of the moment `at` as in
    /// [`evaluate`](Self::evaluate).
    pub(super) fn evaluate_effects(&mut self, at: f64) {
        self.particles.clear_forces();
        self.apply_effects(at);
    }

    fn apply_effects(&mut self, at: f64) {
        self.prepare_effects(at);
        let effects = self.setup.effects.len();
        if self.ledger.is_none() {
            self.act(0..effects);
            return;
        }
        let (particles, all) = (&self.particles, &self.setup.effects);
        let potential = all
            .iter()
            .take_while(|(_, it)| it.energy(particles).is_some());
        let after_potential = all.iter().skip(potential.count());
        let shaking = after_potential.map_while(|(_, it)| it.acceleration());
        let shaking = shaking.fold(Vector::ZERO, |sum, it| sum + it);
        let uniform = all.iter().take_while(|(_, it)| it.acceleration().is_some());
        let uniform = uniform.count();
        self.act(0..uniform);
        let particles = &self.particles;
        let before = [particles.force.clone(), particles.torque.clone()];
        self.act(uniform..effects);
        if let Some(ledger) = &mut self.ledger {
            let books = &mut ledger.books;
            books.note_shaking(shaking);
            books.note_air([&before[0], &before[1]], &self.particles);
        }
    }

    /// Prepares the effects for the present positions and a moment of the present step.
    fn prepare_effects(&mut self, at: f64) {
        // From the number of the step: a sum of steps would depend on where a run was interrupted.
        let time = (self.step.number as f64 - 1.0 + at) * self.setup.dt;
        if self.setup.shielded {
            let (near, particles) = (&mut self.neighbours.near, &self.particles);
            near.count_shielding(self.level, particles);
            self.mark(StepPart::Shield);
        }
        for (place, effect) in &mut self.setup.effects {
            effect.prepare(time, self.neighbours.near.shielding());
            profile::mark(&mut self.profile, StepPart::Effect(*place));
        }
    }

    /// Adds the forces and torques of some effects.
    fn act(&mut self, effects: Range<usize>) {
        if !effects.is_empty() {
            self.move_all(effects, Motion::NONE);
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

    /// The laws of this step's contacts.
    #[inline(always)]
    pub(super) fn laws(&self) -> Laws<N, T> {
        Laws {
            normal: self.normal,
            tangential: self.tangential,
            loading: self.loading,
            overlap_limit: self.setup.limits.overlap,
        }
    }

    /// Everything on which a contact force depends, besides the two spheres and their history.
    pub(super) fn settings(&self) -> ContactSettings<N, T> {
        ContactSettings {
            laws: self.laws(),
            alike: self.alike,
            mostly_touch: self.neighbours.near.mostly_touch(),
            prefetched: exceed_caches(&self.pair_history),
        }
    }
}
