//! Figures of a study of accuracy.

mod changes;
mod work_precision;

use super::svg::Svg;
use super::{PlotError, PlotErrorKind};
use crate::record::Program;
use crate::study::accuracy::{AccuracyStudy, Evaluation};
use crate::study::comparison::Comparison;

/// A figure with its name, or why it cannot be drawn.
pub type Named = (&'static str, Result<Svg, PlotError>);

/// The names of the figures.
pub const NAMES: [&str; 2] = ["work-precision", "label-changes"];

/// All figures that a study has: error against time, and where labels change. A figure of which
/// nothing can be drawn, as no error is above zero, is left out.
pub fn draw_all(
    study: &AccuracyStudy,
    comparison: Option<&Comparison>,
    evaluation: &Evaluation,
    program: &Program,
) -> Vec<Named> {
    let mut figures = vec![(NAMES[0], work_precision::draw(study, evaluation, program))];
    if let Some(comparison) = comparison.filter(|it| !it.axes().is_empty() && it.seeds() > 1) {
        let drawn = changes::draw(study, comparison, evaluation, program);
        figures.push((NAMES[1], drawn));
    }
    figures.retain(
        |(_, figure)| !matches!(figure, Err(error) if error.kind() == PlotErrorKind::Nothing),
    );
    figures
}

/// Colour of a line by its number.
fn color(line: usize, lines: usize) -> plotters::style::RGBColor {
    use super::palette;
    match lines <= palette::LINES.len() {
        true => palette::LINES[line % palette::LINES.len()],
        false => palette::DISTINCT[line % palette::DISTINCT.len()],
    }
}
