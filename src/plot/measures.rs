//! Every measure of a sweep over its horizontal axis: means over the seeds, with their intervals.

use super::chart::{self, Bar, Chart, ChartLine, ChartPanel};
use super::grid::{self, GridAxis};
use super::map::{self, MeasureMap};
use super::scale::AxisSpan;
use super::series::{self, PointSeries};
use super::spacing::AxisSpacing;
use super::style::px;
use super::svg::Svg;
use super::{Figure, PlotError, Source};
use crate::sweep::Sweep;

/// Name of the figure.
const NAME: &str = "measures";

/// Distance of the bars of two lines at one place, over the length of the axis: so that they do not
/// hide each other.
const ASIDE: f64 = 0.012;

pub(super) fn figure() -> Figure {
    Figure::of_sweep(
        NAME,
        "every measure over the x axis: means over the seeds with their 95 % intervals",
        draw,
    )
}

fn draw(source: &Source<'_>) -> Result<Svg, PlotError> {
    let axis = grid::horizontal(source)?;
    let (lines, left_out) = series::lines(source, &axis)?;
    let panels: Vec<ChartPanel> = map::of_measures(source.table.family)
        .filter_map(|map| panel(source, &map, &lines, &axis))
        .collect();
    if panels.is_empty() {
        return Err(PlotError::no_measures(NAME));
    }
    let named = lines.iter().filter(|line| !line.name.is_empty());
    Chart {
        name: NAME,
        columns: 2,
        height: px(130),
        panels,
        x_label: axis.label(),
        legend: named.map(|line| (line.color, line.name.clone())).collect(),
        notes: [Some(note(source.sweep)), left_out]
            .into_iter()
            .flatten()
            .collect(),
        ..Chart::default()
    }
    .draw(&source.origin())
}

/// What bars are.
const BARS: &str = "Bars: 95 % intervals of the means (Student's t, within 0 and 1 for shares; \
                    Wilson's where all are 0 or 1).";

/// What points and bars are.
fn note(sweep: &Sweep) -> String {
    match sweep.seeds.len() {
        1 => "Points: one run each.".to_owned(),
        seeds => {
            format!("Points: means over {seeds} seeds, or over those that have a value. {BARS}")
        }
    }
}

/// The panel of a measure; none if no run has it.
fn panel(
    source: &Source<'_>,
    map: &MeasureMap,
    lines: &[PointSeries],
    axis: &GridAxis,
) -> Option<ChartPanel> {
    // The axis of the phase diagram, on which points stand at their values.
    let AxisSpan {
        low,
        high,
        spacing,
        ticks,
        ..
    } = axis.span();
    let aside = |value: f64, lines: f64| {
        let place = spacing.fraction(value, low, high) + ASIDE * lines;
        spacing.along(place, low, high)
    };
    let mut panel = ChartPanel {
        head: vec![map.label(source.sweep.units())],
        x: (low, high),
        spacing: [spacing.clone(), AxisSpacing::Linear],
        ticks,
        ..ChartPanel::default()
    };
    for (index, line) in lines.iter().enumerate() {
        let from_middle = index as f64 - 0.5 * (lines.len() - 1) as f64;
        let bars: Vec<Bar> = line
            .points
            .iter()
            .filter_map(|(at, point)| {
                let values = map.values(source, point);
                map.bar(aside(axis.show(*at), from_middle), &values, line.color)
            })
            .collect();
        // A line between two points would only repeat them.
        if bars.len() > 2 {
            panel.lines.push(ChartLine {
                points: bars.iter().map(|bar| bar.at).collect(),
                color: line.color,
            });
        }
        panel.bars.extend(bars);
    }
    panel.y = chart::range(panel.bars.iter().flat_map(Bar::ends))?;
    Some(panel)
}
