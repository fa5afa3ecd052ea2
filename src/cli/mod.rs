//! The command line: one file per subcommand.

mod ablate;
mod accuracy;
mod builds;
mod check;
mod classify;
mod compare;
mod completions;
mod console;
mod cost;
mod exit;
mod export;
mod fit;
mod folders;
mod format;
mod interrupt;
mod job;
mod kind;
mod man;
mod neighbours;
mod new;
mod overlaps;
mod plot;
mod progress;
mod reference;
mod refined;
mod run;
mod runs;
mod schema;
mod stability;
mod status;
mod study;
mod sweep;
mod time_step;
mod verify;
mod view;

use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand};
use console::Console;
use exit::Exit;
use phase::scene::LARGEST_SEED;
use std::ffi::OsString;
use std::process::ExitCode;

const VERSION: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    " (commit ",
    env!("PHASE_COMMIT"),
    ")"
);

const AFTER_HELP: &str = "\
Exit codes:
  0    done
  1    something failed: a job, the disk, a file that cannot be read or written
  2    refused before anything was done: wrong arguments, a wrong scene or sweep file,
       records of other parameters in the way, a folder in use
  130  interrupted by Ctrl-C or a request to end; the same command goes on from there, `run` with
       --resume

Example: a phase diagram from one file
  phase sweep sweeps/quick.toml";

/// From a TOML file to a phase diagram: simulations of spheres in a vortex.
#[derive(Parser)]
#[command(name = "phase", version = VERSION, after_help = AFTER_HELP)]
struct CommandLine {
    #[command(flatten)]
    verbosity: Verbosity,
    #[command(subcommand)]
    command: Command,
}

#[derive(Args)]
struct Verbosity {
    /// Print nothing but errors, and what `--json` asks for.
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Print more: every job as it ends, every record that is run again.
    #[arg(short, long, global = true)]
    verbose: bool,
}

#[derive(Subcommand)]
enum Command {
    Sweep(sweep::Arguments),
    Classify(classify::Arguments),
    Plot(plot::Arguments),
    Run(run::Arguments),
    Export(export::Arguments),
    View(view::Arguments),
    Check(check::Arguments),
    Cost(cost::Arguments),
    Neighbours(neighbours::Arguments),
    Compare(compare::Arguments),
    Fit(fit::Arguments),
    Stability(stability::Arguments),
    Accuracy(accuracy::Arguments),
    Ablate(ablate::Arguments),
    Status(status::Arguments),
    Verify(verify::Arguments),
    New(new::Arguments),
    Schema(schema::Arguments),
    Reference(reference::Arguments),
    Completions(completions::Arguments),
    Man(man::Arguments),
}

impl Command {
    /// Whether the result is for a program.
    fn wants_json(&self) -> bool {
        match self {
            Self::Sweep(arguments) => arguments.json,
            Self::Classify(arguments) => arguments.json,
            Self::Plot(arguments) => arguments.json,
            Self::Run(arguments) => arguments.json,
            Self::Export(arguments) => arguments.json,
            Self::View(arguments) => arguments.json,
            Self::Check(arguments) => arguments.json,
            Self::Cost(arguments) => arguments.json,
            Self::Neighbours(arguments) => arguments.json,
            Self::Compare(arguments) => arguments.json,
            Self::Fit(arguments) => arguments.json,
            Self::Stability(arguments) => arguments.options.json,
            Self::Accuracy(arguments) => arguments.options.json,
            Self::Ablate(arguments) => arguments.options.json,
            Self::Status(arguments) => arguments.json,
            Self::Verify(arguments) => arguments.json,
            _ => false,
        }
    }
}

/// Parses the command line. A number may be negative: commands that do not accept one say so.
fn parse() -> CommandLine {
    let command = CommandLine::command();
    let command = command.mut_subcommands(|command| command.allow_negative_numbers(true));
    let parsed = CommandLine::from_arg_matches(&command.get_matches());
    parsed.unwrap_or_else(|error| error.exit())
}

/// Parses a seed.
fn seed(text: &str) -> Result<u64, String> {
    match text.parse() {
        Ok(seed) if seed <= LARGEST_SEED => Ok(seed),
        _ => Err(format!("must be a whole number from 0 to {LARGEST_SEED}")),
    }
}

/// Parses two times (s), the earlier first.
fn times(text: &str) -> Result<[f64; 2], String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|it| it.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[from, to]) if 0.0 <= from && from < to && to.is_finite() => Ok([from, to]),
        _ => Err("give two times in seconds, the earlier first, such as 40,200".to_owned()),
    }
}

/// Parses the command line and does what it says.
pub(crate) fn main() -> ExitCode {
    interrupt::report_too_large_files();
    let CommandLine { verbosity, command } = parse();
    let wants_json = command.wants_json();
    let console = Console::new(verbosity.quiet, verbosity.verbose, wants_json);
    let is_text = |argument: OsString| argument.into_string().is_ok();
    if wants_json && !std::env::args_os().all(is_text) {
        console.error(
            "--json needs arguments in UTF-8, and one is not; rename the file or folder, or leave \
             out --json",
        );
        return Exit::Refused.into();
    }
    let result = match command {
        Command::Sweep(arguments) => sweep::main(&arguments, &console),
        Command::Classify(arguments) => classify::main(&arguments, &console),
        Command::Plot(arguments) => plot::main(&arguments, &console),
        Command::Run(arguments) => run::main(&arguments, &console),
        Command::Export(arguments) => export::main(&arguments, &console),
        Command::View(arguments) => view::main(&arguments, &console),
        Command::Check(arguments) => check::main(&arguments, &console),
        Command::Cost(arguments) => cost::main(&arguments, &console),
        Command::Neighbours(arguments) => neighbours::main(&arguments, &console),
        Command::Compare(arguments) => compare::main(&arguments, &console),
        Command::Fit(arguments) => fit::main(&arguments, &console),
        Command::Stability(arguments) => stability::main(&arguments, &console),
        Command::Accuracy(arguments) => accuracy::main(&arguments, &console),
        Command::Ablate(arguments) => ablate::main(&arguments, &console),
        Command::Status(arguments) => status::main(&arguments, &console),
        Command::Verify(arguments) => verify::main(&arguments, &console),
        Command::New(arguments) => new::main(&arguments, &console),
        Command::Schema(arguments) => schema::main(&arguments, &console),
        Command::Reference(arguments) => reference::main(&arguments, &console),
        Command::Completions(arguments) => completions::main(&arguments, &console),
        Command::Man(arguments) => man::main(&arguments, &console),
    };
    match result.and_then(|exit| console.check_output().map(|()| exit)) {
        Ok(exit) => exit.into(),
        Err(failure) => {
            console.error(&failure.message);
            failure.exit.into()
        }
    }
}
