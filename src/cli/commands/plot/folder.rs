//! Figures of a results folder.

use super::name_all;
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::figures::{default_figures, draw};
use crate::cli::folders::ANOTHER_FOLDER;
use crate::cli::{folders, format, labels};
use phase::classify::LabelTable;
use phase::plot;
use phase::record::Program;
use phase::sweep::{Folder, Selection, Sweep};
use serde::Serialize;
use std::path::Path;

/// The figure whose fits are printed.
const BEVERLOO: &str = "beverloo";

/// The figures of a folder.
#[derive(Serialize)]
pub(super) struct FolderAnswer {
    folder: String,
    /// The files written.
    files: Vec<String>,
    /// Figures that could not be drawn, and why.
    pub(super) problems: Vec<String>,
}

/// A law that was fitted for a figure.
#[derive(Serialize)]
pub(super) struct FitEntry {
    folder: String,
    figure: &'static str,
    /// The line of the figure, by its values on the other axes.
    line: String,
    /// C and k, each with half of its 95 % interval.
    c: f64,
    c_half_width: f64,
    k: f64,
    k_half_width: f64,
    /// Grains per area of the bed at rest (1/m2).
    number_density: f64,
    /// Root mean square residual (grains per second).
    residual: f64,
    /// Runs that were fitted, and runs without a rate.
    runs: usize,
    without_rate: usize,
}

impl FolderAnswer {
    pub(super) fn new(folder: &Folder) -> Self {
        Self {
            folder: folder.root().display().to_string(),
            files: Vec::new(),
            problems: Vec::new(),
        }
    }

    /// Draws the figures of a folder, the default ones if none is requested. One that cannot be
    /// drawn does not stop the others.
    pub(super) fn of(
        folder: &Folder,
        place: &Path,
        asked: &[String],
        chosen: (&[Selection], Option<[f64; 2]>),
        fits: &mut Vec<FitEntry>,
        console: &Console,
    ) -> Result<Self, Failure> {
        let root = folder.root();
        let sweep = folder.read_sweep()?;
        let table = labels::read(folder)?.with_variants(sweep.variants());
        let names: Vec<&str> = match asked {
            [] => default_figures(&sweep, &table, console),
            names => names.iter().map(String::as_str).collect(),
        };
        if place != root {
            folders::refuse_foreign(place, folders::files_of_figures(&names), ANOTHER_FOLDER)?;
        }
        folders::make(place)?;
        let before = console.files().len();
        let mut failures = Vec::new();
        for name in &names {
            let drawn = draw(name, folder, place, (&sweep, &table), chosen, console);
            let fitted = drawn.and_then(|()| match *name == BEVERLOO && !asked.is_empty() {
                true => print_fits(folder, &sweep, &table, console),
                false => Ok(Vec::new()),
            });
            match fitted {
                Ok(found) => fits.extend(found),
                Err(failure) => failures.push(failure),
            }
        }
        let files = console.files().split_off(before);
        let problems = name_all(failures, files.is_empty(), console)?;
        Ok(Self {
            files,
            problems,
            ..Self::new(folder)
        })
    }
}

/// Prints the constants of the law that the figure `beverloo` shows.
fn print_fits(
    folder: &Folder,
    sweep: &Sweep,
    table: &LabelTable,
    console: &Console,
) -> Result<Vec<FitEntry>, Failure> {
    let program = Program::current();
    let lines = plot::fitted_lines(&plot::Source {
        sweep,
        refining: None,
        table,
        failures: &[],
        record: &|id| folder.read_record(id),
        points: &[],
        times: None,
        program: &program,
    });
    let entries = lines
        .map_err(|error| Failure::from(error).at(folder.root()))?
        .into_iter()
        .map(|line| FitEntry {
            folder: folder.root().display().to_string(),
            figure: BEVERLOO,
            c: line.fit.c.value,
            c_half_width: line.fit.c.half_width,
            k: line.fit.k.value,
            k_half_width: line.fit.k.half_width,
            number_density: line.bed.number_density,
            residual: line.fit.residual,
            runs: line.fit.discharges,
            without_rate: line.without_rate,
            line: line.name,
        });
    let entries: Vec<FitEntry> = entries.collect();
    for entry in &entries {
        let line = match entry.line.as_str() {
            "" => String::new(),
            line => format!("{line}: "),
        };
        console.result(format_args!(
            "{line}C = {:.4} +- {:.4}, k = {:.4} +- {:.4} (95 %, {}; {} without a rate)",
            entry.c,
            entry.c_half_width,
            entry.k,
            entry.k_half_width,
            format::count(entry.runs, "run"),
            entry.without_rate
        ));
    }
    Ok(entries)
}
