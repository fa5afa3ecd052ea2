//! One move of a spot.

use super::arrangement::Arrangement;
use super::guard::Fault;
use super::model::{Scratch, SpotRules};
use super::parameters::Relaxation;
use super::profile::DrainagePart;
use super::walk::MovingSpot;
use crate::particles::vector::Vector;

impl SpotRules {
    /// Moves a spot and the spheres in its range, and relaxes these if it is time to. Random
    /// numbers 0 <= u < 1 choose the way and decide about the relaxation. Returns whether there was
    /// a relaxation; `None` if the spot is to be removed instead.
    pub(crate) fn make_move(
        &self,
        (arrangement, position): (&Arrangement, &mut [Vector]),
        scratch: &mut Scratch,
        spot: &mut MovingSpot,
        [way, chance]: [f64; 2],
    ) -> Result<Option<bool>, Fault> {
        scratch.clock.begin_move();
        scratch.moved.clear();
        scratch.relaxed.clear();
        let from = spot.position;
        if from.z >= arrangement.top + self.parameters.removal_height {
            return Ok(None);
        }
        let Some(step) = self.step(arrangement, position, scratch, (from, way)) else {
            scratch.moved.clear();
            return Ok(None);
        };
        let centre = from + step * 0.5;
        self.spot(arrangement, position, scratch, (centre, step));
        if scratch.moved.is_empty() {
            self.check_empty(arrangement, centre)?;
        }
        spot.position = from + step;
        spot.moves = spot.moves.saturating_add(1);
        let relaxes = match self.parameters.relaxation {
            Relaxation::EveryMove => true,
            Relaxation::Off | Relaxation::Global { .. } => false,
            Relaxation::AtRandom { ratio } => chance * (ratio as f64) < 1.0,
            Relaxation::Counted { ratio } => u64::from(spot.moves).is_multiple_of(ratio),
        };
        scratch.clock.mark(DrainagePart::Spots);
        if relaxes {
            self.relax(arrangement, position, scratch, centre)?;
            scratch.clock.mark(DrainagePart::Relaxation);
        }
        Ok(Some(relaxes))
    }
}
