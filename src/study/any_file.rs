//! A file that may be a scene, a sweep or a study.

use super::StudyName;
use super::accuracy::{self, AccuracyStudy};
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
    /// A study.
    Study(AnyStudy),
}

/// A study of any kind.
#[derive(Clone, Debug)]
pub enum AnyStudy {
    /// Of stability.
    Stability(Box<Study>),
    /// Of accuracy.
    Accuracy(Box<AccuracyStudy>),
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
            FileKind::Study => Self::Study(AnyStudy::of_document(&document)?),
        })
    }
}

impl AnyStudy {
    fn of_document(document: &Document) -> Result<Self, LoadError> {
        Ok(match StudyName::of(document) {
            Some(StudyName::Accuracy) => Self::Accuracy(Box::new(accuracy::of_document(document)?)),
            _ => Self::Stability(Box::new(stability::of_document(document)?)),
        })
    }
}
