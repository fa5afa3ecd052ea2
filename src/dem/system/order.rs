//! Sorting the spheres of a large scene in memory, and all that has an entry per sphere with them.

use super::System;
use crate::dem::contact::NormalLaw;
use crate::dem::friction::{History, TangentialLaw};
use crate::dem::order::{self, reorder};
use crate::dem::profile::Part;
use crate::record::Instability;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Sorts the spheres if it is time to look at their order, and they have mixed.
    pub(super) fn keep_in_order(&mut self) -> Result<(), Instability> {
        if !self.parts.sorted || !self.step.is_multiple_of(order::INTERVAL) {
            return Ok(());
        }
        let result = match order::found_anew(&self.parts.particles) {
            Some(order) => self.reorder(&order),
            None => Ok(()),
        };
        self.mark(Part::List);
        result
    }

    fn reorder(&mut self, order: &[u32]) -> Result<(), Instability> {
        let mut histories = self.remembered();
        let places = order::places(order);
        for (i, j, history) in &mut histories {
            (*i, *j) = (places[*i as usize], places[*j as usize]);
            if *i > *j {
                std::mem::swap(i, j);
                *history = history.turned_round();
            }
        }
        histories.sort_unstable_by_key(|&(i, j, _)| (i, j));
        self.parts.particles.reorder(order);
        reorder(&mut self.parts.limits.speed_squared, order);
        for effect in &mut self.parts.effects {
            effect.reorder(order);
        }
        for wall in &mut self.walls {
            wall.reorder(&places);
        }
        if let Some(ledger) = &mut self.ledger {
            ledger.books.reorder(order);
        }
        self.stale = true;
        if self.list.is_none() {
            return Ok(());
        }
        self.fill_lists(&histories)
    }
}
