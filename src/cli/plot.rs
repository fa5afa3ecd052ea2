//! `phase plot`: draws the figures of a results folder or of the record of a single run.

use super::console::Console;
use super::exit::{Exit, Failure};
use super::folders;
use phase::classify::{DRAINAGE, FAMILIES, Family, LabelTable};
use phase::plot::{self, PlotError, Svg};
use phase::record::{Program, RunRecord};
use phase::store;
use phase::sweep::{Folder, FolderError, Sweep, parse_point};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Draw the figures of a results folder, as SVG and PNG, from its labels.csv and records, or those
/// of the record of one run: the tracks of its spheres, the ledger of its energy.
#[derive(clap::Args)]
#[command(after_help = "\
Example: what can be drawn of a folder, and one of it
  phase plot --list results/quick
  phase plot results/quick --figure hole-radius
Example: the speeds in two runs
  phase plot results/quick --figure speeds --point radius=0.002,omega=8 --point radius=0.006,omega=8
Example: the paths of the spheres in one record, which needs `trajectory = true` in its scene
  phase plot results/collisions/cradle.h5
Example: where the energy went, in a record of `phase run --ledger`; energies and speeds of any
  phase plot tank.h5 --figure ledger,energies,speeds --out figures")]
pub(crate) struct Arguments {
    /// A results folder of `phase sweep`, a folder that holds several, or a record (.h5).
    #[arg(required_unless_present = "list")]
    dir: Option<PathBuf>,
    /// A figure to draw; may be given several times [default: phase and settle-time of a tank's
    /// folder, phase and discharge-rate of a silo's, of a record what it holds of tracks and
    /// ledger].
    #[arg(short, long, value_name = "NAME", value_delimiter = ',')]
    figure: Vec<String>,
    /// A point of the grid, such as `radius=0.003,omega=6`, and if you like `seed=2`, for figures
    /// of single runs; may be given several times.
    #[arg(short, long = "point", value_name = "POINT", requires = "figure")]
    points: Vec<String>,
    /// Folder for the figures [default: the results folder, or that of the record].
    #[arg(short, long, value_name = "DIR", conflicts_with = "list")]
    out: Option<PathBuf>,
    /// Print the names of all figures, or of those that can be drawn of DIR, and what they show;
    /// draw nothing.
    #[arg(short, long)]
    list: bool,
    /// Print the result as one JSON object (docs/json.md) instead of text.
    #[arg(long)]
    pub(super) json: bool,
}

/// Values by name of an axis.
type Point = Vec<(String, f64)>;

/// The figure whose fits are printed.
const BEVERLOO: &str = "beverloo";

/// A figure of a single run.
struct RecordFigure {
    name: &'static str,
    description: &'static str,
    draw: fn(&RunRecord) -> Result<Svg, PlotError>,
}

/// The figures of a single run.
const OF_RECORD: [RecordFigure; 7] = [
    RecordFigure {
        name: "tracks",
        description: "paths of the spheres, from the record of one run with its trajectory",
        draw: plot::draw_tracks,
    },
    RecordFigure {
        name: "ledger",
        description: "where the energy went, from the record of one run with its ledger",
        draw: plot::draw_ledger,
    },
    RecordFigure {
        name: "energies",
        description: "energies over time, of one run",
        draw: |record| plot::draw_single("energies", record),
    },
    RecordFigure {
        name: "speeds",
        description: "speeds of spheres and air over time, of one run",
        draw: |record| plot::draw_single("speeds", record),
    },
    RecordFigure {
        name: "states",
        description: "the spheres at the end of one run",
        draw: |record| plot::draw_single("states", record),
    },
    RecordFigure {
        name: "surface-angle",
        description: "angle of the free surface of one drainage over time",
        draw: |record| plot::draw_single("surface-angle", record),
    },
    RecordFigure {
        name: "radial-distribution",
        description: "radial distribution function of one drainage",
        draw: |record| plot::draw_single("radial-distribution", record),
    },
];

/// Those of them that are drawn if none is asked for, as far as the record holds them.
const DEFAULT_OF_RECORD: [&str; 2] = ["tracks", "ledger"];

