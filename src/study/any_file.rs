//! A file that may be a scene, a sweep or a study.

use super::stability::{self, Study};
use crate::document::{Document, LoadError};
use crate::run::{self, Reading};
use crate::scene::{FileKind, Scene};
use crate::sweep::{self, Sweep};
use std::path::Path;

/// What a file describes.
#[derive(Clone, Debug)]
pub enum AnyFile {
    /// A scene, as [`Scene::load_base`] returns it.
    Scene(Box<Scene>),
    /// A sweep.
    Sweep(Box<Sweep>),
    /// A study of stability.
    Study(Box<Study>),
}

impl AnyFile {
    /// Reads a file, which says by its keys what it is.
    ///
    /// # Errors
    /// All that is wrong with the file, each with line, column and the fix.
    pub fn load(path: &Path) -> Result<Self, LoadError> {
        let document = Document::read(path)?;
        Ok(match FileKind::of(&document).0 {
            FileKind::Scene => {
                Self::Scene(Box::new(run::base_of_document(&document, Reading::RUN)?))
            }
            FileKind::Sweep => Self::Sweep(Box::new(sweep::of_document(&document)?)),
            FileKind::Study => Self::Study(Box::new(stability::of_document(&document)?)),
        })
    }
}
