//! A file that may be a scene, a sweep or a study.

use super::StudyName;
use super::ablation::{Ablation, AblationError, AblationOptions};
use super::accuracy::{self, AccuracyStudy};
use super::stability::{self, StabilityStudy};
use crate::document::{Document, LoadError, Problem};
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
    Stability(Box<StabilityStudy>),
    /// Of accuracy.
    Accuracy(Box<AccuracyStudy>),
    /// Of the effects that a scene or sweep needs.
    Ablation(Box<Ablation>),
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
    /// Reads a study, or with `ablate` the ablation of a scene or sweep.
    ///
    /// # Errors
    /// All that is wrong with the file; or if it is no study.
    pub fn load(
        path: &Path,
        ablate: bool,
        options: AblationOptions,
    ) -> Result<Self, AblationError> {
        let document = Document::read(path)?;
        let (kind, key) = FileKind::of(&document);
        let is_ablation = StudyName::of(&document) == Some(StudyName::Ablation);
        match kind {
            FileKind::Study if ablate => {
                let message = "this is a study of its own, which has no ablation";
                let help = "leave out --ablate, or give a scene or sweep";
                let problem = Problem::new(key, message).help(help).at_key();
                Err(document.refuse(&[problem]).into())
            }
            FileKind::Study => Ok(Self::of_document(&document)?),
            _ if ablate || is_ablation => {
                let ablation = Ablation::of_document(&document, options)?;
                Ok(Self::Ablation(Box::new(ablation)))
            }
            _ => {
                let message = format!("this is a {}, not a study", kind.name());
                let help = "with --ablate it is a study of the effects that it needs";
                let problem = Problem::new(key, message).help(help).at_key();
                Err(document.refuse(&[problem]).into())
            }
        }
    }

    fn of_document(document: &Document) -> Result<Self, LoadError> {
        Ok(match StudyName::of(document) {
            Some(StudyName::Accuracy) => Self::Accuracy(Box::new(accuracy::of_document(document)?)),
            _ => Self::Stability(Box::new(stability::of_document(document)?)),
        })
    }
}
