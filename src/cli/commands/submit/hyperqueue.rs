//! A job file of HyperQueue, one task for each line of jobs.

use super::{Handover, Submission};
use crate::cli::exit::Failure;
use crate::cli::format;

pub(super) fn write(order: &Handover<'_>) -> Result<Submission, Failure> {
    let (here, name, run) = (&order.here, &order.name, order.run());
    let (cores, time) = (order.arguments.jobs, order.arguments.time.as_secs());
    let logs = order.place.join("hyperqueue-logs");
    let lines = order.lines();
    let quoted = |text: &str| toml::Value::String(text.to_owned()).to_string();
    let mut text = format!(
        "# {} runs that are missing, about {}. `phase submit` writes this file again.\n\
         name = {}\n\
         stream = {}\n",
        order.next.missing.len(),
        format::core_hours(order.seconds),
        quoted(&format!("phase-{name}")),
        quoted(&logs.display().to_string())
    );
    // Whatever becomes of a task, the last one is to come and submit what is missing. A task whose
    // worker was lost is started again, and continues from its checkpoints.
    for (id, line) in lines.iter().enumerate() {
        let line_of_shell = format!("cd {here} && {run} --job {line} || true");
        text += &format!(
            "\n[[task]]\nid = {id}\ncommand = [\"bash\", \"-c\", {}]\ncrash_limit = 5\n\
             [[task.request]]\nresources = {{ \"cpus\" = {cores} }}\ntime_request = \"{time}s\"\n",
            quoted(&line_of_shell)
        );
    }
    let [todo, next] = order.write_next("", "hyperqueue")?;
    let before: Vec<String> = (0..lines.len()).map(|id| id.to_string()).collect();
    text += &format!(
        "\n[[task]]\nid = {}\ncommand = [\"bash\", {}]\ndeps = [{}]\n",
        lines.len(),
        quoted(&next.display().to_string()),
        before.join(", ")
    );
    let job = order.write("job.toml", &text)?;
    let words = ["hq", "job", "submit-file"].map(str::to_owned).into_iter();
    let words = words.chain([job.display().to_string()]);
    Ok(Submission {
        tasks: lines.len(),
        commands: vec![words.chain(order.arguments.more.iter().cloned()).collect()],
        files: vec![job, next, todo],
    })
}
