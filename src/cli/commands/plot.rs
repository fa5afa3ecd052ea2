//! `phase plot`: draws the figures of a results folder or of the records of single runs.

mod folder;
mod records;

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::figures::drawn;
use crate::cli::folders::{self, Entry};
use crate::cli::labels;
use crate::cli::options::Measured;
use crate::cli::runs::check_labels;
use folder::{FitEntry, FolderAnswer};
use phase::plot::{self, Figure};
use phase::sweep::{Folder, Selection, parse_point};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Draw the figures of a results folder (from its labels.csv and records) or of single records, as
/// SVG and PNG.
///
/// Figures of drainages measure the states within --times; `packing-map` shows the states at these
/// two times.
#[derive(clap::Args)]
#[command(after_help = "\
Example: list the figures of a folder, and draw one
  phase plot --list results/quick
  phase plot results/quick --figure hole-radius
Example: the speeds in two runs
  phase plot results/quick --figure speeds --point radius=0.002,omega=8 --point radius=0.006,omega=8
Example: the paths of the spheres in one record, which needs `trajectory = true` in its scene
  phase plot results/collisions/cradle.h5
Example: where the energy went in a record of `phase run --ledger`; energies and speeds
  phase plot tank.h5 --figure ledger,energies,speeds --out figures
Example: two drainages in one figure, from when the flow has developed
  phase plot full.h5 coarse.h5 --figure radial-distribution --times 40,200 --out figures
Example: a drainage with points from a paper
  phase plot full.h5 --figure cross-profile --times 80,180 --data paper.csv")]
pub(crate) struct Arguments {
    /// A results folder of `phase sweep`, a folder that holds several, or one or more records
    /// (.h5). Several records are shown in one figure, together with files of other programs as in
    /// `phase compare`.
    #[arg(required_unless_present = "list", value_name = "DIR|RECORD")]
    paths: Vec<PathBuf>,
    /// A figure to draw; may be given several times [default: tank folder: phase, settle-time; silo
    /// folder: phase, discharge-rate; record: tracks and ledger, if stored].
    #[arg(short, long, value_name = "NAME", value_delimiter = ',')]
    figure: Vec<String>,
    /// A point of the grid for figures of single runs, such as `radius=0.003,omega=6` or
    /// `radius=0.003,omega=6,seed=2`; may be given several times.
    #[arg(short, long = "point", value_name = "POINT", requires = "figure")]
    points: Vec<String>,
    #[command(flatten)]
    measured: Measured,
    /// Points from another source, such as a paper, to add to figures of records (CSV: place, value
    /// and optionally the half width of an interval, in the units of the axes). The file's name is
    /// the legend. May be given several times.
    #[arg(long, value_name = "CSV", requires = "figure")]
    data: Vec<PathBuf>,
    /// Folder for the figures [default: the results folder, or the record's folder].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Prefix of the output files when plotting records [default: the record's name; none for
    /// several records].
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// List all figures, or those that can be drawn from DIR, with what they show; draw nothing.
    #[arg(short, long, conflicts_with_all = ["out", "name", "labels"])]
    list: bool,
}

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
    console.answer_with_files(&answer);
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
                true => "several paths must all be records (.h5)",
                false => "no such file; check the path",
            };
            return Err(Failure::refused(reason).at(folder));
        }
        if self.name.is_some() && is_one_folder {
            return Err(Failure::refused(
                "--name is for figures of records; figures of a folder have fixed names",
            ));
        }
        if self.measured.scene.is_some() && is_one_folder {
            return Err(Failure::refused(
                "--scene is for files of other programs; a results folder has its own scene",
            ));
        }
        if let Some(data) = self.data.first().filter(|_| is_one_folder) {
            return Err(Failure::refused(format_args!(
                "--data {}: data can be added to figures of records, not of a folder",
                data.display()
            )));
        }
        if self.measured.window.times.is_some() && is_one_folder && self.figure.is_empty() {
            return Err(Failure::refused(
                "--times is for figures of drainages; name one with --figure",
            ));
        }
        check_labels(&self.measured.labels, self.paths.len(), is_one_folder)
    }
}

/// The `--json` result.
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
}

/// A figure that can be drawn.
#[derive(Serialize)]
struct Listed {
    name: String,
    description: String,
    /// The runs that a figure of single runs shows without --point.
    default_runs: Option<&'static str>,
    /// Names of the families of scenes that it is for; none for all.
    families: Vec<&'static str>,
}

