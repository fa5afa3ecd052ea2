//! What a study of stability would run.

use super::{Arguments, ForecastAnswer, describe_grid, effects, line, print_forecast};
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::format;
use phase::cost::Leaves;
use phase::scene::Integrator;
use phase::study::stability::{Study, Theory};
use phase::sweep::{Axis, Job};
use serde::Serialize;
use std::path::Path;

/// Says what the study would run and, with a trial, what that costs.
pub(super) fn main(
    study: &Study,
    arguments: &Arguments,
    workers: usize,
    console: &Console,
) -> Result<Exit, Failure> {
    let jobs = study.jobs().map_err(Failure::refused)?;
    let spans = Span::all(study, &jobs);
    console.result(describe(study, jobs.len()));
    for span in &spans {
        console.result(line("time step", span.line()));
    }
    let forecast = match arguments.no_trial {
        true => None,
        // A guard may end any run.
        false => Some(print_forecast(
            &jobs,
            workers,
            true,
            Leaves::Nothing,
            console,
        )?),
    };
    console.answer(&Answer {
        file: &arguments.file,
        kind: "study",
        title: study.title.as_deref(),
        jobs: jobs.len(),
        axes: &study.axes,
        integrators: spans,
        spheres: study.scene.spheres.count,
        effects: effects(&study.scene),
        duration: study.scene.time.duration,
        frames: study.frames,
        forecast: forecast.map(|forecast| ForecastAnswer::new(&forecast, workers)),
    });
    Ok(Exit::Done)
}

fn describe(study: &Study, runs: usize) -> String {
    let scene = &study.scene;
    let title = study.title.as_ref().or(scene.title.as_ref());
    let runs = format!("a study of stability, {}", format::count(runs, "run"));
    let mut lines = describe_grid(title, &runs, &study.axes);
    lines.push(line("spheres", scene.spheres.count));
    lines.push(line("effects", effects(scene).join(", ")));
    let (duration, frames) = (scene.time.duration, study.frames);
    let text = format!("{duration} s in about {frames} frames, of whole steps");
    lines.push(line("duration", text));
    lines.join("\n")
}

/// How far the steps of an integrator's runs go below and above their limit.
#[derive(Serialize)]
struct Span {
    integrator: &'static str,
    runs: usize,
    /// Least and largest time step over its limit; none where nothing limits the step.
    least_ratio: Option<f64>,
    largest_ratio: Option<f64>,
}

impl Span {
    fn all(study: &Study, jobs: &[Job]) -> Vec<Self> {
        let of = |&integrator: &Integrator| {
            let own = jobs
                .iter()
                .filter(move |job| job.scene.time.integrator == integrator);
            let ratios = own.clone().filter_map(|job| {
                let limit = Theory::of(&job.scene).decisive?;
                Some(job.scene.time.dt / limit.seconds)
            });
            Self {
                integrator: integrator.name(),
                runs: own.count(),
                least_ratio: ratios.clone().reduce(f64::min),
                largest_ratio: ratios.reduce(f64::max),
            }
        };
        study.integrators.iter().map(of).collect()
    }

    fn line(&self) -> String {
        let (name, runs) = (self.integrator, format::count(self.runs, "run"));
        match (self.least_ratio, self.largest_ratio) {
            (Some(least), Some(largest)) => {
                format!("{least:.3} to {largest:.3} of the limit in {runs} ({name})")
            }
            _ => format!("nothing sets a limit in {runs} ({name})"),
        }
    }
}

/// What `--json` prints.
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
