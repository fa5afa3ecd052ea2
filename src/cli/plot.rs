//! `phase plot`: draws the figures of a results folder or of the records of single runs.

mod records;

use super::console::Console;
use super::exit::{Exit, Failure};
use super::folders;
use super::runs::check_labels;
use phase::classify::LabelTable;
use phase::plot::{self, About, PlotError, Svg};
use phase::record::Program;
use phase::store;
use phase::sweep::{Folder, Selection, Sweep, parse_point};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Draw the figures of a results folder, as SVG and PNG, from its labels.csv and records, or those
/// of the record of one run or several: the tracks of its spheres, the ledger of its energy.
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
  phase plot tank.h5 --figure ledger,energies,speeds --out figures
Example: two drainages in one figure, from when the flow has developed
  phase plot full.h5 coarse.h5 --figure radial-distribution --times 40,200 --out figures
Example: a drainage beside points of a paper
  phase plot full.h5 --figure cross-profile --times 80,180 --data paper.csv")]
pub(crate) struct Arguments {
    /// A results folder of `phase sweep`, a folder that holds several, or a record (.h5); or
    /// several records, for figures that show them beside each other. Beside records there may be
    /// files of other programs, as of `phase compare`.
    #[arg(required_unless_present = "list", value_name = "DIR|RECORD")]
    paths: Vec<PathBuf>,
    /// A figure to draw; may be given several times [default: phase and settle-time of a tank's
    /// folder, phase and discharge-rate of a silo's, of a record what it holds of tracks and
    /// ledger].
    #[arg(short, long, value_name = "NAME", value_delimiter = ',')]
    figure: Vec<String>,
    /// A point of the grid, such as `radius=0.003,omega=6`, and if you like `seed=2`, for figures
    /// of single runs; may be given several times.
    #[arg(short, long = "point", value_name = "POINT", requires = "figure")]
    points: Vec<String>,
    /// First and last time (s) of the states that figures of drainages measure [default: from a
    /// fifth of the run to its end], or the two that `packing-map` shows.
    #[arg(long, value_name = "FROM,TO", value_parser = super::times)]
    times: Option<[f64; 2]>,
    /// The scene of files of other programs [default: that of the first record].
    #[arg(long, value_name = "TOML")]
    scene: Option<PathBuf>,
    /// Points of another source to show beside records, such as a figure of a paper (CSV: place and
    /// value in the units of the axes, and if you like the half width of an interval); may be given
    /// several times. Its file names it.
    #[arg(long, value_name = "CSV", requires = "figure")]
    data: Vec<PathBuf>,
    /// Folder for the figures [default: the results folder, or that of the record].
    #[arg(short, long, value_name = "DIR", conflicts_with = "list")]
    out: Option<PathBuf>,
    /// What the names of the files begin with, of records [default: the name of the record; of
    /// several nothing].
    #[arg(long, value_name = "NAME", conflicts_with = "list")]
    name: Option<String>,
    /// What names a record, in the order of the records [default: the keys in which they differ].
    #[arg(long = "label", value_name = "TEXT", conflicts_with = "list")]
    labels: Vec<String>,
    /// Print the names of all figures, or of those that can be drawn of DIR, and what they show;
    /// draw nothing.
    #[arg(short, long)]
    list: bool,
    /// Print the result as one JSON object (docs/json.md) instead of text.
    #[arg(long)]
    pub(super) json: bool,
}

/// The figure whose fits are printed.
const BEVERLOO: &str = "beverloo";

/// The figure of refined sweeps.
const REFINED: &str = "refined";

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    arguments.check()?;
    let (mut figures, mut fits) = (Vec::new(), Vec::new());
    match &arguments.paths[..] {
        paths if arguments.list => figures = list(paths.first().map(PathBuf::as_path), console)?,
        [dir] if !dir.is_file() => fits = draw_folders(dir, arguments, console)?,
        paths => records::draw(paths, arguments, console)?,
    }
    console.answer(&Answer {
        figures,
        fits,
        files: console.files(),
    });
    Ok(Exit::Done)
}

