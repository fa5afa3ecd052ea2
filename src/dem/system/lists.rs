//! When lists of neighbours are renewed, and what becomes of the histories of their contacts.

use super::contact_state::SphereProperties;
use super::division::threads;
use super::moves::Drift;
use super::wall_contacts::WallContacts;
use super::{Age, NeighbourState, System, SystemSetup};
use crate::dem::neighbours::{NearPair, Reach, VerletList};
use crate::dem::profile::StepPart;
use crate::dem::threads::both;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::{History, TangentialLaw};
use crate::particles::Particles;
use crate::simulation::Instability;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Finds the near pairs again, in a list that holds until the next time.
    pub(super) fn refresh(&mut self) -> Result<(), Instability> {
        let Some(list) = &self.neighbours.list else {
            self.neighbours.stale = false;
            return self.check_positions();
        };
        let age = std::mem::take(&mut self.neighbours.near_age);
        self.neighbours.near.adapt(age.steps, age.time, list.skin());
        if !list.holds(
            &self.particles,
            self.neighbours.age.time,
            self.neighbours.near.reach(),
        ) {
            self.mark(StepPart::Near);
            self.renew()?;
            self.mark(StepPart::List);
        }
        self.neighbours.stale = false;
        if let Some(list) = &self.neighbours.list {
            let (near, particles) = (&mut self.neighbours.near, &self.particles);
            let threads = threads(self.division.as_ref());
            if Self::HAS_HISTORY {
                let before = near.exchange_pairs(std::mem::take(&mut self.neighbours.spare_pairs));
                near.refresh(self.level, list, particles, threads);
                let (pairs, histories) = (near.pairs(), &mut self.pair_history);
                both(
                    threads,
                    || carry_over(&before, pairs, histories),
                    || find_at_walls(&mut self.walls, particles, near.margin()),
                );
                // A large scene would keep this memory unused most of the time.
                if !self.setup.sorted {
                    self.neighbours.spare_pairs = before;
                }
            } else {
                near.refresh(self.level, list, particles, threads);
                // These histories have size zero.
                self.pair_history
                    .resize(near.pairs().len(), T::History::default());
                find_at_walls(&mut self.walls, particles, near.margin());
            }
            if let Some(division) = &mut self.division {
                let (pairs, histories) = (self.neighbours.near.pairs(), &self.pair_history);
                division.divide(particles.len(), pairs, histories, &self.walls);
            }
        }
        self.mark(StepPart::Near);
        Ok(())
    }

    /// Adapts the lists after spheres were added or removed.
    pub(super) fn renumber(&mut self) {
        self.find_driven();
        if self.neighbours.list.is_some() {
            self.alike = SphereProperties::of_all::<N, T>(&self.particles);
        }
        self.neighbours.stale = true;
    }

    /// Checks the positions of all spheres, and makes the list hold again: it follows the spheres
    /// that left their margins, or is built again.
    fn renew(&mut self) -> Result<(), Instability> {
        self.check_positions()?;
        let Some(list) = &mut self.neighbours.list else {
            return Ok(());
        };
        let particles = &self.particles;
        if list.follow(
            particles,
            self.neighbours.age.time,
            self.neighbours.near.reach(),
        ) {
            return Ok(());
        }
        let age = std::mem::take(&mut self.neighbours.age);
        // A list that ended in its first step was replaced because spheres changed: its age says
        // nothing about the skin.
        if age.steps > 0 {
            list.adapt(age.steps, age.time);
        }
        list.build(particles, threads(self.division.as_ref()));
        Ok(())
    }

    pub(super) fn check_positions(&self) -> Result<(), Instability> {
        let SystemSetup { limits, dt, .. } = &self.setup;
        limits.check_positions(&self.particles, self.step.number, *dt)
    }
}

impl NeighbourState {
    /// For a system with this normal law.
    pub(super) fn new<N: NormalLaw>(setup: &SystemSetup) -> Self {
        let reach = match setup.shielded {
            true => Reach::Column,
            false => Reach::Contact,
        };
        let interact = N::ACTS || setup.shielded;
        Self {
            list: interact.then(|| {
                let list = VerletList::new(reach, setup.skin, setup.neighbours);
                if setup.sorted { list.of_sorted() } else { list }
            }),
            near: setup.near::<N>(),
            stale: true,
            age: Age::default(),
            near_age: Age::default(),
            spare_pairs: Vec::new(),
        }
    }

