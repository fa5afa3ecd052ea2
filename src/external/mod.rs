//! Other programs behind the door to a model: they are started, watched, and what they leave is
//! read as the frames of a run.
//!
//! A run has a folder of its own, in which all files that this program writes for it lie. What the
//! other program does, and which bits it gives, is its own affair. Nothing here starts a program
//! but [`begin`] and [`find_version`]; who calls them has asked whether it may.

mod frames;
mod process;
mod run_folder;
mod simulation;
mod states;
pub mod table;
mod version;

pub use process::kill_all;
pub use run_folder::RunFolder;
pub use version::{VersionError, find_version};

use crate::run::Run;
use crate::scene::Scene;
use crate::simulation::BuildError;
use simulation::ExternalSimulation;
use std::io;

/// The folder of a run cannot be made.
#[derive(Debug, thiserror::Error)]
#[error("{}: {source}{}", path.display(), crate::document::advice(source))]
struct NoRunFolder {
    path: std::path::PathBuf,
    source: io::Error,
}

/// The run of a scene by its program, in that folder. The program starts when the run advances,
/// and is ended when the run is dropped before. If it `may_go_on` and the scene says how, it goes
/// on from what the same run left there when it was stopped; else what is there is removed.
///
/// # Errors
/// If the scene has no program, or the folder cannot be made or is of something else.
pub fn begin(scene: &Scene, run_folder: RunFolder, may_go_on: bool) -> Result<Run, BuildError> {
    let path = run_folder.path().to_owned();
    let simulation = ExternalSimulation::new(scene, run_folder, may_go_on);
    let simulation = simulation.map_err(|source| BuildError::new(NoRunFolder { path, source }))?;
    Ok(Run::with_simulation(scene, Box::new(simulation)))
}
