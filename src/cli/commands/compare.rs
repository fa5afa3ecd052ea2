//! `phase compare`: the numbers of runs beside each other, or the labels of two sweeps.

mod inputs;
mod sweeps;
mod table;

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::folders;
use crate::cli::runs::check_labels;
use crate::cli::values;
use inputs::Column;
use phase::compare::{ComparisonRow, are_of_one_run};
use phase::scene::Units;
use phase::statistics::Estimate;
use serde::Serialize;
use std::path::PathBuf;

/// Compare runs: records, or two folders of sweeps.
///
/// Drainages are measured: outflow, widening of the flow, packing, mixing, surface. Every number
/// has its interval of 95 % over ten states or blocks of time, where one can be told. Lengths are
/// over the diameter of the spheres. Of tanks and silos the label and the measures of `labels.csv`
/// are told. Of two records the difference is told, too.
///
/// Dumps of LAMMPS, extended XYZ files, and files of VTK are compared with records of phase too; of
/// VTK, give the collection (`.pvd`) that says the times of the files. What they do not say is taken
/// from the scene of the first record (or `--scene`). A table that this command wrote takes the
/// place of its records.
///
/// Of two folders, runs of one point and seed are paired: the share with one label, and the mean
/// differences of measures.
#[derive(clap::Args)]
#[command(after_help = "\
Example: two drainages, and what differs
  phase compare full.h5 coarse.h5 --times 40,160 --out coarse.csv
Example: another program
  phase compare full.h5 dump.lammpstrj --times 40,160
Example: two sweeps
  phase compare results/steel results/steel-softened")]
pub(crate) struct Arguments {
    /// Records (HDF5, LAMMPS dump, extended XYZ, VTK) or tables (CSV), one or more; or two folders.
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// First and last time (s) of the states that count, since the opening [default: from a fifth
    /// of the drainage to its end].
    #[arg(long, value_name = "FROM,TO", value_parser = values::times)]
    times: Option<[f64; 2]>,
    /// The scene of files of other programs [default: that of the first record].
    #[arg(long, value_name = "TOML")]
    scene: Option<PathBuf>,
    /// What names a record, in the order of the records [default: its file, and the keys in which
    /// they differ].
    #[arg(long = "label", value_name = "TEXT")]
    labels: Vec<String>,
    /// A table to write (CSV).
    #[arg(short, long, value_name = "CSV")]
    out: Option<PathBuf>,
    /// Print the result as one JSON object (docs/json.md) instead of text.
    #[arg(long)]
    pub(super) json: bool,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    if let Some(table) = &arguments.out {
        folders::refuse_to_replace(table, "a table of this command", table::QUANTITY.as_bytes())?;
        folders::make_for(table)?;
    }
    if arguments.paths.iter().any(|path| path.is_dir()) {
        check_labels(&arguments.labels, arguments.paths.len(), true)?;
        if let Some(file) = arguments.paths.iter().find(|path| !path.is_dir()) {
            return Err(Failure::refused(format_args!(
                "{}: this is no folder, and folders are compared with folders; compare records \
                 with records",
                file.display()
            )));
        }
        return sweeps::main(arguments, console);
    }
    let inputs = inputs::read(&arguments.paths, arguments.scene.as_deref())?;
    let units = inputs::units(&inputs)?;
    let columns = inputs::columns(&inputs, arguments.times)?;
    let names = names(&columns, &arguments.labels)?;
    if arguments.out.is_some() {
        table::check(&names)?;
    }
    warn_of_windows(&columns, arguments.times, units, console);
    let rows = inputs::rows(&columns);
    let is_of_one_run = are_of_one_run(&rows);
    for (index, name) in names.iter().enumerate() {
        console.result(format_args!("{}  {name}", letter(index)));
    }
    for line in lines(&rows, names.len(), units, is_of_one_run) {
        console.result(line);
    }
    if let Some(path) = &arguments.out {
        table::write(path, &rows, &names)?;
        console.file(path);
    }
    console.answer(&Answer {
        records: names,
        rows: rows
            .iter()
            .map(|row| Entry::new(row, is_of_one_run))
            .collect(),
        files: console.files(),
    });
    Ok(Exit::Done)
}

