//! `phase compare`: compares the numbers of runs, or the labels of two sweeps.

mod sweeps;

use crate::cli::columns::{in_columns, written};
use crate::cli::compared::table::Column;
use crate::cli::compared::{self as inputs, table};
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::folders;
use crate::cli::options::Measured;
use crate::cli::runs::check_labels;
use phase::compare::{ComparisonRow, are_of_one_run};
use phase::scene::Units;
use phase::statistics::Estimate;
use serde::Serialize;
use std::path::PathBuf;

/// Compare runs: records, or two folders of sweeps.
///
/// For drainages: outflow, widening of the flow, packing, mixing and surface, with 95 % intervals
/// over ten states or blocks of time where possible; lengths in diameters of the spheres. For tanks
/// and silos: the label and the measures of `labels.csv`. For two records also the differences.
///
/// Files of other programs can be compared too: dumps of LAMMPS, extended XYZ, and VTK files
/// through the collection (`.pvd`) that holds their times. What they lack is taken from the scene
/// of the first record, or from `--scene`. A table that this command wrote can be used instead of
/// its records.
///
/// Two results folders are compared by pairs of runs with the same point and seed: the share with
/// equal labels, and the mean differences of measures.
#[derive(clap::Args)]
#[command(after_help = "\
Example: two drainages, and what differs
  phase compare full.h5 coarse.h5 --times 40,160 --out coarse.csv
Example: another program
  phase compare full.h5 dump.lammpstrj --times 40,160
Example: two sweeps
  phase compare results/steel results/steel-softened")]
pub(crate) struct Arguments {
    /// Records (HDF5, LAMMPS dump, extended XYZ, VTK) or tables (CSV); or two results folders.
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    measured: Measured,
    /// A table to write (CSV).
    #[arg(short, long, value_name = "CSV")]
    out: Option<PathBuf>,
    /// Draw the phase diagrams of two results folders beside each other, as NAME.svg and NAME.png.
    #[arg(long, value_name = "NAME")]
    figure: Option<PathBuf>,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    if let Some(table) = &arguments.out {
        folders::refuse_to_replace(table, "a table of this command", table::QUANTITY.as_bytes())?;
        folders::make_for(table)?;
    }
    if arguments.paths.iter().any(|path| path.is_dir()) {
        check_labels(&arguments.measured.labels, arguments.paths.len(), true)?;
        if let Some(file) = arguments.paths.iter().find(|path| !path.is_dir()) {
            return Err(Failure::refused(
                "not a folder; compare folders with folders, and records with records",
            )
            .at(file));
        }
        return sweeps::main(arguments, console);
    }
    if arguments.figure.is_some() {
        return Err(Failure::refused(
            "--figure draws the phase diagrams of results folders; `phase plot` draws records",
        ));
    }
    let inputs = inputs::read(&arguments.paths, arguments.measured.scene.as_deref())?;
    let units = inputs::units(&inputs)?;
    let columns = inputs::columns(&inputs, arguments.measured.window.times)?;
    let names = names(&columns, &arguments.measured.labels)?;
    if arguments.out.is_some() {
        table::check(&names)?;
    }
    warn_of_windows(&columns, arguments.measured.window.times, units, console);
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
    console.answer_with_files(&Answer {
        records: names,
        rows: rows
            .iter()
            .map(|row| Entry::new(row, is_of_one_run))
            .collect(),
    });
    Ok(Exit::Done)
}

/// Warns of records that are measured at other times than the first one, or than requested.
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
                "{} is measured from {from} to {to} {} since the opening, unlike the others or the \
                 request; give --times that all records cover",
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

/// The names of the records' columns: A, B and so on.
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

/// The `--json` result.
#[derive(Serialize)]
struct Answer {
    /// The records: file, and what differs.
    records: Vec<String>,
    rows: Vec<Entry>,
}

/// A quantity of all records.
#[derive(Serialize)]
struct Entry {
    quantity: String,
    unit: String,
    /// Values, and half widths of their intervals of 95 %, in the order of the records.
    values: Vec<Option<f64>>,
    half_widths: Vec<Option<f64>>,
    /// For two records the second minus the first, and half the width of its interval.
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
