//! `phase submit`: hands what is missing of a sweep to a batch system.

mod hyperqueue;
mod row;
mod slurm;

use crate::cli::cluster::{self, Handed};
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::programs::AllowProgram;
use crate::cli::{format, values};
use phase::store;
use phase::sweep::{Folder, NextJobs, Shard, Sweep};
use serde::Serialize;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// Hand what is missing of a sweep or study to Slurm, HyperQueue or row.
///
/// The script or job file is written into the results folder, as `cluster/`, for people to read and
/// edit. Tasks that are asked to end leave checkpoints. The same command again hands over what is
/// still missing; of a refined sweep that is the next round.
#[derive(clap::Args)]
#[command(after_help = "\
Examples: look at the script first; then tasks of two hours on four cores each
  phase submit sweeps/steel.toml --to slurm --dry-run
  phase submit sweeps/steel.toml --to slurm --time 2h -j 4 -- --account a --partition p

The results folder must be seen by all machines. docs/clusters.md says more.")]
pub(crate) struct Arguments {
    /// The sweep or study file (TOML).
    file: PathBuf,
    /// The batch system.
    #[arg(long, value_name = "SYSTEM")]
    to: BatchSystem,
    /// The results folder [default: that of `phase sweep` or `phase study`].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Most time of a task, such as 20m or 2h; tasks are cut to take half of it.
    #[arg(long, value_name = "TIME", value_parser = values::time, default_value = "2h")]
    time: Duration,
    /// Cores of a task: jobs that it works on at the same time.
    #[arg(short, long, value_name = "N", value_parser = values::at_least_one, default_value = "1")]
    jobs: usize,
    /// Number of tasks of the whole sweep [default: as many as their time asks for].
    #[arg(long, value_name = "N", value_parser = values::at_least_one)]
    tasks: Option<usize>,
    #[command(flatten)]
    program: AllowProgram,
    /// Write the script or job file, and submit nothing.
    #[arg(long)]
    dry_run: bool,
    /// Options of sbatch, `hq job submit-file` or `row submit`.
    #[arg(last = true, value_name = "OPTIONS")]
    more: Vec<String>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum BatchSystem {
    Slurm,
    Hyperqueue,
    Row,
}

/// What is handed over.
struct Handover<'a> {
    arguments: &'a Arguments,
    next: NextJobs,
    sweep: Sweep,
    folder: Folder,
    /// Name of the sweep, of plain letters.
    name: String,
    /// Processor time of what is missing, and of all jobs (s).
    seconds: f64,
    all_seconds: f64,
    /// Work per second of a core.
    rate: f64,
    /// The program, the sweep file, the results folder, the folder of the script, and the folder
    /// in which all this is done: absolute, and as words of a shell.
    program: String,
    /// The command that runs the file.
    command: &'static str,
    file: String,
    /// The option that lets it start programs, if it does.
    leave: &'static str,
    out: String,
    place: PathBuf,
    here: String,
}

/// What is to be submitted.
struct Submission {
    /// Files that were written.
    files: Vec<PathBuf>,
    /// How many tasks there are.
    tasks: usize,
    /// Commands that submit them. What the first one prints stands for `{}` in the others.
    commands: Vec<Vec<String>>,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let mut handed = Handed::load(&arguments.file, arguments.out.as_ref(), arguments.jobs)?;
    let starts_programs = arguments.program.ask(&mut handed.sweep, &arguments.file)?;
    let (folder, command) = (handed.folder.clone(), handed.command);
    if handed.next.missing.is_empty() {
        console.result(format_args!(
            "no run is missing; `phase {command} {}` writes tables and figures",
            arguments.file.display()
        ));
        console.answer(&Answer::default());
        return Ok(Exit::Done);
    }
    folder.create()?;
    let order = Handover::new(arguments, handed, starts_programs)?;
    fs::create_dir_all(&order.place).map_err(|it| cannot_write(&order.place, &it))?;
    let submission = match arguments.to {
        BatchSystem::Slurm => slurm::write(&order)?,
        BatchSystem::Hyperqueue => hyperqueue::write(&order)?,
        BatchSystem::Row => row::write(&order)?,
    };
    for file in &submission.files {
        console.file(file);
    }
    console.result(format_args!(
        "{} missing, about {}, in {} of {}",
        format::count(order.next.missing.len(), "run"),
        format::core_hours(order.seconds),
        format::count(submission.tasks, "task"),
        format::count(arguments.jobs, "core"),
    ));
    let mut answer = Answer {
        runs: order.next.missing.len(),
        tasks: submission.tasks,
        core_hours: order.seconds / 3600.0,
        submitted: Vec::new(),
        commands: submission.commands.clone(),
    };
    if !arguments.dry_run {
        if !order.folder.sweep().exists() {
            // So that `phase status` knows it before the first task begins.
            order.folder.write_sweep(&order.sweep)?;
        }
        answer.submitted = submit(&submission.commands, console)?;
    }
    console.answer_with_files(&answer);
    Ok(Exit::Done)
}

