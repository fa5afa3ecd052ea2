//! Figures as commands draw and write them.

use super::console::Console;
use super::exit::Failure;
use phase::classify::{Family, LabelTable};
use phase::plot::{self, Svg};
use phase::record::Program;
use phase::store;
use phase::sweep::{Folder, Selection, Sweep, read_failures};
use std::path::{Path, PathBuf};

/// The figure of refined sweeps.
const REFINED: &str = "refined";

/// Draws the default figures. Returns the figures that could not be drawn, and why.
pub(super) fn draw_default_figures(
    folder: &Folder,
    sweep: &Sweep,
    table: &LabelTable,
    console: &Console,
) -> Vec<String> {
    let names = default_figures(sweep, table, console).into_iter();
    let draw = |name| {
        draw(
            name,
            folder,
            folder.root(),
            (sweep, table),
            (&[], None),
            console,
        )
    };
    let problems = names.filter_map(|name| Some(draw(name).err()?.message));
    problems.inspect(|problem| console.error(problem)).collect()
}

/// The figures that are drawn if none is requested.
pub(super) fn default_figures(
    sweep: &Sweep,
    table: &LabelTable,
    console: &Console,
) -> Vec<&'static str> {
    if sweep.axes.is_empty() {
        console.note("a sweep without axes has no phase diagram; no figures drawn");
        return Vec::new();
    }
    figures_of_sweep(sweep, table.family)
}

/// The figures that a sweep with axes draws.
pub(super) fn figures_of_sweep(sweep: &Sweep, family: &'static Family) -> Vec<&'static str> {
    let refined = sweep.refine.iter().map(|_| REFINED);
    refined
        .chain(family.default_figures.iter().copied())
        .collect()
}

/// Draws the figure of a refined sweep after a round, without a word.
pub(super) fn draw_round(
    folder: &Folder,
    sweep: &Sweep,
    table: &LabelTable,
) -> Result<(), Failure> {
    let figure = drawn(REFINED, (folder, sweep, table), (&[], None))?;
    for (extension, bytes) in images(&figure)? {
        let path = folder.root().join(format!("{REFINED}.{extension}"));
        store::write_atomic(&path, &bytes)?;
    }
    Ok(())
}

/// Draws a figure, of points and times if requested, writes it to the folder `place` as
/// SVG and PNG and prints their paths.
pub(super) fn draw(
    name: &str,
    folder: &Folder,
    place: &Path,
    (sweep, table): (&Sweep, &LabelTable),
    (points, times): (&[Selection], Option<[f64; 2]>),
    console: &Console,
) -> Result<(), Failure> {
    let figure = drawn(name, (folder, sweep, table), (points, times))?;
    let file = |extension: &str| place.join(format!("{name}.{extension}"));
    write(&figure, file, console)
}

/// A figure of a folder, of points and times if requested.
pub(super) fn drawn(
    name: &str,
    (folder, sweep, table): (&Folder, &Sweep, &LabelTable),
    (points, times): (&[Selection], Option<[f64; 2]>),
) -> Result<Svg, Failure> {
    let refining = folder.read_refining(sweep)?;
    // A table that cannot be read tells of no failure; `phase status` refuses it.
    let failures = read_failures(&sweep.axes, &folder.failures()).unwrap_or_default();
    let source = plot::Source {
        sweep,
        refining: refining.as_ref(),
        table,
        failures: &failures,
        record: &|id| folder.read_record(id),
        points,
        times,
        program: &Program::current(),
    };
    plot::draw(name, &source).map_err(|error| Failure::from(error).at(folder.root()))
}

/// The files of a figure, by the ends of their names.
fn images(figure: &Svg) -> Result<[(&'static str, Vec<u8>); 2], Failure> {
    Ok([
        ("svg", figure.to_svg_bytes()),
        ("png", figure.to_png_bytes()?),
    ])
}

/// Writes a figure as SVG and PNG and prints their paths and the figure's warnings.
pub(super) fn write(
    figure: &Svg,
    place: impl Fn(&str) -> PathBuf,
    console: &Console,
) -> Result<(), Failure> {
    for (extension, bytes) in images(figure)? {
        let path = place(extension);
        store::write_atomic(&path, &bytes)?;
        console.file(&path);
    }
    for warning in figure.warnings() {
        console.warning(format_args!("{}: {warning}", place("png").display()));
    }
    Ok(())
}
