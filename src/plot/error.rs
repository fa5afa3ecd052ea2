//! Why a figure cannot be drawn.

use super::canvas;
use crate::refine::RefineError;
use crate::refusal::Refusal;
use crate::sweep::SelectError;
use std::fmt::{self, Display};

/// Why a figure cannot be drawn.
#[derive(Debug)]
pub struct PlotError {
    kind: PlotErrorKind,
    message: String,
}

/// What a figure fails at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlotErrorKind {
    /// The request: a figure, point or effect that does not exist here.
    Request,
    /// The runs have nothing that the figure shows.
    Nothing,
    /// A table or record that it is drawn from, or the settings of its axes.
    File,
    /// The drawing itself.
    Drawing,
}

impl PlotError {
    fn new(kind: PlotErrorKind, message: impl Display) -> Self {
        Self {
            kind,
            message: message.to_string(),
        }
    }

    pub(super) fn request(message: impl Display) -> Self {
        Self::new(PlotErrorKind::Request, message)
    }

    pub(super) fn nothing(message: impl Display) -> Self {
        Self::new(PlotErrorKind::Nothing, message)
    }

    pub(super) fn file(message: impl Display) -> Self {
        Self::new(PlotErrorKind::File, message)
    }

    pub(super) fn drawing(message: impl Display) -> Self {
        Self::new(PlotErrorKind::Drawing, message)
    }

    /// The scene lacks what a figure shows.
    pub(super) fn needs(figure: &str, needs: &str) -> Self {
        Self::request(format_args!(
            "the figure `{figure}` needs a scene with {needs}"
        ))
    }

    /// No run has what a figure shows.
    pub(super) fn no_measures(figure: &str) -> Self {
        Self::nothing(format_args!(
            "no run has a measure that the figure `{figure}` shows; give runs that differ, or \
             times in which they have states"
        ))
    }

    /// Points are asked for in a figure of all of them.
    pub(super) fn no_points(figure: &str) -> Self {
        Self::request(format_args!(
            "the figure `{figure}` shows no single runs, so it takes no points"
        ))
    }

    /// There is no axis to draw along.
    pub(super) fn no_axis() -> Self {
        Self::file("no axis is left for x: the figure needs a sweep over at least one axis")
    }

    /// There are no runs to draw.
    pub(super) fn empty_table() -> Self {
        Self::file(
            "the table of labels is empty: no run of this sweep has ended and been classified; \
             `phase sweep` goes on with it",
        )
    }

    /// The PNG could not be made of the SVG.
    pub(super) fn png(error: impl Display) -> Self {
        Self::drawing(format_args!("cannot make the PNG: {error}"))
    }

    /// What the figure fails at.
    pub fn kind(&self) -> PlotErrorKind {
        self.kind
    }
}

impl Refusal for PlotError {
    fn is_refusal(&self) -> bool {
        self.kind == PlotErrorKind::Request
    }
}

impl Display for PlotError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&self.message)
    }
}

impl std::error::Error for PlotError {}

impl From<canvas::Failed> for PlotError {
    fn from(error: canvas::Failed) -> Self {
        Self::drawing(format_args!("cannot draw the figure: {error}"))
    }
}

impl From<SelectError> for PlotError {
    fn from(error: SelectError) -> Self {
        Self::request(error)
    }
}

impl From<RefineError> for PlotError {
    fn from(error: RefineError) -> Self {
        Self::file(error)
    }
}