impl Answer {
    /// Prints name and description of every figure, or of the figures that can be drawn from `dir`.
    fn list(&mut self, dir: Option<&Path>, console: &Console) -> Result<(), Failure> {
        let mut of_rules = BTreeMap::new();
        let known: Vec<&Figure> = match dir {
            None => {
                let figures = plot::figures().iter();
                figures
                    .filter(|it| it.is_of_sweep() || it.is_of_one_record())
                    .collect()
            }
            Some(path) if path.is_file() => records::drawable(path)?,
            Some(dir) => self.drawable(dir, &mut of_rules, console)?,
        };
        let of_record = dir.is_some_and(Path::is_file);
        let figures = known.into_iter().map(|figure| Listed {
            name: figure.name.to_owned(),
            description: figure.description.clone(),
            default_runs: figure.default_runs().filter(|_| !of_record),
            families: match of_record {
                true => Vec::new(),
                false => figure.families.iter().map(|it| it.name).collect(),
            },
        });
        let of_rules = of_rules.into_iter().map(|(name, description)| Listed {
            name,
            description,
            default_runs: None,
            families: Vec::new(),
        });
        self.figures = figures.chain(of_rules).collect();
        for figure in &self.figures {
            figure.print(dir.is_none(), console);
        }
        Ok(())
    }

    /// The figures that can be drawn from the results folders at `dir`, found by drawing them.
    /// Adds those of the rules of their files, by name, with what they show.
    fn drawable(
        &mut self,
        dir: &Path,
        of_rules: &mut BTreeMap<String, String>,
        console: &Console,
    ) -> Result<Vec<&'static Figure>, Failure> {
        let of_sweeps = plot::figures().iter().filter(|figure| figure.is_of_sweep());
        let mut is_drawn: Vec<(&Figure, bool)> = of_sweeps.map(|figure| (figure, false)).collect();
        let found = Folder::find(dir)?;
        self.folders = folders::go_through(dir, found, console, |folder| {
            let sweep = folder.read_sweep()?;
            let table = labels::read(folder)?.with_variants(sweep.variants());
            for (figure, is_drawn) in is_drawn.iter_mut().filter(|(_, is_drawn)| !is_drawn) {
                let of_folder = (folder, &sweep, &table);
                *is_drawn = drawn(figure.name, of_folder, (&[], None)).is_ok();
            }
            of_rules.extend(plot::figures_of_rules(table.family));
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
        let found = Folder::find(dir);
        for name in &arguments.figure {
            match plot::figures().iter().find(|known| known.name == name) {
                Some(figure) if figure.is_of_sweep() => {}
                Some(figure) if figure.is_of_one_record() => {
                    return Err(Failure::refused(format_args!(
                        "`{name}` is drawn from the record of one run; give its .h5 file instead \
                         of {}",
                        dir.display()
                    )));
                }
                _ if found.iter().flatten().any(|it| is_of_rules(name, it)) => {}
                _ => {
                    return Err(Failure::refused(format_args!(
                        "there is no figure `{name}`; `phase plot --list` lists all figures"
                    )));
                }
            }
        }
        let points = arguments.points.iter().map(|point| parse_point(point));
        let points: Vec<Selection> = points.collect::<Result<_, _>>()?;
        let found = found?;
        let several = found.len() > 1;
        self.folders = folders::go_through(dir, found, console, |folder| {
            let place = match (&arguments.out, folder.root().file_name()) {
                (None, _) => folder.root().to_owned(),
                (Some(out), Some(name)) if several => out.join(name),
                (Some(out), _) => out.clone(),
            };
            let chosen = (&points[..], arguments.measured.window.times);
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
    /// Prints it, with its families of scenes if the folder does not determine them.
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
                "{:<22} of the runs at --point; by default {runs}",
                ""
            ));
        }
    }
}

/// Reports figures that could not be drawn, and returns the reasons. If nothing was drawn, the
/// first reason is the failure of the command.
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

/// Whether that is the map of a measure that the file of a folder states itself.
fn is_of_rules(name: &str, folder: &Folder) -> bool {
    let (sweep, name) = (folder.read_sweep(), name.replace('-', "_"));
    sweep.is_ok_and(|sweep| sweep.family().measures().any(|it| it.name == name))
}
