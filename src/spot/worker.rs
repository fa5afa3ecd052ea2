//! One thread's part of a batch: the moves of its strip.
//!
//! It has its own copy of the positions that its moves read. While a move has to wait for one in
//! another strip, later independent moves are made.

use super::batch::{MadeMove, MoveBatch};
use super::board::{Board, Inbox};
use super::guard::Fault;
use super::model::Scratch;
use super::region::NOWHERE;
use super::slack::Wear;
use super::strips::{ABOVE, BELOW, Planner, Strip, StripPlan, Turn};
use crate::particles::block::ROWS;
use crate::particles::vector::Vector;
use std::collections::VecDeque;
use std::iter::Peekable;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// How often a thread checks whether another one has made a move before it yields its processor:
/// about 20 microseconds.
const LOOKS: usize = 1024;

/// Largest number of waiting moves.
const MOST_WAITING: usize = 32;

/// A move that waits, and its centre, if known (m).
type Waiting = (Turn, Vector);

/// The state of one thread.
#[derive(Debug, Default)]
#[repr(align(128))]
pub(super) struct Worker {
    pub(super) position: Vec<Vector>,
    /// What another thread has moved.
    inbox: Inbox,
    pub(super) scratch: Scratch,
    pub(super) done: Vec<MadeMove>,
    /// The guard that a move broke.
    pub(super) fault: Option<Fault>,
    /// Moves that wait for other threads, and moves that must follow them, in order.
    waiting: VecDeque<Waiting>,
    pub(super) wear: Wear,
    /// Its busy time (s).
    pub(super) busy: f64,
}

/// What the threads share.
#[derive(Clone, Copy)]
pub(super) struct StripTask<'a> {
    pub(super) batch: &'a MoveBatch<'a>,
    pub(super) planner: &'a Planner,
    pub(super) plan: &'a StripPlan,
    pub(super) boards: &'a [Board],
    /// Only moves with smaller numbers are made.
    pub(super) end: &'a AtomicUsize,
    /// With nothing noted yet.
    pub(super) wear: Wear,
    /// The strip of this thread.
    pub(super) own: usize,
}

impl Worker {
    /// Makes the moves of a strip. `position` are the centres before the batch (m).
    pub(super) fn make_moves(&mut self, task: &StripTask<'_>, position: &[Vector]) {
        let start = Instant::now();
        let strip = &task.plan.strips[task.own];
        self.begin(strip, (position, task.wear));
        let mut turns = strip.turns.iter().peekable();
        let mut shared = 0;
        while let Some(turn) = self.next_turn(task, &mut turns) {
            self.make(task, &turn);
            if turn.shared.contains(&true) {
                shared += 1;
                self.share(task, &turn, shared);
            }
        }
        self.busy += start.elapsed().as_secs_f64();
    }

    fn begin(&mut self, strip: &Strip, (position, wear): (&[Vector], Wear)) {
        self.position.resize(position.len(), NOWHERE);
        let seen = strip.seen.clone();
        self.position[seen.clone()].copy_from_slice(&position[seen]);
        // Padding for vector instructions.
        let filled = position.len() - ROWS;
        self.position[filled..].fill(NOWHERE);
        self.scratch.wear = wear;
        self.scratch.left.clear();
        self.waiting.clear();
        self.done.clear();
        self.fault = None;
        self.wear = wear;
        self.busy = 0.0;
    }

