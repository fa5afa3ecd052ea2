//! Steps of fixed length: section 2.1 of Rycroft, Wong and Bazant (2010). There, lambda and mu are
//! exchanged: a step takes 1/mu, and lambda/mu spots are inserted in each on average.

use super::arrangement::Arrangement;
use super::guard::{Failure, Fault};
use super::model::{Model, Scratch};
use super::parameters::{Relaxation, Schedule};
use super::simulation::Simulation;
use super::walk::Spot;
use super::waves::{Planner, Waves};
use crate::particles::vector::Vector;
use std::ops::Range;

/// A move of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Move {
    /// Index of the spot.
    spot: u32,
    /// Random numbers 0 <= u < 1 for the way and the relaxation.
    random: [f64; 2],
}

/// What a move has done.
#[derive(Clone, Copy, Debug)]
pub(super) struct Done {
    spot: u32,
    /// The spot after its move, and whether it was relaxed around it; None if it is to be removed.
    result: Option<(Spot, bool)>,
}

/// The moves of a step, and what they depend on.
pub(super) struct Step<'a> {
    pub(super) model: &'a Model,
    pub(super) arrangement: &'a Arrangement,
    pub(super) spots: &'a [Spot],
    pub(super) moves: &'a [Move],
    pub(super) waves: &'a Waves,
}

impl Simulation {
    /// Makes all steps that end by a time (s).
    pub(super) fn steps_until(&mut self, time: f64) -> Result<(), Failure> {
        let rate = self.model.parameters.move_rate;
        let mut planner = Planner::new(&self.model.parameters);
        loop {
            let end = (self.steps + 1) as f64 / rate;
            if !(end <= time) {
                return Ok(());
            }
            self.step(&mut planner)
                .map_err(|fault| self.failure(fault, end))?;
        }
    }

    fn step(&mut self, planner: &mut Planner) -> Result<(), Fault> {
        let parameters = &self.model.parameters;
        let (insertion, rate) = (parameters.insertion_rate, parameters.move_rate);
        let relaxation = parameters.relaxation;
        for _ in 0..self.random[0].poisson(insertion / rate) {
            self.insert();
        }
        let moves = self.moves_in_order();
        let centres: Vec<Vector> = moves.iter().map(|it| self.expected_centre(it)).collect();
        let waves = planner.plan(&centres);
        let mut gone = vec![false; self.spots.len()];
        let mut next = 0;
        while next < waves.len() {
            self.sort_if_stale()?;
            next = self.make_waves((&moves, &waves), next, &mut gone)?;
        }
        let mut gone = gone.into_iter();
        self.spots.retain(|_| gone.next() != Some(true));
        self.steps += 1;
        match relaxation {
            Relaxation::Global { ratio } if self.steps.is_multiple_of(u64::from(ratio)) => {
                self.relax_all()
            }
            _ => Ok(()),
        }
    }

    /// The middle of the way of a move, as far as it is known.
    fn expected_centre(&self, it: &Move) -> Vector {
        let spot = &self.spots[it.spot as usize];
        self.model.expected_centre(spot.position, it.random[0])
    }

    /// One move of each spot, in the order of the step.
    fn moves_in_order(&mut self) -> Vec<Move> {
        let mut order: Vec<u32> = (0..self.spots.len() as u32).rev().collect();
        if self.model.parameters.schedule == Schedule::StepsInRandomOrder {
            for last in (1..order.len()).rev() {
                order.swap(last, self.random[0].below(last + 1));
            }
        }
        let moves = order.into_iter().map(|spot| Move {
            spot,
            random: [self.random[0].uniform(), self.relaxation_chance()],
        });
        moves.collect()
    }

    /// Makes the moves of waves until the spheres must be sorted. Returns the next wave.
    fn make_waves(
        &mut self,
        (moves, waves): (&[Move], &Waves),
        first: usize,
        gone: &mut [bool],
    ) -> Result<usize, Fault> {
        let step = Step {
            model: &self.model,
            arrangement: &self.arrangement,
            spots: &self.spots,
            moves,
            waves,
        };
        let crew = self.workers.crew();
        let (next, done) = match crew {
            Some(crew) => crew.make_waves(&step, first, &mut self.position, &mut self.scratch)?,
            None => step.make_waves(first, &mut self.position, &mut self.scratch)?,
        };
        for Done { spot, result } in done {
            match result {
                Some((moved, relaxed)) => {
                    self.spots[spot as usize] = moved;
                    self.counts.moves += 1;
                    self.counts.relaxations += u64::from(relaxed);
                }
                None => {
                    gone[spot as usize] = true;
                    self.counts.removed += 1;
                }
            }
        }
        self.count_left();
        Ok(next)
    }
}

impl Step<'_> {
    /// Makes one move.
    pub(super) fn make(
        &self,
        number: u32,
        position: &mut [Vector],
        scratch: &mut Scratch,
    ) -> Result<Done, Fault> {
        let Move { spot, random } = self.moves[number as usize];
        let mut moved = self.spots[spot as usize];
        let spheres = (self.arrangement, position);
        let relaxed = self.model.make_move(spheres, scratch, &mut moved, random)?;
        Ok(Done {
            spot,
            result: relaxed.map(|relaxed| (moved, relaxed)),
        })
    }

    /// The waves that are left from one on.
    pub(super) fn waves_from(&self, first: usize) -> Range<usize> {
        first..self.waves.len()
    }

    /// Makes the moves of waves on this thread.
    fn make_waves(
        &self,
        first: usize,
        position: &mut [Vector],
        scratch: &mut Scratch,
    ) -> Result<(usize, Vec<Done>), Fault> {
        let mut done = Vec::new();
        for wave in self.waves_from(first) {
            for &number in self.waves.wave(wave) {
                done.push(self.make(number, position, scratch)?);
            }
            if scratch.stale {
                return Ok((wave + 1, done));
            }
        }
        Ok((self.waves.len(), done))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spot::samples;

    #[test]
    fn waves_give_the_bits_of_one_move_after_the_other() {
        for schedule in [Schedule::StepsInRandomOrder, Schedule::StepsNewestFirst] {
            let mut simulation = samples::simulation(|it| {
                it.schedule = schedule;
                it.relaxation = Relaxation::AtRandom { ratio: 4 };
            });
            simulation.advance_to(4.5).expect("no guard breaks");
            simulation.scratch.stale = true;
            simulation.sort_if_stale().expect("sorted");
            let moves = simulation.moves_in_order();
            let centre = |it: &Move| simulation.expected_centre(it);
            let centres: Vec<Vector> = moves.iter().map(centre).collect();
            let waves = Planner::new(&simulation.model.parameters).plan(&centres);
            assert!(waves.len() < moves.len(), "{} waves", waves.len());
            let step = Step {
                model: &simulation.model,
                arrangement: &simulation.arrangement,
                spots: &simulation.spots,
                moves: &moves,
                waves: &waves,
            };
            let [mut in_waves, mut in_order] = [0, 1].map(|_| simulation.position.clone());
            let mut scratch = Scratch::default();
            step.make_waves(0, &mut in_waves, &mut scratch)
                .expect("no guard breaks");
            assert!(!scratch.stale);
            for number in 0..moves.len() as u32 {
                step.make(number, &mut in_order, &mut scratch)
                    .expect("no guard breaks");
            }
            assert!(in_waves == in_order);
            assert!(in_waves != simulation.position);
        }
    }
}