/// The same for a drainage.
const DEFAULT_OF_DRAINAGE: [&str; 2] = ["surface-angle", "radial-distribution"];

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let (mut figures, mut fits) = (Vec::new(), Vec::new());
    match &arguments.dir {
        dir if arguments.list => figures = list(dir.as_deref(), console)?,
        Some(path) if path.is_file() => draw_record(path, arguments, console)?,
        Some(dir) => fits = draw_folders(dir, arguments, console)?,
        None => {}
    }
    console.answer(&Answer {
        figures,
        fits,
        files: console.files(),
    });
    Ok(Exit::Done)
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer {
    /// The figures that can be drawn, if they were asked for.
    figures: Vec<Entry>,
    /// The laws that were fitted for figures.
    fits: Vec<FitEntry>,
    /// The files written.
    files: Vec<PathBuf>,
}

/// A figure that can be drawn.
#[derive(Serialize)]
struct Entry {
    name: &'static str,
    description: String,
    /// The runs that a figure of single runs shows without --point.
    default_runs: Option<&'static str>,
    /// `tank` or `silo`; none for all.
    family: Option<&'static str>,
}

/// A law that was fitted for a figure.
#[derive(Serialize)]
struct FitEntry {
    folder: PathBuf,
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

/// Prints name and description of every figure, or of those that can be drawn of what is at `dir`.
fn list(dir: Option<&Path>, console: &Console) -> Result<Vec<Entry>, Failure> {
    let (families, record) = match dir {
        None => (FAMILIES.to_vec(), true),
        Some(path) if path.is_file() => (Vec::new(), true),
        Some(dir) => {
            let folders = Folder::find(dir).map_err(Failure::refused)?.into_iter();
            let family = |folder: Folder| Ok(Family::of(&folder.read_sweep()?.scene));
            let families = folders.map(family).collect::<Result<_, FolderError>>();
            (families.map_err(Failure::failed)?, false)
        }
    };
    let mut entries: Vec<Entry> = plot::figures()
        .into_iter()
        .filter(|figure| families.iter().any(|family| figure.applies_to(family)))
        .map(|figure| Entry {
            name: figure.name,
            description: figure.description,
            default_runs: figure.default_runs,
            family: figure.family.map(|family| family.name),
        })
        .collect();
    if record {
        entries.extend(OF_RECORD.map(|figure| Entry {
            name: figure.name,
            description: figure.description.to_owned(),
            default_runs: None,
            family: None,
        }));
    }
    for entry in &entries {
        // What is listed for a folder applies to it.
        let family = entry.family.filter(|_| dir.is_none());
        let family = family.map_or(String::new(), |name| format!(" [{name}]"));
        console.result(format_args!(
            "{:<22} {}{family}",
            entry.name, entry.description
        ));
        if let Some(runs) = entry.default_runs {
            console.result(format_args!(
                "{:<22} of the runs at --point, or else {runs}",
                ""
            ));
        }
    }
    Ok(entries)
}

/// Draws the figures of every results folder at `dir`.
fn draw_folders(
    dir: &Path,
    arguments: &Arguments,
    console: &Console,
) -> Result<Vec<FitEntry>, Failure> {
    let is_known = |name: &String| plot::figures().iter().any(|known| known.name == name);
    if let Some(name) = arguments.figure.iter().find(|name| !is_known(name)) {
        if OF_RECORD.iter().any(|known| known.name == *name) {
            return Err(Failure::refused(format_args!(
                "`{name}` is drawn from the record of one run; name its .h5 file instead of {}",
                dir.display()
            )));
        }
        return Err(Failure::refused(format_args!(
            "there is no figure `{name}`; `phase plot --list` names them all"
        )));
    }
    let points = arguments.points.iter().map(|point| parse_point(point));
    let points: Vec<Point> = points.collect::<Result<_, _>>().map_err(Failure::refused)?;
    let mut fits = Vec::new();
    let found = Folder::find(dir).map_err(Failure::refused)?;
    let several = found.len() > 1;
    for folder in found {
        let place = match (&arguments.out, folder.root().file_name()) {
            (None, _) => folder.root().to_owned(),
            (Some(out), Some(name)) if several => out.join(name),
            (Some(out), _) => out.clone(),
        };
        folders::make(&place)?;
        let sweep = folder.read_sweep().map_err(Failure::failed)?;
        let path = folder.labels();
        if !path.exists() {
            return Err(Failure::refused(format_args!(
                "{}: there are no labels yet; run `phase classify {}` first",
                path.display(),
                folder.root().display()
            )));
        }
        let table = store::read_labels(&path).map_err(|error| {
            Failure::failed(format_args!(
                "{error}; `phase classify {}` makes it anew",
                folder.root().display()
            ))
        })?;
        if arguments.figure.is_empty() {
            draw_default_figures(&folder, &place, &sweep, &table, console)?;
        }
        for name in &arguments.figure {
            draw(name, &folder, &place, &sweep, &table, &points, console)?;
            if name == BEVERLOO {
                fits.extend(print_fits(&folder, &sweep, &table, console)?);
            }
        }
    }
    Ok(fits)
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
        table,
        record: &|id| folder.read_record(id),
        points: &[],
        program: &program,
    });
    let entries = lines
        .map_err(refused_or_failed)?
        .into_iter()
        .map(|line| FitEntry {
            folder: folder.root().to_owned(),
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
            super::format::count(entry.runs, "run"),
            entry.without_rate
        ));
    }
    Ok(entries)
}

