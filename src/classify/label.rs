//! The states of a run.

use crate::color;
use serde::{Serialize, Serializer};
use std::fmt;

/// The state of a run. A family's labels are declared with its sieves; these two belong to all.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Label {
    /// Number of the state, unique among labels; for a tank the thesis's number.
    pub code: i8,
    /// Name, as in tables.
    pub name: &'static str,
    /// Colour in diagrams.
    pub color: [u8; 3],
}

impl Label {
    /// A numerical guard ended the run.
    pub const UNSTABLE: Self = Self::new(-1, "unstable", 0x00_00_00);

    /// No steady state was reached; of a silo: its door did not open, or so late that nothing can
    /// be said.
    pub const UNSETTLED: Self = Self::new(0, "unsettled", 0xe6_e2_f7);

    /// A label of that code, name and colour (0xRRGGBB).
    pub(super) const fn new(code: i8, name: &'static str, color: u32) -> Self {
        Self {
            code,
            name,
            color: color::rgb(color),
        }
    }
}

impl fmt::Debug for Label {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name)
    }
}

impl Serialize for Label {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name)
    }
}
