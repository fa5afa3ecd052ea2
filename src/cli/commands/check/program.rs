//! What `phase check` says of a scene that another program runs: it starts none.

use super::describe::line;
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::{folders, format, programs};
use phase::document::shown;
use phase::grid::describe;
use phase::scene::Scene;
use phase::sweep::{Folder, Job, Plan, Sweep};
use std::path::Path;

/// Whether another program runs all scenes of a sweep.
pub(super) fn runs_all(sweep: &Sweep) -> bool {
    sweep.scenes().into_iter().all(Scene::is_external)
}

/// Prints the commands of the first run of each scene, its files, and what is read.
pub(super) fn describe_programs(sweep: &Sweep, jobs: &[Job], console: &Console) {
    let mut kinds: Vec<String> = Vec::new();
    for job in jobs {
        let scene = job.scene();
        let (Some(program), Some(filled)) = (&scene.program, scene.filled_program()) else {
            continue;
        };
        let start = sweep.start_of(&job.values);
        let kind = format!("{:?}", start.program);
        if kinds.contains(&kind) {
            continue;
        }
        kinds.push(kind);
        let at = describe(&sweep.axes, &job.values, job.seed);
        console.result(line(
            "program",
            format_args!("at {at}, in a folder of its own:"),
        ));
        for words in &filled.commands {
            let words: Vec<String> = words.iter().map(|word| quoted(word)).collect();
            console.result(line("", words.join(" ")));
        }
        if let Some((file, commands)) = &filled.resume {
            let words = |words: &Vec<String>| words.iter().map(|it| quoted(it)).collect::<Vec<_>>();
            let commands: Vec<String> = commands.iter().map(|it| words(it).join(" ")).collect();
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

/// A word of a command as a shell would need it.
fn quoted(word: &str) -> String {
    let is_plain = |it: char| it.is_ascii_alphanumeric() || "-_./=:,+@%".contains(it);
    match !word.is_empty() && word.chars().all(is_plain) {
        true => word.to_owned(),
        false => format!("'{}'", shown(word).replace('\'', "'\\''")),
    }
}

/// Forecasts the time of the runs that are left, from those that the default folder of the file
/// holds: how long a program takes is not known before.
pub(super) fn forecast(
    sweep: &mut Sweep,
    file: &Path,
    workers: usize,
    console: &Console,
) -> Result<(), Failure> {
    let folder = Folder::new(folders::default_folder(file));
    programs::take_versions(sweep, &folder);
    let jobs = sweep.jobs()?;
    let Some(mean) = programs::seconds_of_runs(&folder, &jobs, workers)? else {
        let text = "unknown until a run is done: the program is not started here";
        console.result(line("forecast", text));
        return Ok(());
    };
    let plan = Plan::new(&folder, jobs, workers)?;
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
