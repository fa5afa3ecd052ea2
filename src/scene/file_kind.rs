//! What a file describes, determined from its keys.

use crate::document::{Document, LoadError, Problem};
use serde_json::Value;

/// What a file describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// One scene.
    Scene,
    /// A scene and the axes over which it varies.
    Sweep,
    /// A study of the numerics.
    Study,
}

/// Keys that make a file a sweep.
const SWEEP_KEYS: [&str; 5] = ["axis", "scene", "sieves", "plot", "seeds"];

/// The key of every scene of spheres.
const SCENE_KEY: &str = "spheres";

/// The key of a scene that another program runs.
const PROGRAM_KEY: &str = "program";

/// The key that makes a file a study.
const STUDY_KEY: &str = "study";

/// The study of a sweep: its file is one of a sweep.
const ABLATION: &str = "ablation";

impl FileKind {
    /// The kind of a document, and the key that determines it (for a scene, `spheres` or
    /// `program`).
    pub(crate) fn of(document: &Document) -> (Self, &'static str) {
        let tree: &Value = document.tree();
        let has = |key: &str| tree.get(key).is_some();
        match SWEEP_KEYS.into_iter().find(|key| has(key)) {
            _ if has(STUDY_KEY) && tree[STUDY_KEY] != ABLATION => (Self::Study, STUDY_KEY),
            Some(key) => (Self::Sweep, key),
            None if has(PROGRAM_KEY) => (Self::Scene, PROGRAM_KEY),
            None => (Self::Scene, SCENE_KEY),
        }
    }

    /// Refuses a document that is clearly of another kind. A document without such a key is left to
    /// the check of keys.
    ///
    /// # Errors
    /// The kind of the document, with the command for it.
    pub(crate) fn expect(self, document: &Document) -> Result<(), LoadError> {
        let (kind, key) = Self::of(document);
        if kind == self || document.tree().get(key).is_none() {
            return Ok(());
        }
        let file = document.path().display();
        let help = match (kind, self) {
            (Self::Scene, Self::Sweep) => {
                format!("`phase run {file}` runs it, and a sweep names it with `scene = \"...\"`")
            }
            (Self::Scene, _) => format!("`phase run {file}` runs it"),
            (Self::Sweep, Self::Study) => {
                format!("`phase sweep {file}` runs it; a study says `study = \"stability\"`")
            }
            (Self::Sweep, _) => format!("`phase sweep {file}` runs it"),
            (Self::Study, _) => format!("`phase study {file}` runs it"),
        };
        let message = format!("this is a {}, not a {}", kind.name(), self.name());
        Err(document.refuse(&[Problem::new(key, message).help(help).at_key()]))
    }

    /// Name, as in messages and in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Sweep => "sweep",
            Self::Study => "study",
        }
    }
}
