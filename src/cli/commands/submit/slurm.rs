//! An array of Slurm, one task for each shard that lacks runs.

use super::{Handover, Submission, clock};
use crate::cli::exit::Failure;
use crate::cli::format;
use phase::sweep::Shard;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

/// Largest array where Slurm does not say it, its default.
const USUAL_ARRAY: usize = 1001;

pub(super) fn write(order: &Handover<'_>) -> Result<Submission, Failure> {
    // Tasks are numbered from 1, and their largest number is below the size.
    let of = order.tasks(largest_array() - 1);
    let shards = shards_with_missing(order, of);
    let (here, name, arguments) = (&order.here, &order.name, order.arguments);
    let (cores, time) = (arguments.jobs, clock(arguments.time));
    let (in_script, log) = output(order, "%A_%a.log")?;
    let (array, run) = (ranges(&shards), order.run());
    // Enough for checkpoints, and not all of a short task.
    let early = (arguments.time.as_secs() / 4).clamp(15, 120);
    let (runs, hours) = (order.next.missing.len(), format::core_hours(order.seconds));
    let text = format!(
        "#!/bin/bash\n\
         #SBATCH --job-name=phase-{name}\n\
         #SBATCH --array={array}\n\
         #SBATCH --cpus-per-task={cores}\n\
         #SBATCH --time={time}\n\
         #SBATCH --signal=B:USR1@{early}\n\
         #SBATCH --requeue\n\
         #SBATCH --open-mode=append\n\
         {in_script}\
         \n\
         # {runs} runs that are missing, about {hours}. Each task makes a shard of\n\
         # them. `phase submit` writes this file again.\n\
         cd {here} || exit\n\
         \n\
         # Runs leave a checkpoint when the task is to end. Before its time is up it goes back\n\
         # into the queue. Slurm puts one there that is preempted, and none that is cancelled.\n\
         leave() {{\n    \
             kill -TERM $work 2>/dev/null\n    \
             wait $work\n\
         }}\n\
         again() {{\n    \
             leave\n    \
             case $? in\n    \
             130 | 143) scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID\" ;;\n    \
             esac\n    \
             exit\n\
         }}\n\
         trap again USR1\n\
         trap 'leave; exit' TERM\n\
         {run} \\\n    \
             --shard $SLURM_ARRAY_TASK_ID/{of} &\n\
         work=$!\n\
         wait $work\n"
    );
    let script = order.write("submit.sh", &text)?;
    let (in_script, next_log) = output(order, "%j.log")?;
    let head = format!(
        "#SBATCH --job-name=phase-{name}-next\n#SBATCH --time=01:00:00\n\
         #SBATCH --cpus-per-task={cores}\n{in_script}"
    );
    let [todo, next] = order.write_next(&head, "slurm")?;
    // The last option of a name counts.
    let sbatch = |options: &[String], script: &Path| -> Vec<String> {
        let words = ["sbatch", "--parsable"].map(str::to_owned).into_iter();
        let words = words.chain(arguments.more.iter().cloned());
        let words = words.chain(options.iter().cloned());
        words.chain([script.display().to_string()]).collect()
    };
    let after = "--dependency=afterany:{}".to_owned();
    Ok(Submission {
        tasks: shards.len(),
        commands: vec![
            sbatch(log.as_slice(), &script),
            sbatch(&[&[after], next_log.as_slice()].concat(), &next),
        ],
        files: vec![script, next, todo],
    })
}

/// The file for what tasks print: a line of the script, or an option where the path holds what
/// would end such a line.
fn output(order: &Handover<'_>, name: &str) -> Result<(String, Option<String>), Failure> {
    let place = order.place.display().to_string();
    if order.path("")? == format!("{place}/") && !place.contains('%') {
        return Ok((format!("#SBATCH --output={place}/{name}\n"), None));
    }
    let place = place.replace('%', "%%");
    Ok((String::new(), Some(format!("--output={place}/{name}"))))
}

/// Numbers of the shards that lack runs.
fn shards_with_missing(order: &Handover<'_>, of: usize) -> Vec<usize> {
    let parts = Shard::parts(&order.next.jobs, of);
    let missing = order.next.missing.iter();
    let numbers: BTreeSet<usize> = missing.map(|&place| parts[place]).collect();
    numbers.into_iter().collect()
}

/// Numbers as Slurm lists them: `1-3,7`.
fn ranges(numbers: &[usize]) -> String {
    let runs = numbers.chunk_by(|a, b| a + 1 == *b);
    let range = |run: &[usize]| match run {
        [one] => one.to_string(),
        [first, .., last] => format!("{first}-{last}"),
        [] => String::new(),
    };
    runs.map(range).collect::<Vec<_>>().join(",")
}

/// The largest array that this site allows.
fn largest_array() -> usize {
    let output = Command::new("scontrol").args(["show", "config"]).output();
    let text = output.map(|it| String::from_utf8_lossy(&it.stdout).into_owned());
    let size = text.ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("MaxArraySize"))?;
        line.split('=').nth(1)?.trim().parse().ok()
    });
    size.unwrap_or(USUAL_ARRAY).max(2)
}
