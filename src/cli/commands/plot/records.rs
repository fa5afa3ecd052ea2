//! Figures of the records of single runs.

use super::{Arguments, Listed, name_all};
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::figures::write;
use crate::cli::options::Measured;
use crate::cli::{folders, runs};
use phase::classify::{DRAINAGE, Family};
use phase::plot::{self, About, PlotError, Svg};
use phase::record::RunRecord;
use phase::store::{self, DataSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// A figure that one record alone has.
pub(super) struct RecordFigure {
    pub(super) name: &'static str,
    description: &'static str,
    /// Whether a record holds what it shows.
    is_of: fn(&RunRecord) -> bool,
    draw: fn(&RunRecord) -> Result<Svg, PlotError>,
}

/// Figures of a single record, of data that only some records hold.
pub(super) const OF_ONE: [RecordFigure; 2] = [
    RecordFigure {
        name: "tracks",
        description: "paths of the spheres, from the record of one run with its trajectory",
        is_of: |record| record.trajectory.len() > 1,
        draw: plot::draw_tracks,
    },
    RecordFigure {
        name: "ledger",
        description: "where the energy went, from the record of one run with its ledger",
        is_of: |record| !record.observations.residual.is_empty(),
        draw: plot::draw_ledger,
    },
];

/// The default figures of a drainage; the default figures of other runs are [`OF_ONE`].
const DEFAULT_OF_DRAINAGE: [&str; 2] = ["surface-angle", "radial-distribution"];

/// The figure that any record of discrete elements has, whatever its family.
const OF_ELEMENTS: &str = "energies";

/// The figures of single runs that folders have too, of such a record.
fn of_runs(record: &RunRecord) -> impl Iterator<Item = About> {
    let family = Family::of(&record.scene);
    let has_energies = record.scene.spot.is_none();
    let figures = plot::figures().into_iter();
    figures.filter(move |figure| {
        let applies = figure.applies_to(family) || (figure.name == OF_ELEMENTS && has_energies);
        figure.default_runs.is_some() && applies
    })
}

/// What can be drawn of a record.
pub(super) fn list(path: &Path) -> Result<Vec<Listed>, Failure> {
    let record = store::read_record(path)?;
    let records = std::slice::from_ref(&record);
    let is_drawn =
        |figure: &About| plot::draw_records(figure.name, records, None, &[], &[]).is_ok();
    let of_runs = of_runs(&record).filter(is_drawn).map(|figure| Listed {
        name: figure.name,
        description: figure.description,
        default_runs: None,
        families: Vec::new(),
    });
    let of_one = OF_ONE.iter().filter(|figure| (figure.is_of)(&record));
    Ok(of_one.map(RecordFigure::entry).chain(of_runs).collect())
}

/// The entries of what one record alone has.
pub(super) fn of_one() -> Vec<Listed> {
    OF_ONE.iter().map(RecordFigure::entry).collect()
}

impl RecordFigure {
    fn entry(&self) -> Listed {
        Listed {
            name: self.name,
            description: self.description.to_owned(),
            default_runs: None,
            families: Vec::new(),
        }
    }
}

/// Draws figures of one record, or of several beside each other: NAME.h5 gives NAME-tracks.svg and
/// .png; several give tracks.svg and .png, in the folder of the first or that which is asked for.
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
    let prefix = match (&arguments.name, &paths) {
        (Some(name), _) => OsString::from(name),
        (None, [path]) => path.file_stem().unwrap_or_default().to_owned(),
        (None, _) => OsString::new(),
    };
    let stem = |name: &String| {
        let mut stem = prefix.clone();
        stem.push(if stem.is_empty() { "" } else { "-" });
        stem.push(name);
        stem
    };
    let files = folders::files_of_figures(names.iter().map(stem));
    folders::refuse_foreign(
        folder,
        files,
        "choose another folder with --out or another name with --name",
    )?;
    let failed = |error: PlotError| Failure::from(error).at(first);
    let mut missing = None;
    let mut failures = Vec::new();
    for name in &names {
        let written = match image(name, &records, &data, arguments) {
            Err(
                error @ (PlotError::NoTrajectory
                | PlotError::NoLedger
                | PlotError::NoMeasures { .. }),
            ) if arguments.figure.is_empty() => {
                missing.get_or_insert(error);
                continue;
            }
            Err(error) => Err(failed(error)),
            Ok(image) => folders::make(folder).and_then(|()| {
                let place = |end: &str| folder.join(stem(name)).with_added_extension(end);
                write(&image, place, console)
            }),
        };
        failures.extend(written.err());
    }
    let nothing_drawn = console.files().is_empty();
    if nothing_drawn && failures.is_empty() {
        failures.extend(missing.map(failed));
    }
    name_all(failures, nothing_drawn, console)
}

/// A figure of one record or of several.
fn image(
    name: &str,
    records: &[RunRecord],
    data: &[DataSet],
    arguments: &Arguments,
) -> Result<Svg, PlotError> {
    let of_one = OF_ONE.iter().find(|figure| figure.name == name);
    match (of_one, records) {
        (Some(figure), [_]) if arguments.measured.window.times.is_some() => {
            Err(PlotError::NoTimes(figure.name))
        }
        (Some(figure), [_]) if !data.is_empty() => Err(PlotError::NoData(figure.name)),
        (Some(figure), [record]) => (figure.draw)(record),
        (Some(figure), _) => Err(PlotError::OfOneRecord(figure.name)),
        (None, _) => {
            let Measured { window, labels, .. } = &arguments.measured;
            plot::draw_records(name, records, window.times, labels, data)
        }
    }
}

/// The figures asked for, or the default ones.
fn names(record: &RunRecord, arguments: &Arguments) -> Result<Vec<String>, Failure> {
    let family = Family::of(&record.scene);
    let of_runs: Vec<&str> = of_runs(record).map(|figure| figure.name).collect();
    let known = OF_ONE.iter().map(|figure| figure.name).chain(of_runs);
    let known: Vec<&str> = known.collect();
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
    let defaults = match family == &DRAINAGE {
        true => DEFAULT_OF_DRAINAGE,
        false => OF_ONE.map(|figure| figure.name),
    };
    Ok(defaults.map(str::to_owned).into())
}
