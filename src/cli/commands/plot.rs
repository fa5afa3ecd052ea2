//! `phase plot`: draws the figures of a results folder or of the records of single runs.

mod folder;
mod records;

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::folders::{self, Entry};
use crate::cli::runs::check_labels;
use crate::cli::values;
use folder::{FitEntry, FolderAnswer};
use phase::classify::{Family, LabelTable};
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
    #[arg(long, value_name = "FROM,TO", value_parser = values::times)]
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

/// The figure of refined sweeps.
const REFINED: &str = "refined";

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    arguments.check()?;
    let mut answer = Answer::default();
    match &arguments.paths[..] {
        paths if arguments.list => answer.list(paths.first().map(PathBuf::as_path), console)?,
        [dir] if !dir.is_file() => answer.draw_folders(dir, arguments, console)?,
        paths => answer.problems = records::draw(paths, arguments, console)?,
    }
    let exit = match answer.problems[..] {
        [] => Entry::exit(&answer.folders, |folder| folder.problems.is_empty()),
        [_, ..] => Exit::Failed,
    };
    answer.files = console.files();
    console.answer(&answer);
    Ok(exit)
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
#[derive(Default, Serialize)]
struct Answer {
    /// The figures that can be drawn, if they were asked for.
    figures: Vec<Listed>,
    /// The laws that were fitted for figures.
    fits: Vec<FitEntry>,
    /// The results folders.
    folders: Vec<Entry<FolderAnswer>>,
    /// Figures of records that could not be drawn, and why.
    problems: Vec<String>,
    /// The files written.
    files: Vec<String>,
}

/// A figure that can be drawn.
#[derive(Serialize)]
struct Listed {
    name: &'static str,
    description: String,
    /// The runs that a figure of single runs shows without --point.
    default_runs: Option<&'static str>,
    /// Names of the families of scenes that it is for; none for all.
    families: Vec<&'static str>,
}

impl Answer {
    /// Prints name and description of every figure, or of those that can be drawn of what is at
    /// `dir`.
    fn list(&mut self, dir: Option<&Path>, console: &Console) -> Result<(), Failure> {
        let (known, of_record) = match dir {
            None => (plot::figures(), records::of_one()),
            Some(path) if path.is_file() => (Vec::new(), records::list(path)?),
            Some(dir) => (self.drawable(dir, console)?, Vec::new()),
        };
        let figures = known.into_iter().map(|figure| Listed {
            name: figure.name,
            description: figure.description,
            default_runs: figure.default_runs,
            families: figure.families.iter().map(|it| it.name).collect(),
        });
        self.figures = figures.chain(of_record).collect();
        for figure in &self.figures {
            figure.print(dir.is_none(), console);
        }
        Ok(())
    }

    /// The figures that can be drawn of the results folders at `dir`: a try succeeds.
    fn drawable(&mut self, dir: &Path, console: &Console) -> Result<Vec<About>, Failure> {
        let mut is_drawn: Vec<(About, bool)> = plot::figures()
            .into_iter()
            .map(|figure| (figure, false))
            .collect();
        let found = Folder::find(dir).map_err(Failure::refused)?;
        self.folders = folders::go_through(dir, found, console, |folder| {
            let sweep = folder.read_sweep().map_err(Failure::failed)?;
            let table = folder::read_labels(folder)?.with_variants(sweep.variants());
            for (figure, is_drawn) in is_drawn.iter_mut().filter(|(_, is_drawn)| !is_drawn) {
                let of_folder = (folder, &sweep, &table);
                *is_drawn = drawn(figure.name, of_folder, (&[], None)).is_ok();
            }
            Ok(FolderAnswer::new(folder))
        })?;
        let drawn = is_drawn.into_iter().filter(|(_, is_drawn)| *is_drawn);
        Ok(drawn.map(|(figure, _)| figure).collect())
    }

