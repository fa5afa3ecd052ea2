//! Studies of accuracy.

use super::runs::{Place, Tally};
use super::{Arguments, Conclusion, NamedFigure, Study, answer};
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::format;
use phase::plot::{self, PlotErrorKind, StudyResult};
use phase::record::Program;
use phase::study::StudyName;
use phase::study::accuracy::{AccuracyStudy, CaseSetting, Evaluation, write_accuracy};
use phase::study::comparison::{Comparison, RunRow};

/// A study of settings of a scene.
impl Study for (&AccuracyStudy, &Comparison) {
    const NAME: StudyName = StudyName::Accuracy;

    fn figures(&self) -> Vec<String> {
        let times = self.0.step_time.iter().map(|x| format!("step-time-{x}"));
        FIGURES
            .map(str::to_owned)
            .into_iter()
            .chain(times)
            .collect()
    }

    fn comparison(&self) -> &Comparison {
        self.1
    }

    fn conclude(&self, rows: &[Option<RunRow>]) -> Result<Conclusion, Failure> {
        let (study, comparison) = self;
        let draws_map = !comparison.axes().is_empty() && comparison.seeds() > 1;
        let names = match draws_map {
            true => &FIGURES[..],
            false => &FIGURES[..1],
        };
        let mut found = conclusion(study, names, study.evaluate(comparison, rows))?;
        let times = study.step_time.iter().map(|x| {
            let result = StudyResult::StepTimes(comparison, rows, x);
            let drawn = plot::draw("step-time", (result, &Program::current()));
            (format!("step-time-{x}"), drawn)
        });
        found.figures.extend(times.filter(has_something));
        Ok(found)
    }
}

/// The figures of every study: error against time, and where labels change.
const FIGURES: [&str; 2] = ["work-precision", "label-changes"];

/// Whether a figure shows anything: of some nothing can be drawn, as no error is above zero.
fn has_something((_, figure): &NamedFigure) -> bool {
    !matches!(figure, Err(error) if error.kind() == PlotErrorKind::Nothing)
}

/// Simulates the settings of a verification case: runs that leave no row.
pub(super) fn run_cases(
    study: &AccuracyStudy,
    settings: &[CaseSetting],
    arguments: &Arguments,
    console: &Console,
) -> Result<Exit, Failure> {
    let (name, figures) = (StudyName::Accuracy, &FIGURES[..1]);
    let names: Vec<String> = figures.iter().map(|&it| it.to_owned()).collect();
    let place = Place::open(arguments, name, &names, None, console)?;
    let workers = arguments.workers.count();
    let evaluation = study.run_cases(workers, place.stop);
    let mut tally = Tally {
        folder: place.folder.root().to_owned(),
        runs: settings.len(),
        workers,
        ..Tally::default()
    };
    let Some(evaluation) = evaluation? else {
        tally.left = settings.len();
        tally.interrupted = true;
        return Ok(answer(tally, None, console));
    };
    let missing = evaluation.outcomes.iter().filter(|it| it.missing > 0);
    tally.failed = missing.count();
    tally.run_now = settings.len() - tally.failed;
    let found = conclusion(study, figures, evaluation)?;
    let found = arguments.keep(name, found, &place, console)?;
    Ok(answer(tally, Some(found), console))
}

/// What follows from an evaluation, with these figures of it.
fn conclusion(
    study: &AccuracyStudy,
    figures: &[&str],
    evaluation: Evaluation,
) -> Result<Conclusion, Failure> {
    let result = StudyResult::Accuracy(study, &evaluation);
    let figures = figures.iter().map(|&name| {
        let drawn = plot::draw(name, (result, &Program::current()));
        (name.to_owned(), drawn)
    });
    Ok(Conclusion {
        json: serde_json::to_value(&evaluation).map_err(Failure::failed)?,
        text: text(&evaluation),
        figures: figures.filter(has_something).collect(),
        table: Some(Box::new(move |path| write_accuracy(&evaluation, path))),
    })
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
