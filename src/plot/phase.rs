//! The phase diagram: the state at every point of the grid (Rice, 2012, figures 13 and 14).

use super::diagram::{Diagram, Look};
use super::grid::PanelGrid;
use super::legend::{LegendEntry, LegendKey};
use super::style::Fill;
use super::svg::Svg;
use super::{Figure, PlotError, Source, palette};
use crate::classify::Label;
use crate::classify::Point;
use plotters::style::WHITE;

/// Name of the figure.
const NAME: &str = "phase";

pub(super) fn figure() -> Figure {
    Figure::of_sweep(
        NAME,
        "phase diagram: the majority label at every point, paler and with a dot where seeds \
         disagree, hatched where a run did not become steady, a cross where all runs failed",
        draw,
    )
}

fn draw(source: &Source<'_>) -> Result<Svg, PlotError> {
    with_diagram(NAME, source, |diagram| diagram.draw(source))
}

/// Has the phase diagram of a source drawn, under a name.
pub(super) fn with_diagram(
    name: &str,
    source: &Source<'_>,
    draw: impl FnOnce(&Diagram<'_>) -> Result<Svg, PlotError>,
) -> Result<Svg, PlotError> {
    let grid = PanelGrid::new(source.sweep, source.table)?;
    let points: Vec<&Point> = grid
        .panels
        .iter()
        .flat_map(|panel| panel.cells.iter().flatten())
        .collect();
    let occurs = |label: &Label| {
        let mut points = points.iter();
        points.any(|point| has_majority(point) && point.label == *label)
    };
    let labels = source.table.family.labels().into_iter();
    let mut legend: Vec<LegendEntry> = labels
        .filter(|label| occurs(label))
        .map(|label| LegendEntry::new(LegendKey::Fill(fill(label)), &label.name.replace('-', " ")))
        .collect();
    legend.extend(of_disagreement(&points));
    let is_unsteady = |point: &Point| source.table.is_unsteady(point);
    if points.iter().any(|point| is_unsteady(point)) {
        let key = LegendKey::Fill(Fill::Falling(WHITE));
        legend.push(LegendEntry::new(key, "not steady"));
    }
    draw(&Diagram {
        name,
        grid: &grid,
        look: &|point| Some(look(point, is_unsteady(point))),
        empty: "not run".to_owned(),
        failed: grid.failed(source.failures),
        legend,
        bar: None,
    })
}

/// Whether more than half of the seeds of a point have its label.
fn has_majority(point: &Point) -> bool {
    point.agreement > 0.5
}

pub(super) fn fill(label: Label) -> Fill {
    match label {
        // The colour of the critical rotation.
        Label::UNSTABLE => Fill::CrossHatch,
        _ => Fill::Color(palette::state(label)),
    }
}

fn look(point: &Point, is_unsteady: bool) -> Look {
    if has_majority(point) {
        Look {
            // In grey print a pale colour may look like another label; the mark says it is pale.
            fill: match fill(point.label) {
                Fill::Color(color) => {
                    let color = palette::faded(color, point.agreement);
                    match is_unsteady {
                        true => Fill::Falling(color),
                        false => Fill::Color(color),
                    }
                }
                pattern => pattern,
            },
            agreement: point.agreement,
            group: Some(point.label.code),
            mark: None,
        }
    } else {
        Look::new(Fill::Stipple, None)
    }
}

/// Entries of the legend for points whose seeds disagree: the largest and the smallest agreement
/// that is a majority, and points without one.
fn of_disagreement(points: &[&Point]) -> Vec<LegendEntry> {
    let agreements = points.iter().map(|point| point.agreement);
    let marked = agreements.filter(|&agreement| agreement > 0.5 && agreement < 1.0);
    let mut ends: Vec<f64> = marked.collect();
    ends.sort_by(|one, other| other.total_cmp(one));
    ends.dedup();
    if ends.len() > 2 {
        ends.drain(1..ends.len() - 1);
    }
    let mut entries: Vec<LegendEntry> = ends
        .into_iter()
        .map(|agreement| {
            let text = format!("{:.0} % of seeds agree", 100.0 * agreement);
            LegendEntry::new(LegendKey::Agreement(agreement), &text)
        })
        .collect();
    if points.iter().any(|point| !has_majority(point)) {
        entries.push(LegendEntry::new(
            LegendKey::Fill(Fill::Stipple),
            "no majority",
        ));
    }
    entries
}
