//! Which study a file describes.

use crate::document::{Document, LoadError, Problem};
use schemars::JsonSchema;
use serde::Deserialize;

/// The studies that files describe.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StudyName {
    /// Where integrators are stable, over two keys of a scene.
    Stability,
    /// What settings of a scene cost, and how wrong they are.
    Accuracy,
    /// Which effects a scene or sweep needs.
    Ablation,
}

impl StudyName {
    /// Name, as in a file and in the path of its results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stability => "stability",
            Self::Accuracy => "accuracy",
            Self::Ablation => "ablation",
        }
    }

    /// Which study a document says that it is; none if it does not say it rightly.
    pub(super) fn of(document: &Document) -> Option<Self> {
        Self::deserialize(&document.tree()["study"]).ok()
    }

    /// Refuses a document of another study.
    ///
    /// # Errors
    /// What it is, with the command for it.
    pub(super) fn expect(self, document: &Document) -> Result<(), LoadError> {
        match Self::of(document) {
            Some(other) if other != self => {
                let (own, other) = (self.name(), other.name());
                let message = format!("this is a study of {other}, not of {own}");
                let file = document.path().display();
                let help = format!("`phase study {file}` runs it");
                Err(document.refuse(&[Problem::new("study", message).help(help)]))
            }
            _ => Ok(()),
        }
    }
}
