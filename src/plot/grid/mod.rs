//! The grid of a figure: which axes it shows where, and the point in every cell.

mod axis;

use super::page::columns;
use super::{PlotError, Source};
use crate::classify::{LabelTable, Point};
use crate::grid::Axis;
use crate::sweep::Sweep;
pub(super) use axis::{GridAxis, strip};

/// One of the small multiples; its cells hold points of a sweep, or of something else.
#[derive(Clone, Debug)]
pub(super) struct GridPanel<P = Point> {
    /// What stands above it.
    pub(super) head: Option<String>,
    /// Values of the axes it is for, on `columns` and `rows` of the grid.
    pub(super) column: Option<f64>,
    pub(super) row: Option<f64>,
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
    pub(super) fn new(source: &Source<'_>) -> Result<Self, PlotError> {
        let (sweep, table) = (source.sweep, source.table);
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
        Ok(grid)
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
                    cells: vec![None; horizontal * vertical],
                }
            }));
        }
        for point in points {
            let place = |axis: &Option<GridAxis>| match axis {
                Some(axis) => axis.position(&point.values),
                None => Some(0),
            };
            let places = (
                self.x.position(&point.values),
                place(&self.y),
                place(&self.columns),
                place(&self.rows),
            );
            if let (Some(x), Some(y), Some(column), Some(row)) = places {
                self.panels[column + row * columns.len()].cells[x + y * horizontal] = Some(point);
            }
        }
    }
}

impl<P> PanelGrid<P> {
    /// Number of cells of a panel, horizontally and vertically.
    pub(super) fn cells(&self) -> (usize, usize) {
        let vertical = self.y.as_ref().map_or(1, |axis| axis.values.len());
        (self.x.values.len(), vertical)
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

pub(super) fn check(sweep: &Sweep, table: &LabelTable) -> Result<(), PlotError> {
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
pub(super) fn places(sweep: &Sweep) -> Result<[Option<usize>; 4], PlotError> {
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
