//! Lines of a chart over one axis of a sweep: one for each combination of values of the others.

use super::grid::GridAxis;
use super::{PlotError, Source, choice, grid, palette};
use crate::classify::Point;
use plotters::style::RGBColor;

/// The points of a sweep along one axis.
pub(super) struct PointSeries {
    /// Values on the other axes, with markup; empty if there are none.
    pub(super) name: String,
    pub(super) color: RGBColor,
    /// Its points, each with its value on the axis.
    pub(super) points: Vec<(f64, Point)>,
}

/// Values on the other axes, and the points that have them, each with its value on the axis.
type Group = (Vec<f64>, Vec<(f64, Point)>);

/// The lines of a sweep, as many as there are colours: of more, some evenly from first to last, and
/// a sentence that says so.
pub(super) fn lines(
    source: &Source<'_>,
    axis: &GridAxis,
) -> Result<(Vec<PointSeries>, Option<String>), PlotError> {
    grid::check(source.sweep, source.table)?;
    let mut groups: Vec<Group> = Vec::new();
    for point in source.table.points() {
        let at = point.values[axis.index];
        let mut others = point.values.clone();
        others.remove(axis.index);
        match groups.iter_mut().find(|(values, _)| *values == others) {
            Some((_, points)) => points.push((at, point)),
            None => groups.push((others, vec![(at, point)])),
        }
    }
    let all = groups.len();
    let colors: &[RGBColor] = match all <= palette::LINES.len() {
        true => &palette::LINES,
        false => &palette::DISTINCT,
    };
    let most = colors.len();
    let chosen =
        |index: usize| all <= most || (0..most).any(|line| line * (all - 1) / (most - 1) == index);
    let left_out = (all > most).then(|| format!("{most} of {all} lines are shown."));
    let groups = groups.into_iter().enumerate();
    let shown = groups.filter(|(index, _)| chosen(*index));
    let lines = shown.zip(colors).map(|((_, (_, mut points)), &color)| {
        points.sort_by(|one, other| one.0.total_cmp(&other.0));
        PointSeries {
            name: name(source, axis, &points[0].1),
            color,
            points,
        }
    });
    Ok((lines.collect(), left_out))
}

/// What a point is on all axes but one.
fn name(source: &Source<'_>, axis: &GridAxis, point: &Point) -> String {
    let mut parts = choice::quantities(source, &point.values);
    parts.remove(axis.index);
    parts.join(", ")
}
