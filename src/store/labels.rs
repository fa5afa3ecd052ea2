//! `labels.csv`, one row per job, and `points.csv`, one row per point of the grid.
//!
//! Columns of `labels.csv`: `id`, the axes by their names, `seed`, `label`, its `code`, `steady` if
//! runs end when they are steady, then the [measures](Family::measures) of the family by their
//! names. What is not known is empty. Numbers are written with as many digits as it takes to read
//! back the same bits.

use super::{StoreError, write_atomic};
use crate::classify::{FAMILIES, Family, LabelRow, LabelTable, Verdict};
use crate::document::text;
use csv::StringRecord;
use serde::Serialize;
use std::collections::HashMap;
use std::path::Path;

/// The columns between the axes and the measures.
const VERDICT: [&str; 3] = ["seed", "label", "code"];

/// The column after these in a table of runs that end when they are steady.
const STEADY: &str = "steady";

/// Writes a table of labels.
///
/// # Errors
/// [`StoreError::DiskFull`], [`StoreError::Write`], or [`StoreError::Content`] if a row does not
/// have one value per axis, or is of another family than the table.
pub fn write_labels(table: &LabelTable, path: &Path) -> Result<(), StoreError> {
    let fail = |error| StoreError::content(path, error);
    let mut writer = csv_writer();
    let has_steady = table.has_steady();
    writer
        .write_record(columns(table.family, &table.axes, has_steady))
        .map_err(fail)?;
    for row in &table.rows {
        let verdict = &row.verdict;
        if verdict.family != table.family {
            let (row, table) = (verdict.family.name, table.family.name);
            let reason = format!("a row of a {row} in the table of a {table}");
            return Err(StoreError::content(path, reason));
        }
        let label = (verdict.label, verdict.label.code);
        let steady: &[Option<bool>] = match has_steady {
            true => &[verdict.steady],
            false => &[],
        };
        let values = &verdict.values;
        let point = cells(table, &row.values);
        writer
            .serialize((&row.id, point, row.seed, label, steady, values))
            .map_err(fail)?;
    }
    save(writer, path)
}

/// Writes the points of a table's grid, replicate seeds put together: the axes by their names,
/// the majority `label`, its `code`, the `agreement` of the seeds and their number, `seeds`.
///
/// # Errors
/// As for [`write_labels`].
pub fn write_points(table: &LabelTable, path: &Path) -> Result<(), StoreError> {
    let fail = |error| StoreError::content(path, error);
    let mut writer = csv_writer();
    let axes = table.axes.iter().map(String::as_str);
    writer
        .write_record(axes.chain(["label", "code", "agreement", "seeds"]))
        .map_err(fail)?;
    for point in table.points() {
        writer
            .serialize((
                cells(table, &point.values),
                point.label,
                point.label.code,
                point.agreement,
                point.rows.len(),
            ))
            .map_err(fail)?;
    }
    save(writer, path)
}

/// The values of a point, a variant by its name.
fn cells<'a>(table: &'a LabelTable, values: &[f64]) -> Vec<Cell<'a>> {
    let of_variants = table.axis_of_variants();
    let cell = |(axis, &value): (usize, &f64)| match table.variants.get(value as usize) {
        Some(name) if Some(axis) == of_variants => Cell::Word(name),
        _ => Cell::Number(value),
    };
    values.iter().enumerate().map(cell).collect()
}

/// A value in a table.
#[derive(Serialize)]
#[serde(untagged)]
enum Cell<'a> {
    Number(f64),
    Word(&'a str),
}

/// Reads a table of labels of a family that needs no rules. Variants are in the order in which it
/// names them first.
///
/// # Errors
/// [`StoreError::Read`], with the line at fault.
pub fn read_labels(path: &Path) -> Result<LabelTable, StoreError> {
    read_labels_of(path, None)
}

/// Reads a table of labels: of the family `own`, or of one that needs no rules.
///
/// # Errors
/// [`StoreError::Read`], with the line at fault.
pub fn read_labels_of(path: &Path, own: Option<&'static Family>) -> Result<LabelTable, StoreError> {
    let content = text::read(path).map_err(|error| StoreError::reading(path, error))?;
    let mut reader = csv::Reader::from_reader(content.as_bytes());
    let header = reader.headers().map_err(|error| malformed(path, &error))?;
    let header = read_header(header, own).map_err(|reason| StoreError::text(path, 1, reason))?;
    let LabelColumns { family, axes, .. } = &header;
    let names = columns(family, axes, header.has_steady);
    let mut variants = Vec::new();
    let rows = reader
        .records()
        .map(|record| {
            let record = record.map_err(|error| malformed(path, &error))?;
            read_row(&header, &names, &mut variants, &record).map_err(|reason| {
                let line = record.position().map_or(1, csv::Position::line);
                StoreError::text(path, line, reason)
            })
        })
        .collect::<Result<Vec<LabelRow>, _>>()?;
    let mut lines: HashMap<&str, usize> = HashMap::new();
    for (row, line) in rows.iter().zip(2..) {
        if let Some(first) = lines.insert(&row.id, line) {
            let reason = format!(
                "duplicate row of run {}, already on line {first}; remove one",
                row.id
            );
            return Err(StoreError::text(path, line as u64, reason));
        }
    }
    drop(lines);
    let LabelColumns { family, axes, .. } = header;
    Ok(LabelTable {
        family,
        axes,
        variants,
        rows,
    })
}

/// What the header line of a table says.
struct LabelColumns {
    family: &'static Family,
    axes: Vec<String>,
    has_steady: bool,
}

/// Names of all columns.
fn columns(family: &Family, axes: &[String], has_steady: bool) -> Vec<String> {
    let mut names = vec!["id".to_owned()];
    names.extend_from_slice(axes);
    names.extend(VERDICT.map(str::to_owned));
    names.extend(has_steady.then(|| STEADY.to_owned()));
    names.extend(family.measures().map(|measure| measure.name.to_owned()));
    names
}

