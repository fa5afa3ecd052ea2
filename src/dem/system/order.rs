//! Sorting the spheres of a large scene in memory, and everything that has an entry per sphere.

use super::System;
use crate::dem::neighbours::NearPair;
use crate::dem::order;
use crate::dem::profile::StepPart;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::{History, TangentialLaw};
use crate::simulation::Instability;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Whether the order of the spheres is to be checked now.
    pub(super) fn checks_order(&self) -> bool {
        self.setup.sorted && self.step.number.is_multiple_of(order::INTERVAL)
    }

    /// Sorts the spheres if their order is to be checked now and they have mixed.
    pub(super) fn keep_in_order(&mut self) -> Result<(), Instability> {
        if !self.checks_order() {
            return Ok(());
        }
        let result = match order::found_anew(&self.particles) {
            Some(order) => self.reorder(&order),
            None => Ok(()),
        };
        self.mark(StepPart::List);
        result
    }

    fn reorder(&mut self, order: &[u32]) -> Result<(), Instability> {
        let places = order::places(order);
        self.renumber_pairs(&places);
        self.particles.reorder(order);
        self.find_driven();
        for (_, effect) in &mut self.setup.effects {
            effect.reorder(order);
        }
        for wall in &mut self.walls {
            wall.reorder(&places);
        }
        if let Some(ledger) = &mut self.ledger {
            ledger.books.reorder(order);
        }
        self.neighbours.stale = true;
        if self.neighbours.list.is_none() {
            return Ok(());
        }
        self.forget_lists();
        self.refresh()
    }

    /// Gives the near pairs with a history their new indices, and sorts them and their histories.
    /// These take most of the memory of a large scene, so they are sorted in place.
    fn renumber_pairs(&mut self, places: &[u32]) {
        let pairs = self.neighbours.near.pairs_mut();
        let histories = &mut self.pair_history;
        if !Self::HAS_HISTORY {
            pairs.clear();
            histories.clear();
            return;
        }
        let mut known = 0;
        for at in 0..pairs.len() {
            if histories[at].is_new() {
                continue;
            }
            let (i, j) = (
                places[pairs[at].i() as usize],
                places[pairs[at].j() as usize],
            );
            histories[known] = match i < j {
                true => histories[at],
                false => histories[at].turned_round(),
            };
            pairs[known] = NearPair::new(i.min(j), i.max(j));
            known += 1;
        }
        pairs.truncate(known);
        histories.truncate(known);
        let mut order: Vec<u32> = (0..known as u32).collect();
        order.sort_unstable_by_key(|&at| pairs[at as usize]);
        pairs.sort_unstable();
        // Each cycle of the permutation is followed once. An entry that names its own place is
        // done.
        for first in 0..known {
            let (mut at, history) = (first, histories[first]);
            loop {
                let from = std::mem::replace(&mut order[at], at as u32) as usize;
                if from == first || from == at {
                    break;
                }
                histories[at] = histories[from];
                at = from;
            }
            histories[at] = history;
        }
    }
}
