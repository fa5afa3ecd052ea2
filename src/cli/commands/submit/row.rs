//! A project of row: a directory for each line of jobs, which is done when it holds `done.json`.

use super::{Handover, Submission, cannot_write, clock};
use crate::cli::exit::Failure;
use crate::cli::format;
use std::fs;
use std::path::Path;

pub(super) fn write(order: &Handover<'_>) -> Result<Submission, Failure> {
    let lines = order.lines();
    remove_open(&order.place.join("shards"));
    for line in &lines {
        // The same jobs have the same directory.
        let name = blake3::hash(line.as_bytes()).to_hex();
        let folder = order.place.join("shards").join(&name[..12]);
        fs::create_dir_all(&folder).map_err(|it| cannot_write(&folder, &it))?;
        order.write(&format!("shards/{}/job", &name[..12]), line)?;
    }
    let shards = order.path("shards")?;
    let (here, run, arguments) = (&order.here, order.run(), order.arguments);
    let cores = arguments.jobs;
    // row puts the name of a directory into the line.
    let own = format!("{shards}/{{directory}}");
    let line = format!(
        "cd {here} && {run} --json --job \"$(cat {own}/job)\" > {own}/answer.json && \
         mv {own}/answer.json {own}/done.json"
    );
    let text = format!(
        "# {} runs that are missing, about {}. `phase submit` writes this file again.\n\
         [workspace]\npath = \"shards\"\n\n\
         [[action]]\nname = \"sweep\"\nproducts = [\"done.json\"]\ncommand = {}\n\n\
         [action.resources]\nthreads_per_process = {cores}\nwalltime.per_directory = \"{}\"\n",
        order.next.missing.len(),
        format::core_hours(order.seconds),
        toml::Value::String(format!("({line})")),
        clock(arguments.time)
    );
    let workflow = order.write("workflow.toml", &text)?;
    let place = order.place.display().to_string();
    let words = ["env", "-C", &place, "row", "submit", "--yes"].map(str::to_owned);
    let words = words.into_iter();
    Ok(Submission {
        tasks: lines.len(),
        commands: vec![words.chain(arguments.more.iter().cloned()).collect()],
        files: vec![workflow],
    })
}

/// Removes the directories that are not done: their lines are of an earlier round, or listed anew.
fn remove_open(shards: &Path) {
    for entry in fs::read_dir(shards).into_iter().flatten().flatten() {
        if !entry.path().join("done.json").exists() {
            // One that stays does no harm: its runs are made once.
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}
