//! What a simulation goes on from: its state between two steps.

use super::Simulation;
use super::process::{Process, ProcessState};
use super::system::EngineState;
pub(super) use crate::simulation::StateError;
use serde::{Deserialize, Serialize};

/// What a simulation goes on from: everything that neither its scene says nor can be found again
/// from the rest. Random streams are not in it, as they serve the start alone; nor are lists of
/// neighbours, on which no bit depends.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SimulationState<'a> {
    engine: EngineState<'a>,
    /// Absent where no sphere comes or goes.
    process: Option<ProcessState>,
}

impl SimulationState<'_> {
    /// The same, on its own.
    pub fn into_owned(self) -> SimulationState<'static> {
        SimulationState {
            engine: self.engine.into_owned(),
            process: self.process,
        }
    }
}

impl Simulation {
    /// The state between the latest step and the next. Asking for it never changes the motion.
    pub fn state(&self) -> SimulationState<'_> {
        SimulationState {
            engine: self.engine.state(),
            process: self.process.as_ref().map(Process::state),
        }
    }

    /// Takes up a state of the same scene, by the same program: the simulation, which must not have
    /// been advanced, goes on with the bits of the one that was saved.
    ///
    /// # Errors
    /// If the state cannot be one of this scene; the simulation is then as it was.
    pub fn restore(&mut self, state: SimulationState<'_>) -> Result<(), StateError> {
        match (&self.process, &state.process) {
            (Some(process), Some(state)) => process.accepts(state)?,
            (None, None) => {}
            _ => return Err(StateError("spheres come and go in only one of them")),
        }
        self.engine.restore(state.engine)?;
        if let (Some(process), Some(state)) = (&mut self.process, state.process) {
            process.restore(state);
        }
        Ok(())
    }
}
