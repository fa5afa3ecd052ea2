//! `failed.csv`: the jobs of a sweep that failed, one row per job.
//!
//! Columns: `id`, the axes by their names, `seed`, `reason`.

use super::Failure;
use crate::grid::Axis;
use crate::store::{StoreError, write_atomic};
use serde::Serialize;
use std::path::Path;

/// Writes the table of failed jobs of a sweep with these axes.
///
/// # Errors
/// If the file cannot be written.
pub fn write_failures<'a>(
    axes: &[Axis],
    failures: impl IntoIterator<Item = &'a Failure>,
    path: &Path,
) -> Result<(), StoreError> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let names = axes.iter().map(|axis| axis.name.as_str());
    let fail = |error: csv::Error| StoreError::content(path, error);
    table
        .write_record(["id"].into_iter().chain(names).chain(["seed", "reason"]))
        .map_err(fail)?;
    for failure in failures {
        table
            .serialize((
                &failure.id,
                cells(axes, &failure.values),
                failure.seed,
                &failure.reason,
            ))
            .map_err(fail)?;
    }
    let bytes = table
        .into_inner()
        .map_err(|error| StoreError::content(path, error))?;
    write_atomic(path, &bytes)
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

/// Reads the table of failed jobs of a sweep with these axes. Where there is no file, no job failed.
///
/// # Errors
/// If the file cannot be read or is not such a table.
pub fn read_failures(axes: &[Axis], path: &Path) -> Result<Vec<Failure>, StoreError> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let mut table =
        csv::Reader::from_path(path).map_err(|error| StoreError::reading(path, error.into()))?;
    let mut failures = Vec::new();
    for row in table.records() {
        let row = row.map_err(|error| StoreError::reading(path, error.into()))?;
        let line = row.position().map_or(1, csv::Position::line);
        failures.push(parse(axes, &row).ok_or_else(|| {
            StoreError::text(
                path,
                line,
                "this is not a row of failed jobs; delete the file",
            )
        })?);
    }
    Ok(failures)
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
        let failures = [failure.clone(), failure];
        write_failures(&axes, &failures, &path).unwrap();
        assert_eq!(read_failures(&axes, &path).unwrap(), failures);
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.starts_with("id,radius,omega,seed,reason\n"), "{text}");

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
        let other = folder.path().join("other.csv");
        write_failures(&variants, [&of_variant], &other).unwrap();
        let text_of_variant = std::fs::read_to_string(&other).unwrap();
        assert!(
            text_of_variant.contains(",\"no drag, calm\","),
            "{text_of_variant}"
        );
        assert_eq!(read_failures(&variants, &other).unwrap(), [of_variant]);

        std::fs::write(&path, text.replace("40.0", "forty")).unwrap();
        let message = read_failures(&axes, &path).unwrap_err().to_string();
        assert!(message.contains("failed.csv:2: "), "{message}");
    }
}
