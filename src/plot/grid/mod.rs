//! The grid of a figure: which axes it shows where, and the point in every cell.

mod axis;

use super::page::columns;
use super::{PlotError, Source};
use crate::classify::{LabelTable, Point};
use crate::grid::Axis;
use crate::sweep::{Failure, Sweep};
pub(super) use axis::{GridAxis, strip};
pub use axis::{ShownAxis, shown_axis};
use std::collections::HashSet;

/// One of the small multiples; its cells hold points of a sweep, or of something else.
#[derive(Clone, Debug)]
pub(super) struct GridPanel<P = Point> {
    /// What stands above it.
    pub(super) head: Option<String>,
    /// Values of the axes it is for, on `columns` and `rows` of the grid.
    pub(super) column: Option<f64>,
    pub(super) row: Option<f64>,
    /// Its horizontal and its vertical axis, where these are not the grid's: they show values as
    /// its variant has them.
    pub(super) own: [Option<GridAxis>; 2],
    /// Its points; cell (x, y) is at `x + y * number of x values`.
    pub(super) cells: Vec<Option<P>>,
}

/// The axes of a figure and the points in its cells.
#[derive(Clone, Debug)]
pub(super) struct PanelGrid<P = Point> {
    pub(super) x: GridAxis,
    pub(super) y: Option<GridAxis>,
    /// Axis of the small multiples.
    pub(super) columns: Option<GridAxis>,
    /// A second such axis.
    pub(super) rows: Option<GridAxis>,
    /// Panels, row by row.
    pub(super) panels: Vec<GridPanel<P>>,
}

impl PanelGrid {
    /// Chooses the axes as the sweep's plot settings say and sorts the table into cells.
    pub(super) fn new(sweep: &Sweep, table: &LabelTable) -> Result<Self, PlotError> {
        check(sweep, table)?;
        let places = places(sweep)?;
        let axis = |place: usize| places[place].map(|index| GridAxis::new(index, sweep, table));
        let mut grid = Self {
            x: axis(0).ok_or_else(PlotError::no_axis)?,
            y: axis(1),
            columns: axis(2),
            rows: axis(3),
            panels: Vec::new(),
        };
        grid.fill(table.points());
        grid.show_variants(&sweep.axes);
        Ok(grid)
    }

    /// Gives panels of variants axes of their own, where these show values in another way.
    fn show_variants(&mut self, axes: &[Axis]) {
        let places: Vec<Option<f64>> = self.panels.iter().map(|it| self.variant(it)).collect();
        for (index, shared) in [Some(&mut self.x), self.y.as_mut()].into_iter().enumerate() {
            let Some(shared) = shared else { continue };
            let of_place = |place: &Option<f64>| shared.of_variant((*place)?, axes);
            let own: Option<Vec<GridAxis>> = places.iter().map(of_place).collect();
            let Some([first, others @ ..]) = own.as_deref() else {
                continue;
            };
            // One label serves all panels.
            let is_one = others.iter().all(|other| other.label() == first.label());
            if !is_one || others.iter().all(|other| other.is_shown_like(first)) {
                continue;
            }
            *shared = first.clone();
            for (panel, axis) in self.panels.iter_mut().zip(own.into_iter().flatten()) {
                panel.own[index] = Some(axis);
            }
        }
    }

    fn fill(&mut self, points: Vec<Point>) {
        let (horizontal, vertical) = self.cells();
        let values = |axis: &Option<GridAxis>| match axis {
            Some(axis) => axis.values.iter().copied().map(Some).collect(),
            None => vec![None],
        };
        let columns: Vec<Option<f64>> = values(&self.columns);
        for row in values(&self.rows) {
            self.panels.extend(columns.iter().map(|&column| {
                GridPanel {
                    head: self
                        .columns
                        .as_ref()
                        .zip(column)
                        .map(|(axis, value)| axis.at(value)),
                    column,
                    row,
                    own: [None, None],
                    cells: vec![None; horizontal * vertical],
                }
            }));
        }
        for point in points {
            if let Some((panel, cell)) = self.place(&point.values) {
                self.panels[panel].cells[cell] = Some(point);
            }
        }
    }

    /// Cells without a point where jobs failed: panels, and places in them.
    pub(super) fn failed(&self, failures: &[Failure]) -> HashSet<(usize, usize)> {
        let places = failures.iter().filter_map(|it| self.place(&it.values));
        let is_empty = |&(panel, cell): &(usize, usize)| self.panels[panel].cells[cell].is_none();
        places.filter(is_empty).collect()
    }

    /// The panel and the cell of a point of the sweep.
    fn place(&self, values: &[f64]) -> Option<(usize, usize)> {
        let along = |axis: &Option<GridAxis>| match axis {
            Some(axis) => axis.position(values),
            None => Some(0),
        };
        let columns = self.columns.as_ref().map_or(1, |axis| axis.values.len());
        let panel = along(&self.columns)? + along(&self.rows)? * columns;
        let cell = self.x.position(values)? + along(&self.y)? * self.x.values.len();
        Some((panel, cell))
    }
}

