//! `phase completions`: lets a shell complete commands.

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use clap::CommandFactory;
use clap_complete::Shell;

/// Print what lets a shell complete the commands and options of phase.
#[derive(clap::Args)]
#[command(after_help = "\
Example: for bash, from the next shell on
  mkdir -p ~/.local/share/bash-completion/completions
  phase completions bash > ~/.local/share/bash-completion/completions/phase
For zsh, write it to a file _phase in a folder of $fpath; for fish, to
~/.config/fish/completions/phase.fish.")]
pub(crate) struct Arguments {
    /// The shell.
    shell: Shell,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    let mut command = crate::cli::CommandLine::command();
    clap_complete::generate(arguments.shell, &mut command, "phase", &mut script);
    console.result(String::from_utf8_lossy(&script).trim_end());
    Ok(Exit::Done)
}