/// The family whose measures the header line names, and the axes.
fn read_header(
    header: &StringRecord,
    own: Option<&'static Family>,
) -> Result<LabelColumns, String> {
    let read = |family: &'static Family, has_steady: bool| {
        let others = columns(family, &[], has_steady).len();
        let axes = header.len().checked_sub(others)?;
        let axes = header.iter().skip(1).take(axes);
        let axes: Vec<_> = axes.map(str::to_owned).collect();
        let expected = columns(family, &axes, has_steady);
        header.iter().eq(&expected).then_some(LabelColumns {
            family,
            axes,
            has_steady,
        })
    };
    let mut families = own.into_iter().chain(FAMILIES);
    let either = |family| read(family, false).or_else(|| read(family, true));
    families
        .find_map(either)
        .ok_or_else(|| match header.is_empty() {
            true => "this file is empty".to_owned(),
            false => own
                .and_then(|family| of_other_rules(header, family))
                .unwrap_or_else(|| {
                    "this is not the header line of a table of labels, which names id, the axes, \
                     seed, label, code and the measures of a family"
                        .to_owned()
                }),
        })
}

/// What differs where the header line is of other labels and measures than those of a family.
fn of_other_rules(header: &StringRecord, family: &Family) -> Option<String> {
    let columns: Vec<&str> = header.iter().collect();
    let last = columns.windows(VERDICT.len()).position(|it| it == VERDICT);
    let written = columns[last? + VERDICT.len()..].iter().copied();
    let written = names_of_rules(written.filter(|name| *name != STEADY));
    let own = names_of_rules(family.measures().map(|it| it.name));
    let only = |names: &[&str], others: &[&str]| -> String {
        let names = names.iter().filter(|name| !others.contains(name));
        names.copied().collect::<Vec<_>>().join(", ")
    };
    let parts = [
        ("has", only(&written, &own)),
        ("lacks", only(&own, &written)),
    ];
    let parts = parts.iter().filter(|(_, names)| !names.is_empty());
    let parts: Vec<String> = parts
        .map(|(verb, names)| format!("{verb} {names}"))
        .collect();
    Some(format!(
        "this table is of other labels or measures than the sweep: it {}",
        parts.join(" and ")
    ))
    .filter(|_| !parts.is_empty())
}

/// Names of measures; of those that a label leaves one, its own.
fn names_of_rules<'a>(measures: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let is_more = |name: &str| name.ends_with("_value") || name.ends_with("_threshold");
    let names = measures.filter(|name| !is_more(name));
    names
        .map(|name| name.strip_suffix("_margin").unwrap_or(name))
        .collect()
}

fn read_row(
    header: &LabelColumns,
    names: &[String],
    variants: &mut Vec<String>,
    record: &StringRecord,
) -> Result<LabelRow, String> {
    fn parse<T: std::str::FromStr>(name: &str, field: &str, what: &str) -> Result<T, String> {
        let parsed = field.parse();
        parsed.map_err(|_| format!("column `{name}`: `{field}` is not {what}"))
    }
    let number = |at: usize| parse::<f64>(&names[at], &record[at], "a number");
    let optional = |at: usize| match &record[at] {
        "" => Ok(None),
        _ => number(at).map(Some),
    };
    let family = header.family;
    let seed = 1 + header.axes.len();
    let steady = header.has_steady.then_some(seed + VERDICT.len());
    let first = seed + VERDICT.len() + usize::from(header.has_steady);

    let label = family.label(&record[seed + 1]).ok_or_else(|| {
        format!(
            "`{}` is not a label of a {}",
            &record[seed + 1],
            family.name
        )
    })?;
    if parse::<i8>("code", &record[seed + 2], "a whole number")? != label.code {
        let (code, name) = (&record[seed + 2], label.name);
        return Err(format!("label `{name}` does not have code {code}"));
    }
    let truth = |at: usize| match &record[at] {
        "" => Ok(None),
        field => parse(&names[at], field, "true or false").map(Some),
    };
    let values = (first..names.len()).map(optional);
    let mut value = |at: usize| {
        if names[at] != LabelTable::VARIANT {
            return number(at);
        }
        let known = variants.iter().position(|name| *name == record[at]);
        Ok(known.unwrap_or_else(|| {
            variants.push(record[at].to_owned());
            variants.len() - 1
        }) as f64)
    };
    Ok(LabelRow {
        id: record[0].to_owned(),
        seed: parse("seed", &record[seed], "a whole number")?,
        verdict: Verdict {
            label,
            family,
            steady: steady.map(truth).transpose()?.flatten(),
            values: values.collect::<Result<_, _>>()?,
        },
        values: (1..seed).map(&mut value).collect::<Result<_, _>>()?,
    })
}

fn malformed(path: &Path, error: &csv::Error) -> StoreError {
    match error.kind() {
        csv::ErrorKind::UnequalLengths {
            pos,
            expected_len,
            len,
        } => {
            let line = pos.as_ref().map_or(1, csv::Position::line);
            let reason = format!("{len} values, but the header line names {expected_len} columns");
            StoreError::text(path, line, reason)
        }
        _ => StoreError::text(path, error.position().map_or(1, csv::Position::line), error),
    }
}

fn csv_writer() -> csv::Writer<Vec<u8>> {
    csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(Vec::new())
}

fn save(writer: csv::Writer<Vec<u8>>, path: &Path) -> Result<(), StoreError> {
    let bytes = writer
        .into_inner()
        .map_err(|error| StoreError::content(path, error))?;
    write_atomic(path, &bytes)
}

#[cfg(test)]
mod tests;
