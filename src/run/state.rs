//! The state of a run between two frames, as a checkpoint keeps it.
//!
//! The run's own part comes first (frame, processor time, recorded data), then the simulation's
//! part, in a form that only the simulation knows.

use super::Run;
use super::recorder::Recorded;
use crate::cpu_time;
use crate::record::Outcome;
use crate::simulation::StateError;
use std::io;

impl Run {
    /// Whether a guard ended the run. It then cannot continue.
    pub fn is_unstable(&self) -> bool {
        self.outcome != Outcome::Completed
    }

    /// Writes the state at the latest frame: with the scene, everything needed to continue. Saving
    /// changes nothing.
    ///
    /// # Errors
    /// If `to` cannot be written, or a guard ended the run.
    pub fn save(&self, to: &mut dyn io::Write) -> io::Result<()> {
        if self.is_unstable() {
            return Err(io::Error::other("a guard ended the run"));
        }
        let own = (self.frame, self.cpu_seconds(), self.recorder.recorded());
        postcard::to_io(&own, &mut *to).map_err(io::Error::other)?;
        self.simulation.save(to)
    }

    /// Continues from the state of a run with the same scene and output, saved by the same program.
    /// This run must be at its start; it continues with the same bits.
    ///
    /// # Errors
    /// If the state cannot belong to this scene. The run is then unchanged.
    pub fn restore(&mut self, state: &[u8]) -> Result<(), StateError> {
        let own: (u64, f64, Recorded);
        let simulation;
        (own, simulation) = postcard::take_from_bytes(state).map_err(|_| StateError::OTHER_FORM)?;
        self.simulation.restore(simulation)?;
        let recorded;
        (self.frame, self.cpu_seconds_before, recorded) = own;
        self.recorder.restore(self.frame, recorded);
        self.started = cpu_time::of_this_thread();
        Ok(())
    }
}

/// The frame of a saved state, the start not counted.
///
/// # Errors
/// If it is not a state of a run.
pub fn frame_of_state(state: &[u8]) -> Result<u64, StateError> {
    let (frame, _) = postcard::take_from_bytes(state).map_err(|_| StateError::OTHER_FORM)?;
    Ok(frame)
}
