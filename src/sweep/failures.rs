//! `failed.csv`: the jobs of a sweep that failed, one row per job.
//!
//! Columns: `id`, the axes by their names, `seed`, `reason`.

use super::Failure;
use crate::grid::Axis;
use crate::store::{Lease, StoreError, write_atomic};
use serde::Serialize;
use std::collections::HashMap;
use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The table of failed jobs of a results folder, which several processes may write.
pub(super) struct FailureTable<'a> {
    axes: &'a [Axis],
    path: PathBuf,
}

impl<'a> FailureTable<'a> {
    /// The table of a sweep with these axes.
    pub(super) fn new(axes: &'a [Axis], path: PathBuf) -> Self {
        Self { axes, path }
    }

    /// Appends a failure. A row that another process loses while it tidies the table is noted again
    /// at the end.
    pub(super) fn append(&self, failure: &Failure) -> Result<(), StoreError> {
        let fail = |error| StoreError::writing(&self.path, error);
        let mut file = OpenOptions::new();
        let file = file.append(true).create(true).open(&self.path);
        let mut file = file.map_err(fail)?;
        let length = file.metadata().map_err(fail)?.len();
        let mut text = if length == 0 {
            self.header()?
        } else {
            Vec::new()
        };
        text.extend(self.row(failure)?);
        file.write_all(&text).map_err(|error| {
            // No part of a row may stay.
            let _ = file.set_len(length);
            fail(error)
        })
    }

    /// Notes these failures, too, and drops what is none (any more). The jobs are in the order of
    /// `place`, and of each the last failure counts. Without any failure there is no file. A table
    /// that cannot be read, or of a sweep with other axes, counts as empty.
    pub(super) fn tidy<K: Ord>(
        &self,
        more: &[Failure],
        is_failure: impl Fn(&Failure) -> bool,
        place: impl Fn(&Failure) -> K,
    ) -> Result<(), StoreError> {
        if more.is_empty() && !self.path.exists() {
            return Ok(());
        }
        // One that has been stopped while it tidies is not waited for.
        let _lease = Lease::take_beside(&self.path, Duration::from_secs(1))
            .map_err(|error| StoreError::writing(&self.path, error))?;
        let mut text = self.header()?;
        let before = fs::read(&self.path).unwrap_or_default();
        let noted = match before.starts_with(&text) {
            true => read_failures(self.axes, &self.path).unwrap_or_default(),
            false => Vec::new(),
        };
        let mut failures = last_of_each(noted.into_iter().chain(more.iter().cloned()));
        failures.retain(is_failure);
        failures.sort_by_key(place);
        for failure in &failures {
            text.extend(self.row(failure)?);
        }
        if !failures.is_empty() {
            return match text == before {
                true => Ok(()),
                false => write_atomic(&self.path, &text),
            };
        }
        match fs::remove_file(&self.path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(StoreError::writing(&self.path, error))
            }
            _ => Ok(()),
        }
    }

    fn header(&self) -> Result<Vec<u8>, StoreError> {
        let names = self.axes.iter().map(|axis| axis.name.as_str());
        let cells = ["id"].into_iter().chain(names).chain(["seed", "reason"]);
        self.line(|table| table.write_record(cells))
    }

    fn row(&self, failure: &Failure) -> Result<Vec<u8>, StoreError> {
        let values = cells(self.axes, &failure.values);
        let cells = (&failure.id, values, failure.seed, &failure.reason);
        self.line(|table| table.serialize(cells))
    }

    fn line(
        &self,
        write: impl FnOnce(&mut csv::Writer<Vec<u8>>) -> csv::Result<()>,
    ) -> Result<Vec<u8>, StoreError> {
        let mut table = csv::WriterBuilder::new();
        let mut table = table.has_headers(false).from_writer(Vec::new());
        write(&mut table).map_err(|error| StoreError::content(&self.path, error))?;
        let line = table.into_inner();
        line.map_err(|error| StoreError::content(&self.path, error))
    }
}

/// The last failure of each job, in the order in which the jobs come first.
fn last_of_each(failures: impl IntoIterator<Item = Failure>) -> Vec<Failure> {
    let mut places = HashMap::new();
    let mut last: Vec<Failure> = Vec::new();
    for failure in failures {
        match places.get(&failure.id) {
            Some(&place) => last[place] = failure,
            None => {
                places.insert(failure.id.clone(), last.len());
                last.push(failure);
            }
        }
    }
    last
}

/// The values of a point in a table: numbers, and the names of variants.
fn cells(axes: &[Axis], values: &[f64]) -> Vec<Cell> {
    let cell = |(axis, &value): (&Axis, &f64)| match axis.variant(value) {
        Some(variant) => Cell::Word(variant.name.clone()),
        None => Cell::Number(value),
    };
    axes.iter().zip(values).map(cell).collect()
}

/// A value in a table.
#[derive(Serialize)]
#[serde(untagged)]
enum Cell {
    Number(f64),
    Word(String),
}

