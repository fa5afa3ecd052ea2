//! `refined.csv`, one row per point of a refined sweep, and `borders.csv`, one row per border.
//!
//! Columns of `refined.csv`: the axes by their names, the most probable `label`, its `code`, and
//! `p_LABEL` for each label, its probability. Columns of `borders.csv`: the axes by their names (on
//! the axis that is crossed, the place of the border), `along` (the axis that is crossed), the
//! labels `below` and `above`, the ends of the intervals of 68 and 95 % (`low_68`, `high_68`,
//! `low_95`, `high_95`), `width_95` (length of the latter, as a share of the axis in its scale) and
//! `critical_rotation` (rad/s; empty without one).

use super::{StoreError, write_atomic};
use crate::refine::{Borders, Code, Lattice, ProbabilityMap};
use std::path::Path;

/// A border, as in `borders.csv`.
#[derive(Clone, Debug, PartialEq)]
pub struct BorderRow {
    /// Value on each axis; on the axis that is crossed, the place of the border.
    pub values: Vec<f64>,
    /// Name of the axis that is crossed.
    pub along: String,
    /// Label below the border and above it.
    pub labels: [&'static str; 2],
    /// Ends of the interval of 68 %.
    pub band68: [f64; 2],
    /// Ends of the interval of 95 %.
    pub band95: [f64; 2],
    /// Length of the interval of 95 %, as a share of the axis in its scale.
    pub width: f64,
    /// Critical rotation there (rad/s), if the scene has one.
    pub critical_rotation: Option<f64>,
}

/// Writes the probability of each label at each point of a lattice with these names of axes. The
/// labels are the names of the codes.
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`].
pub fn write_probabilities(
    axes: &[&str],
    lattice: &Lattice,
    map: &ProbabilityMap,
    (codes, name): (&[Code], &dyn Fn(Code) -> &'static str),
    path: &Path,
) -> Result<(), StoreError> {
    let columns: Vec<String> = codes
        .iter()
        .map(|code| format!("p_{}", name(*code)))
        .collect();
    let axes = axes.iter().copied();
    let header = axes.chain(["label", "code"]);
    let header = header.chain(columns.iter().map(String::as_str));
    let learnt = codes.iter().map(|code| map.codes().binary_search(code));
    let learnt: Vec<_> = learnt.collect();
    let rows = (0..lattice.places()).map(|place| {
        let at = map.at(place);
        let probability = |label: &Result<usize, usize>| label.map_or(0.0, |label| at[label]);
        let code = map.label(place);
        let probabilities: Vec<f64> = learnt.iter().map(probability).collect();
        (lattice.values(place), name(code), code, probabilities)
    });
    write(header, rows, path)
}

/// Writes a table of borders with these names of axes.
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`].
pub fn write_borders(axes: &[&str], rows: &[BorderRow], path: &Path) -> Result<(), StoreError> {
    let header = axes.iter().copied().chain(Borders::COLUMNS);
    let rows = rows.iter().map(|row| {
        let bands = (row.band68, row.band95, row.width, row.critical_rotation);
        (&row.values, &row.along, row.labels, bands)
    });
    write(header, rows, path)
}

fn write<'a>(
    header: impl Iterator<Item = &'a str>,
    rows: impl Iterator<Item = impl serde::Serialize>,
    path: &Path,
) -> Result<(), StoreError> {
    let fail = |error| StoreError::content(path, error);
    let mut writer = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(Vec::new());
    writer.write_record(header).map_err(fail)?;
    for row in rows {
        writer.serialize(row).map_err(fail)?;
    }
    let bytes = writer
        .into_inner()
        .map_err(|error| StoreError::content(path, error))?;
    write_atomic(path, &bytes)
}
