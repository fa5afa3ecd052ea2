//! `phase stability`: where integrators are stable over two keys of a scene.

use super::study::{self, Place, Tally};
use crate::cli::builds;
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::figures;
use phase::plot::stability as figure;
use phase::record::{Program, RunRecord};
use phase::scene::Integrator;
use phase::study::stability::{self, Label, Report, Row, Study, Trials};
use phase::sweep::{Job, LocalThreads, Wishes, describe};
use serde::Serialize;
use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

/// Try integrators over two keys of a scene, such as time step and stiffness: a phase diagram of
/// the numerics.
///
/// Every point is labelled stable, energy-gain, lost-sphere or not-a-number, and the figure has the
/// theoretical limit of the time step over it. The step may be above the limit at which scenes are
/// refused. Runs whose row is in the table already are not made again.
#[derive(clap::Args)]
#[command(after_help = "\
Example: Newton's cradle, all integrators, time step against stiffness
  phase stability sweeps/stability/cradle.toml

The results folder holds stability.csv (one row per run), stability.makers.csv (which build made
each row) and the figure as SVG and PNG.")]
pub(crate) struct Arguments {
    /// The study file (TOML).
    file: PathBuf,
    #[command(flatten)]
    pub(super) options: study::Options,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let study = stability::load(&arguments.file).map_err(Failure::refused)?;
    let jobs = study.jobs().map_err(Failure::refused)?;
    let options = &arguments.options;
    let files = (
        &["stability.csv", "stability.makers.csv"][..],
        &["stability"][..],
    );
    let place = Place::open("stability", &arguments.file, options, files, console)?;
    let table = place.file("stability.csv");
    let known = match options.force {
        true => Vec::new(),
        false => stability::read_stability(&study.axes, &table).map_err(Failure::refused)?,
    };
    refuse_to_lose(&known, &jobs, &table)?;
    let trials = Trials {
        study: &study,
        jobs: &jobs,
        table: &table,
        backend: &LocalThreads::new(options.workers()),
        wishes: place.wishes(&|_| {}),
    };
    let (report, seconds) = run(&trials, known, console)?;
    let tried = Tried::all(&study, &report.rows);
    let tally = Tally {
        folder: place.folder.root().to_owned(),
        runs: jobs.len(),
        done_before: report.known,
        run_now: report.rows.len() - report.known,
        left: report.left,
        failed: report.failures.len(),
        interrupted: place.is_interrupted(report.left),
        workers: options.workers(),
        seconds,
        cpu_seconds: report.cpu_seconds,
    };
    tally.print(&study.axes, &report.failures, console);
    for tried in &tried {
        console.result(tried.line());
    }
    console.file(&table);
    if !tally.interrupted && !options.no_plot {
        draw(&study, &report.rows, &place, console)?;
    }
    let exit = tally.exit();
    console.answer(&Answer {
        tally,
        integrators: tried,
        files: console.files(),
    });
    Ok(exit)
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer {
    #[serde(flatten)]
    tally: Tally,
    integrators: Vec<Tried>,
    files: Vec<String>,
}

/// How an integrator did.
#[derive(Serialize)]
struct Tried {
    integrator: &'static str,
    /// Number of runs by label.
    labels: BTreeMap<&'static str, usize>,
    /// Least step over its limit of a run that is not stable.
    all_stable_below: Option<f64>,
    /// Largest step over its limit of a stable run.
    none_stable_above: Option<f64>,
}

impl Tried {
    fn all(study: &Study, rows: &[Row]) -> Vec<Self> {
        let of = |&integrator: &Integrator| {
            let own = rows.iter().filter(|row| row.integrator == integrator);
            Self::of(integrator, own.collect())
        };
        study.integrators.iter().map(of).collect()
    }

    fn of(integrator: Integrator, rows: Vec<&Row>) -> Self {
        let mut labels = BTreeMap::new();
        for row in &rows {
            *labels.entry(row.label.name()).or_default() += 1;
        }
        let ratios = |stable: bool| {
            let chosen = rows
                .iter()
                .filter(move |row| (row.label == Label::Stable) == stable);
            chosen.filter_map(|row| row.limit.as_ref().map(|limit| limit.0))
        };
        Self {
            integrator: integrator.name(),
            labels,
            all_stable_below: ratios(false).reduce(f64::min),
            none_stable_above: ratios(true).reduce(f64::max),
        }
    }

    fn line(&self) -> String {
        let counts = Label::ALL.into_iter().filter_map(|label| {
            let count = self.labels.get(label.name())?;
            Some(format!("{count} {}", label.name()))
        });
        let mut text = format!(
            "{:<20} {}",
            self.integrator,
            counts.collect::<Vec<_>>().join(", ")
        );
        match (self.all_stable_below, self.none_stable_above) {
            (Some(below), Some(above)) => {
                text += &format!(
                    "; the first that is not stable is at {below:.3} of the limit, the last that \
                     is at {above:.3}"
                );
            }
            (None, Some(above)) => text += &format!(", up to {above:.3} of the limit"),
            _ => {}
        }
        text
    }
}

/// Refuses a table with rows that this study would not write again.
fn refuse_to_lose(known: &[Row], jobs: &[Job], table: &Path) -> Result<(), Failure> {
    let own: HashSet<&str> = jobs.iter().map(|job| job.id.as_str()).collect();
    let others = known.iter().filter(|row| !own.contains(row.id.as_str()));
    match others.count() {
        0 => Ok(()),
        lost => Err(Failure::refused(format_args!(
            "{}: {} of another study would be lost; choose another folder with --out, or write the \
             table anew with --force",
            table.display(),
            crate::cli::format::count(lost, "row")
        ))),
    }
}

/// Runs what is left of a study; and how long that took (s).
fn run(trials: &Trials<'_>, known: Vec<Row>, console: &Console) -> Result<(Report, f64), Failure> {
    let is_known = |job: &Job| known.iter().any(|row| row.id == job.id);
    let makers = stability::read_makers(trials.table).map_err(Failure::refused)?;
    let done = trials.jobs.iter().filter(|job| is_known(job));
    builds::tell_of_others("row", done.map(|job| makers.get(&job.id)), console);
    let name = |job: &Job| {
        let point = describe(&trials.study.axes, &job.values, job.seed);
        format!("{}, {point}", job.scene.time.integrator.name())
    };
    let ended = |job: &Job, record: &RunRecord| {
        let row = trials.study.row(job, record);
        format!("{}: {}", row.label.name(), name(job))
    };
    let rows = known.clone();
    let (report, seconds) =
        study::with_progress(trials.jobs, &is_known, &name, &ended, console, |watch| {
            let trials = Trials {
                wishes: Wishes {
                    watch,
                    ..trials.wishes
                },
                ..*trials
            };
            trials.run(rows)
        });
    Ok((report.map_err(Failure::failed)?, seconds))
}

fn draw(study: &Study, rows: &[Row], place: &Place, console: &Console) -> Result<(), Failure> {
    let figure = figure::draw(study, rows, &Program::current()).map_err(Failure::failed)?;
    figures::write(
        &figure,
        |end| place.file(&format!("stability.{end}")),
        console,
    )
}
