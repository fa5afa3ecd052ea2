//! What is observed at every frame, by name.

use crate::scene::FurtherColumn;

/// A scalar that is observed at every frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name, as in the record.
    pub name: &'static str,
    /// Unit, as in the record.
    pub unit: &'static str,
    /// What it is, in one line.
    pub description: &'static str,
}

impl From<FurtherColumn> for Column {
    fn from(column: FurtherColumn) -> Self {
        Self {
            name: column.name(),
            unit: column.unit(),
            description: column.description(),
        }
    }
}
