//! `phase reference`: pages of the manual that follow from the program.

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};

/// Print all keys of scene and sweep files, or all symbols, as a table in Markdown.
#[derive(clap::Args)]
#[command(after_help = "\
Example: what may [output] say?
  phase reference keys | grep -A 12 '\\[output\\]'")]
pub(crate) struct Arguments {
    /// The page.
    page: Page,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Page {
    /// Every key with type, unit, default and description.
    Keys,
    /// Every quantity with symbol, unit and key.
    Notation,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let page = match arguments.page {
        Page::Keys => phase::reference::keys(),
        Page::Notation => phase::reference::notation(),
    };
    console.result(page.trim_end());
    Ok(Exit::Done)
}
