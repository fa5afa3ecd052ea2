//! `runs.csv`: what was measured of the runs of a study, one row per run.
//!
//! Columns: `setting`, the axes by their names, `seed`, `label`, the measured quantities by their
//! names (empty where one is undefined), `sphere_steps`, `force_evaluations`, `cpu_seconds`,
//! `measured` (which thresholds or times the row was measured with), `id`. A run that several
//! settings share has a row for each.
//!
//! `runs.makers.csv` beside it: which build made each row, in the columns `id`, `version` and
//! `commit`. It is a file of its own because the same study gives the same table, whatever build
//! makes it.

use super::{Comparison, Quantity};
use crate::classify::{FAMILIES, Label, NUMERICS};
use crate::grid::Axis;
use crate::record::Program;
use crate::store::{StoreError, write_atomic};
use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

/// What was measured of one run, and what it cost.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRow {
    /// Identity of the run.
    pub id: String,
    /// Its label.
    pub label: Label,
    /// Values of the quantities, in their order; none where one is undefined.
    pub values: Vec<Option<f64>>,
    /// Spheres times steps, of the whole run.
    pub sphere_steps: u64,
    /// Evaluations of the force on a sphere, those of sub-steps too.
    pub force_evaluations: u64,
    /// Processor time (s).
    pub cpu_seconds: f64,
}

/// Columns after the axes and before the quantities.
const BEFORE: [&str; 2] = ["seed", "label"];

/// Columns after the quantities.
const AFTER: [&str; 5] = [
    "sphere_steps",
    "force_evaluations",
    "cpu_seconds",
    "measured",
    "id",
];

fn columns(axes: &[Axis], quantities: &[Quantity]) -> Vec<String> {
    let mut columns = vec!["setting".to_owned()];
    columns.extend(axes.iter().map(|axis| axis.name.clone()));
    columns.extend(BEFORE.map(str::to_owned));
    columns.extend(quantities.iter().map(|it| it.name.clone()));
    columns.extend(AFTER.map(str::to_owned));
    columns
}

/// Writes the rows that there are of the jobs of a comparison, and after them the lines of
/// `others`: those of other settings or seeds, which a later study may want again.
///
/// # Errors
/// If the file cannot be written.
pub(super) fn write_runs(
    comparison: &Comparison,
    rows: &[Option<RunRow>],
    others: &[csv::StringRecord],
    path: &Path,
) -> Result<(), StoreError> {
    let content = |error: &dyn std::fmt::Display| StoreError::content(path, error);
    let mut table = csv::Writer::from_writer(Vec::new());
    let axes = comparison.axes();
    let quantities = comparison.quantities();
    table
        .write_record(columns(axes, &quantities))
        .map_err(|error| content(&error))?;
    let measured = comparison.measurement.digest();
    for (setting, places) in comparison.settings.iter().zip(&comparison.runs) {
        for &place in places {
            let (job, Some(Some(run))) = (&comparison.jobs[place], rows.get(place)) else {
                continue;
            };
            let cells = (
                (&setting.name, &job.values, job.seed, run.label.name),
                &run.values,
                (run.sphere_steps, run.force_evaluations, run.cpu_seconds),
                (&measured, &run.id),
            );
            table.serialize(cells).map_err(|error| content(&error))?;
        }
    }
    for line in others {
        table.write_record(line).map_err(|error| content(&error))?;
    }
    let bytes = table.into_inner().map_err(|error| content(&error))?;
    write_atomic(path, &bytes)
}

/// The rows of a table that can be used again, and its other lines.
#[derive(Clone, Debug, Default)]
pub struct KnownRuns {
    /// Rows of jobs of the comparison.
    pub rows: Vec<RunRow>,
    /// Lines of other settings or seeds.
    pub others: Vec<csv::StringRecord>,
    /// Which builds made them all, by identities, as far as that was noted.
    pub makers: BTreeMap<String, Program>,
}

