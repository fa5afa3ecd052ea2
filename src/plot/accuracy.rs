//! Figures of a study of accuracy.

use super::PlotError;
use super::svg::Svg;
use crate::record::Program;
use crate::study::accuracy::{AccuracyStudy, Evaluation};
use crate::study::comparison::Comparison;

/// All figures of a study, by name.
pub fn draw_all(
    _study: &AccuracyStudy,
    _comparison: Option<&Comparison>,
    _evaluation: &Evaluation,
    _program: &Program,
) -> Vec<(&'static str, Result<Svg, PlotError>)> {
    Vec::new()
}
