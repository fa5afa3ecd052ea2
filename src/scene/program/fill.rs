//! A program with the values of one run in the place of its marks.

use super::marks::{Marks, TextPiece};
use super::{ExternalProgram, TemplateText};
use crate::scene::Scene;
use serde_json::Value;
use std::path::{Component, Path};

/// The name of the seed of a run in marks.
const SEED: &str = "seed";

/// The name of a seed below [`MOST_SEED`], made of the identity of a run.
const SMALL_SEED: &str = "seed32";

/// The largest seed that LAMMPS's generator of Marsaglia takes; it fits into 32 bits with a sign.
const MOST_SEED: u64 = 900_000_000;

/// What is run for one run, with values in the place of marks.
#[derive(Clone, Debug, PartialEq)]
pub struct FilledProgram {
    /// What is run, one after the other.
    pub commands: Vec<Vec<String>>,
    /// The file to go on from, and what is run then.
    pub resume: Option<(String, Vec<Vec<String>>)>,
    /// The files that are written first.
    pub files: Vec<TemplateText>,
    /// The files of the tables, in order.
    pub tables: Vec<String>,
    /// The file of the states, and the radius of the spheres (m).
    pub states: Option<(String, f64)>,
}

impl Scene {
    /// The program of this scene with the values of its run; `None` for a scene of spheres.
    pub fn filled_program(&self) -> Option<FilledProgram> {
        let program = self.program.as_ref()?;
        let seed = self.small_seed();
        let fill = |text: &String| self.fill(text, seed);
        let all = |commands: &[Vec<String>]| {
            let words = |words: &Vec<String>| words.iter().map(fill).collect();
            commands.iter().map(words).collect()
        };
        let resume = program.resume.as_ref();
        let file = |file: &TemplateText| TemplateText {
            name: fill(&file.name),
            text: fill(&file.text),
        };
        Some(FilledProgram {
            commands: all(&program.commands),
            resume: resume.map(|it| (fill(&it.file), all(&it.commands))),
            files: program.texts().map(file).collect(),
            tables: program.read.iter().map(|it| fill(&it.file)).collect(),
            states: program.states.as_ref().map(|states| {
                // A scene without problems has a number there.
                let radius = fill(&states.radius).trim().parse().unwrap_or(f64::NAN);
                (fill(&states.file), radius)
            }),
        })
    }

    /// A seed from 1 to [`MOST_SEED`], from the identity of the run.
    fn small_seed(&self) -> u64 {
        let text = format!("{} {SMALL_SEED}", self.identity());
        let hash = blake3::hash(text.as_bytes());
        let mut bytes = [0; 8];
        bytes.copy_from_slice(&hash.as_bytes()[..8]);
        u64::from_le_bytes(bytes) % MOST_SEED + 1
    }

    /// A text with values in the place of its marks.
    pub(in crate::scene) fn filled_text(&self, text: &str) -> String {
        self.fill(text, self.small_seed())
    }

    fn fill(&self, text: &str, small_seed: u64) -> String {
        let mut filled = String::with_capacity(text.len());
        for piece in Marks::of(text) {
            match piece {
                TextPiece::Plain(plain) => filled += plain,
                TextPiece::Mark(SEED, _) => filled += &self.seed.to_string(),
                TextPiece::Mark(SMALL_SEED, _) => filled += &small_seed.to_string(),
                TextPiece::Mark(name, _) => filled += &self.parameter(name).unwrap_or_default(),
                // A scene without problems has none.
                TextPiece::Open(place) => filled += &text[place],
            }
        }
        filled
    }

    /// A parameter as it is written in texts: numbers so that they are read as the same numbers.
    fn parameter(&self, name: &str) -> Option<String> {
        Some(match self.parameters.get(name)? {
            Value::String(text) => text.clone(),
            other => other.to_string(),
        })
    }
}

impl ExternalProgram {
    /// Whether a mark of that name stands in a command or in a file.
    pub(crate) fn is_given(&self, name: &str) -> bool {
        let resumed = self.resume.iter().flat_map(|it| &it.commands);
        let words = self.commands.iter().chain(resumed).flatten();
        let texts = self.texts().flat_map(|file| [&file.name, &file.text]);
        let is_mark = |piece| matches!(piece, TextPiece::Mark(own, _) if own == name);
        words.chain(texts).any(|text| Marks::of(text).any(is_mark))
    }

    /// Whether a name is the path of a file in the folder of a run.
    pub(crate) fn is_inside(name: &str) -> bool {
        let mut parts = Path::new(name).components();
        let is_plain = parts.all(|it| matches!(it, Component::Normal(_)));
        let ends_well = !name.is_empty() && !name.ends_with('/');
        is_plain && ends_well && !name.contains(['\\', '\0'])
    }

    /// Whether a name is of a file that this program writes there for itself.
    pub(crate) fn is_reserved(name: &str) -> bool {
        name.starts_with("phase-")
    }

    /// The names that marks may have, besides parameters.
    pub(in crate::scene) const NAMES: [&str; 2] = [SEED, SMALL_SEED];
}
