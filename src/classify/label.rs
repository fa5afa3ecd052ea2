//! The states of a run, by name and by number.

use serde::{Deserialize, Serialize};

/// The state of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Label {
    /// A numerical guard ended the run.
    Unstable,
    /// No steady state was reached; of a silo: its door did not open, or so late that nothing can be
    /// said.
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
    /// The grains of a silo have stopped to leave it, and most are still in.
    Arching,
    /// Grains are leaving a silo when the run ends.
    Flowing,
    /// (Nearly) all grains have left a silo.
    Emptied,
}

impl Label {
    /// All labels, in the order of their codes.
    pub const ALL: [Self; 10] = [
        Self::Unstable,
        Self::Unsettled,
        Self::Settled,
        Self::Fluid,
        Self::Pinned,
        Self::SmallSpout,
        Self::LargeSpout,
        Self::Arching,
        Self::Flowing,
        Self::Emptied,
    ];

    /// Number of the state: that of the thesis for a tank, 0 unsettled to 5 large spout; 6 to 8 for
    /// those of a silo; -1 unstable.
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
            Self::Arching => "arching",
            Self::Flowing => "flowing",
            Self::Emptied => "emptied",
        }
    }

    /// The label of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|label| label.name() == name)
    }
}
