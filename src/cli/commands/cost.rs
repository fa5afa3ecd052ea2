//! `phase cost`: what each part of a run costs.

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::values;
use crate::cli::{format, job, kind};
use phase::cost::{PartCost, SweepCost, TriedJob};
use phase::grid::{Axis, describe};
use phase::record::Outcome;
use phase::scene::FileKind;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Measure what each effect and each part of the engine costs in a scene or sweep.
///
/// Runs the file for some seconds of processor time, without a record, and extrapolates to the
/// whole run. The clock is read between the parts in one step out of 16 to 256. In a sweep the jobs
/// at the corners and in the middle of the grid are run, one after the other; each represents the
/// jobs nearest to it.
#[derive(clap::Args)]
#[command(after_help = "\
Example: where the time goes in the realistic tank
  phase cost sweeps/scenes/realistic.toml")]
pub(crate) struct Arguments {
    /// The scene or sweep file (TOML).
    file: PathBuf,
    /// Processor time for all runs together (s); each runs for at least one frame.
    #[arg(long, value_name = "SECONDS", default_value = "10", value_parser = values::seconds)]
    seconds: Duration,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let (sweep, kind) = kind::load_scene_or_sweep(&arguments.file)?;
    let jobs = sweep.jobs()?;
    let unit = job::unit_of(&jobs);
    let seconds = format::duration(arguments.seconds.as_secs_f64());
    console.note(format_args!("measuring for up to about {seconds} ..."));
    let cost = SweepCost::measure(&jobs, arguments.seconds)?;
    for tried in &cost.tried {
        console.result(describe_tried(tried, &sweep.axes, jobs.len(), unit));
    }
    print_parts(&cost, unit, console);
    let about = match cost.tried.iter().all(|tried| tried.cost.whole) && jobs.len() == 1 {
        true => "the run took",
        false if jobs.iter().any(|job| job.scene().has_flow()) => "the whole takes at most about",
        false => "the whole takes about",
    };
    console.result(format_args!(
        "{about} {} of processor time for {}",
        format::duration(cost.total()),
        format::work(cost.work() as f64, unit)
    ));
    console.answer(&Answer::new(
        arguments,
        kind,
        jobs.len(),
        &cost,
        &sweep.axes,
    ));
    Ok(Exit::Done)
}

/// How much of a job was run, and what it represents.
fn describe_tried(tried: &TriedJob<'_>, axes: &[Axis], jobs: usize, unit: &str) -> String {
    let cost = &tried.cost;
    let extent = match (&cost.record.outcome, cost.whole) {
        (Outcome::Unstable(instability), _) => {
            format!("a run that became unstable ({instability})")
        }
        (_, true) => "the whole run".to_owned(),
        (_, false) => "the first part of the run".to_owned(),
    };
    let what = format!(
        "{}, {} in {extent}",
        format::count(cost.frames as usize, "frame"),
        format::work(cost.work as f64, unit)
    );
    if jobs == 1 {
        return what;
    }
    format!(
        "{}: {what}; {:.1} ns per {}, represents {}",
        describe(axes, &tried.job.values, tried.job.seed),
        1e9 * cost.total() / cost.work.max(1) as f64,
        unit.trim_end_matches('s'),
        format::count(tried.jobs, "job")
    )
}

fn print_parts(cost: &SweepCost<'_>, unit: &str, console: &Console) {
    console.result(format_args!(
        "  {:<20} {:>18} {:>9}",
        "part",
        format!("ns per {}", unit.trim_end_matches('s')),
        "share"
    ));
    for row in rows(cost) {
        match row.present {
            true => console.result(format_args!(
                "  {:<20} {:>18.2} {:>6.1} %",
                row.part,
                row.nanoseconds,
                100.0 * row.share
            )),
            false => console.result(format_args!("  {:<20} {:>18}", row.part, "absent")),
        }
    }
    console.result(format_args!(
        "  {:<20} {:>18.2} {:>6.1} %",
        "total",
        1e9 * cost.total() / cost.work().max(1) as f64,
        100.0
    ));
}

/// The `--json` result.
#[derive(Serialize)]
struct Answer<'a> {
    file: &'a Path,
    kind: &'static str,
    jobs: usize,
    sphere_steps: u64,
    cpu_seconds: f64,
    nanoseconds: f64,
    parts: Vec<Row>,
    tried: Vec<TriedAnswer>,
}

/// The cost of a part.
#[derive(Serialize)]
struct Row {
    part: &'static str,
    /// Whether any job has it.
    present: bool,
    /// Per sphere and step (ns).
    nanoseconds: f64,
    /// Share of the total.
    share: f64,
}

/// A job that was run for it.
#[derive(Serialize)]
struct TriedAnswer {
    point: BTreeMap<String, Value>,
    seed: u64,
    stands_for: usize,
    whole: bool,
    /// Whether a guard ended it.
    unstable: bool,
    frames: u64,
    sphere_steps: u64,
    cpu_seconds: f64,
}

fn rows(cost: &SweepCost<'_>) -> Vec<Row> {
    let total = cost.total();
    let work = cost.work().max(1) as f64;
    let row = |part: &PartCost| Row {
        part: part.name,
        present: part.is_present,
        nanoseconds: 1e9 * part.seconds / work,
        share: part.seconds / total,
    };
    cost.parts().iter().map(row).collect()
}

impl<'a> Answer<'a> {
    fn new(
        arguments: &'a Arguments,
        kind: FileKind,
        jobs: usize,
        cost: &SweepCost<'_>,
        axes: &[Axis],
    ) -> Self {
        let tried = cost.tried.iter().map(|tried| TriedAnswer {
            point: job::point(axes, &tried.job.values),
            seed: tried.job.seed,
            stands_for: tried.jobs,
            whole: tried.cost.whole,
            unstable: matches!(tried.cost.record.outcome, Outcome::Unstable(_)),
            frames: tried.cost.frames,
            sphere_steps: tried.cost.work,
            cpu_seconds: tried.cost.total(),
        });
        Self {
            file: &arguments.file,
            kind: kind.name(),
            jobs,
            sphere_steps: cost.work(),
            cpu_seconds: cost.total(),
            nanoseconds: 1e9 * cost.total() / cost.work().max(1) as f64,
            parts: rows(cost),
            tried: tried.collect(),
        }
    }
}