/// Reads the table of failed jobs of a sweep with these axes. Where there is no file, no job
/// failed. Of a job that failed several times the last failure counts.
///
/// # Errors
/// If the file cannot be read or is not such a table.
pub fn read_failures(axes: &[Axis], path: &Path) -> Result<Vec<Failure>, StoreError> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let mut table = csv::ReaderBuilder::new();
    let table = table.has_headers(false).from_path(path);
    let mut table = table.map_err(|error| StoreError::reading(path, error.into()))?;
    let mut failures = Vec::new();
    for row in table.records() {
        let row = row.map_err(|error| StoreError::reading(path, error.into()))?;
        if row.get(0) == Some("id") {
            // The header; two processes that begin the table write two.
            continue;
        }
        let line = row.position().map_or(1, csv::Position::line);
        failures.push(parse(axes, &row).ok_or_else(|| {
            StoreError::text(
                path,
                line,
                "this is not a row of failed jobs; delete the file",
            )
        })?);
    }
    Ok(last_of_each(failures))
}

fn parse(axes: &[Axis], row: &csv::StringRecord) -> Option<Failure> {
    let mut cells: Vec<&str> = row.iter().collect();
    let reason = cells.pop()?.to_owned();
    let seed = cells.pop()?.parse().ok()?;
    let (id, values) = cells.split_first()?;
    let values = values
        .iter()
        .enumerate()
        .map(|(place, cell)| match axes.get(place) {
            Some(axis) if axis.is_of_variants() => axis.place_of(cell),
            _ => cell.parse().ok(),
        })
        .collect::<Option<_>>()?;
    Some(Failure {
        id: (*id).to_owned(),
        values,
        seed,
        reason,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_back_what_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("failed.csv");
        let axes = ["radius", "omega"].map(|name| Axis::of_numbers(name, name, vec![]));
        assert_eq!(read_failures(&axes, &path).unwrap(), []);
        let failure = Failure {
            id: "0123456789abcdef".to_owned(),
            values: vec![0.1 + 0.2, 40.0],
            seed: u64::MAX,
            reason: "no room, \"really\"\nnone".to_owned(),
        };
        let other = Failure {
            id: "fedcba9876543210".to_owned(),
            ..failure.clone()
        };
        let table = FailureTable::new(&axes, path.clone());
        for failure in [&failure, &other, &failure] {
            table.append(failure).unwrap();
        }
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(text.matches("no room").count(), 3);
        let failures = [failure.clone(), other.clone()];
        assert_eq!(read_failures(&axes, &path).unwrap(), failures);
        table.tidy(&[], |_| true, |_| ()).unwrap();
        assert_eq!(read_failures(&axes, &path).unwrap(), failures);
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.starts_with("id,radius,omega,seed,reason\n"), "{text}");
        assert_eq!(text.matches("no room").count(), 2);

        let variant = crate::grid::Variant {
            name: "no drag, calm".to_owned(),
            scale: Vec::new(),
            scene: crate::sweep::Sweep::of_falling_sphere().scene,
        };
        let variants = [axes[0].clone(), Axis::of_variants(vec![variant])];
        let of_variant = Failure {
            values: vec![0.1, 0.0],
            ..failures[0].clone()
        };
        let place = folder.path().join("variants.csv");
        let table = FailureTable::new(&variants, place.clone());
        table.append(&of_variant).unwrap();
        let row = std::fs::read_to_string(&place).unwrap();
        assert!(row.contains(",\"no drag, calm\","), "{row}");
        assert_eq!(read_failures(&variants, &place).unwrap(), [of_variant]);

        std::fs::write(&path, text.replace("40.0", "forty")).unwrap();
        let message = read_failures(&axes, &path).unwrap_err().to_string();
        assert!(message.contains("failed.csv:2: "), "{message}");
    }

    /// Each process notes what failed with it, and drops what another one has made since.
    #[test]
    fn failures_of_several_processes_stay() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("failed.csv");
        let failure = |id: &str| Failure {
            id: id.to_owned(),
            values: Vec::new(),
            seed: 1,
            reason: "none".to_owned(),
        };
        let (one, other) = (
            FailureTable::new(&[], path.clone()),
            FailureTable::new(&[], path.clone()),
        );
        one.append(&failure("b")).unwrap();
        other.tidy(&[], |_| true, |it| it.id.clone()).unwrap();
        other.append(&failure("a")).unwrap();
        one.tidy(&[failure("b")], |_| true, |it| it.id.clone())
            .unwrap();
        assert_eq!(
            read_failures(&[], &path).unwrap(),
            [failure("a"), failure("b")]
        );
        one.tidy(&[failure("b")], |it| it.id != "b", |_| ())
            .unwrap();
        assert_eq!(read_failures(&[], &path).unwrap(), [failure("a")]);
        // A sweep with other axes has other failures.
        let axes = [Axis::of_numbers("seed", "seed", vec![])];
        let edited = FailureTable::new(&axes, path.clone());
        edited.tidy(&[], |_| true, |_| ()).unwrap();
        assert!(!path.exists());
    }
}
