//! `phase plot`: draws the figures of a results folder or of the record of a single run.

use super::console::Console;
use super::exit::{Exit, Failure};
use phase::plot::{self, Svg};
use phase::record::Program;
use phase::store;
use phase::sweep::{Folder, LabelTable, Sweep, parse_point};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Draw the figures of a results folder, as SVG and PNG, from its labels.csv and records, or the
/// tracks of the spheres from the record of one run.
#[derive(clap::Args)]
#[command(after_help = "\
Example: what can be drawn, and one of it
  phase plot --list
  phase plot results/quick --figure hole-radius
Example: the speeds in two runs
  phase plot results/quick --figure speeds --point radius=0.002,omega=8 --point radius=0.006,omega=8
Example: the paths of the spheres in one record, which needs `trajectory = true` in its scene
  phase plot results/collisions/cradle.h5")]
pub(crate) struct Arguments {
    /// A results folder of `phase sweep`, a folder that holds several, or a record (.h5).
    #[arg(required_unless_present = "list")]
    dir: Option<PathBuf>,
    /// A figure to draw; may be given several times [default: phase and settle-time of a folder,
    /// tracks of a record].
    #[arg(short, long, value_name = "NAME", value_delimiter = ',')]
    figure: Vec<String>,
    /// A point of the grid, such as `radius=0.003,omega=6`, and if you like `seed=2`, for figures of
    /// single runs; may be given several times.
    #[arg(short, long = "point", value_name = "POINT", requires = "figure")]
    points: Vec<String>,
    /// Print the names of all figures and what they show.
    #[arg(short, long)]
    list: bool,
    /// Print the result as one JSON object (docs/json.md) instead of text.
    #[arg(long)]
    pub(super) json: bool,
}

/// Values by name of an axis.
type Point = Vec<(String, f64)>;

/// What is drawn if nothing else is asked for.
const DEFAULT_FIGURES: [&str; 2] = ["phase", "settle-time"];

/// The figure of a single run.
const TRACKS: &str = "tracks";

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let figures = match arguments.list {
        true => list(console)?,
        false => Vec::new(),
    };
    match &arguments.dir {
        Some(path) if path.is_file() => draw_record(path, &arguments.figure, console)?,
        Some(dir) => draw_folders(dir, arguments, console)?,
        None => {}
    }
    console.answer(&Answer {
        figures,
        files: console.files(),
    })?;
    Ok(Exit::Done)
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer {
    /// All figures, if they were asked for.
    figures: Vec<Entry>,
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
}

/// Prints name and description of every figure.
fn list(console: &Console) -> Result<Vec<Entry>, Failure> {
    let mut entries: Vec<Entry> = plot::figures()
        .into_iter()
        .map(|figure| Entry {
            name: figure.name,
            description: figure.description,
            default_runs: figure.default_runs,
        })
        .collect();
    entries.push(Entry {
        name: TRACKS,
        description: "paths of the spheres, from the record of one run with its trajectory"
            .to_owned(),
        default_runs: None,
    });
    for entry in &entries {
        console.result(format_args!("{:<22} {}", entry.name, entry.description))?;
        if let Some(runs) = entry.default_runs {
            console.result(format_args!(
                "{:<22} of the runs at --point, or else {runs}",
                ""
            ))?;
        }
    }
    Ok(entries)
}

/// Draws the figures of every results folder at `dir`.
fn draw_folders(dir: &Path, arguments: &Arguments, console: &Console) -> Result<(), Failure> {
    if arguments.figure.iter().any(|name| name == TRACKS) {
        return Err(Failure::refused(format_args!(
            "`{TRACKS}` is drawn from the record of one run; name its .h5 file instead of {}",
            dir.display()
        )));
    }
    let is_known = |name: &String| plot::figures().iter().any(|known| known.name == name);
    if let Some(name) = arguments.figure.iter().find(|name| !is_known(name)) {
        return Err(Failure::refused(format_args!(
            "there is no figure `{name}`; `phase plot --list` names them all"
        )));
    }
    let points = arguments.points.iter().map(|point| parse_point(point));
    let points: Vec<Point> = points.collect::<Result<_, _>>().map_err(Failure::refused)?;
    for folder in Folder::find(dir).map_err(Failure::refused)? {
        let sweep = folder.read_sweep().map_err(Failure::failed)?;
        let path = folder.labels();
        if !path.exists() {
            return Err(Failure::refused(format_args!(
                "{}: there are no labels yet; run `phase classify {}` first",
                path.display(),
                folder.root().display()
            )));
        }
        let table = store::read_labels(&path).map_err(Failure::failed)?;
        if arguments.figure.is_empty() {
            draw_default_figures(&folder, &sweep, &table, console)?;
        }
        for name in &arguments.figure {
            draw(name, &folder, &sweep, &table, &points, console)?;
        }
    }
    Ok(())
}

/// Draws what is drawn if nothing else is asked for.
pub(super) fn draw_default_figures(
    folder: &Folder,
    sweep: &Sweep,
    table: &LabelTable,
    console: &Console,
) -> Result<(), Failure> {
    if sweep.axes.is_empty() {
        console.note("a sweep without axes has no diagram: no figures");
        return Ok(());
    }
    DEFAULT_FIGURES
        .iter()
        .try_for_each(|name| draw(name, folder, sweep, table, &[], console))
}

/// Draws a figure, writes it as SVG and PNG and prints their paths.
fn draw(
    name: &str,
    folder: &Folder,
    sweep: &Sweep,
    table: &LabelTable,
    points: &[Point],
    console: &Console,
) -> Result<(), Failure> {
    let source = plot::Source {
        sweep,
        table,
        record: &|id| folder.read_record(id),
        points,
        program: &Program::current(),
    };
    let figure = plot::draw(name, &source).map_err(|error| {
        if error.is_of_request() {
            Failure::refused(error)
        } else {
            Failure::failed(error)
        }
    })?;
    write(&figure, |extension| folder.figure(name, extension), console)
}

/// Draws the tracks of a record beside it: NAME.h5 gives NAME-tracks.svg and .png.
fn draw_record(path: &Path, figures: &[String], console: &Console) -> Result<(), Failure> {
    if let Some(name) = figures.iter().find(|name| *name != TRACKS) {
        return Err(Failure::refused(format_args!(
            "`{name}` is no figure of a single record; `{TRACKS}` is"
        )));
    }
    let record = store::read_record(path).map_err(Failure::refused)?;
    let figure = plot::draw_tracks(&record)
        .map_err(|error| Failure::failed(format_args!("{}: {error}", path.display())))?;
    let mut stem = path.file_stem().unwrap_or_default().to_owned();
    stem.push("-tracks");
    let place = |extension: &str| path.with_file_name(&stem).with_added_extension(extension);
    write(&figure, place, console)
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
        console.file(&path)?;
    }
    Ok(())
}
