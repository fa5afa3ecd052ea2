//! A program of the user's in place of a model: what is run, with which files, and what is read
//! from what it leaves behind.

mod columns;
mod fill;
mod marks;

pub use columns::{DescribedColumn, ProgramColumn, ProgramTable, TableFormat};
pub use fill::FilledProgram;
pub(crate) use marks::{Marks, TextPiece};

use super::{Scene, Start, is_default};
use crate::document::unit;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// Numbers and texts that a program is given, by their names.
pub type ProgramParameters = BTreeMap<String, Value>;

/// Another program in place of a model of this one. It runs in a folder of its own, with files in
/// which marks such as `@{omega}` stand for the values of `[parameters]`; what it measured is read
/// from the tables that it leaves there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExternalProgram {
    /// What is run, one after the other: each a program and its words, such as
    /// `[["python3", "ising.py"]]`. Words may hold marks. No shell reads them.
    pub commands: Vec<Vec<String>>,
    /// Files that are written into the folder of a run: paths relative to this file, of folders
    /// with all that is in them. They are texts and may hold marks; `@@{` stands for `@{`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<TemplateFile>,
    /// The tables that it leaves. Their rows are the frames of a run.
    pub read: Vec<ProgramTable>,
    /// States of spheres that it leaves. They become the snapshots of the record.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub states: Option<ProgramStates>,
    /// Units of parameters and of `time`, such as `{ omega = "rad/s" }`. Others have none.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub units: BTreeMap<String, String>,
    /// A command that prints the version of the program. What it prints first is part of the
    /// identity of each run: another version makes all runs anew.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub version: Vec<String>,
    /// What `version` printed; `phase sweep` and `phase run` write it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub found_version: Option<String>,
    /// How a run goes on that was stopped. Absent: it begins anew.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resume: Option<ProgramResume>,
    /// Exit codes with which the program has done its work.
    #[serde(default = "zero", skip_serializing_if = "is_zero")]
    pub exit_codes: Vec<i32>,
    /// How often a run that failed is tried again.
    #[serde(default, skip_serializing_if = "is_default")]
    pub retries: u32,
    /// The longest time (s) that a run may take, of all commands together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = unit("s").above(0.0))]
    pub time_limit: Option<f64>,
    /// The most that a run may leave in its folder (bytes).
    #[serde(default = "most_bytes", skip_serializing_if = "is_most_bytes")]
    #[schemars(transform = unit("bytes").at_least(1.0))]
    pub most_bytes: f64,
    /// What stays of the folder of a run that ended well.
    #[serde(default, skip_serializing_if = "is_default")]
    pub keep: Keep,
}

/// A file in the folder of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum TemplateFile {
    /// Path of a file or folder, relative to the scene file.
    Path(String),
    /// A text of its own.
    Text(TemplateText),
}

/// A text that is written into the folder of a run, where marks stand for values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TemplateText {
    /// Name in the folder of a run, with `/` between folders.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// States of spheres that a program leaves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProgramStates {
    /// A text dump of LAMMPS, or a file of extended XYZ, which may hold marks in its name.
    pub file: String,
    /// Radius (m) of the spheres, as a number in quotes or as a mark, such as `"@{radius}"`.
    pub radius: String,
}

/// How a run goes on that was stopped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProgramResume {
    /// The file that the program leaves to go on from. Without it a run begins anew.
    pub file: String,
    /// What is run then, in place of `commands`.
    pub commands: Vec<Vec<String>>,
}

/// What stays of the folder of a run that ended well.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Keep {
    /// Everything.
    #[default]
    All,
    /// Nothing: only folders of runs that failed stay.
    Failed,
}

fn zero() -> Vec<i32> {
    vec![0]
}

fn is_zero(codes: &Vec<i32>) -> bool {
    *codes == [0]
}

/// Ten gigabytes.
const MOST_BYTES: f64 = 1e10;

fn most_bytes() -> f64 {
    MOST_BYTES
}

fn is_most_bytes(bytes: &f64) -> bool {
    *bytes == MOST_BYTES
}

impl ExternalProgram {
    /// Its texts; none of files that are not read yet.
    pub fn texts(&self) -> impl Iterator<Item = &TemplateText> {
        self.files.iter().filter_map(|file| match file {
            TemplateFile::Text(text) => Some(text),
            TemplateFile::Path(_) => None,
        })
    }

    /// All its columns, with the unit of each.
    pub fn columns(&self) -> impl Iterator<Item = &ProgramColumn> {
        self.read.iter().flat_map(|table| &table.columns)
    }

    /// The same without what changes no result: units, limits, and what is kept.
    pub(crate) fn without_limits(self) -> Self {
        Self {
            units: BTreeMap::new(),
            retries: 0,
            time_limit: None,
            most_bytes: MOST_BYTES,
            keep: Keep::All,
            ..self
        }
    }

    /// The programs that it starts.
    pub fn programs(&self) -> Vec<&str> {
        let resumed = self.resume.iter().flat_map(|it| &it.commands);
        let commands = self.commands.iter().chain(resumed).chain([&self.version]);
        let mut names: Vec<&str> = commands
            .filter_map(|words| words.first().map(String::as_str))
            .collect();
        names.sort_unstable();
        names.dedup();
        names
    }
}

/// The parts of a scene that only models of this program have, in the scene of another program.
/// Their values mean nothing; no scene of spheres has them.
pub(super) mod absent {
    use super::super::{Integrator, Output, Radii, Shape, Spheres, Time};
    use super::Start;

    /// Far beyond all times of runs and all densities.
    const NONE: f64 = 1e15;

    /// The highest place (m).
    const NOWHERE: f64 = 1e9;

    pub(in crate::scene) fn spheres() -> Spheres {
        Spheres {
            count: 1,
            radius: Radii::One(1.0),
            density: NONE,
            shape: Shape::Sphere,
        }
    }

    pub(in crate::scene) fn are_spheres(spheres: &Spheres) -> bool {
        *spheres == self::spheres()
    }

    pub(in crate::scene) fn start() -> Start {
        Start::Random {
            z_min: NOWHERE,
            z_max: NOWHERE,
            x: None,
            y: None,
            speed: 0.0,
            spin: 0.0,
        }
    }

    pub(in crate::scene) fn is_start(start: &Start) -> bool {
        *start == self::start()
    }

    pub(in crate::scene) fn time() -> Time {
        Time {
            dt: NONE,
            safety_factor: None,
            duration: NONE,
            frame_interval: NONE,
            integrator: Integrator::default(),
            resolution: None,
        }
    }

    pub(in crate::scene) fn is_time(time: &Time) -> bool {
        *time == self::time()
    }

    /// No more than one state, which has no spheres.
    pub(in crate::scene) fn output() -> Output {
        Output {
            snapshot_interval: 0.0,
            rise_speeds: Vec::new(),
            rise_radii: Vec::new(),
            ..Output::default()
        }
    }
}

impl Scene {
    /// Whether another program runs it, so that it has no spheres.
    pub fn is_external(&self) -> bool {
        self.program.is_some()
    }

    /// The unit of the times of its frames. Another program may count something else.
    pub fn unit_of_time(&self) -> &str {
        match &self.program {
            None => "s",
            Some(program) => program.units.get("time").map_or("1", String::as_str),
        }
    }
}