impl Arguments {
    /// Refuses what does not go together.
    fn check(&self) -> Result<(), Failure> {
        let is_one_folder = matches!(&self.paths[..], [dir] if !dir.is_file());
        if self.list && self.paths.len() > 1 {
            return Err(Failure::refused("--list takes one folder or record"));
        }
        if let Some(folder) = self
            .paths
            .iter()
            .find(|path| self.paths.len() > 1 && !path.is_file())
        {
            let reason = match folder.exists() {
                true => "several are drawn beside each other only if all are records (.h5)",
                false => "there is no such file; check the path",
            };
            return Err(Failure::refused(format_args!(
                "{}: {reason}",
                folder.display()
            )));
        }
        if self.name.is_some() && is_one_folder {
            return Err(Failure::refused(
                "--name is for figures of records: those of a folder have their own names",
            ));
        }
        if self.scene.is_some() && is_one_folder {
            return Err(Failure::refused(
                "--scene is for files of other programs: a folder has that of its sweep",
            ));
        }
        if let Some(data) = self.data.first().filter(|_| is_one_folder) {
            return Err(Failure::refused(format_args!(
                "--data {}: it is shown beside records, not in figures of a folder",
                data.display()
            )));
        }
        if self.times.is_some() && is_one_folder && self.figure.is_empty() {
            return Err(Failure::refused(
                "--times is for figures of drainages: name one of them with --figure",
            ));
        }
        check_labels(&self.labels, self.paths.len(), is_one_folder)
    }
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
    /// Names of the families of scenes that it is for; none for all.
    families: Vec<&'static str>,
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
    let (known, of_record) = match dir {
        None => (plot::figures(), records::of_one()),
        Some(path) if path.is_file() => (Vec::new(), records::list(path)?),
        Some(dir) => (drawable(dir)?, Vec::new()),
    };
    let mut entries: Vec<Entry> = known
        .into_iter()
        .map(|figure| Entry {
            name: figure.name,
            description: figure.description,
            default_runs: figure.default_runs,
            families: figure.families.iter().map(|it| it.name).collect(),
        })
        .collect();
    entries.extend(of_record);
    for entry in &entries {
        // What is listed for a folder applies to it.
        let families = match entry.families.join(", ") {
            names if dir.is_none() && !names.is_empty() => format!(" [{names}]"),
            _ => String::new(),
        };
        console.result(format_args!(
            "{:<22} {}{families}",
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

/// The figures that can be drawn of a results folder at `dir`: those of which a try succeeds.
fn drawable(dir: &Path) -> Result<Vec<About>, Failure> {
    let mut figures = plot::figures();
    let mut found = Vec::new();
    for folder in Folder::find(dir).map_err(Failure::refused)? {
        let sweep = folder.read_sweep().map_err(Failure::failed)?;
        let table = read_labels(&folder)?;
        let is_drawn = |figure: &mut About| {
            let of_folder = (&folder, &sweep, &table);
            drawn(figure.name, of_folder, (&[], None)).is_ok()
        };
        found.extend(figures.extract_if(.., is_drawn));
    }
    // In the order of all figures, whichever folder they are of.
    let names: Vec<&str> = plot::figures().iter().map(|figure| figure.name).collect();
    found.sort_by_key(|figure| names.iter().position(|name| *name == figure.name));
    Ok(found)
}

/// The labels of a folder.
fn read_labels(folder: &Folder) -> Result<LabelTable, Failure> {
    let path = folder.labels();
    if !path.exists() {
        return Err(Failure::refused(format_args!(
            "{}: there are no labels yet; run `phase classify {}` first",
            path.display(),
            folder.root().display()
        )));
    }
    store::read_labels(&path).map_err(|error| {
        Failure::failed(format_args!(
            "{error}; `phase classify {}` makes it anew",
            folder.root().display()
        ))
    })
}

/// Draws the figures of every results folder at `dir`.
fn draw_folders(
    dir: &Path,
    arguments: &Arguments,
    console: &Console,
) -> Result<Vec<FitEntry>, Failure> {
    let is_known = |name: &String| plot::figures().iter().any(|known| known.name == name);
    if let Some(name) = arguments.figure.iter().find(|name| !is_known(name)) {
        if records::OF_ONE.iter().any(|known| known.name == *name) {
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
    let points: Vec<Selection> = points.collect::<Result<_, _>>().map_err(Failure::refused)?;
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
        let table = read_labels(&folder)?;
        if arguments.figure.is_empty() {
            draw_default_figures(&folder, &place, &sweep, &table, console)?;
        }
        for name in &arguments.figure {
            draw(
                name,
                &folder,
                &place,
                (&sweep, &table),
                (&points, arguments.times),
                console,
            )?;
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
        times: None,
        captions: &[],
        data: &[],
        program: &program,
    });
    let entries = lines
        .map_err(|error| refused_or_failed(folder, error))?
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
    let refined = sweep.refine.iter().map(|_| &REFINED);
    let mut names = refined.chain(table.family.default_figures);
    names.try_for_each(|name| draw(name, folder, place, (sweep, table), (&[], None), console))
}

/// Draws the figure of a refined sweep after a round, without a word.
pub(super) fn draw_round(
    folder: &Folder,
    sweep: &Sweep,
    table: &LabelTable,
) -> Result<(), Failure> {
    let figure = drawn(REFINED, (folder, sweep, table), (&[], None));
    let figure = figure.map_err(|error| refused_or_failed(folder, error))?;
    for (extension, bytes) in images(&figure)? {
        let path = folder.root().join(format!("{REFINED}.{extension}"));
        store::write_atomic(&path, &bytes).map_err(Failure::failed)?;
    }
    Ok(())
}

/// Draws a figure, of points and times if they are asked for, writes it to the folder `place` as
/// SVG and PNG and prints their paths.
fn draw(
    name: &str,
    folder: &Folder,
    place: &Path,
    (sweep, table): (&Sweep, &LabelTable),
    (points, times): (&[Selection], Option<[f64; 2]>),
    console: &Console,
) -> Result<(), Failure> {
    let figure = drawn(name, (folder, sweep, table), (points, times));
    let figure = figure.map_err(|error| refused_or_failed(folder, error))?;
    let file = |extension: &str| place.join(format!("{name}.{extension}"));
    write(&figure, file, console)
}

/// A figure of a folder, of points and times if they are asked for.
fn drawn(
    name: &str,
    (folder, sweep, table): (&Folder, &Sweep, &LabelTable),
    (points, times): (&[Selection], Option<[f64; 2]>),
) -> Result<Svg, PlotError> {
    let source = plot::Source {
        sweep,
        table,
        record: &|id| folder.read_record(id),
        points,
        times,
        captions: &[],
        data: &[],
        program: &Program::current(),
    };
    plot::draw(name, &source)
}

/// Why a figure of a folder is not drawn.
fn refused_or_failed(folder: &Folder, error: PlotError) -> Failure {
    let text = format!("{}: {error}", folder.root().display());
    match error.is_of_request() {
        true => Failure::refused(text),
        false => Failure::failed(text),
    }
}

/// The files of a figure, by the ends of their names.
fn images(figure: &Svg) -> Result<[(&'static str, Vec<u8>); 2], Failure> {
    Ok([
        ("svg", figure.to_svg_bytes()),
        ("png", figure.to_png_bytes().map_err(Failure::failed)?),
    ])
}

/// Writes a figure as SVG and PNG and prints their paths, and what a reader of it would miss.
pub(super) fn write(
    figure: &Svg,
    place: impl Fn(&str) -> PathBuf,
    console: &Console,
) -> Result<(), Failure> {
    for (extension, bytes) in images(figure)? {
        let path = place(extension);
        store::write_atomic(&path, &bytes).map_err(Failure::failed)?;
        console.file(&path);
    }
    for warning in figure.warnings() {
        console.warning(format_args!("{}: {warning}", place("png").display()));
    }
    Ok(())
}
