//! The runs of a study of accuracy.

use super::{Arguments, ForecastAnswer, TRIAL_TIME, describe_grid, effects, line};
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::{forecast, format};
use phase::grid::Axis;
use phase::study::accuracy::{AccuracyStudy, Subject};
use phase::study::comparison::Comparison;
use serde::Serialize;
use std::path::Path;

/// Says what the study would run and, with a trial, what that costs.
pub(super) fn main(
    study: &AccuracyStudy,
    arguments: &Arguments,
    workers: usize,
    console: &Console,
) -> Result<Exit, Failure> {
    let comparison = match &study.subject {
        Subject::Scene(comparison) => comparison,
        Subject::Case(settings) => {
            let runs = format::count(settings.len(), "run");
            let names: Vec<&str> = settings.iter().map(|it| it.name.as_str()).collect();
            console.result(match &study.title {
                Some(title) => format!("{title}: a study of accuracy, {runs}"),
                None => format!("a study of accuracy, {runs}"),
            });
            console.result(line("settings", names.join(", ")));
            console.answer(&Answer::new(study, &names, &[], settings.len(), arguments));
            return Ok(Exit::Done);
        }
    };
    describe(study, comparison, console);
    let forecast = match arguments.no_trial {
        true => None,
        false => {
            console.note("running the first part of a few jobs ...");
            let forecast = forecast::of_settings(comparison, workers, TRIAL_TIME)?;
            let time = format::duration(forecast.seconds);
            let workers = format::count(workers.min(comparison.jobs.len()), "worker");
            console.result(line(
                "time",
                format_args!("at most about {time} with {workers}"),
            ));
            Some(forecast)
        }
    };
    let names: Vec<&str> = comparison
        .settings
        .iter()
        .map(|it| it.name.as_str())
        .collect();
    let mut answer = Answer::new(
        study,
        &names,
        comparison.axes(),
        comparison.jobs.len(),
        arguments,
    );
    answer.forecast = forecast.map(|it| ForecastAnswer::new(&it, workers));
    console.answer(&answer);
    Ok(Exit::Done)
}

fn describe(study: &AccuracyStudy, comparison: &Comparison, console: &Console) {
    let runs = format!(
        "a study of accuracy, {} with {} at {}, {} in all",
        format::count(comparison.settings.len(), "setting"),
        format::count(comparison.seeds(), "seed"),
        format::count(comparison.points(), "point"),
        format::count(comparison.jobs.len(), "run")
    );
    console.result(describe_grid(study.title.as_ref(), &runs, comparison.axes()).join("\n"));
    if let Some(first) = comparison.settings.first() {
        console.result(line("effects", effects(&first.sweep.scene).join(", ")));
    }
    for (place, setting) in comparison.settings.iter().enumerate() {
        let mut text = setting.name.clone();
        if place == comparison.reference {
            text += " (the reference)";
        }
        if let Some(note) = &setting.note {
            text += &format!("; {note}");
        }
        console.result(line("setting", text));
    }
}

/// The `--json` result.
#[derive(Serialize)]
struct Answer<'a> {
    file: &'a Path,
    kind: &'static str,
    title: Option<&'a str>,
    jobs: usize,
    axes: &'a [Axis],
    settings: Vec<&'a str>,
    forecast: Option<ForecastAnswer>,
}

impl<'a> Answer<'a> {
    fn new(
        study: &'a AccuracyStudy,
        settings: &[&'a str],
        axes: &'a [Axis],
        jobs: usize,
        arguments: &'a Arguments,
    ) -> Self {
        Self {
            file: &arguments.file,
            kind: "study",
            title: study.title.as_deref(),
            jobs,
            axes,
            settings: settings.to_vec(),
            forecast: None,
        }
    }
}
