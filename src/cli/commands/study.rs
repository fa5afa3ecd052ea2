//! `phase study`: the runs of a study, and what follows from them.

mod ablation;
mod accuracy;
mod runs;
mod stability;

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::figures;
use crate::cli::options::{Ablate, Workers};
use crate::cli::programs::AllowProgram;
use crate::cli::values;
use phase::plot::{PlotError, Svg};
use phase::store::{self, StoreError};
use phase::study::accuracy::Subject;
use phase::study::comparison::{Comparison, RunRow, RunTable};
use phase::study::{AnyStudy, StudyName};
use phase::sweep::Shard;
use runs::{Place, Tally};
use serde::Serialize;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Make the runs of a study, and say what follows from them.
///
/// The file names the study (`study = "..."`). `stability` finds where integrators are stable over
/// two keys of a scene. `accuracy` measures what settings of a scene cost in time, and how wrong
/// they are. `ablation` takes each effect of a sweep away by itself, or reduces it to a
/// simpler law; --ablate does so for any scene or sweep. Runs that have a row in the table or a
/// record are not made again.
#[derive(clap::Args)]
#[command(after_help = "\
Examples: where do integrators break in Newton's cradle; how large may the time step of a collapse
be; which effects decide the published diagram?
  phase study sweeps/stability/cradle.toml
  phase study sweeps/accuracy/collapse.toml
  phase study sweeps/theoretical-9x9.toml --ablate --seeds 5

The results folder holds sweep.json (the settings as the variants of a sweep), records/ (one HDF5
file per run), runs.csv (one row per run), a table of settings if the study has one, a file of JSON
with all that was found, and figures as SVG and PNG.
Several processes may make the runs of one study in one folder.")]
pub(crate) struct Arguments {
    /// The study file (TOML); with --ablate a scene or sweep file.
    file: PathBuf,
    #[command(flatten)]
    ablate: Ablate,
    /// Share of the labels that may change without an effect that an ablation calls not needed
    /// [default: 0.05].
    #[arg(long, value_name = "SHARE", value_parser = share)]
    tolerance: Option<f64>,
    /// Take away one effect at a time only; else two that matter are taken away at once too.
    #[arg(long)]
    no_pairs: bool,
    /// The results folder [default: results/STUDY/NAME, with the name of the study or command, and
    /// that of the file without .toml].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    workers: Workers,
    #[command(flatten)]
    program: AllowProgram,
    /// Make every run again, whatever the results folder holds.
    #[arg(short, long)]
    force: bool,
    /// Make one of N parts of equal work, in any number of processes on any machines: I/N, or
    /// `auto` for the task of a Slurm array. The last one says what follows.
    #[arg(long, value_name = "I/N", value_parser = values::part)]
    #[arg(conflicts_with_all = ["job", "force"])]
    shard: Option<Shard>,
    /// Make the runs of a line that `phase jobs` printed.
    #[arg(long, value_name = "LINE", conflicts_with = "force")]
    job: Option<Shard>,
    /// Draw no figure.
    #[arg(long)]
    no_plot: bool,
}

fn share(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(share) if share > 0.0 && share <= 1.0 => Ok(share),
        _ => Err("must be a number above 0, and 1 at most".to_owned()),
    }
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let given = [
        ("--tolerance", arguments.tolerance.is_some()),
        ("--no-pairs", arguments.no_pairs),
    ];
    let mut study = arguments
        .ablate
        .load(&arguments.file, arguments.tolerance, &given)?;
    if let Some(comparison) = study.comparison_mut() {
        let (program, sweep) = (&arguments.program, &mut comparison.sweep);
        if program.prepare(sweep, &arguments.file, console)? {
            comparison.choose_runs()?;
        }
    }
    match study {
        AnyStudy::Stability(study) => arguments.run(*study, console),
        AnyStudy::Ablation(study) => arguments.run(*study, console),
        AnyStudy::Accuracy(study) => match &study.subject {
            Subject::Scene(comparison) => arguments.run((&*study, &**comparison), console),
            Subject::Case(settings) => accuracy::run_cases(&study, settings, arguments, console),
        },
    }
}

/// A study of some kind: from the table of its runs a finding and figures follow.
trait Study: Sized {
    /// Which kind.
    const NAME: StudyName;
    /// Names of the figures.
    fn figures(&self) -> Vec<String>;

    /// What is run.
    fn comparison(&self) -> &Comparison;

    /// Says what is not run, and why.
    fn note_skipped(&self, _: &Console) {}

    /// The study with the runs that follow from these rows, if there may be such.
    fn extended(&self, _: &[Option<RunRow>]) -> Result<Option<Self>, Failure> {
        Ok(None)
    }

