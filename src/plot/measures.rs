//! Every measure of a sweep over its horizontal axis: means over the seeds, with their intervals.

use super::chart::{self, Bar, Chart, Line, Panel};
use super::grid::Grid;
use super::map::{self, Map};
use super::series::{self, Series};
use super::style::px;
use super::svg::Svg;
use super::{Figure, PlotError, Source};
use crate::statistics::Estimate;

/// Every measure over the horizontal axis.
pub(super) struct MeasuresFigure;

/// Distance of the bars of two lines at one place, over the length of the axis: so that they do not
/// hide each other.
const ASIDE: f64 = 0.012;

impl Figure for MeasuresFigure {
    fn name(&self) -> &'static str {
        "measures"
    }

    fn description(&self) -> String {
        "every measure over the x axis: means over the seeds with their 95 % intervals".to_owned()
    }

    fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let axis = Grid::new(source)?.x;
        let (lines, left_out) = series::lines(source, &axis)?;
        let shown = axis.shown();
        let x = chart::range(shown.iter().copied()).unwrap_or((0.0, 1.0));
        let panels: Vec<Panel> = map::of_measures(source.table.family)
            .filter_map(|map| panel(source, map, &lines, axis.factor, x))
            .collect();
        if panels.is_empty() {
            return Err(PlotError::NoMeasures);
        }
        let named = lines.iter().filter(|line| !line.name.is_empty());
        let seeds = source.sweep.seeds.len();
        let note = format!(
            "Points: means over {seeds} seeds, or over those that have a value. Bars: 95 % intervals \
             of the means (Student's t)."
        );
        Chart {
            name: self.name(),
            common: Vec::new(),
            columns: 2,
            height: px(130),
            panels,
            x_label: axis.label(),
            y_label: String::new(),
            legend: named.map(|line| (line.color, line.name.clone())).collect(),
            notes: [Some(note), left_out].into_iter().flatten().collect(),
        }
        .draw(source)
    }
}

/// The panel of a measure; none if no run has it.
fn panel(
    source: &Source<'_>,
    map: &Map,
    lines: &[Series],
    factor: f64,
    x: (f64, f64),
) -> Option<Panel> {
    let mut panel = Panel {
        head: vec![map.label()],
        x,
        ..Panel::default()
    };
    for (index, line) in lines.iter().enumerate() {
        let aside = ASIDE * (x.1 - x.0) * (index as f64 - 0.5 * (lines.len() - 1) as f64);
        let means: Vec<(f64, Estimate)> = line
            .points
            .iter()
            .filter_map(|(at, point)| {
                let mean = Estimate::of_mean(&map.values(source, point))?;
                Some((at * factor + aside, mean))
            })
            .collect();
        // A line between two points would only repeat them.
        if means.len() > 2 {
            panel.lines.push(Line {
                points: means.iter().map(|(at, mean)| (*at, mean.value)).collect(),
                color: line.color,
            });
        }
        panel.bars.extend(means.iter().map(|(at, mean)| Bar {
            at: (*at, mean.value),
            half: mean.half_width,
            color: line.color,
        }));
    }
    panel.y = chart::range(panel.bars.iter().flat_map(Bar::ends))?;
    Some(panel)
}
