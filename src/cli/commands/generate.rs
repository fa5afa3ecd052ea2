//! `phase generate`: schemas, pages of the reference, completions, manual pages.

use crate::cli::CommandLine;
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::folders::{self, ANOTHER_FOLDER};
use clap::CommandFactory;
use clap_complete::Shell;
use phase::reference::{self, InputFile};
use phase::store;
use std::path::{Path, PathBuf};

/// Print a JSON schema, a page of the reference, completions for a shell, or manual pages.
#[derive(clap::Args)]
#[command(after_help = "\
Example: a schema for your own scenes
  phase generate schema scene > scene.schema.json
With `#:schema scene.schema.json` as the first line of a scene file, editors that know TOML (VS Code
with Even Better TOML, Helix, Neovim or Zed with taplo) complete its keys and underline mistakes.

Example: which keys can [output] have?
  phase generate reference keys | grep -A 12 '\\[output\\]'

Example: completions for bash, from the next shell on
  mkdir -p ~/.local/share/bash-completion/completions
  phase generate completions bash > ~/.local/share/bash-completion/completions/phase
For zsh, write them to a file _phase in a folder of $fpath; for fish, to
~/.config/fish/completions/phase.fish.

Example: install the manual pages
  phase generate man ~/.local/share/man/man1")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    /// Print the JSON schema of a kind of file, with which editors complete and check it.
    Schema {
        /// The kind of file.
        kind: Kind,
    },
    /// Print all keys of scene and sweep files, or all symbols, as a table in Markdown.
    Reference {
        /// The page.
        page: Page,
    },
    /// Print a script with which a shell completes commands and options of phase.
    Completions {
        /// The shell.
        shell: Shell,
    },
    /// Write the manual pages of all commands: phase.1, phase-sweep.1 and so on.
    Man {
        /// The folder to write to.
        dir: PathBuf,
    },
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

#[derive(Clone, Copy, clap::ValueEnum)]
enum Page {
    /// Every key with type, unit, default and description.
    Keys,
    /// Every quantity with symbol, unit and key.
    Notation,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    match &arguments.what {
        What::Schema { kind } => console.result(schema(*kind)),
        What::Reference { page } => console.result(match page {
            Page::Keys => reference::keys().trim_end().to_owned(),
            Page::Notation => reference::notation().trim_end().to_owned(),
        }),
        What::Completions { shell } => {
            let mut script = Vec::new();
            let mut command = CommandLine::command();
            clap_complete::generate(*shell, &mut command, "phase", &mut script);
            console.result(String::from_utf8_lossy(&script).trim_end());
        }
        What::Man { dir } => write_pages(dir, console)?,
    }
    Ok(Exit::Done)
}

fn schema(kind: Kind) -> String {
    let file = match kind {
        Kind::Scene => InputFile::Scene,
        Kind::Sweep => InputFile::Sweep,
        Kind::Stability => InputFile::Stability,
        Kind::Accuracy => InputFile::Accuracy,
    };
    format!("{:#}", reference::schema(file))
}

/// Writes the manual pages of all commands to a folder.
fn write_pages(folder: &Path, console: &Console) -> Result<(), Failure> {
    let mut command = CommandLine::command().disable_help_subcommand(true);
    // Gives subcommands their full names and the global options.
    command.build();
    let subcommands: Vec<_> = command.get_subcommands().cloned().collect();
    let named = std::iter::once(command).chain(subcommands).map(|command| {
        let name = command.get_display_name().unwrap_or(command.get_name());
        (format!("{name}.1"), command)
    });
    let named: Vec<_> = named.collect();
    folders::refuse_foreign(folder, named.iter().map(|(name, _)| name), ANOTHER_FOLDER)?;
    folders::make(folder)?;
    for (name, command) in named {
        let mut page = Vec::new();
        let rendered = clap_mangen::Man::new(command).render(&mut page);
        rendered.map_err(Failure::failed)?;
        let path = folder.join(name);
        store::write_atomic(&path, &page)?;
        console.file(&path);
    }
    Ok(())
}
