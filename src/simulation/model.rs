//! The interface between the program and its models.

use super::{Column, Counts, Frame, Instability, Milestone, PartOfStep, Profile, Snapshot};
use crate::forces::simplification::Simplification;
use crate::scene::Scene;
use rayon::ThreadPoolBuildError;
use std::error::Error;
use std::io;

/// A kind of simulation: properties of a scene before it runs, and how to run it.
pub trait Model: Sync {
    /// The unit in which the model counts its work, such as `sphere-steps`.
    fn work_unit(&self) -> &'static str;

    /// Upper bound of the work of a whole run.
    fn work_of(&self, scene: &Scene) -> u64;

    /// The parts of a step that cost time, whether the scene has them or not.
    fn parts_of(&self, scene: &Scene) -> Vec<PartOfStep>;

    /// Simpler stand-ins for the effects and laws of a scene, as changes of its keys.
    fn simplifications(&self, _scene: &Scene) -> Vec<Simplification> {
        Vec::new()
    }

    /// A simulation of the scene at its start.
    ///
    /// # Errors
    /// If the scene cannot be built.
    fn build(&self, scene: &Scene) -> Result<Box<dyn Simulation>, BuildError>;
}

/// A running model, advanced frame by frame. Runs, checkpoints, sweeps and costs use only this
/// interface.
pub trait Simulation {
    /// Advances to the next frame.
    ///
    /// # Errors
    /// The guard that was broken. The simulation must not be advanced any further.
    fn advance_frame(&mut self) -> Result<(), Instability>;

    /// Time (s).
    fn time(&self) -> f64;

    /// Whether nothing more will happen, however long the run continues.
    fn ended(&self) -> bool {
        false
    }

    /// Whether there is a frame to look at. A program that runs elsewhere has none before it ends.
    fn has_frame(&self) -> bool {
        true
    }

    /// Number of frames of the whole run, the start not counted, if the scene does not say it.
    fn frames(&self) -> Option<u64> {
        None
    }

    /// Why the run has failed without a broken guard, if it has. It then has ended.
    fn failure(&self) -> Option<&str> {
        None
    }

    /// Whether its state can be saved between two frames.
    fn can_be_saved(&self) -> bool {
        true
    }

    /// States of the spheres that the model keeps itself, in place of those that the recorder
    /// keeps.
    fn take_snapshots(&mut self) -> Option<Vec<Snapshot>> {
        None
    }

    /// Work done so far, in the [unit](Model::work_unit) of the model.
    fn work(&self) -> u64;

    /// Radius of every sphere of the scene that moves (m), by its number.
    fn radius(&self) -> &[f64];

    /// Mass of every sphere of the scene that moves (kg), by its number.
    fn mass(&self) -> &[f64];

    /// Shows the present frame. Looking never changes the motion.
    fn look(&mut self, look: &mut dyn FnMut(&dyn Frame));

    /// Scalars that the model declares, besides observables of the spheres.
    fn columns(&self) -> &[Column] {
        &[]
    }

    /// Their present values, in the same order.
    fn values(&mut self) -> Vec<f64> {
        Vec::new()
    }

    /// Writes the state between two frames: with the scene, everything needed to continue. Saving
    /// never changes the motion.
    ///
    /// # Errors
    /// If `to` cannot be written.
    fn save(&self, to: &mut dyn io::Write) -> io::Result<()>;

    /// Continues from a state that the same program saved for the same scene. The simulation must
    /// be at its start, and continues with the bits of the saved one.
    ///
    /// # Errors
    /// If the state cannot belong to this scene. The simulation is then unchanged.
    fn restore(&mut self, state: &[u8]) -> Result<(), StateError>;

    /// How many spheres came and went, in a scene where they do.
    fn counts(&self) -> Option<Counts> {
        None
    }

    /// Events so far that happen once in a run.
    fn milestones(&self) -> &[Milestone] {
        &[]
    }

    /// Advances on this number of threads from now on, if that pays. No bit depends on it.
    ///
    /// # Errors
    /// If the system cannot start threads.
    fn use_threads(&mut self, _threads: usize) -> Result<(), ThreadPoolBuildError> {
        Ok(())
    }

    /// Processor time of all threads besides the caller's (s).
    fn seconds_of_threads(&self) -> f64 {
        0.0
    }

    /// Releases memory that is not needed for looking at the spheres. The simulation must not be
    /// advanced any further.
    fn release_memory(&mut self) {}

    /// Begins to measure the times of the parts of a step. Never changes the motion.
    fn keep_profile(&mut self) {}

    /// The profile since [`keep_profile`](Self::keep_profile); `None` from a model that does not
    /// measure.
    fn profile(&self) -> Option<&Profile> {
        None
    }
}

/// Why a scene cannot be built.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub struct BuildError(Box<dyn Error + Send + Sync>);

impl BuildError {
    /// The error of a model.
    pub fn new(error: impl Error + Send + Sync + 'static) -> Self {
        Self(Box::new(error))
    }
}

/// A state does not belong to the scene, or another program saved it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the state does not fit the scene: {0}")]
pub struct StateError(pub &'static str);

impl StateError {
    /// The content cannot be read as a state.
    pub const OTHER_FORM: Self = Self("its content has another form");
}
