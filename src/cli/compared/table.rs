//! Tables of `phase compare` (CSV): one row for each quantity of each record.

use crate::cli::exit::Failure;
use phase::compare::ComparisonRow;
use phase::statistics::Estimate;
use phase::store;
use std::path::Path;

/// The numbers of a record: name and unit of each, and its value.
pub(in crate::cli) struct Column {
    pub(in crate::cli) name: String,
    pub(in crate::cli) values: Vec<([String; 2], Option<Estimate>)>,
    /// First and last time (s) since the opening between which a drainage was measured.
    pub(in crate::cli) window: Option<[f64; 2]>,
}

/// First column of the table.
pub(in crate::cli) const QUANTITY: &str = "quantity";

const COLUMNS: [&str; 5] = [QUANTITY, "unit", "record", "value", "half_width"];

/// Refuses two records of one name: a table could not distinguish them.
pub(in crate::cli) fn check(names: &[String]) -> Result<(), Failure> {
    let mut again = names.iter().enumerate();
    match again.find(|(place, name)| names[..*place].contains(name)) {
        None => Ok(()),
        Some((_, name)) => Err(Failure::refused(format_args!(
            "two records are called `{name}`, and a table needs distinct names; give each record a \
             --label"
        ))),
    }
}

pub(in crate::cli) fn write(
    path: &Path,
    rows: &[ComparisonRow],
    names: &[String],
) -> Result<(), Failure> {
    let text = written(rows, names).map_err(Failure::failed)?;
    Ok(store::write_atomic(path, &text)?)
}

fn written(rows: &[ComparisonRow], names: &[String]) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(COLUMNS)?;
    let number = |value: f64| match value.is_finite() {
        true => value.to_string(),
        false => String::new(),
    };
    for row in rows {
        for (name, value) in names.iter().zip(&row.values) {
            let [value, half_width] = match value {
                Some(it) => [it.value, it.half_width].map(number),
                None => [String::new(), String::new()],
            };
            table.write_record([&row.name, &row.unit, name, &value, &half_width])?;
        }
    }
    table
        .into_inner()
        .map_err(|error| error.into_error().into())
}

/// Reads a table back: one column for each of its records, in their order.
pub(super) fn read(path: &Path) -> Result<Vec<Column>, Failure> {
    let refuse = |line: u64, reason: &str| {
        Failure::refused(format_args!("{}:{line}: {reason}", path.display()))
    };
    let failed = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        refuse(line, &error.to_string())
    };
    let content = std::fs::read(path).map_err(|error| {
        Failure::refused(format_args!(
            "cannot read {}: {error}; check the path",
            path.display()
        ))
    })?;
    let mut reader = csv::Reader::from_reader(&content[..]);
    if reader.headers().map_err(failed)? != COLUMNS[..] {
        let columns = COLUMNS.join(",");
        return Err(refuse(
            1,
            &format!("not a table of `phase compare`: expected `{columns}`"),
        ));
    }
    let mut columns: Vec<Column> = Vec::new();
    for (record, line) in reader.records().zip(2..) {
        let record = record.map_err(failed)?;
        let number = |place: usize, empty: f64| match &record[place] {
            "" => Ok(empty),
            text => match text.parse::<f64>() {
                Ok(number) if number.is_finite() => Ok(number),
                _ => Err(refuse(line, &format!("`{text}` is not a finite number"))),
            },
        };
        let [value, half_width] = [number(3, f64::NAN)?, number(4, f64::INFINITY)?];
        if half_width < 0.0 {
            return Err(refuse(line, "a half width cannot be negative"));
        }
        let value = (!value.is_nan()).then_some(Estimate { value, half_width });
        let name = &record[2];
        let place = columns.iter().position(|it| it.name == name);
        let place = place.unwrap_or_else(|| {
            columns.push(Column {
                name: name.to_owned(),
                values: Vec::new(),
                window: None,
            });
            columns.len() - 1
        });
        let quantity = [&record[0], &record[1]].map(str::to_owned);
        let values = &mut columns[place].values;
        if values.iter().any(|(it, _)| *it == quantity) {
            let reason = format!("duplicate `{}` of `{name}`; keep one", quantity[0]);
            return Err(refuse(line, &reason));
        }
        values.push((quantity, value));
    }
    match columns.is_empty() {
        true => Err(refuse(1, "the table is empty")),
        false => Ok(columns),
    }
}
