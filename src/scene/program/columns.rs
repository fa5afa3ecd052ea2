//! The tables that a program leaves behind.

use super::is_default;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A table that a program leaves behind, and which of its columns are kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProgramTable {
    /// The file, relative to the folder of the run. It may hold marks.
    pub file: String,
    /// How it is written.
    #[serde(default, skip_serializing_if = "is_default")]
    pub format: TableFormat,
    /// The names of its columns, in order, if the file does not say them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub header: Vec<String>,
    /// The column with the time of each row. Absent: rows are counted, from 0. Rows of several
    /// tables go together by it; those that not all tables have are left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<String>,
    /// The columns that records keep, as names or as tables.
    pub columns: Vec<ProgramColumn>,
}

/// How a table is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TableFormat {
    /// Commas between values, and a line of names first.
    #[default]
    Csv,
    /// Blanks between values; names in a first line or in the last line of comments before it.
    Text,
    /// The log of LAMMPS, with its tables of `thermo`.
    LammpsLog,
    /// A file of LAMMPS's `fix ave/time` in the mode of scalars.
    LammpsAverage,
    /// An array of numpy (`.npy`) or several (`.npz`).
    Numpy,
    /// A file of HDF5. Its data sets of one dimension are the columns; their names are paths, such
    /// as `group/velocity`.
    Hdf5,
}

impl ProgramTable {
    /// The names, in the table, of the columns that are read, each once.
    pub fn sources(&self) -> Vec<String> {
        let kept = self.columns.iter().map(ProgramColumn::source);
        let mut names: Vec<String> = Vec::new();
        for name in self.time.as_deref().into_iter().chain(kept) {
            if !names.iter().any(|known| known == name) {
                names.push(name.to_owned());
            }
        }
        names
    }
}

/// A column that records keep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ProgramColumn {
    /// Of this name in the table, without a unit.
    Name(String),
    /// Described.
    Described(DescribedColumn),
}

/// A column with its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DescribedColumn {
    /// Name in records and rules: small letters, digits and `_`.
    pub name: String,
    /// Name in the table. Absent: the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<String>,
    /// Unit. Absent: none.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// What it is, in one line.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
}

impl ProgramColumn {
    /// Name in records and rules.
    pub fn name(&self) -> &str {
        match self {
            Self::Name(name) => name,
            Self::Described(column) => &column.name,
        }
    }

    /// Name in the table.
    pub fn source(&self) -> &str {
        match self {
            Self::Name(name) => name,
            Self::Described(column) => column.from.as_ref().unwrap_or(&column.name),
        }
    }

    /// Unit, `1` for none.
    pub fn unit(&self) -> &str {
        match self {
            Self::Described(column) if !column.unit.is_empty() => &column.unit,
            _ => "1",
        }
    }

    /// What it is, in one line.
    pub fn description(&self) -> &str {
        match self {
            Self::Described(column) if !column.description.is_empty() => &column.description,
            _ => "What the program wrote",
        }
    }
}
