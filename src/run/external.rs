//! What is known of a scene of another program before it runs.

use crate::document::shown;
use crate::scene::Scene;
use crate::simulation::{BuildError, Model, PartOfStep, Simulation};

/// Another program. It is started only by who may: see [`external::begin`](crate::external::begin).
pub(super) struct ExternalModel;

/// A program cannot be started here.
#[derive(Debug, thiserror::Error)]
#[error(
    "the scene starts another program (`{0}`), which only `phase sweep`, `phase study` and \
     `phase run` do"
)]
struct NotStarted(String);

impl Model for ExternalModel {
    fn work_unit(&self) -> &'static str {
        "runs"
    }

    fn work_of(&self, _scene: &Scene) -> u64 {
        1
    }

    fn parts_of(&self, _scene: &Scene) -> Vec<PartOfStep> {
        Vec::new()
    }

    fn build(&self, scene: &Scene) -> Result<Box<dyn Simulation>, BuildError> {
        let programs = scene.program.iter().flat_map(|it| it.programs());
        let programs: Vec<String> = programs.map(shown).collect();
        Err(BuildError::new(NotStarted(programs.join("`, `"))))
    }
}
