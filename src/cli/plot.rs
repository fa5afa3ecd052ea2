//! `phase plot`: draws the figures of a results folder.

use super::console::Console;
use super::exit::{Exit, Failure};
use phase::plot;
use phase::record::Program;
use phase::store;
use phase::sweep::{Folder, LabelTable, Sweep};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Draw the figures of a results folder, as SVG and PNG, from its labels.csv.
#[derive(clap::Args)]
#[command(after_help = "\
Example: what can be drawn, and one of it
  phase plot --list
  phase plot results/quick --figure hole-radius")]
pub(crate) struct Arguments {
    /// A results folder of `phase sweep`, or a folder that holds several.
    #[arg(required_unless_present = "list")]
    dir: Option<PathBuf>,
    /// A figure to draw; may be given several times [default: phase and settle-time].
    #[arg(short, long, value_name = "NAME", value_delimiter = ',')]
    figure: Vec<String>,
    /// Print the names of all figures and what they show.
    #[arg(short, long)]
    list: bool,
    /// Print the result as one JSON object (docs/json.md) instead of text.
    #[arg(long)]
    pub(super) json: bool,
}

/// What is drawn if nothing else is asked for.
const DEFAULT_FIGURES: [&str; 2] = ["phase", "settle-time"];

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    if arguments.list {
        for (name, description) in plot::figures() {
            console.result(format_args!("{name:<22} {description}"))?;
        }
    }
    if let Some(dir) = &arguments.dir {
        draw_all(dir, &arguments.figure, console)?;
    }
    console.answer(&Answer {
        figures: if arguments.list { list() } else { Vec::new() },
        files: console.files(),
    })?;
    Ok(Exit::Done)
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer {
    /// All figures, if they were asked for.
    figures: Vec<Entry>,
    /// The files written.
    files: Vec<PathBuf>,
}

/// A figure that can be drawn.
#[derive(Serialize)]
struct Entry {
    name: &'static str,
    description: String,
}

fn list() -> Vec<Entry> {
    let figures = plot::figures().into_iter();
    figures
        .map(|(name, description)| Entry { name, description })
        .collect()
}

fn draw_all(dir: &Path, figures: &[String], console: &Console) -> Result<(), Failure> {
    let is_known = |name: &String| plot::figures().iter().any(|(known, _)| known == name);
    if let Some(name) = figures.iter().find(|name| !is_known(name)) {
        return Err(Failure::refused(format_args!(
            "there is no figure `{name}`; `phase plot --list` names them all"
        )));
    }
    for folder in Folder::find(dir).map_err(Failure::refused)? {
        let sweep = folder.read_sweep().map_err(Failure::failed)?;
        let path = folder.labels();
        if !path.exists() {
            return Err(Failure::refused(format_args!(
                "{}: there are no labels yet; run `phase classify {}` first",
                path.display(),
                folder.root().display()
            )));
        }
        let table = store::read_labels(&path).map_err(Failure::failed)?;
        if figures.is_empty() {
            draw_default_figures(&folder, &sweep, &table, console)?;
        }
        for name in figures {
            draw(name, &folder, &sweep, &table, console)?;
        }
    }
    Ok(())
}

/// Draws what is drawn if nothing else is asked for.
pub(super) fn draw_default_figures(
    folder: &Folder,
    sweep: &Sweep,
    table: &LabelTable,
    console: &Console,
) -> Result<(), Failure> {
    if sweep.axes.is_empty() {
        console.note("a sweep without axes has no diagram: no figures");
        return Ok(());
    }
    DEFAULT_FIGURES
        .iter()
        .try_for_each(|name| draw(name, folder, sweep, table, console))
}

/// Draws a figure, writes it as SVG and PNG and prints their paths.
fn draw(
    name: &str,
    folder: &Folder,
    sweep: &Sweep,
    table: &LabelTable,
    console: &Console,
) -> Result<(), Failure> {
    let figure = plot::draw(name, sweep, table, &Program::current()).map_err(Failure::failed)?;
    let images = [
        ("svg", figure.to_svg_bytes()),
        ("png", figure.to_png_bytes().map_err(Failure::failed)?),
    ];
    for (extension, bytes) in images {
        let path = folder.figure(name, extension);
        store::write_atomic(&path, &bytes).map_err(Failure::failed)?;
        console.file(&path)?;
    }
    Ok(())
}
