//! What files may say, for editors and for readers: all of it follows from the schemas of the
//! structs that files end in. `docs/` holds what these functions return; a test compares.

mod keys;
mod notation;

pub use keys::keys;
pub use notation::notation;

use crate::document::Schema;
use crate::scene::SCENE;
use crate::study::stability::STUDY;
use crate::sweep::SWEEP;
use serde_json::{Value, json};

/// A kind of file that the program reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum File {
    /// One simulation.
    Scene,
    /// A scene, and what is varied in it.
    Sweep,
    /// A scene, and the two keys over which integrators are tried.
    Stability,
}

impl File {
    /// All kinds of files.
    pub const ALL: [Self; 3] = [Self::Scene, Self::Sweep, Self::Stability];

    /// Name, as on the command line and in file names.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Sweep => "sweep",
            Self::Stability => "stability",
        }
    }

    fn schema(self) -> &'static Schema {
        match self {
            Self::Scene => &SCENE,
            Self::Sweep => &SWEEP,
            Self::Stability => &STUDY,
        }
    }
}

/// The JSON schema (draft 7, which editors know best) of a kind of file.
///
/// It refuses what the loader refuses for a single key: unknown and missing keys, wrong types,
/// numbers out of range. What concerns several keys at once only the loader finds.
pub fn schema(file: File) -> Value {
    let mut schema = file.schema().json.clone();
    schema["title"] = json!(format!("phase {} file", file.name()));
    schema
}
