//! `phase man`: the manual pages.

use super::plot::ANOTHER_FOLDER;
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::folders;
use clap::CommandFactory;
use std::path::PathBuf;

/// Print the manual page, or write those of all commands to a folder.
#[derive(clap::Args)]
#[command(after_help = "\
Example: read it, or install them all
  phase man | man -l -
  phase man --out ~/.local/share/man/man1")]
pub(crate) struct Arguments {
    /// The folder to write phase.1, phase-sweep.1 and so on to.
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let mut command = crate::cli::CommandLine::command().disable_help_subcommand(true);
    // Gives subcommands their full names and the global options.
    command.build();
    let Some(folder) = &arguments.out else {
        let page = page(command)?;
        console.result(String::from_utf8_lossy(&page).trim_end());
        return Ok(Exit::Done);
    };
    let subcommands: Vec<_> = command.get_subcommands().cloned().collect();
    let named = std::iter::once(command).chain(subcommands).map(|command| {
        let name = command.get_display_name().unwrap_or(command.get_name());
        (format!("{name}.1"), command)
    });
    let named: Vec<_> = named.collect();
    folders::refuse_foreign(folder, named.iter().map(|(name, _)| name), ANOTHER_FOLDER)?;
    folders::make(folder)?;
    for (name, command) in named {
        let path = folder.join(name);
        phase::store::write_atomic(&path, &page(command)?).map_err(Failure::failed)?;
        console.file(&path);
    }
    Ok(Exit::Done)
}

fn page(command: clap::Command) -> Result<Vec<u8>, Failure> {
    let mut page = Vec::new();
    clap_mangen::Man::new(command)
        .render(&mut page)
        .map_err(Failure::failed)?;
    Ok(page)
}
