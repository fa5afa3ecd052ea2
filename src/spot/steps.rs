//! Steps of fixed length: section 2.1 of Rycroft, Wong and Bazant (2010). The paper swaps lambda
//! and mu there: a step takes 1/mu, and on average lambda/mu spots are inserted in each.
//!
//! If the newest spots move first, a step has two parts: the newer, lower half of the spots, and
//! the rest. The lower part of a step can be made together with the upper part of the one before,
//! which it touches only where they meet. Spheres are sorted between the parts, so that the bits do
//! not depend on whether this is done.

use super::batch::{Move, MoveBatch};
use super::guard::{Fault, SpotFailure};
use super::parameters::{Relaxation, Schedule};
use super::simulation::SpotSimulation;

impl SpotSimulation {
    /// Makes all steps that end by a time (s).
    pub(super) fn steps_until(&mut self, time: f64) -> Result<(), SpotFailure> {
        let made = match self.model.parameters.schedule {
            Schedule::StepsNewestFirst => self.steps_newest_first(time),
            _ => self.steps_in_random_order(time),
        };
        made.map_err(|fault| self.failure(fault, self.end_of_step(1)))
    }

    /// When one of the next steps ends, counted from 1 (s).
    fn end_of_step(&self, next: u64) -> f64 {
        (self.steps + next) as f64 / self.model.parameters.move_rate
    }

    fn steps_in_random_order(&mut self, time: f64) -> Result<(), Fault> {
        while self.end_of_step(1) <= time {
            self.insert_spots();
            let mut order: Vec<usize> = (0..self.spots.len()).rev().collect();
            for last in (1..order.len()).rev() {
                order.swap(last, self.random[0].below(last + 1));
            }
            let moves = self.moves_of(order.into_iter());
            self.sort_if_worn()?;
            self.make_moves(&moves, 0, None)?;
            self.end_step()?;
        }
        Ok(())
    }

    fn steps_newest_first(&mut self, time: f64) -> Result<(), Fault> {
        let mut upper = None;
        while self.end_of_step(1 + u64::from(upper.is_some())) <= time {
            let rest = self.lower_part(upper.take())?;
            if self.workers.are_several() && !self.relaxes_all_after(self.steps + 1) {
                upper = Some(rest);
            } else {
                self.upper_part(&rest)?;
            }
        }
        upper.map_or(Ok(()), |rest| self.upper_part(&rest))
    }

    /// Makes the lower part of a step, together with the remaining upper part of the step before,
    /// if any. Returns the moves of the upper part.
    fn lower_part(&mut self, left: Option<Vec<Move>>) -> Result<Vec<Move>, Fault> {
        let upper = left.as_ref().map(Vec::len);
        let mut moves = left.unwrap_or_default();
        let newest = self.insert_spots() + self.lower;
        let spots = self.spots.len();
        moves.extend(self.moves_of((spots - newest..spots).rev()));
        let newest = self.make_moves(&moves, newest, upper)?;
        self.sort_if_worn()?;
        let spots = self.spots.len();
        let half = self.spots.first().map_or(0.0, |it| 0.5 * it.position.z);
        let lower = self.spots[spots - newest..].iter();
        self.lower = lower.filter(|it| it.position.z < half).count();
        Ok(self.moves_of((0..spots - newest).rev()))
    }

    /// Makes the upper part of a step.
    fn upper_part(&mut self, moves: &[Move]) -> Result<(), Fault> {
        self.make_moves(moves, 0, None)?;
        self.end_step()
    }

    /// Inserts the spots of a step. Returns how many.
    fn insert_spots(&mut self) -> usize {
        let parameters = &self.model.parameters;
        let mean = parameters.insertion_rate / parameters.move_rate;
        let count = self.random[0].poisson(mean);
        (0..count).for_each(|_| self.insert());
        count as usize
    }

    /// One move of each of these spots.
    fn moves_of(&mut self, spots: impl Iterator<Item = usize>) -> Vec<Move> {
        let moves = spots.map(|spot| Move {
            spot: spot as u32,
            random: [self.random[0].uniform(), self.relaxation_chance()],
        });
        moves.collect()
    }

    fn end_step(&mut self) -> Result<(), Fault> {
        self.steps += 1;
        if self.relaxes_all_after(self.steps) {
            self.relax_all()?;
        }
        Ok(())
    }

    fn relaxes_all_after(&self, step: u64) -> bool {
        match self.model.parameters.relaxation {
            Relaxation::Global { ratio } => step.is_multiple_of(ratio),
            _ => false,
        }
    }

    /// Makes moves, sorts spheres in between if they must be, and removes spots. A step may end
    /// with the first of the moves. Returns how many of the newest spots remain.
    fn make_moves(
        &mut self,
        moves: &[Move],
        newest: usize,
        ending: Option<usize>,
    ) -> Result<usize, Fault> {
        // Moves from bottom to top form a chain of dependences, and a part of a step has only one
        // such chain.
        let random = self.model.parameters.schedule == Schedule::StepsInRandomOrder;
        let apart = random || ending.is_some();
        let mut gone = vec![false; self.spots.len()];
        let mut next = 0;
        let mut made = Ok(());
        while made.is_ok() && next < moves.len() {
            made = self.sort_if_stale();
            if made.is_ok() {
                let some = self.make_some(&moves[next..], &mut gone, apart);
                next += some.0;
                made = some.1;
            }
        }
        let whole = next.saturating_sub(usize::from(made.is_err()));
        self.steps += u64::from(ending.is_some_and(|ending| whole >= ending));
        made?;
        let older = gone.len() - newest;
        let left = gone[older..].iter().filter(|it| !**it).count();
        let mut gone = gone.into_iter();
        self.spots.retain(|_| gone.next() != Some(true));
        Ok(left)
    }

    /// Makes moves until the spheres must be sorted or a guard breaks. Returns how many were made
    /// or begun. They are made on several threads if there are moves far enough apart.
    fn make_some(
        &mut self,
        moves: &[Move],
        gone: &mut [bool],
        apart: bool,
    ) -> (usize, Result<(), Fault>) {
        let batch = MoveBatch {
            model: &self.model,
            arrangement: &self.arrangement,
            spots: &self.spots,
            moves,
        };
        let (position, scratch) = (&mut self.position, &mut self.scratch);
        let made = match self.workers.crew() {
            Some(crew) if apart => crew.make_moves(&batch, position, scratch),
            _ => batch.make_in_order(position, scratch),
        };
        for done in made.done {
            let spot = done.spot as usize;
            match done.result {
                Some((moved, relaxed)) => {
                    self.spots[spot] = moved;
                    self.counts.moves += 1;
                    self.scratch.clock.count_move();
                    self.counts.relaxations += u64::from(relaxed);
                }
                None => {
                    gone[spot] = true;
                    self.counts.removed += 1;
                }
            }
        }
        self.count_left();
        (made.moves, made.fault.map_or(Ok(()), Err))
    }
}
