//! Figures of the records of single runs.

use super::{Arguments, name_all};
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::figures::write;
use crate::cli::{folders, runs};
use phase::classify::{DRAINAGE, Family};
use phase::plot::{self, Figure, PlotError, PlotErrorKind, RecordSet};
use phase::record::RunRecord;
use phase::store::{self, DataSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The default figures of a drainage; other runs have the default figures of one record.
const DEFAULT_OF_DRAINAGE: [&str; 2] = ["surface-angle", "radial-distribution"];

/// The figure that any record of discrete elements has, whatever its family.
const OF_ELEMENTS: &str = "energies";

/// Figures that need one record alone, with data that only some records hold.
fn of_one() -> impl Iterator<Item = &'static Figure> {
    plot::figures().iter().filter(|it| it.is_of_one_record())
}

/// All figures of a record: figures of one record alone, and figures of single runs.
fn known(record: &RunRecord) -> Vec<&'static Figure> {
    let family = Family::of(&record.scene);
    let has_energies = record.scene.spot.is_none();
    let of_runs = plot::figures().iter().filter(|figure| {
        let applies = figure.applies_to(family) || (figure.name == OF_ELEMENTS && has_energies);
        figure.default_runs().is_some() && applies
    });
    of_one().chain(of_runs).collect()
}

/// The figures that can be drawn of a record: a try succeeds.
pub(super) fn drawable(path: &Path) -> Result<Vec<&'static Figure>, Failure> {
    let record = store::read_record(path)?;
    let records = std::slice::from_ref(&record);
    let mut figures = known(&record);
    figures.retain(|figure| plot::draw(figure.name, RecordSet::of(records)).is_ok());
    Ok(figures)
}

/// Draws figures of one record, or of several side by side: NAME.h5 gives NAME-tracks.svg and
/// .png; several give tracks.svg and .png, in the folder of the first or the requested one.
/// Gives the figures that could not be drawn, and why.
pub(super) fn draw(
    paths: &[PathBuf],
    arguments: &Arguments,
    console: &Console,
) -> Result<Vec<String>, Failure> {
    if let Some(point) = arguments.points.first() {
        return Err(Failure::refused(format_args!(
            "--point {point} is for a results folder; a record holds one run"
        )));
    }
    let records: Vec<RunRecord> = runs::read(paths, arguments.measured.scene.as_deref())?;
    let (Some(first), Some(record)) = (paths.first(), records.first()) else {
        return Ok(Vec::new());
    };
    let data = arguments.data.iter().map(|path| store::read_data_set(path));
    let data: Vec<DataSet> = data.collect::<Result<_, _>>()?;
    let names = names(record, arguments)?;
    let beside = first.parent().unwrap_or(Path::new(""));
    let folder = arguments.out.as_deref().unwrap_or(beside);
    let stem = |name: &String| stem(name, paths, arguments);
    let files = folders::files_of_figures(names.iter().map(stem));
    folders::refuse_foreign(
        folder,
        files,
        "choose another folder with --out or another name with --name",
    )?;
    let set = RecordSet {
        records: &records,
        labels: &arguments.measured.labels,
        times: arguments.measured.window.times,
        data: &data,
    };
    let failed = |error: PlotError| Failure::from(error).at(first);
    let mut missing = None;
    let mut failures = Vec::new();
    for name in &names {
        let image = match plot::draw(name, set) {
            Err(error) if arguments.figure.is_empty() && error.kind() == PlotErrorKind::Nothing => {
                missing.get_or_insert(error);
                continue;
            }
            other => other.map_err(failed),
        };
        let written = image.and_then(|image| {
            folders::make(folder)?;
            let place = |end: &str| folder.join(stem(name)).with_added_extension(end);
            write(&image, place, console)
        });
        failures.extend(written.err());
    }
    let nothing_drawn = console.files().is_empty();
    if nothing_drawn && failures.is_empty() {
        failures.extend(missing.map(failed));
    }
    name_all(failures, nothing_drawn, console)
}

/// The name of the files of a figure, without their extensions.
fn stem(name: &str, paths: &[PathBuf], arguments: &Arguments) -> OsString {
    let mut stem = match (&arguments.name, paths) {
        (Some(prefix), _) => OsString::from(prefix),
        (None, [path]) => path.file_stem().unwrap_or_default().to_owned(),
        (None, _) => OsString::new(),
    };
    stem.push(if stem.is_empty() { "" } else { "-" });
    stem.push(name);
    stem
}

/// The figures asked for, or the default ones.
fn names(record: &RunRecord, arguments: &Arguments) -> Result<Vec<String>, Failure> {
    let family = Family::of(&record.scene);
    let known: Vec<&str> = known(record).iter().map(|figure| figure.name).collect();
    let names = &arguments.figure;
    if let Some(name) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(Failure::refused(format_args!(
            "`{name}` is not a figure of a record of a {}; available: `{}`",
            family.name,
            known.join("`, `")
        )));
    }
    if !names.is_empty() {
        return Ok(names.clone());
    }
    let defaults: Vec<&str> = match family == &DRAINAGE {
        true => DEFAULT_OF_DRAINAGE.into(),
        false => of_one().map(|figure| figure.name).collect(),
    };
    Ok(defaults.into_iter().map(str::to_owned).collect())
}
