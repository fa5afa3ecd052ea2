//! `phase study`: the runs of a study, and what follows from them.

mod ablation;
mod accuracy;
mod runs;
mod stability;

use crate::cli::builds;
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::figures;
use phase::plot::{PlotError, Svg};
use phase::store::{self, StoreError};
use phase::study::ablation::{AblationError, AblationOptions};
use phase::study::comparison::{Comparison, KnownRuns, RunRow, StudyReport, StudyRuns, read_runs};
use phase::study::{AnyStudy, StudyName};
use runs::{Options, Place, Tally};
use serde::Serialize;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Make the runs of a study, and say what follows from them.
///
/// The file names the study (`study = "..."`). `stability` finds where integrators are stable over
/// two keys of a scene. `accuracy` measures what settings of a scene cost in time, and how wrong
/// they are. `ablation` takes each effect of a sweep away by itself, or reduces it to a
/// simpler law; --ablate does so for any scene or sweep. Runs that have a row in the table are not
/// made again.
#[derive(clap::Args)]
#[command(after_help = "\
Examples: where do integrators break in Newton's cradle; how large may the time step of a collapse
be; which effects decide the published diagram?
  phase study sweeps/stability/cradle.toml
  phase study sweeps/accuracy/collapse.toml
  phase study sweeps/theoretical-9x9.toml --ablate --seeds 5

The results folder holds runs.csv (one row per run), runs.makers.csv (which build made each row),
a table of settings if the study has one, a file of JSON with all that was found, and figures as SVG
and PNG.")]
pub(crate) struct Arguments {
    /// The study file (TOML); with --ablate a scene or sweep file.
    file: PathBuf,
    /// Take away the effects of a scene or sweep, one by one: all of them, or those whose names
    /// hold one of these words.
    #[arg(long, value_name = "WORDS", num_args = 0..=1, require_equals = true)]
    #[arg(default_missing_value = "", value_delimiter = ',')]
    ablate: Option<Vec<String>>,
    /// Number of seeds at each point of an ablation [default: those of the sweep, or 5 if it has
    /// fewer].
    #[arg(short, long, value_name = "N", value_parser = three_or_more)]
    seeds: Option<usize>,
    /// Share of the labels that may change without an effect that an ablation calls not needed
    /// [default: 0.05].
    #[arg(long, value_name = "SHARE", value_parser = share)]
    tolerance: Option<f64>,
    /// Take away one effect at a time only; else two that matter are taken away at once too.
    #[arg(long)]
    no_pairs: bool,
    #[command(flatten)]
    options: Options,
}

fn three_or_more(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(number) if (3..=10_000).contains(&number) => Ok(number),
        _ => Err(
            "must be a whole number from 3 to 10000: fewer seeds tell nothing from noise".into(),
        ),
    }
}

fn share(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(share) if share > 0.0 && share <= 1.0 => Ok(share),
        _ => Err("must be a number above 0, and 1 at most".to_owned()),
    }
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    match arguments.load()? {
        AnyStudy::Stability(study) => arguments.run(*study, console),
        AnyStudy::Ablation(study) => arguments.run((*study, !arguments.no_pairs), console),
        AnyStudy::Accuracy(study) => match accuracy::Compared::of(*study) {
            Ok(study) => arguments.run(study, console),
            Err(cases) => cases.run(arguments, console),
        },
    }
}

/// A study of some kind.
trait Study: Sized {
    /// Which kind.
    const NAME: StudyName;
    /// Names of the figures.
    fn figures(&self) -> Vec<String>;

    /// What is run.
    fn comparison(&self) -> &Comparison;

    /// Says what is not run, and why.
    fn note_skipped(&self, _: &Console) {}

    /// The study with more runs, if these rows ask for them.
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
    figures: Vec<(String, Result<Svg, PlotError>)>,
}

/// Writes a file.
type Write = Box<dyn FnOnce(&Path) -> Result<(), StoreError>>;

impl Arguments {
    fn load(&self) -> Result<AnyStudy, Failure> {
        let words = self.ablate.iter().flatten();
        let options = AblationOptions {
            seeds: self.seeds,
            tolerance: self.tolerance.unwrap_or(0.05),
            effects: words.filter(|it| !it.is_empty()).cloned().collect(),
        };
        let study = AnyStudy::load(&self.file, self.ablate.is_some(), options);
        let study = study.map_err(|error: AblationError| Failure::refused(error))?;
        let given = [
            ("--seeds", self.seeds.is_some()),
            ("--tolerance", self.tolerance.is_some()),
            ("--no-pairs", self.no_pairs),
        ];
        match given.iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) if !matches!(study, AnyStudy::Ablation(_)) => {
                Err(Failure::refused(format_args!(
                    "{option} is of ablations; this study says it in {}",
                    self.file.display()
                )))
            }
            _ => Ok(study),
        }
    }

    /// The folder of a study with figures of these names.
    fn place(
        &self,
        study: StudyName,
        figures: &[String],
        console: &Console,
    ) -> Result<Place, Failure> {
        let name = study.name();
        let tables = ["runs", "runs.makers", name].map(|it| format!("{it}.csv"));
        let files = tables.into_iter().chain([format!("{name}.json")]);
        Place::open(name, &self.file, &self.options, files, figures, console)
    }

    fn run<S: Study>(&self, mut study: S, console: &Console) -> Result<Exit, Failure> {
        let place = self.place(S::NAME, &study.figures(), console)?;
        study.note_skipped(console);
        let known = match self.options.force {
            true => KnownRuns::default(),
            false => known_runs(&study, &place)?,
        };
        let (mut report, mut tally) = self.make(&study, known, &place, console)?;
        if tally.left == 0
            && let Some(more) = study.extended(&report.rows)?
        {
            let known = known_runs(&more, &place)?;
            (report, tally) = self.make(&more, known, &place, console)?;
            study = more;
        }
        console.file(&StudyRuns::table(&place.folder));
        let finding = match tally.left {
            0 => Some(self.keep(S::NAME, study.conclude(&report.rows)?, &place, console)?),
            _ => None,
        };
        Ok(answer(tally, finding, console))
    }

    /// Makes what is left of the runs, and says what became of them.
    fn make<S: Study>(
        &self,
        study: &S,
        known: KnownRuns,
        place: &Place,
        console: &Console,
    ) -> Result<(StudyReport, Tally), Failure> {
        let makers = known.rows.iter().map(|row| known.makers.get(&row.id));
        builds::tell_of_others("row", makers, console);
        runs::make(study.comparison(), &self.options, place, known, console)
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
            write(&path).map_err(Failure::failed)?;
            console.file(&path);
        }
        let path = place.file(&format!("{name}.json"));
        let bytes = serde_json::to_vec_pretty(&found.json).map_err(Failure::failed)?;
        store::write_atomic(&path, &bytes).map_err(Failure::failed)?;
        console.file(&path);
        let mut written = Ok(());
        for (name, figure) in found.figures {
            if self.options.no_plot {
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

/// The runs that the table of a folder has already.
fn known_runs<S: Study>(study: &S, place: &Place) -> Result<KnownRuns, Failure> {
    let table = StudyRuns::table(&place.folder);
    read_runs(study.comparison(), &table).map_err(Failure::refused)
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