/// What `--json` prints.
#[derive(Default, Serialize)]
struct Answer {
    /// Runs that are missing.
    runs: usize,
    tasks: usize,
    core_hours: f64,
    /// What the batch system calls them; empty with --dry-run.
    submitted: Vec<String>,
    /// The commands that submit them.
    commands: Vec<Vec<String>>,
}

/// Runs the commands one after the other; gives what they print.
fn submit(commands: &[Vec<String>], console: &Console) -> Result<Vec<String>, Failure> {
    let mut names: Vec<String> = Vec::new();
    for command in commands {
        let first = names.first().cloned().unwrap_or_default();
        let fill = |word: &String| match word.starts_with("--dependency=") {
            true => word.replace("{}", &first),
            false => word.clone(),
        };
        let words: Vec<String> = command.iter().map(fill).collect();
        let line = words.join(" ");
        let Some((program, words)) = words.split_first() else {
            continue;
        };
        let output = Command::new(program).args(words).output();
        let output = output.map_err(|error| {
            Failure::failed(format_args!(
                "cannot run {program}: {error}; submit the files from where it is installed"
            ))
        })?;
        if !output.status.success() {
            let message = String::from_utf8_lossy(&output.stderr);
            return Err(Failure::failed(format_args!("{line}: {}", message.trim())));
        }
        let name = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        let what = ["submitted", "submitted what follows"][names.len().min(1)];
        console.result(format_args!("{what}: {name}"));
        // Federations add the name of the cluster.
        names.push(name.split(';').next().unwrap_or_default().to_owned());
    }
    Ok(names)
}

impl<'a> Handover<'a> {
    fn new(
        arguments: &'a Arguments,
        handed: Handed,
        starts_programs: bool,
    ) -> Result<Self, Failure> {
        let Handed {
            next,
            sweep,
            folder,
            command,
        } = handed;
        let forecast = cluster::forecast(&next, &next.missing, &folder)?;
        let work = |places: &mut dyn Iterator<Item = usize>| -> u64 {
            places.map(|place| next.jobs[place].work()).sum()
        };
        let all = work(&mut (0..next.jobs.len())) as f64 / forecast.rate;
        let missing = work(&mut next.missing.iter().copied()) as f64 / forecast.rate;
        let absolute = |path: &Path| path.canonicalize().map_err(|it| cannot_write(path, &it));
        let root = absolute(folder.root())?;
        let here = std::env::current_dir().map_err(Failure::failed)?;
        let program = std::env::current_exe().map_err(Failure::failed)?;
        let name = arguments.file.file_stem().unwrap_or("sweep".as_ref());
        Ok(Self {
            name: plain(&name.to_string_lossy()),
            seconds: missing,
            all_seconds: all,
            rate: forecast.rate,
            program: word(program.as_os_str())?,
            command,
            file: word(absolute(&arguments.file)?.as_os_str())?,
            leave: match starts_programs {
                true => " --allow-program",
                false => "",
            },
            out: word(root.as_os_str())?,
            here: word(here.as_os_str())?,
            place: root.join("cluster"),
            sweep,
            folder,
            arguments,
            next,
        })
    }

    /// The command of a shell that runs the file, with so many cores.
    fn run(&self) -> String {
        format!(
            "{} {} {} --out {} --jobs {}{}",
            self.program, self.command, self.file, self.out, self.arguments.jobs, self.leave
        )
    }

