//! Where labels change: for each setting, at each point, how much more often its labels disagree
//! with those of the reference than seeds of the reference do among themselves.

use crate::plot::PlotError;
use crate::plot::color_bar::ColorBar;
use crate::plot::diagram::{Diagram, Look};
use crate::plot::grid::{GridAxis, GridPanel, PanelGrid};
use crate::plot::style::Fill;
use crate::plot::svg::Svg;
use crate::record::Program;
use crate::study::accuracy::{AccuracyStudy, Errors, Evaluation, Outcome};
use crate::study::comparison::{Comparison, PointDisagreement};
use std::collections::HashSet;

/// Most settings that are shown: those that change most labels.
const MOST_PANELS: usize = 9;

/// Draws it over the first two axes, at the first value of any others.
///
/// # Errors
/// [`PlotError`] if nothing can be drawn.
pub(super) fn draw(
    study: &AccuracyStudy,
    comparison: &Comparison,
    evaluation: &Evaluation,
    program: &Program,
) -> Result<Svg, PlotError> {
    let sweep = comparison.sweep_of(comparison.reference);
    let axis = |index| {
        let axis = GridAxis::over(index, &sweep.axes, &sweep.scene, std::iter::empty());
        axis.with(&sweep.plot)
    };
    let x = axis(0);
    let y = (sweep.axes.len() > 1).then(|| axis(1));
    let shown = shown(evaluation);
    let grid: PanelGrid<f64> = PanelGrid {
        panels: shown
            .iter()
            .map(|(outcome, points)| GridPanel {
                head: Some(outcome.name.clone()),
                column: None,
                row: None,
                own: [None, None],
                cells: cells(comparison, points, &x, y.as_ref()),
            })
            .collect(),
        x,
        y,
        columns: None,
        rows: None,
    };
    let values = grid
        .panels
        .iter()
        .flat_map(|panel| panel.cells.iter().flatten().copied());
    let bar = ColorBar::new(values, true, "labels changed".to_owned());
    let Some(bar) = bar else {
        return Err(PlotError::no_measures("label-changes"));
    };
    let diagram = Diagram {
        name: "label-changes",
        grid: &grid,
        look: &|value: &f64| Some(Look::new(Fill::Color(bar.color(*value)), None)),
        empty: "not run".to_owned(),
        failed: HashSet::new(),
        legend: Vec::new(),
        bar: Some(bar.clone()),
    };
    let curves = vec![Vec::new(); grid.panels.len()];
    let body = diagram.body(study.title.as_deref(), &curves, None)?;
    let title = study.title.clone().unwrap_or_default();
    Ok(Svg::of_program("label-changes", title, program, &body))
}

/// The settings that are shown, but for the reference, those that change most labels.
fn shown(evaluation: &Evaluation) -> Vec<(&Outcome, &[PointDisagreement])> {
    let outcomes = evaluation.outcomes.iter().enumerate();
    let others = outcomes.filter(|(place, _)| Some(*place) != evaluation.reference);
    let mut all: Vec<(usize, f64, &Outcome, &[PointDisagreement])> = others
        .filter_map(|(place, outcome)| match &outcome.errors {
            Errors::States(states) => {
                let it = states.disagreement.as_ref()?;
                Some((place, it.excess.value, outcome, it.points.as_slice()))
            }
            _ => None,
        })
        .collect();
    all.sort_by(|one, other| other.1.total_cmp(&one.1));
    all.truncate(MOST_PANELS);
    all.sort_by_key(|it| it.0);
    all.into_iter()
        .map(|(_, _, outcome, points)| (outcome, points))
        .collect()
}

/// The values of a panel, at their cells.
fn cells(
    comparison: &Comparison,
    points: &[PointDisagreement],
    x: &GridAxis,
    y: Option<&GridAxis>,
) -> Vec<Option<f64>> {
    let columns = x.values.len();
    let mut cells = vec![None; columns * y.map_or(1, |axis| axis.values.len())];
    // The points of all settings have the places of those of the reference.
    let sweep = comparison.sweep_of(comparison.reference);
    for (values, point) in sweep.grid().zip(points) {
        let row = y.map_or(Some(0), |axis| axis.position(&values));
        let (Some(column), Some(row)) = (x.position(&values), row) else {
            continue;
        };
        let excess = point.chance - point.floor;
        let cell = &mut cells[column + row * columns];
        if cell.is_none() && excess.is_finite() {
            *cell = Some(excess);
        }
    }
    cells
}
