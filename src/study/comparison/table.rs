//! `runs.csv`: what was measured of the runs of a study, one row per run.
//!
//! Columns: `setting`, the axes by their names, `seed`, `label`, the measured quantities by their
//! names (empty where one is undefined), `sphere_steps`, `force_evaluations`, `cpu_seconds`,
//! `measured` (which thresholds or times the row was measured with), `id`. A run that several
//! settings share has a row for each.

use super::{Comparison, Measured, Measurement, Quantity};
use crate::classify::{FAMILIES, Family, Label};
use crate::document::text;
use crate::grid::Axis;
use crate::record::RunRecord;
use crate::store::{StoreError, write_atomic};
use crate::sweep::{Folder, Job, Plan, work};
use std::collections::{HashMap, HashSet};

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

/// The table of the runs of a comparison.
#[derive(Clone, Debug, Default)]
pub struct RunTable {
    /// The rows of its jobs, in their order; none of one that failed or is yet to be run.
    pub rows: Vec<Option<RunRow>>,
    /// Lines of other settings or seeds, which a later study may want again.
    pub others: Vec<csv::StringRecord>,
}

/// Why there is no table.
#[derive(Debug, thiserror::Error)]
pub enum RunTableError {
    /// A record cannot be read.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The system gives no threads.
    #[error("cannot start the workers: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

crate::refusal::always!(false: RunTableError);

impl RunTable {
    /// The table without a row.
    pub fn new(comparison: &Comparison) -> Self {
        Self {
            rows: vec![None; comparison.jobs.len()],
            ..Self::default()
        }
    }

    /// Reads the rows of a results folder that can be used again: of the same axes, quantities and
    /// measurement. Without a file there are none.
    ///
    /// # Errors
    /// If the file cannot be read, or has other columns: its rows are not to be written over.
    pub fn read(comparison: &Comparison, folder: &Folder) -> Result<Self, StoreError> {
        let path = &folder.runs();
        let mut table = Self::new(comparison);
        if !path.exists() {
            return Ok(table);
        }
        let (axes, quantities) = (comparison.axes(), comparison.quantities());
        let content = text::read(path).map_err(|error| StoreError::reading(path, error))?;
        let mut file = csv::ReaderBuilder::new();
        let mut file = file.flexible(true).from_reader(content.as_bytes());
        let fail = |error: csv::Error| StoreError::reading(path, error.into());
        let header = file.headers().map_err(fail)?;
        if header.iter().ne(columns(axes, &quantities)) {
            let reason = "its columns are not those of this study: other axes, other quantities, \
                          or a table of something else; move it away, or write it anew with \
                          --force";
            return Err(StoreError::text(path, 1, reason));
        }
        let family = comparison.measurement.family(&comparison.sweep.scene);
        let measured = comparison.measurement.digest();
        let ids = comparison.jobs.iter().map(|job| job.id.as_str());
        let places: HashMap<&str, usize> = ids.enumerate().map(|(at, id)| (id, at)).collect();
        for line in file.records() {
            let line = line.map_err(fail)?;
            let number = line.position().map_or(1, csv::Position::line);
            let (mut row, how) = parse(&line, axes.len(), quantities.len(), family).ok_or_else(|| {
                let reason = "this is no row of a study; remove the line, or delete the file: its \
                              rows are made again from records, or by runs";
                StoreError::text(path, number, reason)
            })?;
            if how != measured {
                continue;
            }
            row.label = comparison.measurement.label_again(row.label, &row.values);
            match places.get(row.id.as_str()) {
                Some(&place) => table.rows[place] = Some(row),
                None => table.others.push(line),
            }
        }
        Ok(table)
    }

    /// Identities of the runs that the table of a folder has a row of. Without a table, or with one
    /// that cannot be read, there are none.
    pub fn identities(folder: &Folder) -> HashSet<String> {
        let content = text::read(&folder.runs()).unwrap_or_default();
        let mut file = csv::ReaderBuilder::new();
        let mut file = file.flexible(true).from_reader(content.as_bytes());
        // Its last column, as `columns` lists them.
        let ids = file.records().flatten();
        ids.filter_map(|line| Some(line.iter().next_back()?.to_owned()))
            .collect()
    }

    /// The plan of a folder in which jobs that have a row are done.
    #[must_use]
    pub fn applied_to(&self, plan: Plan) -> Plan {
        let rows = self.rows.iter().flatten();
        let known: HashSet<&str> = rows.map(|row| row.id.as_str()).collect();
        plan.with_labels(|job| known.contains(job.id.as_str()))
    }

    /// Adds rows of the jobs that have a record in the folder, with that many workers.
    ///
    /// # Errors
    /// If a record cannot be read.
    pub fn add_records(
        &mut self,
        comparison: &Comparison,
        folder: &Folder,
        workers: usize,
    ) -> Result<(), RunTableError> {
        let jobs = comparison.jobs.iter().enumerate();
        let missing: Vec<(usize, &Job)> = jobs.filter(|(at, _)| self.rows[*at].is_none()).collect();
        let quantities = comparison.quantities().len();
        let measured = work::map(workers, &missing, |(_, job)| {
            let record = folder.read_record_of(job)?;
            let row = record.map(|it| RunRow::of(job, &it, &comparison.measurement, quantities));
            Ok::<_, StoreError>(row)
        })?;
        for ((place, _), row) in missing.into_iter().zip(measured) {
            self.rows[place] = row?;
        }
        Ok(())
    }

    /// Writes the table of a results folder: the rows of each setting, then the lines of others.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write(&self, comparison: &Comparison, folder: &Folder) -> Result<(), StoreError> {
        let path = &folder.runs();
        let fail = |error: csv::Error| StoreError::content(path, error);
        let mut table = csv::Writer::from_writer(Vec::new());
        let names = columns(comparison.axes(), &comparison.quantities());
        table.write_record(names).map_err(fail)?;
        let measured = comparison.measurement.digest();
        for (place, setting) in comparison.settings.iter().enumerate() {
            for (values, seed, run) in comparison.rows_of(place, &self.rows) {
                let cells = (
                    (&setting.name, values, seed, run.label.name),
                    &run.values,
                    (run.sphere_steps, run.force_evaluations, run.cpu_seconds),
                    (&measured, &run.id),
                );
                table.serialize(cells).map_err(fail)?;
            }
        }
        for line in &self.others {
            table.write_record(line).map_err(fail)?;
        }
        let bytes = table.into_inner();
        let bytes = bytes.map_err(|error| StoreError::content(path, error))?;
        write_atomic(path, &bytes)
    }
}

impl RunRow {
    /// The row of a run, measured of its record.
    fn of(job: &Job, record: &RunRecord, measurement: &Measurement, quantities: usize) -> Self {
        let measured = measurement.measure(record);
        // Sieves were checked against the scene; a record that contradicts itself has no values.
        let measured = measured.unwrap_or_else(|_| Measured {
            label: Label::UNSTABLE,
            values: vec![None; quantities],
        });
        Self {
            id: job.id.clone(),
            label: measured.label,
            values: measured.values,
            sphere_steps: job.work(),
            force_evaluations: record.work,
            cpu_seconds: record.cpu_seconds,
        }
    }
}

/// The row of a line, and how it was measured; none if it is no row.
fn parse(
    line: &csv::StringRecord,
    axes: usize,
    quantities: usize,
    family: &Family,
) -> Option<(RunRow, String)> {
    let cells: Vec<&str> = line.iter().skip(1 + axes).collect();
    let (_seed, label) = (cells.first()?.parse::<u64>().ok()?, cells.get(1)?);
    let mut families = std::iter::once(family).chain(FAMILIES);
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
