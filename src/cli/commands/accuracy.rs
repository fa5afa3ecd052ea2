//! `phase accuracy`: what settings of a scene cost, and how wrong they are.

use super::study::{self, Options, Place, Tally};
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::figures as drawn_figures;
use crate::cli::format;
use phase::plot::accuracy as figures;
use phase::record::{Program, RunRecord};
use phase::store;
use phase::study::accuracy::{self, AccuracyStudy, Evaluation, Subject, write_accuracy};
use phase::study::comparison::{Comparing, Comparison, KnownRuns, Report, read_runs};
use phase::sweep::{Axis, Job, LocalThreads, describe};
use serde::Serialize;
use std::path::PathBuf;

/// Measure what settings of a scene cost in time, and how wrong they are.
///
/// A study climbs ladders of choices: time step, integrator, stiffness, laws, or any other key. It
/// compares every setting with a reference: the numbers of a verification case, the motion at given
/// times, or, where runs are chaotic, labels and order parameters beyond what seeds make of them.
/// It names the cheapest setting that is good enough. Runs whose row is in the table already are
/// not made again.
#[derive(clap::Args)]
#[command(after_help = "\
Example: how large may the time step of a collapse be?
  phase accuracy sweeps/accuracy/collapse.toml

The results folder holds runs.csv (one row per run), accuracy.csv (one row per setting),
accuracy.json (all of it, with the sentence) and figures as SVG and PNG.")]
pub(crate) struct Arguments {
    /// The study file (TOML).
    file: PathBuf,
    #[command(flatten)]
    pub(super) options: Options,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let study = accuracy::load(&arguments.file).map_err(Failure::refused)?;
    let options = &arguments.options;
    let files = (
        &["runs.csv", "accuracy.csv", "accuracy.json"][..],
        &figures::NAMES[..],
    );
    let place = Place::open("accuracy", &arguments.file, options, files, console)?;
    match &study.subject {
        Subject::Scene(comparison) => of_scene(&study, comparison, options, &place, console),
        Subject::Case(settings) => of_case(&study, settings.len(), options, &place, console),
    }
}

fn of_case(
    study: &AccuracyStudy,
    runs: usize,
    options: &Options,
    place: &Place,
    console: &Console,
) -> Result<Exit, Failure> {
    let evaluation = study.run_cases(options.workers(), place.stop);
    let evaluation = evaluation.map_err(Failure::failed)?;
    let mut tally = Tally {
        folder: place.folder.root().to_owned(),
        runs,
        workers: options.workers(),
        ..Tally::default()
    };
    match &evaluation {
        Some(evaluation) => {
            let missing = evaluation.outcomes.iter().filter(|it| it.missing > 0);
            tally.failed = missing.count();
            tally.run_now = runs - tally.failed;
            conclude(study, None, evaluation, options, place, console)?;
        }
        None => {
            tally.left = runs;
            tally.interrupted = true;
        }
    }
    Ok(answer(tally, evaluation.as_ref(), console))
}

fn of_scene(
    study: &AccuracyStudy,
    comparison: &Comparison,
    options: &Options,
    place: &Place,
    console: &Console,
) -> Result<Exit, Failure> {
    let known = known_runs(comparison, options, place)?;
    let (report, tally) = run(comparison, options, place, known, console)?;
    console.file(&Comparing::table(&place.folder));
    let evaluation = (!tally.interrupted).then(|| study.evaluate(comparison, &report.rows));
    if let Some(evaluation) = &evaluation {
        conclude(study, Some(comparison), evaluation, options, place, console)?;
    }
    Ok(answer(tally, evaluation.as_ref(), console))
}

fn answer(tally: Tally, evaluation: Option<&Evaluation>, console: &Console) -> Exit {
    let exit = tally.exit();
    console.answer(&Answer {
        tally,
        evaluation,
        files: console.files(),
    });
    exit
}

/// The runs that the table of a folder has already.
pub(super) fn known_runs(
    comparison: &Comparison,
    options: &Options,
    place: &Place,
) -> Result<KnownRuns, Failure> {
    let table = Comparing::table(&place.folder);
    match options.force {
        true => Ok(KnownRuns::default()),
        false => read_runs(comparison, &table).map_err(Failure::refused),
    }
}

