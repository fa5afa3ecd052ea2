//! Figures of a study of accuracy.

mod changes;
mod step_time;
mod work_precision;

use super::svg::Svg;
use super::{PlotError, PlotErrorKind};
use crate::record::Program;
use crate::study::accuracy::{AccuracyStudy, Evaluation};
use crate::study::comparison::{Comparison, RunRow};

/// A figure with its name, or why it cannot be drawn.
pub type Named = (String, Result<Svg, PlotError>);

/// The names of the figures of every study.
const NAMES: [&str; 2] = ["work-precision", "label-changes"];

/// The names of the figures of a study.
pub fn names(study: &AccuracyStudy) -> Vec<String> {
    let times = study.step_time.iter().map(|x| step_time_of(x));
    NAMES.map(str::to_owned).into_iter().chain(times).collect()
}

fn step_time_of(x: &str) -> String {
    format!("step-time-{x}")
}

/// All figures that a study has: error against time, where labels change, and what steps cost. A
/// figure of which nothing can be drawn, as no error is above zero, is left out.
pub fn draw_all(
    study: &AccuracyStudy,
    comparison: Option<(&Comparison, &[Option<RunRow>])>,
    evaluation: &Evaluation,
    program: &Program,
) -> Vec<Named> {
    let drawn = work_precision::draw(study, evaluation, program);
    let mut figures = vec![(NAMES[0].to_owned(), drawn)];
    if let Some((comparison, rows)) = comparison {
        if !comparison.axes().is_empty() && comparison.seeds() > 1 {
            let drawn = changes::draw(study, comparison, evaluation, program);
            figures.push((NAMES[1].to_owned(), drawn));
        }
        figures.extend(study.step_time.iter().map(|x| {
            let drawn = step_time::draw(x, comparison, rows, program);
            (step_time_of(x), drawn)
        }));
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