/// Reads the rows of a table that can be used again: of the same axes, quantities and measurement.
/// There are none where there is no file.
///
/// # Errors
/// If the file cannot be read, or has other columns: its rows are not to be written over.
pub fn read_runs(comparison: &Comparison, path: &Path) -> Result<KnownRuns, StoreError> {
    if !path.exists() {
        return Ok(KnownRuns::default());
    }
    let fail = |error: csv::Error| StoreError::reading(path, error.into());
    let mut table = csv::Reader::from_path(path).map_err(fail)?;
    let axes = comparison.axes();
    let quantities = comparison.quantities();
    if table
        .headers()
        .map_err(fail)?
        .iter()
        .ne(columns(axes, &quantities))
    {
        let reason = "its columns are not those of this study: other axes, other quantities, or a \
                      table of something else; move it away, or write it anew with --force";
        return Err(StoreError::text(path, 1, reason));
    }
    let measured = comparison.measurement.digest();
    let own: HashSet<&str> = comparison.jobs.iter().map(|job| job.id.as_str()).collect();
    let mut runs = KnownRuns {
        makers: read_makers(path)?,
        ..KnownRuns::default()
    };
    let mut known = HashSet::new();
    for row in table.records() {
        let record = row.map_err(fail)?;
        let line = record.position().map_or(1, csv::Position::line);
        let parsed = parse(&record, axes.len(), quantities.len());
        let (mut row, how) = parsed.ok_or_else(|| {
            StoreError::text(path, line, "this is no row of a study; delete the file")
        })?;
        if how != measured {
            continue;
        }
        row.label = comparison.measurement.label_again(row.label, &row.values);
        if !own.contains(row.id.as_str()) {
            runs.others.push(record);
        } else if known.insert(row.id.clone()) {
            runs.rows.push(row);
        }
    }
    let others = runs
        .others
        .iter()
        .filter_map(|line| line.iter().next_back());
    known.extend(others.map(str::to_owned));
    runs.makers.retain(|id, _| known.contains(id));
    Ok(runs)
}

/// The row of a line, and how it was measured; none if it is no row.
fn parse(line: &csv::StringRecord, axes: usize, quantities: usize) -> Option<(RunRow, String)> {
    let cells: Vec<&str> = line.iter().skip(1 + axes).collect();
    let (_seed, label) = (cells.first()?.parse::<u64>().ok()?, cells.get(1)?);
    let mut families = FAMILIES.into_iter().chain([&NUMERICS]);
    let label = families.find_map(|family| family.label(label))?;
    let values = cells
        .get(2..2 + quantities)?
        .iter()
        .map(|cell| match *cell {
            "" => Some(None),
            text => Some(Some(text.parse().ok()?)),
        });
    let values = values.collect::<Option<Vec<_>>>()?;
    let [steps, evaluations, cpu_seconds, how, id] = cells.get(2 + quantities..)? else {
        return None;
    };
    let row = RunRow {
        id: (*id).to_owned(),
        label,
        values,
        sphere_steps: steps.parse().ok()?,
        force_evaluations: evaluations.parse().ok()?,
        cpu_seconds: cpu_seconds.parse().ok()?,
    };
    Some((row, (*how).to_owned()))
}

/// The builds that made the rows of a table are noted in this file.
fn makers_of(table: &Path) -> PathBuf {
    table.with_extension("makers.csv")
}

/// Notes which builds made the rows of a table, by the identities of their runs.
///
/// # Errors
/// If the file cannot be written.
pub(super) fn write_makers(
    makers: &BTreeMap<String, Program>,
    table: &Path,
) -> Result<(), StoreError> {
    let path = makers_of(table);
    let rows = makers.iter();
    let rows = rows.map(|(id, by)| [id.as_str(), &by.version, &by.commit]);
    let mut bytes = csv::Writer::from_writer(Vec::new());
    let fail = |error: csv::Error| StoreError::content(&path, error);
    for row in std::iter::once(["id", "version", "commit"]).chain(rows) {
        bytes.write_record(row).map_err(fail)?;
    }
    let bytes = bytes
        .into_inner()
        .map_err(|error| StoreError::content(&path, error))?;
    write_atomic(&path, &bytes)
}

/// Reads which builds made the rows of a table, as far as that was noted.
fn read_makers(table: &Path) -> Result<BTreeMap<String, Program>, StoreError> {
    let path = makers_of(table);
    if !path.exists() {
        return Ok(BTreeMap::new());
    }
    let fail = |error: csv::Error| StoreError::reading(&path, error.into());
    let mut rows = csv::Reader::from_path(&path).map_err(fail)?;
    let maker = |row: Result<(String, String, String), csv::Error>| {
        let (id, version, commit) = row.map_err(fail)?;
        Ok((id, Program { version, commit }))
    };
    rows.deserialize().map(maker).collect()
}
