//! The runs of a study of stability.

use super::{Arguments, ForecastAnswer, describe_grid, effects, line, print_forecast};
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::format;
use phase::cost::Leaves;
use phase::dem::timestep::largest_stable;
use phase::grid::Axis;
use phase::study::comparison::Setting;
use phase::study::stability::StabilityStudy;
use serde::Serialize;
use std::path::Path;

/// Says what the study would run and, with a trial, what that costs.
pub(super) fn main(
    study: &StabilityStudy,
    arguments: &Arguments,
    workers: usize,
    console: &Console,
) -> Result<Exit, Failure> {
    let jobs = &study.comparison.jobs;
    let sweep = &study.comparison.settings[0].sweep;
    let spans = Span::all(study);
    console.result(describe(study));
    for span in &spans {
        console.result(line("time step", span.line()));
    }
    let forecast = match arguments.no_trial {
        true => None,
        // A guard may end any run.
        false => Some(print_forecast(
            jobs,
            workers,
            true,
            Leaves::Nothing,
            console,
        )?),
    };
    console.answer(&Answer {
        file: &arguments.file,
        kind: "study",
        title: sweep.title.as_deref(),
        jobs: jobs.len(),
        axes: &sweep.axes,
        integrators: spans,
        spheres: sweep.scene.spheres.count,
        effects: effects(&sweep.scene),
        duration: sweep.scene.time.duration,
        frames: study.frames.0,
        forecast: forecast.map(|forecast| ForecastAnswer::new(&forecast, workers)),
    });
    Ok(Exit::Done)
}

fn describe(study: &StabilityStudy) -> String {
    let sweep = &study.comparison.settings[0].sweep;
    let scene = &sweep.scene;
    let title = sweep.title.as_ref().or(scene.title.as_ref());
    let runs = format::count(study.comparison.jobs.len(), "run");
    let mut lines = describe_grid(title, &format!("a study of stability, {runs}"), &sweep.axes);
    lines.push(line("spheres", scene.spheres.count));
    lines.push(line("effects", effects(scene).join(", ")));
    let (duration, frames) = (scene.time.duration, study.frames.0);
    let text = format!("{duration} s in about {frames} frames, of whole steps");
    lines.push(line("duration", text));
    lines.join("\n")
}

/// How far the steps of an integrator's runs go below and above their limit.
#[derive(Serialize)]
struct Span {
    integrator: String,
    runs: usize,
    /// Least and largest time step over its limit; `None` if nothing limits the step.
    least_ratio: Option<f64>,
    largest_ratio: Option<f64>,
}

impl Span {
    fn all(study: &StabilityStudy) -> Vec<Self> {
        let comparison = &study.comparison;
        let of = |(place, setting): (usize, &Setting)| {
            let own = comparison.jobs_of(place);
            let ratios = own.clone().filter_map(|job| {
                let limit = largest_stable(&job.scene)?;
                Some(job.scene.time.dt / limit.seconds)
            });
            Self {
                integrator: setting.name.clone(),
                runs: own.count(),
                least_ratio: ratios.clone().reduce(f64::min),
                largest_ratio: ratios.reduce(f64::max),
            }
        };
        comparison.settings.iter().enumerate().map(of).collect()
    }

    fn line(&self) -> String {
        let (name, runs) = (&self.integrator, format::count(self.runs, "run"));
        match (self.least_ratio, self.largest_ratio) {
            (Some(least), Some(largest)) => {
                format!("{least:.3} to {largest:.3} of the limit in {runs} ({name})")
            }
            _ => format!("nothing sets a limit in {runs} ({name})"),
        }
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
    integrators: Vec<Span>,
    spheres: usize,
    effects: Vec<String>,
    duration: f64,
    frames: u64,
    forecast: Option<ForecastAnswer>,
}
