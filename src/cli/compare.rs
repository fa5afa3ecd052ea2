//! `phase compare`: the numbers of drainages beside each other.

use super::console::Console;
use super::exit::{Exit, Failure};
use super::folders;
use phase::compare::{Comparison, Row};
use phase::plot;
use phase::record::RunRecord;
use phase::statistics::Estimate;
use phase::store;
use serde::Serialize;
use std::path::PathBuf;

/// Measure the records of drainages: outflow, widening of the flow, packing, mixing, surface.
///
/// Every number has its interval of 95 % over blocks of time, where one can be told. Of two records
/// the difference is told, too. Lengths are over the diameter of the spheres.
#[derive(clap::Args)]
#[command(after_help = "\
Example: two drainages, and what differs
  phase compare full.h5 coarse.h5 --times 40,160 --out coarse.csv")]
pub(crate) struct Arguments {
    /// The records (HDF5) of `phase run`, one or more.
    #[arg(required = true, value_name = "RECORD")]
    records: Vec<PathBuf>,
    /// First and last time (s) of the states that count [default: from a fifth of the run to its
    /// end].
    #[arg(long, value_name = "FROM,TO", value_parser = super::times)]
    times: Option<[f64; 2]>,
    /// A table to write (CSV).
    #[arg(short, long, value_name = "CSV")]
    out: Option<PathBuf>,
    /// Print the result as one JSON object (docs/json.md) instead of text.
    #[arg(long)]
    pub(super) json: bool,
}

/// First column of the table.
const QUANTITY: &str = "quantity";

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    if let Some(table) = &arguments.out {
        folders::refuse_to_replace(table, "a table of this command", QUANTITY.as_bytes())?;
        folders::make_for(table)?;
    }
    let read = |path: &PathBuf| store::read_record(path).map_err(Failure::refused);
    let records: Vec<RunRecord> = arguments
        .records
        .iter()
        .map(read)
        .collect::<Result<_, _>>()?;
    let comparison = Comparison::new(&records, arguments.times).map_err(|(place, needs)| {
        let file = arguments.records[place].display();
        Failure::refused(format_args!(
            "{file}: a comparison of drainages needs {needs}"
        ))
    })?;
    let names = names(&records, &arguments.records);
    for (index, name) in names.iter().enumerate() {
        console.result(format_args!("{}  {name}", letter(index)));
    }
    for line in lines(&comparison.rows, names.len()) {
        console.result(line);
    }
    if let Some(path) = &arguments.out {
        let table = table(&comparison, &names).map_err(Failure::failed)?;
        store::write_atomic(path, &table).map_err(Failure::failed)?;
        console.file(path);
    }
    console.answer(&Answer {
        records: names,
        rows: comparison.rows.iter().map(Entry::new).collect(),
        files: console.files(),
    });
    Ok(Exit::Done)
}

/// A record by its file, and by what differs.
fn names(records: &[RunRecord], paths: &[PathBuf]) -> Vec<String> {
    let captions = plot::captions(records).into_iter();
    let named = paths.iter().zip(captions);
    let name = |(path, parts): (&PathBuf, Vec<String>)| {
        let file = [path.display().to_string()];
        file.into_iter().chain(parts).collect::<Vec<_>>().join(", ")
    };
    named.map(name).collect()
}

/// What the columns of a record are called: A, B and so on.
fn letter(index: usize) -> String {
    match u8::try_from(index) {
        Ok(small) if small < 26 => char::from(b'A' + small).to_string(),
        _ => format!("#{}", index + 1),
    }
}

/// The rows as lines of text, in columns.
fn lines(rows: &[Row], records: usize) -> Vec<String> {
    let mut head = vec![String::new()];
    head.extend((0..records).map(letter));
    head.extend((records == 2).then(|| "B - A".to_owned()));
    let cell = |value: Option<Estimate>| value.map_or_else(|| "-".to_owned(), written);
    let cells = rows.iter().map(|row| {
        let unit = match row.unit {
            "" => String::new(),
            unit => format!(" ({unit})"),
        };
        let mut cells = vec![format!("{}{unit}", row.name)];
        cells.extend(row.values.iter().map(|value| cell(*value)));
        cells.extend((records == 2).then(|| cell(row.difference())));
        cells
    });
    let cells: Vec<Vec<String>> = std::iter::once(head).chain(cells).collect();
    let width = |column: usize| cells.iter().map(|row| row[column].chars().count()).max();
    let widths: Vec<usize> = (0..cells[0].len()).filter_map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths);
        let padded = cells.map(|(cell, &width)| format!("{cell:<width$}"));
        padded.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    cells.iter().map(line).collect()
}

/// A value with its interval, if that is known.
fn written(estimate: Estimate) -> String {
    match estimate.half_width.is_finite() {
        true => format!(
            "{:.4} ± {:.2}",
            Short(estimate.value),
            Short(estimate.half_width)
        ),
        false => format!("{:.4}", Short(estimate.value)),
    }
}

/// A number with so many significant digits as the precision says.
struct Short(f64);

impl std::fmt::Display for Short {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = formatter.precision().unwrap_or(4).saturating_sub(1);
        let rounded: f64 = format!("{:.digits$e}", self.0).parse().unwrap_or(self.0);
        match rounded.abs() {
            0.0 | 1e-3..1e6 => write!(formatter, "{rounded}"),
            _ => write!(formatter, "{rounded:e}"),
        }
    }
}

fn table(comparison: &Comparison, names: &[String]) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record([QUANTITY, "unit", "record", "value", "half_width"])?;
    let number = |value: f64| match value.is_finite() {
        true => value.to_string(),
        false => String::new(),
    };
    for row in &comparison.rows {
        for (name, value) in names.iter().zip(&row.values) {
            let [value, half_width] = match value {
                Some(it) => [it.value, it.half_width].map(number),
                None => [String::new(), String::new()],
            };
            table.write_record([row.name, row.unit, name, &value, &half_width])?;
        }
    }
    table
        .into_inner()
        .map_err(|error| error.into_error().into())
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer {
    /// The records: file, and what differs.
    records: Vec<String>,
    rows: Vec<Entry>,
    /// The files written.
    files: Vec<PathBuf>,
}

/// A quantity of all records.
#[derive(Serialize)]
struct Entry {
    quantity: &'static str,
    unit: &'static str,
    /// Values, and half widths of their intervals of 95 %, in the order of the records.
    values: Vec<Option<f64>>,
    half_widths: Vec<Option<f64>>,
    /// Of two records: the second less the first, and half the width of its interval.
    difference: Option<f64>,
    difference_half_width: Option<f64>,
}

impl Entry {
    fn new(row: &Row) -> Self {
        let finite = |value: f64| Some(value).filter(|it| it.is_finite());
        let values = row.values.iter();
        let difference = row.difference();
        Self {
            quantity: row.name,
            unit: row.unit,
            values: values
                .clone()
                .map(|it| it.and_then(|it| finite(it.value)))
                .collect(),
            half_widths: values
                .map(|it| it.and_then(|it| finite(it.half_width)))
                .collect(),
            difference: difference.and_then(|it| finite(it.value)),
            difference_half_width: difference.and_then(|it| finite(it.half_width)),
        }
    }
}
