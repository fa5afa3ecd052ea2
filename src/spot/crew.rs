//! The moves of a batch on several threads, with the same bits as on one.
//!
//! If the spheres must be sorted after a move, or a guard breaks, other threads may already have
//! made later moves. The batch is then repeated up to this move.

use super::batch::{Made, MoveBatch};
use super::board::{Board, lock};
use super::model::Scratch;
use super::parameters::Schedule;
use super::strips::{Planner, StripPlan};
use super::worker::{StripTask, Worker};
use crate::particles::vector::Vector;
use rayon::ThreadPool;
use std::sync::Mutex;
use std::sync::atomic::AtomicUsize;

/// Share of the last batch in the costs of a move.
const SHARE_OF_LAST: f64 = 0.2;

/// Threads and what they work with.
#[derive(Debug)]
pub(crate) struct Crew {
    pool: ThreadPool,
    workers: Vec<Mutex<Worker>>,
    boards: Vec<Board>,
    plan: StripPlan,
    /// Time that a move takes in each strip (s). The bits do not depend on it.
    costs: Vec<f64>,
}

impl Crew {
    pub(crate) fn new(pool: ThreadPool) -> Self {
        let threads = pool.current_num_threads();
        Self {
            pool,
            workers: (0..threads).map(|_| Mutex::default()).collect(),
            boards: (0..threads).map(|_| Board::default()).collect(),
            plan: StripPlan::default(),
            costs: Vec::new(),
        }
    }

    /// The pool of threads.
    pub(crate) fn pool(&self) -> &ThreadPool {
        &self.pool
    }

    /// Makes moves until the spheres must be sorted.
    pub(super) fn make_moves(
        &mut self,
        batch: &MoveBatch<'_>,
        position: &mut [Vector],
        scratch: &mut Scratch,
    ) -> Made {
        let planner = Planner::new(&batch.model.parameters, batch.model.slack);
        let moves = (batch.moves.len(), |number| batch.expected_centre(number));
        // Where the newest spots move first, the strips are to be the parts of the steps.
        let costs = match batch.model.parameters.schedule {
            Schedule::StepsInRandomOrder => &self.costs[..],
            _ => &[],
        };
        let strips = (self.workers.len(), costs);
        planner.divide(&mut self.plan, batch.arrangement, moves, strips);
        if self.plan.strips.len() < 2 {
            return batch.make_in_order(position, scratch);
        }
        let mut most = batch.moves.len();
        loop {
            let end = AtomicUsize::new(most);
            self.boards.iter().for_each(Board::clear);
            self.pool.broadcast(|context| {
                let task = StripTask {
                    batch,
                    planner: &planner,
                    plan: &self.plan,
                    boards: &self.boards,
                    end: &end,
                    wear: scratch.wear.unused(),
                    own: context.index(),
                };
                if task.own < self.plan.strips.len() {
                    lock(&self.workers[task.own]).make_moves(&task, position);
                }
            });
            let end = end.into_inner();
            if end == most {
                return self.merged(most, position, scratch);
            }
            most = end;
        }
    }

    /// Merges the results of the threads.
    fn merged(&mut self, moves: usize, position: &mut [Vector], scratch: &mut Scratch) -> Made {
        let mut made = Made {
            moves,
            done: Vec::with_capacity(moves),
            fault: None,
        };
        self.costs.resize(self.plan.strips.len(), 0.0);
        for (own, strip) in self.plan.strips.iter().enumerate() {
            let worker = &mut *lock(&self.workers[own]);
            worker.take_over_rest(&self.boards, own);
            let slots = strip.own.clone();
            position[slots.clone()].copy_from_slice(&worker.position[slots]);
            let cost = worker.busy / worker.done.len().max(1) as f64;
            made.done.append(&mut worker.done);
            made.fault = made.fault.or(worker.fault.take());
            scratch.left.append(&mut worker.scratch.left);
            scratch.wear.note_all(worker.wear);
            self.costs[own] = match self.costs[own] > 0.0 {
                true => self.costs[own] + SHARE_OF_LAST * (cost - self.costs[own]),
                false => cost,
            };
        }
        made
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spot::batch::Move;
    use crate::spot::parameters::{Parameters, Relaxation};
    use crate::spot::samples;
    use crate::spot::simulation::SpotSimulation;

    /// Small spots, so that a small box has several strips.
    fn flowing(change: impl Fn(&mut Parameters)) -> SpotSimulation {
        let mut simulation = samples::simulation(|it| {
            it.spot_radius = 1.4;
            it.relaxation_radius = 1.2;
            it.insertion_rate = 150.0;
            change(it);
        });
        simulation.advance_to(6.5).expect("no guard breaks");
        simulation.scratch.wear.stale = true;
        simulation.sort_if_stale().expect("sorted");
        simulation
    }

    #[test]
    fn threads_give_the_bits_of_one_move_after_the_other() {
        let kinds = [
            Relaxation::EveryMove,
            Relaxation::AtRandom { ratio: 3 },
            Relaxation::Off,
        ];
        for (relaxation, threads) in kinds.into_iter().zip([3, 2, 5]) {
            let simulation = flowing(|it| it.relaxation = relaxation);
            let spots = &simulation.spots;
            let moves: Vec<Move> = (0..spots.len() as u32)
                .map(|k| Move {
                    // In no order of their heights.
                    spot: (k * 7919) % spots.len() as u32,
                    random: [0.1 + 0.2 * f64::from(k % 4), f64::from(k % 2)],
                })
                .collect();
            let batch = MoveBatch {
                model: &simulation.model,
                arrangement: &simulation.arrangement,
                spots,
                moves: &moves,
            };
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let mut crew = Crew::new(pool.build().expect("threads"));
            let [mut by_crew, mut in_order] = [0, 1].map(|_| simulation.position.clone());
            let [mut crew_scratch, mut scratch] = [0, 1].map(|_| simulation.scratch.clone());
            let made = crew.make_moves(&batch, &mut by_crew, &mut crew_scratch);
            let expected = batch.make_in_order(&mut in_order, &mut scratch);
            assert!(crew.plan.strips.len() >= threads.min(3), "{relaxation:?}");
            assert_eq!(made.moves, expected.moves);
            assert!(by_crew == in_order, "{relaxation:?}");
            assert!(by_crew != simulation.position);
            assert_eq!(crew_scratch.wear, scratch.wear);
            assert_eq!(crew_scratch.left.len(), scratch.left.len());
        }
    }
}
