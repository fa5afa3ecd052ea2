//! When lists of neighbours are made anew, and what becomes of the histories of their contacts.

use super::meeting::{Laws, Solid};
use super::{Age, Parts, System};
use crate::dem::contact::NormalLaw;
use crate::dem::friction::TangentialLaw;
use crate::dem::particles::Particles;
use crate::dem::profile::Part;
use crate::record::Instability;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Looks for near pairs anew, in a list that holds until they must be looked for again.
    pub(super) fn refresh(&mut self) -> Result<(), Instability> {
        let Some(list) = &self.list else {
            return self.rebuild();
        };
        self.near.adapt(self.near_age.steps, list.skin());
        self.near_age = Age::default();
        if !list.holds(&self.parts.particles, self.age.time, self.near.margin()) {
            self.mark(Part::Near);
            self.rebuild()?;
            self.mark(Part::List);
        }
        self.stale = false;
        if let Some(list) = &self.list {
            let (near, particles) = (&mut self.near, &self.parts.particles);
            let history = &mut self.pair_history;
            let mut forget = |entry: u32| history[entry as usize] = T::History::default();
            let forget: Option<&mut dyn FnMut(u32)> = match Self::REMEMBERS {
                true => Some(&mut forget),
                false => None,
            };
            near.refresh(self.level, list, particles, forget);
            let margin = near.margin();
            for wall in &mut self.walls {
                wall.find(particles, margin);
            }
        }
        self.mark(Part::Near);
        Ok(())
    }

    /// What all spheres are like, if they are alike to the laws.
    pub(super) fn alike(particles: &Particles) -> Option<Solid> {
        Solid::of_all(particles, Laws::<N, T>::NEEDS_EFFECTIVE_MASS)
    }

    /// Fits everything that has an entry per sphere to the spheres that there are now.
    pub(super) fn renumber(&mut self) {
        if self.list.is_some() {
            self.alike = Self::alike(&self.parts.particles);
        }
        self.stale = true;
    }

    /// Builds the list anew, after making sure that every sphere is somewhere.
    pub(super) fn rebuild(&mut self) -> Result<(), Instability> {
        let Parts {
            particles,
            limits,
            dt,
            ..
        } = &self.parts;
        limits.check_positions(particles, self.step, *dt)?;
        self.stale = false;
        let age = std::mem::take(&mut self.age);
        let Some(list) = &mut self.list else {
            return Ok(());
        };
        list.adapt(age.steps);
        if !Self::REMEMBERS {
            list.build(particles);
            self.pair_history
                .resize(list.pairs(), T::History::default());
            return Ok(());
        }
        let (start, neighbour) = (list.start().to_vec(), list.neighbour().to_vec());
        list.build(particles);
        let old = std::mem::take(&mut self.pair_history);
        self.pair_history = carry_over(&start, &neighbour, &old, list.start(), list.neighbour());
        Ok(())
    }
}

/// Histories in the order of a new list; both lists are sorted, so one pass over each suffices.
fn carry_over<H: Copy + Default>(
    old_start: &[u32],
    old_neighbour: &[u32],
    old: &[H],
    start: &[u32],
    neighbour: &[u32],
) -> Vec<H> {
    let mut histories = vec![H::default(); neighbour.len()];
    if old.is_empty() {
        return histories;
    }
    for i in 0..start.len() - 1 {
        let mut from = old_start[i] as usize;
        let end = old_start[i + 1] as usize;
        for entry in start[i] as usize..start[i + 1] as usize {
            while from < end && old_neighbour[from] < neighbour[entry] {
                from += 1;
            }
            if from < end && old_neighbour[from] == neighbour[entry] {
                histories[entry] = old[from];
            }
        }
    }
    histories
}