impl<P> PanelGrid<P> {
    /// Number of cells of a panel, horizontally and vertically.
    pub(super) fn cells(&self) -> (usize, usize) {
        let vertical = self.y.as_ref().map_or(1, |axis| axis.values.len());
        (self.x.values.len(), vertical)
    }

    /// The horizontal and the vertical axis of a panel.
    pub(super) fn axes<'a>(
        &'a self,
        panel: &'a GridPanel<P>,
    ) -> (&'a GridAxis, Option<&'a GridAxis>) {
        let [x, y] = &panel.own;
        (
            x.as_ref().unwrap_or(&self.x),
            y.as_ref().or(self.y.as_ref()),
        )
    }

    /// The place of the variant that a panel stands for, if it stands for one.
    pub(super) fn variant(&self, panel: &GridPanel<P>) -> Option<f64> {
        let axes = [(&self.columns, panel.column), (&self.rows, panel.row)];
        axes.into_iter().find_map(|(axis, value)| {
            value.filter(|_| axis.as_ref().is_some_and(|it| !it.words.is_empty()))
        })
    }

    /// How many panels stand side by side.
    pub(super) fn panels_per_row(&self) -> usize {
        match &self.columns {
            Some(axis) if self.rows.is_some() => axis.values.len(),
            _ => columns(self.panels.len()),
        }
    }

    /// What stands beside the rows of panels, if they have an axis.
    pub(super) fn row_heads(&self) -> Vec<String> {
        let rows = self.rows.iter();
        rows.flat_map(|axis| axis.values.iter().map(|&value| axis.at(value)))
            .collect()
    }
}

/// The horizontal axis of all panels together.
pub(super) fn horizontal(source: &Source<'_>) -> Result<GridAxis, PlotError> {
    let (sweep, table) = (source.sweep, source.table);
    check(sweep, table)?;
    let [x, ..] = places(sweep)?;
    let index = x.ok_or_else(PlotError::no_axis)?;
    Ok(GridAxis::new(index, sweep, table))
}

/// Checks that a table holds runs of the sweep, each with one value on each of its axes.
///
/// # Errors
/// It does not, or it is empty.
pub fn check(sweep: &Sweep, table: &LabelTable) -> Result<(), PlotError> {
    let names: Vec<&str> = sweep.axes.iter().map(|axis| axis.name.as_str()).collect();
    if names != table.axes {
        return Err(PlotError::file(format_args!(
            "the table has the axes {}, but the sweep has {}; classify it again",
            table.axes.join(", "),
            names.join(", ")
        )));
    }
    if table.rows.is_empty() {
        return Err(PlotError::empty_table());
    }
    for row in &table.rows {
        let finite = row.values.iter().all(|value| value.is_finite());
        if row.values.len() != names.len() || !finite {
            return Err(PlotError::file(format_args!(
                "run {}: its row does not hold one finite value per axis; classify it again",
                row.id
            )));
        }
    }
    Ok(())
}

/// Indices of the axes shown as x, y, columns and rows: those that the settings name, then the
/// others in order.
///
/// # Errors
/// The settings name an axis that the sweep lacks, or one twice; or there are more than four axes.
pub fn places(sweep: &Sweep) -> Result<[Option<usize>; 4], PlotError> {
    let settings = &sweep.plot;
    let named = [&settings.x, &settings.y, &settings.panels];
    let mut places = [None; 4];
    for (place, name) in named.into_iter().enumerate() {
        let Some(name) = name else { continue };
        let index = find(&sweep.axes, name)?;
        if places.contains(&Some(index)) {
            return Err(PlotError::file(format_args!(
                "[plot] uses the axis `{name}` twice; x, y and panels must differ"
            )));
        }
        places[place] = Some(index);
    }
    let taken = places;
    let mut others = (0..sweep.axes.len()).filter(|index| !taken.contains(&Some(*index)));
    for place in &mut places {
        if place.is_none() {
            *place = others.next();
        }
    }
    match others.next() {
        Some(_) => Err(PlotError::file(
            "a figure shows at most four axes: x, y, and two of small multiples",
        )),
        None => Ok(places),
    }
}

fn find(axes: &[Axis], name: &str) -> Result<usize, PlotError> {
    let mut positions = axes.iter();
    let found = positions.position(|axis| axis.name == name || axis.key == name);
    found.ok_or_else(|| {
        let known: Vec<&str> = axes.iter().map(|axis| axis.name.as_str()).collect();
        PlotError::file(format_args!(
            "[plot] names the axis `{name}`, but the axes of this sweep are {}",
            known.join(", ")
        ))
    })
}
