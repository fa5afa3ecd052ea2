//! Figures: one file each, and the parts they share.
//!
//! A figure is drawn with plotters on a canvas that writes SVG; resvg makes the PNG of it,
//! with a font that is part of the program. The same input gives the same bytes.
//!
//! To add a figure: a file with an implementation of `Figure`, and a line in `all`.

mod canvas;
mod color_bar;
mod critical;
mod diagram;
mod grid;
mod layout;
mod legend;
mod map;
mod palette;
mod phase;
mod scale;
mod style;
mod svg;
mod text;
mod tracks;

pub use svg::Svg;
pub use tracks::draw as draw_tracks;

use crate::record::Program;
use crate::sweep::{LabelTable, Sweep};
use plotters::drawing::DrawingAreaErrorKind;
use std::convert::Infallible;

/// What figures are drawn from.
struct Input<'a> {
    sweep: &'a Sweep,
    table: &'a LabelTable,
    program: &'a Program,
}

/// A figure.
trait Figure: Sync {
    /// Name, as on the command line and in file names.
    fn name(&self) -> &'static str;

    /// What it shows, in one line.
    fn description(&self) -> String;

    /// Draws it.
    fn draw(&self, input: &Input<'_>) -> Result<Svg, PlotError>;
}

/// All figures.
fn all() -> Vec<&'static dyn Figure> {
    let mut figures: Vec<&dyn Figure> = vec![&phase::PhaseDiagram];
    figures.extend(map::MAPS.iter().map(|map| map as &dyn Figure));
    figures
}

/// Name and one line of description of every figure.
pub fn figures() -> Vec<(&'static str, String)> {
    let figures = all().into_iter();
    figures
        .map(|figure| (figure.name(), figure.description()))
        .collect()
}

/// Draws the figure `name` of a sweep's labels, with the axes that the sweep's plot settings
/// choose; `program` goes into the file's metadata.
///
/// The table may be incomplete: cells without a row are marked.
///
/// # Errors
///
/// [`PlotError`] for a figure or an axis that does not exist, for a table that is empty or not of
/// this sweep.
pub fn draw(
    name: &str,
    sweep: &Sweep,
    table: &LabelTable,
    program: &Program,
) -> Result<Svg, PlotError> {
    let figures = all();
    let Some(figure) = figures.iter().find(|figure| figure.name() == name) else {
        let known: Vec<&str> = figures.iter().map(|figure| figure.name()).collect();
        return Err(PlotError::UnknownFigure {
            name: name.to_owned(),
            known: known.join(", "),
        });
    };
    figure.draw(&Input {
        sweep,
        table,
        program,
    })
}

/// Why a figure cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// There is no figure of that name.
    #[error("there is no figure `{name}`; the figures are {known}")]
    UnknownFigure {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
    /// The plot settings name an axis that the sweep does not have.
    #[error("[plot] names the axis `{name}`, but the axes of this sweep are {known}")]
    UnknownAxis {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
    /// The plot settings give one axis two places.
    #[error("[plot] uses the axis `{name}` twice; x, y and panels must differ")]
    AxisTwice {
        /// The axis.
        name: String,
    },
    /// There is no axis to draw along.
    #[error("no axis is left for x: the figure needs a sweep over at least one axis")]
    NoAxis,
    /// There are more axes than places.
    #[error("a figure shows at most four axes: x, y, and two of small multiples")]
    TooManyAxes,
    /// There is nothing to draw.
    #[error("the table of labels is empty: no run of this sweep has been classified yet")]
    EmptyTable,
    /// The table was not made of this sweep.
    #[error("the table has the axes {table}, but the sweep has {sweep}; classify it again")]
    OtherAxes {
        /// Axes of the sweep.
        sweep: String,
        /// Axes of the table.
        table: String,
    },
    /// A row of the table is damaged.
    #[error("run {id}: its row does not hold one finite value per axis; classify it again")]
    BadRow {
        /// Identity of the run.
        id: String,
    },
    /// The record of a run does not hold what its tracks are drawn from.
    #[error(
        "the record holds no trajectory; add `trajectory = true` to [output] of the scene and run \
         it again"
    )]
    NoTrajectory,
    /// The drawing failed.
    #[error("cannot draw the figure: {0}")]
    Drawing(String),
    /// The PNG could not be made of the SVG.
    #[error("cannot make the PNG: {0}")]
    Png(String),
}

impl From<DrawingAreaErrorKind<Infallible>> for PlotError {
    fn from(error: DrawingAreaErrorKind<Infallible>) -> Self {
        Self::Drawing(error.to_string())
    }
}
