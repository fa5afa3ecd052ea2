//! The states of a run, by name and by number.

use serde::{Deserialize, Serialize};

/// The state of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Label {
    /// A numerical guard ended the run.
    Unstable,
    /// No steady state was reached.
    Unsettled,
    /// Steady, and none of the states below.
    Settled,
    /// The surface rises from the axis to the wall.
    Fluid,
    /// A hole about the axis.
    Pinned,
    /// A few spheres rise in the middle.
    SmallSpout,
    /// Many spheres rise in the middle.
    LargeSpout,
}

impl Label {
    /// All labels, in the order of their codes.
    pub const ALL: [Self; 7] = [
        Self::Unstable,
        Self::Unsettled,
        Self::Settled,
        Self::Fluid,
        Self::Pinned,
        Self::SmallSpout,
        Self::LargeSpout,
    ];

    /// The thesis's number of the state: 0 unsettled to 5 large spout; -1 unstable.
    pub fn code(self) -> i8 {
        self as i8 - 1
    }

    /// Name, as in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Unstable => "unstable",
            Self::Unsettled => "unsettled",
            Self::Settled => "settled",
            Self::Fluid => "fluid",
            Self::Pinned => "pinned",
            Self::SmallSpout => "small-spout",
            Self::LargeSpout => "large-spout",
        }
    }

    /// The label of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|label| label.name() == name)
    }
}
