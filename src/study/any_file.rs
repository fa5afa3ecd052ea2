//! A file that may be a scene, a sweep or a study.

use super::StudyName;
use super::ablation::{Ablation, AblationError, AblationOptions};
use super::accuracy::{self, AccuracyStudy, Subject};
use super::comparison::Comparison;
use super::stability::{self, StabilityStudy};
use crate::classify::Rules;
use crate::document::{Document, Problem};
use crate::run::{self, Reading};
use crate::scene::{FileKind, Scene};
use crate::sweep::{self, Sweep};
use std::path::Path;

/// What a file describes.
#[derive(Clone, Debug)]
pub enum AnyFile {
    /// A scene, as [`Scene::load_base`] returns it, with the columns that its rules need.
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
    pub fn load(path: &Path) -> Result<Self, AblationError> {
        let document = Document::read(path)?;
        Ok(match FileKind::of(&document).0 {
            FileKind::Scene => {
                let mut scene = run::base_of_document(&document, Reading::RUN)?;
                Rules::of(&scene).choose_columns(&mut scene);
                Self::Scene(Box::new(scene))
            }
            FileKind::Sweep if !StudyName::is_ablation(&document) => {
                Self::Sweep(Box::new(sweep::of_document(&document)?))
            }
            _ => Self::Study(AnyStudy::of_document(
                &document,
                AblationOptions::default(),
            )?),
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
        let refuse = |key: &str, message: String, help: &str| {
            let problem = Problem::new(key, message).help(help).at_key();
            Err(document.refuse(&[problem]).into())
        };
        match FileKind::of(&document) {
            (FileKind::Study, key) if ablate => {
                let message = "this is a study of its own, which has no ablation";
                let help = "leave out --ablate, or give a scene or sweep";
                refuse(key, message.to_owned(), help)
            }
            (FileKind::Scene | FileKind::Sweep, _) if ablate => {
                Self::of_ablation(&document, options)
            }
            (kind @ (FileKind::Scene | FileKind::Sweep), key)
                if !StudyName::is_ablation(&document) =>
            {
                let message = format!("this is a {}, not a study", kind.name());
                let help = "with --ablate it is a study of the effects that it needs";
                refuse(key, message, help)
            }
            _ => Self::of_document(&document, options),
        }
    }

    /// What it runs; none for a verification case, whose runs leave nothing.
    pub fn comparison(&self) -> Option<&Comparison> {
        match self {
            Self::Stability(study) => Some(&study.comparison),
            Self::Ablation(study) => Some(&study.comparison),
            Self::Accuracy(study) => match &study.subject {
                Subject::Scene(comparison) => Some(comparison),
                Subject::Case(_) => None,
            },
        }
    }

    /// The same, to be changed.
    pub fn comparison_mut(&mut self) -> Option<&mut Comparison> {
        match self {
            Self::Stability(study) => Some(&mut study.comparison),
            Self::Ablation(study) => Some(&mut study.comparison),
            Self::Accuracy(study) => match &mut study.subject {
                Subject::Scene(comparison) => Some(comparison),
                Subject::Case(_) => None,
            },
        }
    }

    /// Which study it is.
    pub fn name(&self) -> StudyName {
        match self {
            Self::Stability(_) => StudyName::Stability,
            Self::Accuracy(_) => StudyName::Accuracy,
            Self::Ablation(_) => StudyName::Ablation,
        }
    }

    fn of_document(document: &Document, options: AblationOptions) -> Result<Self, AblationError> {
        Ok(match StudyName::of(document)? {
            StudyName::Stability => Self::Stability(Box::new(stability::of_document(document)?)),
            StudyName::Accuracy => Self::Accuracy(Box::new(accuracy::of_document(document)?)),
            StudyName::Ablation => Self::of_ablation(document, options)?,
        })
    }

    fn of_ablation(document: &Document, options: AblationOptions) -> Result<Self, AblationError> {
        let ablation = Ablation::of_document(document, options)?;
        Ok(Self::Ablation(Box::new(ablation)))
    }
}
