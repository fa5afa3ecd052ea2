//! Which effects a scene needs.

use super::PlotError;
use super::svg::Svg;
use crate::record::Program;
use crate::study::ablation::Ablated;
use crate::study::comparison::Cost;
use crate::sweep::Sweep;

/// Draws an ablation.
///
/// # Errors
/// [`PlotError`] if the figure cannot be drawn.
pub fn draw(
    _ablated: &[Ablated],
    _cost: &Cost,
    _sweep: &Sweep,
    _program: &Program,
) -> Result<Svg, PlotError> {
    Err(PlotError::NoMeasures)
}
