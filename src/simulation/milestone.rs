//! Events that happen at most once in a run.

use serde::{Deserialize, Serialize};

/// Something that happened once in a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Milestone {
    /// What it was.
    pub kind: MilestoneKind,
    /// When (s).
    pub time: f64,
}

/// What may happen once in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MilestoneKind {
    /// The last sphere came in.
    Filled,
    /// The spheres came to rest; the time is when rest began.
    AtRest,
    /// The door opened.
    DoorOpened,
    /// The last sphere left.
    Emptied,
    /// The run became steady; the time is when the steady state began.
    Steady,
}

impl MilestoneKind {
    /// All kinds.
    pub const ALL: [Self; 5] = [
        Self::Filled,
        Self::AtRest,
        Self::DoorOpened,
        Self::Emptied,
        Self::Steady,
    ];

    /// Name, as in records and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Filled => "filled",
            Self::AtRest => "at rest",
            Self::DoorOpened => "door opened",
            Self::Emptied => "emptied",
            Self::Steady => "steady",
        }
    }
}
