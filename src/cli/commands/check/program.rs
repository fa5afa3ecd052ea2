//! What `phase check` says of a scene that another program runs: it starts none.

use super::describe::line;
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::{folders, format, programs};
use phase::document::shown;
use phase::grid::describe;
use phase::scene::{ExternalProgram, Scene};
use phase::sweep::{Folder, Job, Plan, Sweep};
use std::path::Path;

/// Why nothing is forecast.
pub(super) const NO_FORECAST: &str = "unknown until a run is done: the program is not started here";

/// Whether another program runs all scenes of a sweep.
pub(super) fn runs_all(sweep: &Sweep) -> bool {
    sweep.scenes().into_iter().all(Scene::is_external)
}

/// Prints the commands of the first run of each program, its files, and what is read.
pub(super) fn describe_programs(sweep: &Sweep, jobs: &[Job], console: &Console) {
    let mut known: Vec<&Option<ExternalProgram>> = Vec::new();
    for job in jobs {
        let own = &sweep.start_of(&job.values).program;
        if known.contains(&own) {
            continue;
        }
        known.push(own);
        let scene = job.scene();
        let (Some(program), Some(filled)) = (&scene.program, scene.filled_program()) else {
            continue;
        };
        let at = describe(&sweep.axes, &job.values, job.seed);
        console.result(line(
            "program",
            format_args!("at {at}, in a folder of its own:"),
        ));
        for words in &filled.commands {
            console.result(line("", command(words)));
        }
        if let Some((file, commands)) = &filled.resume {
            let commands: Vec<String> = commands.iter().map(|it| command(it)).collect();
            let text = format!("from {}: {}", shown(file), commands.join("; "));
            console.result(line("goes on", text));
        }
        let files: Vec<String> = filled.files.iter().map(|it| shown(&it.name)).collect();
        if !files.is_empty() {
            console.result(line("files", files.join(", ")));
        }
        for (table, file) in program.read.iter().zip(&filled.tables) {
            let unit = |unit: &str| match unit {
                "1" => String::new(),
                unit => format!(" ({unit})"),
            };
            let columns = table.columns.iter();
            let columns = columns.map(|it| format!("{}{}", it.name(), unit(it.unit())));
            let columns: Vec<String> = columns.collect();
            let text = format!("{}: {}", shown(file), columns.join(", "));
            console.result(line("reads", text));
        }
    }
}

/// A command as a shell needs it, without what a terminal would hide.
fn command(words: &[String]) -> String {
    let words = words.iter().map(|it| format::word_of_shell(&shown(it)));
    words.collect::<Vec<_>>().join(" ")
}

/// Forecasts the time of the runs that are left, from the runs that the default folder of the
/// file holds: how long a program takes is not known before.
pub(super) fn forecast(
    sweep: &mut Sweep,
    file: &Path,
    workers: usize,
    console: &Console,
) -> Result<(), Failure> {
    let folder = Folder::new(folders::default_folder(file));
    programs::take_versions(sweep, &folder);
    let plan = Plan::new(&folder, sweep.jobs()?, workers)?;
    let Some(mean) = programs::seconds_of_runs(&plan) else {
        console.result(line("forecast", NO_FORECAST));
        return Ok(());
    };
    let left = plan.pending().count();
    let seconds = mean * left as f64 / workers.min(left.max(1)) as f64;
    console.result(line(
        "forecast",
        format_args!(
            "about {} for the {} left, with {}, from the {} in {}",
            format::duration(seconds),
            format::count(left, "job"),
            format::count(workers, "worker"),
            format::count(plan.done().count(), "run"),
            folder.root().display()
        ),
    ));
    Ok(())
}
