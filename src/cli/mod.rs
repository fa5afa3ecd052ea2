//! The command line: what commands share, and `commands`, one file each.

mod builds;
mod cluster;
mod columns;
mod commands;
mod compared;
mod console;
mod exit;
mod figures;
mod folders;
mod forecast;
mod format;
mod interrupt;
mod job;
mod kind;
mod labels;
mod options;
mod overlaps;
mod programs;
mod progress;
mod refined;
mod runner;
mod runs;
mod time_step;
mod values;

use clap::{Args, CommandFactory, FromArgMatches, Parser};
use commands::Command;
use console::Console;
use exit::Failure;
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
  130  interrupted by Ctrl-C or a request to end; the same command continues, `run` with --resume

Example: a phase diagram from one file
  phase sweep sweeps/quick.toml";

/// From a TOML file to a phase diagram: simulations of spheres in a vortex.
#[derive(Parser)]
#[command(name = "phase", version = VERSION, after_help = AFTER_HELP)]
struct CommandLine {
    #[command(flatten)]
    printing: Printing,
    #[command(subcommand)]
    command: Command,
}

#[derive(Args)]
struct Printing {
    /// Print only errors, and the result of --json.
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Print more: every job as it ends, every record that is replaced.
    #[arg(short, long, global = true)]
    verbose: bool,
    /// Print the result as one JSON object (docs/json.md) instead of text.
    #[arg(long, global = true)]
    json: bool,
}

/// Parses the command line. A number may be negative: commands that do not accept one say so.
fn parse() -> CommandLine {
    let command = CommandLine::command();
    let command = command.mut_subcommands(|command| command.allow_negative_numbers(true));
    let parsed = CommandLine::from_arg_matches(&command.get_matches());
    parsed.unwrap_or_else(|error| error.exit())
}

/// Refuses `--json` for commands without a result for programs, and with arguments that JSON cannot
/// hold.
fn check_json(command: &Command) -> Result<(), Failure> {
    if !command.has_answer() {
        return Err(Failure::refused(
            "this command has no result for programs; leave out --json",
        ));
    }
    let is_text = |argument: OsString| argument.into_string().is_ok();
    if std::env::args_os().all(is_text) {
        return Ok(());
    }
    Err(Failure::refused(
        "--json needs arguments in UTF-8, and one is not; rename the file or folder, or leave out \
         --json",
    ))
}

/// Parses the command line and does what it says.
pub(crate) fn main() -> ExitCode {
    interrupt::report_too_large_files();
    let CommandLine { printing, command } = parse();
    let Printing {
        quiet,
        verbose,
        json,
    } = printing;
    let console = Console::new(quiet, verbose, json);
    let result = match json {
        true => check_json(&command),
        false => Ok(()),
    };
    let result = result.and_then(|()| command.execute(&console));
    match result.and_then(|exit| console.check_output().map(|()| exit)) {
        Ok(exit) => exit.into(),
        Err(failure) => {
            console.error(&failure.message);
            failure.exit.into()
        }
    }
}