    /// Number of tasks of the whole sweep, of which there may be so many.
    fn tasks(&self, most: usize) -> usize {
        let of_a_task = self.arguments.time.as_secs_f64() / 2.0 * self.arguments.jobs as f64;
        let wished = (self.all_seconds / of_a_task).ceil() as usize;
        let tasks = self.arguments.tasks.unwrap_or(wished);
        tasks.clamp(1, most.min(self.next.jobs.len()).max(1))
    }

    /// Lines of jobs that are missing, one for each task.
    fn lines(&self) -> Vec<String> {
        let missing = &self.next.missing;
        let shards = match self.arguments.tasks {
            Some(tasks) => self.next.parts(missing, tasks),
            None => {
                let time = self.arguments.time / 2 * self.arguments.jobs as u32;
                self.next.shards(missing, self.rate, time)
            }
        };
        shards.iter().map(Shard::to_string).collect()
    }

    /// Writes a file beside the script.
    fn write(&self, name: &str, text: &str) -> Result<PathBuf, Failure> {
        let path = self.place.join(name);
        store::write_atomic(&path, text.as_bytes()).map_err(Failure::failed)?;
        Ok(path)
    }

    /// A file beside the script, as a word of a shell.
    fn path(&self, name: &str) -> Result<String, Failure> {
        word(self.place.join(name).as_os_str())
    }

    /// Writes what is missing, one job a line, and a script that submits what is missing then: the
    /// next round of a refined sweep, or runs of tasks that were killed. Without a new run it
    /// stops.
    fn write_next(&self, head: &str, system: &str) -> Result<[PathBuf; 2], Failure> {
        let Self {
            program,
            file,
            out,
            here,
            leave,
            ..
        } = self;
        let run = self.run();
        let (todo, left) = (self.path("todo")?, self.path("left")?);
        let lines = self.next.shards(&self.next.missing, 0.0, Duration::ZERO);
        let lines: String = lines.iter().map(|line| format!("{line}\n")).collect();
        let (time, jobs) = (self.arguments.time.as_secs(), self.arguments.jobs);
        let tasks = self.arguments.tasks;
        let tasks = tasks.map_or(String::new(), |it| format!(" --tasks {it}"));
        let more = self.arguments.more.iter().map(OsStr::new);
        let more = more.map(word).collect::<Result<Vec<_>, _>>()?;
        let more = match more.is_empty() {
            true => String::new(),
            false => format!(" -- {}", more.join(" ")),
        };
        let text = format!(
            "#!/bin/bash\n{head}\n\
             # Submits what is missing after these tasks, or labels the runs if nothing is.\n\
             cd {here} || exit\n\
             {program} jobs {file} --out {out} --missing > {left} || exit\n\
             if [ ! -s {left} ]; then\n    \
                 exec {run}\n\
             elif cmp -s {left} {todo}; then\n    \
                 echo \"the tasks made no run; see their output and failed.csv\" >&2\n    \
                 exit 1\n\
             fi\n\
             exec {program} submit {file} --out {out} --to {system} --time {time}s --jobs {jobs}\
             {leave}{tasks}{more}\n"
        );
        Ok([self.write("todo", &lines)?, self.write("next.sh", &text)?])
    }
}

/// A name with nothing but letters, digits and a few signs.
fn plain(name: &str) -> String {
    let sign = |it: char| match it.is_ascii_alphanumeric() || "._-".contains(it) {
        true => it,
        false => '-',
    };
    name.chars().map(sign).collect()
}

/// A word of a shell.
fn word(text: &OsStr) -> Result<String, Failure> {
    let text = text.to_str().ok_or_else(|| {
        Failure::refused(format_args!(
            "{}: a path in a script must be UTF-8; rename it",
            text.display()
        ))
    })?;
    Ok(format::word_of_shell(text))
}

/// A time as Slurm and row read it.
fn clock(time: Duration) -> String {
    let seconds = time.as_secs().max(60);
    let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
    format!("{hours:02}:{minutes:02}:{:02}", seconds % 60)
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::failed(format_args!(
        "{}: {error}{}",
        path.display(),
        store::advice(error)
    ))
}