    /// Adds the time (s) of a drift to the ages of the lists.
    pub(super) fn let_pass(&mut self, time: f64) {
        self.age.time += time;
        self.near_age.time += time;
    }

    /// A drift (s) that ends now. It checks whether the near pairs hold, if there are lists.
    pub(super) fn drift(&self, dt: f64) -> Drift {
        let is_listed = self.list.is_some();
        Drift {
            dt,
            allowance: is_listed.then(|| self.near.allowance(self.near_age.time)),
        }
    }
}

/// Finds the spheres near each wall.
fn find_at_walls<H: History>(walls: &mut [WallContacts<H>], particles: &Particles, margin: f64) {
    for wall in walls {
        wall.find(particles, margin);
    }
}

/// Puts the histories of near pairs into the order of the pairs that are near now. Histories of
/// pairs that are no longer near are dropped. Both lists are sorted, so one pass over each
/// suffices. Histories move in place: a second array would dominate the memory of a large scene.
fn carry_over<H: History>(before: &[NearPair], now: &[NearPair], histories: &mut Vec<H>) {
    const GONE: u32 = u32::MAX;
    let mut rest = now.iter().zip(0..).peekable();
    let mut place_of = |pair: &NearPair| {
        while rest.next_if(|(it, _)| *it < pair).is_some() {}
        let same = rest.next_if(|(it, _)| *it == pair);
        same.map_or(GONE, |(_, place)| place)
    };
    let places: Vec<u32> = before.iter().map(&mut place_of).collect();
    let places = || places.iter().map(|&place| place as usize).enumerate();
    histories.resize(before.len().max(now.len()), H::default());
    // New places are in ascending order. Moving entries down from the front, then up from the back,
    // overwrites no entry that has still to move.
    for (at, place) in places().filter(|(at, place)| place < at) {
        histories[place] = histories[at];
    }
    let stay = |place: &usize| *place != GONE as usize;
    for (at, place) in places()
        .rev()
        .filter(|(at, place)| place > at && stay(place))
    {
        histories[place] = histories[at];
    }
    histories.truncate(now.len());
    let mut next = 0;
    for (_, place) in places().filter(|(_, place)| stay(place)) {
        histories[next..place].fill(H::default());
        next = place + 1;
    }
    histories[next..].fill(H::default());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forces::friction::Spring;
    use crate::particles::vector::Vector;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    fn pairs(of: &[[u32; 2]]) -> Vec<NearPair> {
        of.iter().map(|&[i, j]| NearPair::new(i, j)).collect()
    }

    fn springs(of: &[f64]) -> Vec<Spring> {
        let spring = |&x: &f64| Spring {
            force: Vector::new(x, 0.0, 0.0),
        };
        of.iter().map(spring).collect()
    }

    #[test]
    fn histories_stay_with_their_pairs() {
        let before = pairs(&[[0, 1], [0, 2], [1, 2], [1, 4], [2, 4]]);
        let mut histories = springs(&[1.0, 0.0, 3.0, 4.0, 5.0]);
        let now = pairs(&[[0, 2], [0, 3], [1, 2], [1, 3], [1, 4], [2, 3], [3, 4]]);
        carry_over(&before, &now, &mut histories);
        let found: Vec<f64> = histories.iter().map(|it| it.force.x).collect();
        assert_eq!(found, [0.0, 0.0, 3.0, 0.0, 4.0, 0.0, 0.0]);
        carry_over(&now, &before, &mut histories);
        let found: Vec<f64> = histories.iter().map(|it| it.force.x).collect();
        assert_eq!(found, [0.0, 0.0, 3.0, 4.0, 0.0]);
    }

    proptest! {
        #[test]
        fn histories_stay_with_any_pairs(
            before in prop::collection::btree_set((0..9_u32, 9..18_u32), 0..60),
            now in prop::collection::btree_set((0..9_u32, 9..18_u32), 0..60),
        ) {
            let sorted = |of: &BTreeSet<(u32, u32)>| -> Vec<NearPair> {
                of.iter().map(|&(i, j)| NearPair::new(i, j)).collect()
            };
            let number = |&(i, j): &(u32, u32)| f64::from(100 + 18 * i + j);
            let mut histories = springs(&before.iter().map(number).collect::<Vec<_>>());
            carry_over(&sorted(&before), &sorted(&now), &mut histories);
            let kept = |pair| if before.contains(pair) { number(pair) } else { 0.0 };
            let expected = now.iter().map(kept);
            let found = histories.iter().map(|it| it.force.x);
            prop_assert!(found.eq(expected));
        }
    }
}
