//! The state of a simulation between two steps, from which it continues.

use super::DemSimulation;
use super::process::{Process, ProcessState};
use super::system::EngineState;
use crate::simulation::StateError;
use serde::{Deserialize, Serialize};

/// The state of a simulation: everything that follows neither from its scene nor from the rest of
/// the state. Random streams are left out because only the start uses them, and neighbour lists
/// because no bit depends on them.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SimulationState<'a> {
    engine: EngineState<'a>,
    /// Absent where no sphere comes or goes.
    process: Option<ProcessState>,
}

impl SimulationState<'_> {
    /// The same state, which borrows nothing.
    pub fn into_owned(self) -> SimulationState<'static> {
        SimulationState {
            engine: self.engine.into_owned(),
            process: self.process,
        }
    }
}

impl DemSimulation {
    /// The state between the latest step and the next. Asking for it never changes the motion.
    pub fn state(&self) -> SimulationState<'_> {
        SimulationState {
            engine: self.engine.state(),
            process: self.process.as_ref().map(Process::state),
        }
    }

    /// Continues from a state of the same scene, saved by the same program. The simulation must not
    /// have been advanced. It then has the same bits as the one that was saved.
    ///
    /// # Errors
    /// If the state cannot belong to this scene; the simulation is then unchanged.
    pub fn restore(&mut self, state: SimulationState<'_>) -> Result<(), StateError> {
        match (&self.process, &state.process) {
            (Some(process), Some(state)) => process.accepts(state)?,
            (None, None) => {}
            _ => return Err(StateError("spheres come and go in only one of them")),
        }
        let is_open = (state.process.as_ref()).is_some_and(|process| !process.is_closed());
        self.engine.restore(state.engine, is_open)?;
        if let (Some(process), Some(state)) = (&mut self.process, state.process) {
            process.restore(state);
        }
        Ok(())
    }
}