/// Says of which times each record is measured, if they differ or are fewer than asked for.
fn warn_of_windows(columns: &[Column], times: Option<[f64; 2]>, units: Units, console: &Console) {
    let windows = columns.iter().enumerate();
    let windows: Vec<(usize, [f64; 2])> = windows
        .filter_map(|(place, column)| Some((place, column.window?)))
        .collect();
    let differs = |it: [f64; 2], other: [f64; 2]| {
        let off = 1e-9 * other[1];
        (it[0] - other[0]).abs() > off || (it[1] - other[1]).abs() > off
    };
    let wanted = times.or(windows.first().map(|(_, window)| *window));
    for (place, window) in windows {
        if wanted.is_some_and(|wanted| differs(window, wanted)) {
            let [from, to] = window;
            console.warning(format_args!(
                "{} is measured from {from} to {to} {} since the opening, not as the others or as \
                 asked for; give --times that all records have",
                letter(place),
                units.of_time()
            ));
        }
    }
}

/// The labels of all columns, or else their own names.
fn names(columns: &[Column], labels: &[String]) -> Result<Vec<String>, Failure> {
    if labels.is_empty() {
        return Ok(columns.iter().map(|it| it.name.clone()).collect());
    }
    check_labels(labels, columns.len(), false)?;
    Ok(labels.to_vec())
}

/// What the columns of a record are called: A, B and so on.
fn letter(index: usize) -> String {
    match u8::try_from(index) {
        Ok(small) if small < 26 => char::from(b'A' + small).to_string(),
        _ => format!("#{}", index + 1),
    }
}

/// The rows as lines of text, in columns; their scenes are in these units.
fn lines(rows: &[ComparisonRow], records: usize, units: Units, is_of_one_run: bool) -> Vec<String> {
    let mut head = vec![String::new()];
    head.extend((0..records).map(letter));
    head.extend((records == 2).then(|| "B - A".to_owned()));
    let cell = |value: Option<Estimate>| value.map_or_else(|| "-".to_owned(), written);
    let cells = rows.iter().map(|row| {
        let unit = match row.shown_unit(units) {
            "" => String::new(),
            unit => format!(" ({unit})"),
        };
        let mut cells = vec![format!("{}{unit}", row.name)];
        cells.extend(row.values.iter().map(|value| cell(*value)));
        cells.extend((records == 2).then(|| cell(row.difference(is_of_one_run))));
        cells
    });
    let cells: Vec<Vec<String>> = std::iter::once(head).chain(cells).collect();
    in_columns(&cells)
}

/// Rows of as many cells as lines of text, in columns.
pub(super) fn in_columns<R: AsRef<[String]>>(rows: &[R]) -> Vec<String> {
    let columns = rows.first().map_or(0, |row| row.as_ref().len());
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.as_ref().get(column));
        cells.map(|cell| cell.chars().count()).max()
    };
    let widths: Vec<usize> = (0..columns).filter_map(width).collect();
    let line = |row: &R| {
        let cells = row.as_ref().iter().zip(&widths);
        let padded = cells.map(|(cell, &width)| format!("{cell:<width$}"));
        padded.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

/// A value with its interval, if that is known.
pub(super) fn written(estimate: Estimate) -> String {
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

/// What `--json` prints.
#[derive(Serialize)]
struct Answer {
    /// The records: file, and what differs.
    records: Vec<String>,
    rows: Vec<Entry>,
    /// The files written.
    files: Vec<String>,
}

/// A quantity of all records.
#[derive(Serialize)]
struct Entry {
    quantity: String,
    unit: String,
    /// Values, and half widths of their intervals of 95 %, in the order of the records.
    values: Vec<Option<f64>>,
    half_widths: Vec<Option<f64>>,
    /// Of two records: the second less the first, and half the width of its interval.
    difference: Option<f64>,
    difference_half_width: Option<f64>,
}

impl Entry {
    fn new(row: &ComparisonRow, is_of_one_run: bool) -> Self {
        let finite = |value: f64| Some(value).filter(|it| it.is_finite());
        let values = row.values.iter();
        let difference = row.difference(is_of_one_run);
        Self {
            quantity: row.name.clone(),
            unit: row.unit.clone(),
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
