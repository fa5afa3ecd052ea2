//! `stability.csv`: what became of the runs of a study, one row per run.
//!
//! Columns: `integrator`, the axes by their names, `time_step` (s), `step_over_limit` and `limit`
//! (both empty where nothing limits the step), `label`, `energy_gain`, `guard`, `step` and `sphere`
//! (empty where no guard was broken), `id`.
//!
//! `stability.makers.csv` beside it: which build made each row, in the columns `id`, `version` and
//! `commit`. It is a file of its own because the same study gives the same table, whatever build
//! makes it.

use super::{Label, Row};
use crate::record::{Guard, Program};
use crate::scene::Integrator;
use crate::store::{StoreError, write_atomic};
use crate::sweep::Axis;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The columns of a table over these axes.
fn columns(axes: &[Axis]) -> Vec<&str> {
    let mut columns = vec!["integrator"];
    columns.extend(axes.iter().map(|axis| axis.name.as_str()));
    columns.extend(["time_step", "step_over_limit", "limit", "label"]);
    columns.extend(["energy_gain", "guard", "step", "sphere", "id"]);
    columns
}

/// Writes the table of a study with these axes.
///
/// # Errors
/// If the file cannot be written.
pub fn write_stability<'a>(
    axes: &[Axis],
    rows: impl Iterator<Item = &'a Row>,
    path: &Path,
) -> Result<(), StoreError> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let fail = |error: csv::Error| StoreError::content(path, error);
    table.write_record(columns(axes)).map_err(fail)?;
    for row in rows {
        let limit = row.limit.as_ref();
        let cells = (
            (row.integrator.name(), &row.values, row.time_step),
            (limit.map(|it| it.0), limit.map(|it| &it.1)),
            (row.label.name(), row.energy_gain),
            (
                row.broken.map(|it| it.0.name()),
                row.broken.map(|it| it.1),
                row.broken.map(|it| it.2),
            ),
            &row.id,
        );
        table.serialize(cells).map_err(fail)?;
    }
    let bytes = table
        .into_inner()
        .map_err(|error| StoreError::content(path, error))?;
    write_atomic(path, &bytes)
}

/// Reads the table of a study with these axes. There are no rows where there is no file.
///
/// # Errors
/// If the file cannot be read, is no such table, or one of other axes, whose rows would be lost.
pub fn read_stability(axes: &[Axis], path: &Path) -> Result<Vec<Row>, StoreError> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let mut table =
        csv::Reader::from_path(path).map_err(|error| StoreError::reading(path, error.into()))?;
    let header = table.headers();
    let header = header.map_err(|error| StoreError::reading(path, error.into()))?;
    if header.iter().ne(columns(axes)) {
        let reason = "its columns are not those of this study: other axes; move it away, or write \
                      it anew with --force";
        return Err(StoreError::text(path, 1, reason));
    }
    let mut rows = Vec::new();
    for row in table.records() {
        let row = row.map_err(|error| StoreError::reading(path, error.into()))?;
        let line = row.position().map_or(1, csv::Position::line);
        rows.push(parse(&row, axes.len()).ok_or_else(|| {
            StoreError::text(path, line, "this is no row of a study; delete the file")
        })?);
    }
    Ok(rows)
}

fn parse(row: &csv::StringRecord, axes: usize) -> Option<Row> {
    let mut cells = row.iter();
    let integrator = cells.next()?;
    let values = cells.by_ref().take(axes).map(|cell| cell.parse().ok());
    let values: Vec<f64> = values.collect::<Option<_>>()?;
    let rest: Vec<&str> = cells.collect();
    let [
        time_step,
        ratio,
        limit,
        label,
        gain,
        guard,
        step,
        sphere,
        id,
    ] = rest[..]
    else {
        return None;
    };
    let broken = match guard {
        "" => None,
        name => {
            let guard = Guard::ALL.into_iter().find(|guard| guard.name() == name)?;
            Some((guard, step.parse().ok()?, sphere.parse().ok()?))
        }
    };
    Some(Row {
        id: id.to_owned(),
        integrator: Integrator::ALL
            .into_iter()
            .find(|it| it.name() == integrator)?,
        values,
        time_step: time_step.parse().ok()?,
        limit: match ratio {
            "" => None,
            ratio => Some((ratio.parse().ok()?, limit.to_owned())),
        },
        label: Label::ALL.into_iter().find(|it| it.name() == label)?,
        energy_gain: gain.parse().ok()?,
        broken,
    })
}

/// The builds that made the rows of the table `table`, by the identities of their runs, are in this
/// file.
fn makers_of(table: &Path) -> PathBuf {
    table.with_extension("makers.csv")
}

/// Notes which builds made the rows of a table, by the identities of their runs.
///
/// # Errors
/// If the file cannot be written.
pub fn write_makers(makers: &BTreeMap<String, Program>, table: &Path) -> Result<(), StoreError> {
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
///
/// # Errors
/// If there is a file that cannot be read.
pub fn read_makers(table: &Path) -> Result<BTreeMap<String, Program>, StoreError> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn row(label: Label, broken: Option<(Guard, u64, usize)>) -> Row {
        Row {
            id: "0123456789abcdef".to_owned(),
            integrator: Integrator::AdaptiveVerlet,
            values: vec![1e-5, 2.1e11],
            time_step: 1e-5,
            limit: broken.map(|_| (1.0 / 3.0, "drag".to_owned())),
            label,
            energy_gain: 1e-17,
            broken,
        }
    }

    #[test]
    fn reads_back_what_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("stability.csv");
        let axis = |name: &str| Axis {
            key: String::new(),
            name: name.to_owned(),
            values: Vec::new(),
        };
        let axes = [axis("dt"), axis("young_modulus")];
        let lost = row(Label::LostSphere, Some((Guard::OutOfBounds, 7, 2)));
        let rows = vec![row(Label::Stable, None), lost];
        assert_eq!(read_stability(&axes, &path).unwrap(), []);
        write_stability(&axes, rows.iter(), &path).unwrap();
        assert_eq!(read_stability(&axes, &path).unwrap(), rows);
        // Symptom: a table of other axes was written over without a word.
        let message = read_stability(&axes[..1], &path).unwrap_err().to_string();
        assert!(message.contains("other axes"), "{message}");

        let makers = BTreeMap::from([("0123456789abcdef".to_owned(), Program::current())]);
        assert_eq!(read_makers(&path).unwrap(), BTreeMap::new());
        write_makers(&makers, &path).unwrap();
        assert_eq!(read_makers(&path).unwrap(), makers);

        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text.replace("lost-sphere", "lost")).unwrap();
        let message = read_stability(&axes, &path).unwrap_err().to_string();
        assert!(
            message.contains("line 3") || message.contains(":3"),
            "{message}"
        );
    }
}