    /// Draws the figures of every results folder at `dir`.
    fn draw_folders(
        &mut self,
        dir: &Path,
        arguments: &Arguments,
        console: &Console,
    ) -> Result<(), Failure> {
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
        let found = Folder::find(dir).map_err(Failure::refused)?;
        let several = found.len() > 1;
        self.folders = folders::go_through(dir, found, console, |folder| {
            let place = match (&arguments.out, folder.root().file_name()) {
                (None, _) => folder.root().to_owned(),
                (Some(out), Some(name)) if several => out.join(name),
                (Some(out), _) => out.clone(),
            };
            let chosen = (&points[..], arguments.times);
            let fits = &mut self.fits;
            Ok(FolderAnswer::of(
                folder,
                &place,
                &arguments.figure,
                chosen,
                fits,
                console,
            )?)
        })?;
        Ok(())
    }
}

impl Listed {
    /// Prints it, with the families of scenes that it is for if these are not known.
    fn print(&self, with_families: bool, console: &Console) {
        let families = match self.families.join(", ") {
            names if with_families && !names.is_empty() => format!(" [{names}]"),
            _ => String::new(),
        };
        console.result(format_args!(
            "{:<22} {}{families}",
            self.name, self.description
        ));
        if let Some(runs) = self.default_runs {
            console.result(format_args!(
                "{:<22} of the runs at --point, or else {runs}",
                ""
            ));
        }
    }
}

/// Names figures that could not be drawn, and why; gives the reasons. If nothing was drawn, the
/// first of them is the failure of the whole.
fn name_all(
    mut failures: Vec<Failure>,
    nothing_drawn: bool,
    console: &Console,
) -> Result<Vec<String>, Failure> {
    let first = match nothing_drawn && !failures.is_empty() {
        true => Some(failures.remove(0)),
        false => None,
    };
    let reasons = failures.into_iter().map(|failure| failure.message);
    let reasons: Vec<String> = reasons.inspect(|reason| console.error(reason)).collect();
    first.map_or(Ok(reasons), Err)
}

/// What may be done where figures of another program are in the way.
pub(super) const ANOTHER_FOLDER: &str = "choose another folder with --out";

/// Draws what is drawn if nothing else is asked for. Gives the figures that could not be drawn, and
/// why.
pub(super) fn draw_default_figures(
    folder: &Folder,
    sweep: &Sweep,
    table: &LabelTable,
    console: &Console,
) -> Vec<String> {
    let names = default_figures(sweep, table, console).into_iter();
    let draw = |name| {
        draw(
            name,
            folder,
            folder.root(),
            (sweep, table),
            (&[], None),
            console,
        )
    };
    let problems = names.filter_map(|name| Some(draw(name).err()?.message));
    problems.inspect(|problem| console.error(problem)).collect()
}

/// The figures that are drawn if none are asked for.
fn default_figures(sweep: &Sweep, table: &LabelTable, console: &Console) -> Vec<&'static str> {
    if sweep.axes.is_empty() {
        console.note("a sweep without axes has no diagram: no figures");
        return Vec::new();
    }
    figures_of_sweep(sweep, table.family)
}

/// The figures that a sweep with axes draws.
pub(super) fn figures_of_sweep(sweep: &Sweep, family: &'static Family) -> Vec<&'static str> {
    let refined = sweep.refine.iter().map(|_| REFINED);
    refined
        .chain(family.default_figures.iter().copied())
        .collect()
}

/// Draws the figure of a refined sweep after a round, without a word.
pub(super) fn draw_round(
    folder: &Folder,
    sweep: &Sweep,
    table: &LabelTable,
) -> Result<(), Failure> {
    let figure = drawn(REFINED, (folder, sweep, table), (&[], None))?;
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
    let figure = drawn(name, (folder, sweep, table), (points, times))?;
    let file = |extension: &str| place.join(format!("{name}.{extension}"));
    write(&figure, file, console)
}

/// A figure of a folder, of points and times if they are asked for.
fn drawn(
    name: &str,
    (folder, sweep, table): (&Folder, &Sweep, &LabelTable),
    (points, times): (&[Selection], Option<[f64; 2]>),
) -> Result<Svg, Failure> {
    let refining = folder.read_refining(sweep).map_err(Failure::failed)?;
    let source = plot::Source {
        sweep,
        refining: refining.as_ref(),
        table,
        record: &|id| folder.read_record(id),
        points,
        times,
        captions: &[],
        data: &[],
        program: &Program::current(),
    };
    plot::draw(name, &source).map_err(|error| refused_or_failed(folder, error))
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
