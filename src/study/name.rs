//! Which study a file describes.

use crate::document::{Document, LoadError, Problem, suggest};
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
    const ALL: [Self; 3] = [Self::Stability, Self::Accuracy, Self::Ablation];

    /// Name, as in a file and in the path of its results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stability => "stability",
            Self::Accuracy => "accuracy",
            Self::Ablation => "ablation",
        }
    }

    /// Which study a document says that it is.
    ///
    /// # Errors
    /// If there is no such study.
    pub(super) fn of(document: &Document) -> Result<Self, LoadError> {
        let word = &document.tree()["study"];
        Self::deserialize(word).map_err(|_| {
            let names = Self::ALL.map(Self::name);
            let near = word.as_str().and_then(|word| suggest(word, names));
            let help = match near {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => format!("choose one of \"{}\"", names.join("\", \"")),
            };
            let problem = Problem::new("study", format!("there is no study {word}"));
            document.refuse(&[problem.help(help)])
        })
    }

    /// Whether a document says that it is a sweep that is ablated.
    pub(super) fn is_ablation(document: &Document) -> bool {
        Self::of(document).is_ok_and(|it| it == Self::Ablation)
    }

    /// Refuses a document of another study.
    ///
    /// # Errors
    /// What it is, with the command for it.
    pub(super) fn expect(self, document: &Document) -> Result<(), LoadError> {
        if document.tree().get("study").is_none() {
            return Ok(());
        }
        let other = Self::of(document)?;
        if other == self {
            return Ok(());
        }
        let (own, other) = (self.name(), other.name());
        let message = format!("this is a study of {other}, not of {own}");
        let help = format!("`phase study {}` runs it", document.path().display());
        Err(document.refuse(&[Problem::new("study", message).help(help)]))
    }
}
