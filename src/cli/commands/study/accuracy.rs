//! Studies of accuracy.

use super::runs::Tally;
use super::{Arguments, Conclusion, Study, answer};
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::format;
use phase::plot::accuracy as figures;
use phase::record::Program;
use phase::study::StudyName;
use phase::study::accuracy::{AccuracyStudy, Evaluation, Subject, write_accuracy};
use phase::study::comparison::{Comparison, RunRow};

/// A study of settings of a scene.
pub(super) struct Compared {
    study: AccuracyStudy,
    comparison: Box<Comparison>,
}

/// A study of settings of a verification case.
pub(super) struct Cases {
    study: AccuracyStudy,
    settings: usize,
}

impl Compared {
    /// The study; or one of a case.
    pub(super) fn of(study: AccuracyStudy) -> Result<Self, Cases> {
        match study.subject.clone() {
            Subject::Scene(comparison) => Ok(Self { study, comparison }),
            Subject::Case(settings) => Err(Cases {
                study,
                settings: settings.len(),
            }),
        }
    }
}

impl Study for Compared {
    const NAME: StudyName = StudyName::Accuracy;

    fn figures(&self) -> Vec<String> {
        figures::names(&self.study)
    }

    fn comparison(&self) -> &Comparison {
        &self.comparison
    }

    fn conclude(&self, rows: &[Option<RunRow>]) -> Result<Conclusion, Failure> {
        let evaluation = self.study.evaluate(&self.comparison, rows);
        conclusion(&self.study, Some((&self.comparison, rows)), evaluation)
    }
}

impl Cases {
    /// Simulates the settings: runs that leave no row.
    pub(super) fn run(&self, arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
        let options = &arguments.options;
        let names = figures::names(&self.study);
        let place = arguments.place(Compared::NAME, &names, console)?;
        let evaluation = self.study.run_cases(options.workers(), place.stop);
        let mut tally = Tally {
            folder: place.folder.root().to_owned(),
            runs: self.settings,
            workers: options.workers(),
            ..Tally::default()
        };
        let Some(evaluation) = evaluation.map_err(Failure::failed)? else {
            tally.left = self.settings;
            tally.interrupted = true;
            return Ok(answer(tally, None, console));
        };
        tally.failed = evaluation
            .outcomes
            .iter()
            .filter(|it| it.missing > 0)
            .count();
        tally.run_now = self.settings - tally.failed;
        let found = conclusion(&self.study, None, evaluation)?;
        let found = arguments.keep(Compared::NAME, found, &place, console)?;
        Ok(answer(tally, Some(found), console))
    }
}

fn conclusion(
    study: &AccuracyStudy,
    comparison: Option<(&Comparison, &[Option<RunRow>])>,
    evaluation: Evaluation,
) -> Result<Conclusion, Failure> {
    Ok(Conclusion {
        json: serde_json::to_value(&evaluation).map_err(Failure::failed)?,
        text: text(&evaluation),
        figures: figures::draw_all(study, comparison, &evaluation, &Program::current()),
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