    /// The move that can be made next; `None` at the end. Waits if there is nothing else to do.
    fn next_turn<'a>(
        &mut self,
        task: &StripTask<'_>,
        turns: &mut Peekable<impl Iterator<Item = &'a Turn>>,
    ) -> Option<Turn> {
        loop {
            if self.waiting.front().is_some_and(|it| task.is_ready(&it.0)) {
                return self.waiting.pop_front().map(|it| it.0);
            }
            let full = self.waiting.len() == MOST_WAITING;
            let Some(turn) = turns.next_if(|it| !full && !task.is_after_end(it)) else {
                let (first, _) = self.waiting.pop_front()?;
                let since = Instant::now();
                let ready = task.wait_until_ready(&first);
                self.busy -= since.elapsed().as_secs_f64();
                return ready.then_some(first);
            };
            if self.may_be_made(task, turn) {
                return Some(*turn);
            }
            self.waiting.push_back((*turn, task.centre(turn)));
        }
    }

    /// Whether a move depends neither on other threads nor on moves that wait.
    fn may_be_made(&self, task: &StripTask<'_>, turn: &Turn) -> bool {
        if self.waiting.is_empty() {
            return task.is_ready(turn);
        }
        if turn.shared.contains(&true) {
            return false;
        }
        let centre = task.centre(turn);
        let mut waiting = self.waiting.iter();
        !waiting.any(|(_, other)| task.planner.conflict(*other, centre))
    }

    /// Makes a move. If it ends the batch, later moves are no longer made.
    fn make(&mut self, task: &StripTask<'_>, turn: &Turn) {
        for (side, neighbour) in sides(task.own).filter(|(side, _)| turn.after[*side] > 0) {
            // Seen from the neighbour, this strip is on the other side.
            let board = &task.boards[neighbour];
            board.take_over(1 - side, &mut self.inbox, &mut self.position);
        }
        let number = turn.number as usize;
        let done = task
            .batch
            .make(number, &mut self.position, &mut self.scratch);
        let broken = done.is_err();
        match done {
            Ok(done) => self.done.push(done),
            Err(fault) => self.fault = Some(fault),
        }
        let wear = self.scratch.wear;
        self.scratch.wear = wear.unused();
        self.wear.note_all(wear);
        if broken || wear.stale {
            task.end.fetch_min(number + 1, Ordering::Relaxed);
        }
    }

    /// Reports a move to the neighbours. `shared` is the number of moves shared so far.
    fn share(&self, task: &StripTask<'_>, turn: &Turn, shared: u32) {
        let board = &task.boards[task.own];
        for (side, neighbour) in sides(task.own).filter(|(side, _)| turn.shared[*side]) {
            let slots = self.scratch.moved.iter().chain(&self.scratch.relaxed);
            let watched = &task.plan.strips[neighbour].watched;
            board.note(side, watched, slots, &self.position);
        }
        board.show(shared);
    }

    /// Takes over the last reports of the neighbours.
    pub(super) fn take_over_rest(&mut self, boards: &[Board], own: usize) {
        for (side, neighbour) in sides(own) {
            if let Some(board) = boards.get(neighbour) {
                board.take_over(1 - side, &mut self.inbox, &mut self.position);
            }
        }
    }
}

impl StripTask<'_> {
    /// Whether the moves of other strips on which a move depends have been made.
    fn is_ready(&self, turn: &Turn) -> bool {
        let after = sides(self.own).filter(|(side, _)| turn.after[*side] > 0);
        let mut after = after.map(|(side, neighbour)| (turn.after[side], &self.boards[neighbour]));
        after.all(|(shared, board)| board.has_shown(shared))
    }

    /// Waits until a move can be made. False if the end comes first.
    fn wait_until_ready(&self, turn: &Turn) -> bool {
        let mut looks = 0;
        while !self.is_ready(turn) {
            if self.is_after_end(turn) {
                return false;
            }
            looks += 1;
            if looks < LOOKS {
                std::hint::spin_loop();
            } else {
                std::thread::yield_now();
            }
        }
        true
    }

    /// The centre of a move, if known (m).
    fn centre(&self, turn: &Turn) -> Vector {
        self.batch.expected_centre(turn.number as usize)
    }

    fn is_after_end(&self, turn: &Turn) -> bool {
        turn.number as usize >= self.end.load(Ordering::Relaxed)
    }
}

/// The sides of a strip, and the numbers of its neighbours.
fn sides(own: usize) -> impl Iterator<Item = (usize, usize)> {
    [(BELOW, own.wrapping_sub(1)), (ABOVE, own + 1)].into_iter()
}
