//! What a study would run.

use super::answer::{AxisAnswer, ForecastAnswer};
use super::describe::{describe_grid, effects, line};
use super::{Arguments, TRIAL_TIME, print_forecast, program, start_of_trial};
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::{forecast, format};
use phase::dem::timestep::largest_stable;
use phase::study::AnyStudy;
use phase::study::accuracy::{AccuracyStudy, CaseSetting, Subject};
use phase::study::comparison::{Comparison, Setting};
use serde::Serialize;
use std::path::Path;

/// Says what the study would run and, with a trial, what that costs.
pub(super) fn main(
    study: &AnyStudy,
    arguments: &Arguments,
    workers: usize,
    console: &Console,
) -> Result<Exit, Failure> {
    let (title, comparison) = match study {
        AnyStudy::Stability(study) => (None, &study.comparison),
        AnyStudy::Ablation(study) => (None, &study.comparison),
        AnyStudy::Accuracy(study) => match &study.subject {
            Subject::Scene(comparison) => (study.title.as_ref(), &**comparison),
            Subject::Case(settings) => {
                check_cases(study, settings, arguments, console);
                return Ok(Exit::Done);
            }
        },
    };
    let (sweep, scene) = (&comparison.sweep, &comparison.sweep.scene);
    let title = title.or(sweep.title.as_ref()).or(scene.title.as_ref());
    let kind = match study {
        AnyStudy::Ablation(_) => "an ablation".to_owned(),
        _ => format!("a study of {}", study.name().name()),
    };
    let runs = format!("{kind}, {}", describe_runs(comparison));
    console.result(describe_grid(title, &runs, comparison.axes()).join("\n"));
    let is_of_programs = program::runs_all(sweep);
    match is_of_programs {
        true => program::describe_programs(sweep, &comparison.jobs[..1], console),
        false => {
            console.result(line("spheres", scene.spheres.count));
            console.result(line("effects", effects(scene).join(", ")));
        }
    }
    let settings = SettingAnswer::all(comparison);
    let reference = matches!(study, AnyStudy::Accuracy(_)).then_some(comparison.reference);
    for (place, setting) in settings.iter().enumerate() {
        console.result(line("setting", setting.line(Some(place) == reference)));
    }
    let skipped = match study {
        AnyStudy::Ablation(study) => &study.skipped[..],
        _ => &[],
    };
    for it in skipped {
        console.result(line(
            "not tried",
            format_args!("{}: {}", it.name, it.reason),
        ));
    }
    let forecast = match arguments.no_trial {
        true => None,
        false if is_of_programs => {
            console.result(line("forecast", program::NO_FORECAST));
            None
        }
        false => {
            start_of_trial(console);
            let forecast = forecast::of_settings(comparison, workers, TRIAL_TIME)?;
            print_forecast(&forecast, &comparison.jobs, workers, true, console);
            Some(forecast)
        }
    };
    console.answer(&Answer {
        file: &arguments.file,
        kind: "study",
        study: study.name().name(),
        title: title.map(String::as_str),
        jobs: comparison.jobs.len(),
        axes: comparison.axes().iter().map(AxisAnswer::of).collect(),
        seeds: &sweep.seeds,
        settings,
        skipped: skipped.iter().map(|it| it.name.as_str()).collect(),
        spheres: (!is_of_programs).then_some(scene.spheres.count),
        effects: effects(scene),
        forecast: forecast.map(|it| ForecastAnswer::new(&it, workers)),
    });
    Ok(Exit::Done)
}

/// Says which settings of a verification case are simulated.
fn check_cases(
    study: &AccuracyStudy,
    settings: &[CaseSetting],
    arguments: &Arguments,
    console: &Console,
) {
    let title = study.title.as_deref();
    let runs = format::count(settings.len(), "run");
    let names: Vec<&str> = settings.iter().map(|it| it.name.as_str()).collect();
    console.result(match title {
        Some(title) => format!("{title}: a study of accuracy, {runs}"),
        None => format!("a study of accuracy, {runs}"),
    });
    console.result(line("settings", names.join(", ")));
    console.answer(&Answer {
        file: &arguments.file,
        kind: "study",
        study: "accuracy",
        title,
        jobs: settings.len(),
        axes: Vec::new(),
        seeds: &[],
        settings: names.into_iter().map(SettingAnswer::of_case).collect(),
        skipped: Vec::new(),
        spheres: None,
        effects: Vec::new(),
        forecast: None,
    });
}

fn describe_runs(comparison: &Comparison) -> String {
    format!(
        "{} with {} at {}, {} in all",
        format::count(comparison.settings.len(), "setting"),
        format::count(comparison.seeds(), "seed"),
        format::count(comparison.points(), "point"),
        format::count(comparison.jobs.len(), "run")
    )
}

/// A setting, and how far the steps of its runs go below and above their limit.
#[derive(Serialize)]
struct SettingAnswer<'a> {
    name: &'a str,
    note: Option<&'a str>,
    runs: usize,
    /// Least and largest time step over its limit; none where nothing limits the step.
    least_ratio: Option<f64>,
    largest_ratio: Option<f64>,
}

impl<'a> SettingAnswer<'a> {
    fn all(comparison: &'a Comparison) -> Vec<Self> {
        let of = |(place, setting): (usize, &'a Setting)| {
            let own = comparison.jobs_of(place);
            let ratios = own.clone().filter_map(|job| {
                let scene = job.scene();
                Some(scene.time.dt / largest_stable(&scene)?.seconds)
            });
            Self {
                name: &setting.name,
                note: setting.note.as_deref(),
                runs: own.count(),
                least_ratio: ratios.clone().reduce(f64::min),
                largest_ratio: ratios.reduce(f64::max),
            }
        };
        comparison.settings.iter().enumerate().map(of).collect()
    }

    fn of_case(name: &'a str) -> Self {
        Self {
            name,
            note: None,
            runs: 1,
            least_ratio: None,
            largest_ratio: None,
        }
    }

    fn line(&self, is_reference: bool) -> String {
        let runs = format::count(self.runs, "run");
        let reference = match is_reference {
            true => " (the reference)",
            false => "",
        };
        let steps = match (self.least_ratio, self.largest_ratio) {
            (Some(least), Some(largest)) if least == largest => {
                format!("step at {least:.3} of its limit")
            }
            (Some(least), Some(largest)) => {
                format!("steps at {least:.3} to {largest:.3} of their limits")
            }
            _ => "nothing limits the step".to_owned(),
        };
        let note = self.note.map_or_else(String::new, |it| format!("; {it}"));
        format!("{}{reference}: {runs}, {steps}{note}", self.name)
    }
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer<'a> {
    file: &'a Path,
    kind: &'static str,
    study: &'static str,
    title: Option<&'a str>,
    jobs: usize,
    axes: Vec<AxisAnswer<'a>>,
    seeds: &'a [u64],
    settings: Vec<SettingAnswer<'a>>,
    /// What an ablation does not try.
    skipped: Vec<&'a str>,
    spheres: Option<usize>,
    effects: Vec<String>,
    forecast: Option<ForecastAnswer>,
}