/// Draws what is drawn if nothing else is asked for.
pub(super) fn draw_default_figures(
    folder: &Folder,
    place: &Path,
    sweep: &Sweep,
    table: &LabelTable,
    console: &Console,
) -> Result<(), Failure> {
    if sweep.axes.is_empty() {
        console.note("a sweep without axes has no diagram: no figures");
        return Ok(());
    }
    table
        .family
        .default_figures
        .iter()
        .try_for_each(|name| draw(name, folder, place, sweep, table, &[], console))
}

/// Draws a figure, writes it to the folder `place` as SVG and PNG and prints their paths.
fn draw(
    name: &str,
    folder: &Folder,
    place: &Path,
    sweep: &Sweep,
    table: &LabelTable,
    points: &[Point],
    console: &Console,
) -> Result<(), Failure> {
    let program = Program::current();
    let figure = plot::draw(
        name,
        &plot::Source {
            sweep,
            table,
            record: &|id| folder.read_record(id),
            points,
            program: &program,
        },
    );
    let figure = figure.map_err(refused_or_failed)?;
    let file = |extension: &str| place.join(format!("{name}.{extension}"));
    write(&figure, file, console)
}

fn refused_or_failed(error: PlotError) -> Failure {
    if error.is_of_request() {
        Failure::refused(error)
    } else {
        Failure::failed(error)
    }
}

/// Draws figures of a record beside it, or to the folder that is asked for: NAME.h5 gives
/// NAME-tracks.svg and .png.
fn draw_record(path: &Path, arguments: &Arguments, console: &Console) -> Result<(), Failure> {
    let names = &arguments.figure[..];
    let known = |name: &String| OF_RECORD.iter().find(|figure| figure.name == name);
    if let Some(name) = names.iter().find(|name| known(name).is_none()) {
        let known = OF_RECORD.map(|figure| figure.name).join("`, `");
        return Err(Failure::refused(format_args!(
            "`{name}` is not a figure of a single record; available: `{known}`"
        )));
    }
    let record = store::read_record(path).map_err(Failure::refused)?;
    let refused = |error| Failure::failed(format_args!("{}: {error}", path.display()));
    let defaults = match Family::of(&record.scene) == &DRAINAGE {
        true => DEFAULT_OF_DRAINAGE,
        false => DEFAULT_OF_RECORD,
    };
    let mut missing = None;
    let mut drawn = 0;
    for figure in &OF_RECORD {
        let is_wanted = match names {
            [] => defaults.contains(&figure.name),
            names => names.iter().any(|name| name == figure.name),
        };
        if !is_wanted {
            continue;
        }
        match (figure.draw)(&record) {
            Err(error @ (PlotError::NoTrajectory | PlotError::NoLedger)) if names.is_empty() => {
                missing.get_or_insert(error);
            }
            image => {
                let mut stem = path.file_stem().unwrap_or_default().to_owned();
                stem.push(format!("-{}", figure.name));
                let beside = path.parent().unwrap_or(Path::new(""));
                let folder = arguments.out.as_deref().unwrap_or(beside);
                folders::make(folder)?;
                let place = |extension: &str| folder.join(&stem).with_added_extension(extension);
                write(&image.map_err(refused)?, place, console)?;
                drawn += 1;
            }
        }
    }
    match missing {
        Some(error) if drawn == 0 => Err(refused(error)),
        _ => Ok(()),
    }
}

/// Writes a figure as SVG and PNG and prints their paths.
pub(super) fn write(
    figure: &Svg,
    place: impl Fn(&str) -> PathBuf,
    console: &Console,
) -> Result<(), Failure> {
    let images = [
        ("svg", figure.to_svg_bytes()),
        ("png", figure.to_png_bytes().map_err(Failure::failed)?),
    ];
    for (extension, bytes) in images {
        let path = place(extension);
        store::write_atomic(&path, &bytes).map_err(Failure::failed)?;
        console.file(&path);
    }
    Ok(())
}