/// Runs what is left of a comparison, and says what became of it.
pub(super) fn run(
    comparison: &Comparison,
    options: &Options,
    place: &Place,
    known: KnownRuns,
    console: &Console,
) -> Result<(Report, Tally), Failure> {
    let KnownRuns { rows, others } = known;
    let ids: std::collections::HashSet<String> = rows.iter().map(|row| row.id.clone()).collect();
    let axes: &[Axis] = comparison.axes();
    let name = |job: &Job| describe(axes, &job.values, job.seed);
    let ended = |job: &Job, record: &RunRecord| {
        let label = comparison
            .measurement
            .measure(record)
            .map(|it| it.label.name);
        format!("{}: {}", label.unwrap_or("not measured"), name(job))
    };
    let is_known = |job: &Job| ids.contains(&job.id);
    study::warn_of_days(comparison, &is_known, options.workers(), console);
    let jobs = &comparison.jobs;
    let (report, seconds) =
        study::with_progress(jobs, &is_known, &name, &ended, console, |watch| {
            let comparing = Comparing {
                comparison,
                folder: &place.folder,
                others: &others,
                backend: &LocalThreads::new(options.workers()),
                wishes: place.wishes(watch),
            };
            comparing.run(rows)
        });
    let report = report.map_err(Failure::failed)?;
    let tally = Tally {
        folder: place.folder.root().to_owned(),
        runs: report.rows.len(),
        done_before: report.known,
        run_now: report.rows.iter().flatten().count() - report.known,
        left: report.left,
        failed: report.failures.len(),
        interrupted: place.is_interrupted(report.left),
        workers: options.workers(),
        seconds,
        cpu_seconds: report.cpu_seconds,
    };
    tally.print(axes, &report.failures, console);
    Ok((report, tally))
}

/// Prints and writes what a study says.
fn conclude(
    study: &AccuracyStudy,
    comparison: Option<&Comparison>,
    evaluation: &Evaluation,
    options: &Options,
    place: &Place,
    console: &Console,
) -> Result<(), Failure> {
    console.result(text(evaluation));
    let table = place.file("accuracy.csv");
    write_accuracy(evaluation, &table).map_err(Failure::failed)?;
    console.file(&table);
    let json = place.file("accuracy.json");
    let bytes = serde_json::to_vec_pretty(evaluation).map_err(Failure::failed)?;
    store::write_atomic(&json, &bytes).map_err(Failure::failed)?;
    console.file(&json);
    if options.no_plot {
        return Ok(());
    }
    let drawn = figures::draw_all(study, comparison, evaluation, &Program::current());
    let mut written = Ok(());
    for (name, figure) in drawn {
        let figure = figure.map_err(Failure::failed);
        let path = |end: &str| place.file(&format!("{name}.{end}"));
        let now = figure.and_then(|figure| drawn_figures::write(&figure, path, console));
        // One that cannot be drawn does not stop the others.
        written = written.and(now);
    }
    written
}

/// A line for every setting, and the sentence.
fn text(evaluation: &Evaluation) -> String {
    let longest = evaluation
        .outcomes
        .iter()
        .map(|it| it.name.chars().count())
        .max();
    let width = longest.unwrap_or(0).max(7);
    let mut lines = vec![format!(
        "{:<width$}  time a run  evaluations  error",
        "setting"
    )];
    for outcome in &evaluation.outcomes {
        lines.push(format!(
            "{:<width$}  {:>10}  {:>11}  {}",
            outcome.name,
            format::short_duration(outcome.cost.cpu_seconds),
            format::with_prefix(outcome.cost.force_evaluations, ""),
            outcome.in_words(evaluation.counted_time)
        ));
        if let Some(note) = &outcome.note {
            lines.push(format!("{:<width$}  {note}", ""));
        }
    }
    for order in evaluation.orders.iter().filter(|it| it.is_clear()) {
        lines.push(format!(
            "order of {} in {}: {}",
            order.method,
            order.key,
            order.order.in_words(2)
        ));
    }
    for it in &evaluation.majorities {
        lines.push(format!(
            "the majority of {} is wrong at {:.1} % of the points",
            format::count(it.seeds, "seed"),
            100.0 * it.chance
        ));
    }
    lines.push(evaluation.finding.sentence.clone());
    lines.join("\n")
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer<'a> {
    #[serde(flatten)]
    tally: Tally,
    evaluation: Option<&'a Evaluation>,
    files: Vec<String>,
}
