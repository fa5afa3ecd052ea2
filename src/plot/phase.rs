//! The phase diagram: the state at every point of the grid (Rice, 2012, figures 13 and 14).

use super::diagram::{Diagram, Look};
use super::grid::Grid;
use super::legend::{Entry, Key};
use super::svg::Svg;
use super::{Figure, PlotError, Source, palette};
use crate::classify::Label;
use crate::sweep::Point;

/// The phase diagram.
pub(super) struct PhaseDiagram;

impl Figure for PhaseDiagram {
    fn name(&self) -> &'static str {
        "phase"
    }

    fn description(&self) -> String {
        "phase diagram: the majority label at every point, paler where seeds disagree".to_owned()
    }

    fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let grid = Grid::new(source)?;
        let points: Vec<&Point> = grid
            .panels
            .iter()
            .flat_map(|panel| panel.cells.iter().flatten())
            .collect();
        let occurs = |label: &Label| points.iter().any(|point| point.label == *label);
        let mut legend: Vec<Entry> = Label::ALL
            .into_iter()
            .filter(occurs)
            .map(|label| Entry {
                key: Key::Color(palette::state(label)),
                text: label.name().replace('-', " "),
            })
            .collect();
        if points.iter().any(|point| point.agreement < 1.0) {
            legend.push(Entry {
                key: Key::Fading(palette::state(Label::Pinned)),
                text: "paler: seeds disagree".to_owned(),
            });
        }
        Diagram {
            name: self.name(),
            grid: &grid,
            look: &|point| {
                Some(Look {
                    color: palette::faded(palette::state(point.label), point.agreement),
                    group: point.label as usize,
                })
            },
            empty: "not run",
            legend,
            bar: None,
        }
        .draw(source)
    }
}