    /// What follows from the rows of all jobs.
    fn conclude(&self, rows: &[Option<RunRow>]) -> Result<Conclusion, Failure>;
}

/// What follows from the runs of a study.
struct Conclusion {
    /// All of it.
    json: Value,
    /// What is printed.
    text: String,
    /// Writes the table of settings, if the study has one.
    table: Option<Write>,
    figures: Vec<NamedFigure>,
}

/// A figure with the name of its files, or why it cannot be drawn.
type NamedFigure = (String, Result<Svg, PlotError>);

/// Writes a file.
type Write = Box<dyn FnOnce(&Path) -> Result<(), StoreError>>;

impl Arguments {
    fn run<S: Study>(&self, mut study: S, console: &Console) -> Result<Exit, Failure> {
        let place = Place::open(
            self,
            S::NAME,
            &study.figures(),
            Some(study.comparison()),
            console,
        )?;
        study.note_skipped(console);
        let mut table = match self.force {
            true => RunTable::new(study.comparison()),
            false => known_rows(&study, &place)?,
        };
        if let Some(line) = &self.job
            && line.of(&study.comparison().jobs).is_err()
        {
            // Pairs are listed once all runs of single effects are there.
            table.add_records(study.comparison(), &place.folder, self.workers.count())?;
            if let Some(more) = study.extended(&table.rows)? {
                table = known_rows(&more, &place)?;
                study = more;
            }
        }
        let (mut table, mut tally) = place.make(study.comparison(), self, table, console)?;
        let more = match tally.is_whole() && !self.no_pairs {
            true => study.extended(&table.rows)?,
            false => None,
        };
        if more.is_some() && self.job.is_some() {
            tally.print(console);
            console.result("pairs of effects follow: list the jobs again");
            return Ok(answer(tally, None, console));
        }
        if let Some(more) = more {
            let known = known_rows(&more, &place)?;
            let (all, of_all) = place.make(more.comparison(), self, known, console)?;
            (study, table, tally) = (more, all, tally.and(of_all));
        }
        tally.print(console);
        if tally.left_to_others == 0 {
            tell_of_others(&table, &place, console);
            console.file(&place.folder.runs());
        }
        let finding = match tally.is_whole() {
            true => Some(self.keep(S::NAME, study.conclude(&table.rows)?, &place, console)?),
            false => None,
        };
        Ok(answer(tally, finding, console))
    }

    /// Prints what was found and writes its files; returns it as JSON.
    fn keep(
        &self,
        study: StudyName,
        found: Conclusion,
        place: &Place,
        console: &Console,
    ) -> Result<Value, Failure> {
        console.result(&found.text);
        let name = study.name();
        if let Some(write) = found.table {
            let path = place.file(&format!("{name}.csv"));
            write(&path)?;
            console.file(&path);
        }
        let path = place.file(&format!("{name}.json"));
        let bytes = serde_json::to_vec_pretty(&found.json).map_err(Failure::failed)?;
        store::write_atomic(&path, &bytes)?;
        console.file(&path);
        let mut written = Ok(());
        for (name, figure) in found.figures {
            if self.no_plot {
                break;
            }
            let path = |end: &str| place.file(&format!("{name}.{end}"));
            let figure = figure.map_err(Failure::failed);
            let now = figure.and_then(|figure| figures::write(&figure, path, console));
            // One that cannot be drawn does not stop the others.
            written = written.and(now);
        }
        written.map(|()| found.json)
    }
}

/// The rows that the table of a folder has already.
fn known_rows<S: Study>(study: &S, place: &Place) -> Result<RunTable, Failure> {
    RunTable::read(study.comparison(), &place.folder).map_err(Failure::refused)
}

/// Says which rows of the table are not of the study.
fn tell_of_others(table: &RunTable, place: &Place, console: &Console) {
    let (rows, them) = match table.others.len() {
        0 => return,
        1 => ("1 row".to_owned(), "it"),
        rows => (format!("{rows} rows"), "them"),
    };
    console.note(format_args!(
        "{} keeps {rows} of settings, points or seeds that the study does not have; --force drops \
         {them}",
        place.folder.runs().display()
    ));
}

fn answer(tally: Tally, finding: Option<Value>, console: &Console) -> Exit {
    /// What `--json` prints.
    #[derive(Serialize)]
    struct Answer {
        #[serde(flatten)]
        tally: Tally,
        finding: Option<Value>,
        files: Vec<String>,
    }
    let exit = tally.exit();
    console.answer(&Answer {
        tally,
        finding,
        files: console.files(),
    });
    exit
}
