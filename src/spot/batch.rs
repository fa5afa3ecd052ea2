//! Moves of spots that are made one after the other, or as if they were.

use super::arrangement::Arrangement;
use super::guard::Fault;
use super::model::{Scratch, SpotRules};
use super::walk::MovingSpot;
use crate::particles::vector::Vector;

/// A move of a spot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Move {
    /// Index of the spot.
    pub(super) spot: u32,
    /// Random numbers 0 <= u < 1 for the way and the relaxation.
    pub(super) random: [f64; 2],
}

/// What a move has done.
#[derive(Clone, Copy, Debug)]
pub(super) struct MadeMove {
    /// Index of the spot.
    pub(super) spot: u32,
    /// The spot after its move, and whether spheres around it were relaxed; `None` if it is to be
    /// removed.
    pub(super) result: Option<(MovingSpot, bool)>,
}

/// Moves of different spots in their order, and what they depend on.
#[derive(Clone, Copy)]
pub(super) struct MoveBatch<'a> {
    pub(super) model: &'a SpotRules,
    pub(super) arrangement: &'a Arrangement,
    pub(super) spots: &'a [MovingSpot],
    pub(super) moves: &'a [Move],
}

/// The part of a batch that was made: all of it, or all up to the first move after which the
/// spheres must be sorted or which broke a guard.
#[derive(Debug)]
pub(super) struct Made {
    /// Number of moves that were made or begun.
    pub(super) moves: usize,
    /// What they have done, in any order.
    pub(super) done: Vec<MadeMove>,
    /// The guard that the last one broke.
    pub(super) fault: Option<Fault>,
}

impl MoveBatch<'_> {
    /// Makes one move.
    pub(super) fn make(
        &self,
        number: usize,
        position: &mut [Vector],
        scratch: &mut Scratch,
    ) -> Result<MadeMove, Fault> {
        let Move { spot, random } = self.moves[number];
        let mut moved = self.spots[spot as usize];
        let spheres = (self.arrangement, position);
        let relaxed = self.model.make_move(spheres, scratch, &mut moved, random)?;
        Ok(MadeMove {
            spot,
            result: relaxed.map(|relaxed| (moved, relaxed)),
        })
    }

    /// Makes the moves on this thread.
    pub(super) fn make_in_order(&self, position: &mut [Vector], scratch: &mut Scratch) -> Made {
        let mut done = Vec::with_capacity(self.moves.len());
        for number in 0..self.moves.len() {
            let made = self.make(number, position, scratch);
            let fault = match made {
                Ok(made) => {
                    done.push(made);
                    None
                }
                Err(fault) => Some(fault),
            };
            if fault.is_some() || scratch.wear.stale {
                return Made {
                    moves: number + 1,
                    done,
                    fault,
                };
            }
        }
        Made {
            moves: self.moves.len(),
            done,
            fault: None,
        }
    }

    /// The middle of the way of a move, if known.
    #[inline(always)]
    pub(super) fn expected_centre(&self, number: usize) -> Vector {
        let it = &self.moves[number];
        let spot = &self.spots[it.spot as usize];
        self.model.expected_centre(spot.position, it.random[0])
    }
}
