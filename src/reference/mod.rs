//! What files may say, for editors and for readers.
//!
//! Two sources are put together, and neither is repeated here: the tables of keys by which files
//! are checked ([`crate::scene`], [`crate::sweep`], [`crate::stability`]), and the documentation of the structs that files
//! end in. Units and symbols come from [`crate::notation`]. `docs/` holds what these functions
//! return; a test compares.

mod docs;
mod json_schema;
mod keys;
mod notation;

pub use keys::keys;
pub use notation::notation;

use crate::document::schema::Kind;
use crate::scene::Scene;
use crate::scene::schema::SCENE;
use crate::stability::StudyFile;
use crate::stability::schema::STUDY;
use crate::sweep::SweepFile;
use crate::sweep::schema::SWEEP;
use docs::Docs;
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

    fn keys(self) -> Kind {
        match self {
            Self::Scene => SCENE,
            Self::Sweep => SWEEP,
            Self::Stability => STUDY,
        }
    }

    fn docs(self) -> Docs {
        match self {
            Self::Scene => Docs::of::<Scene>(),
            Self::Sweep => Docs::of::<SweepFile>(),
            Self::Stability => Docs::of::<StudyFile>(),
        }
    }
}

/// The JSON schema (draft 7, which editors know best) of a kind of file.
///
/// It refuses what the loader refuses for a single key: unknown and missing keys, wrong types,
/// numbers out of range. What concerns several keys at once only the loader finds.
pub fn schema(file: File) -> Value {
    let docs = file.docs();
    let mut schema = json_schema::of(&file.keys(), docs.root());
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!(format!("phase {} file", file.name()));
    schema
}
