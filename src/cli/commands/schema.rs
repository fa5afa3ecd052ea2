//! `phase schema`: the JSON schema of a kind of file.

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use phase::reference::{self, File};

/// Print the JSON schema of a kind of file, by which an editor completes and checks it.
#[derive(clap::Args)]
#[command(after_help = "\
Example: a schema for your own scenes
  phase schema scene > scene.schema.json
With `#:schema scene.schema.json` as the first line of a scene file, editors that know TOML (VS Code
with Even Better TOML, Helix, Neovim or Zed with taplo) complete its keys and underline mistakes.")]
pub(crate) struct Arguments {
    /// The kind of file.
    file: Kind,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Kind {
    /// One simulation.
    Scene,
    /// A scene, and what is varied in it.
    Sweep,
    /// A study of stability: a scene, and the two keys over which integrators are tried.
    Stability,
    /// A study of accuracy: a scene or sweep, and the settings whose cost and error are measured.
    Accuracy,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let file = match arguments.file {
        Kind::Scene => File::Scene,
        Kind::Sweep => File::Sweep,
        Kind::Stability => File::Stability,
        Kind::Accuracy => File::Accuracy,
    };
    console.result(format_args!("{:#}", reference::schema(file)));
    Ok(Exit::Done)
}
