//! A scene with a simpler stand-in for one of its parts.

use super::{Change, Scene, Start};
use crate::document::Problem;
use crate::forces::simplification::Simplification;
use serde::Deserialize;

impl Scene {
    /// This scene with a simplification. It may have problems of its own.
    ///
    /// # Errors
    /// If what comes out is no scene.
    pub fn simplified(&self, simplification: &Simplification) -> Result<Self, Problem> {
        let fail = |error: &dyn std::fmt::Display| {
            Problem::new("", format!("{}: not a scene: {error}", simplification.name))
        };
        let mut tree = self.for_keys(&[]).tree();
        let change = Change::of_simplification(simplification);
        change.apply(&mut tree).map_err(|path| fail(&path))?;
        let mut scene = Self::deserialize(&tree).map_err(|error| fail(&error))?;
        if let Start::List { .. } = self.start {
            scene.start = self.start.clone();
        }
        Ok(scene)
    }
}
