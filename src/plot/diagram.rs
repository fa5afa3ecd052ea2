//! A diagram over the axes of a sweep: coloured cells, small multiples, axes, title, legend.

use super::axes::Plot;
use super::canvas::{Body, Drawn, FigureSheet};
use super::color_bar::ColorBar;
use super::critical;
use super::grid::{self, GridAxis, GridPanel, PanelGrid};
use super::legend::{LegendEntry, LegendKey};
use super::page::{FigurePage, PagePlan, PanelFrame};
use super::panel_curve::{PanelCurve, Stroke};
use super::scale::AxisScale;
use super::style::{self, Corners, Fill, px};
use super::svg::Svg;
use super::{PlotError, Source};
use crate::classify::Point;
use plotters::element::PathElement;
use plotters::style::{BLACK, Color, RGBColor};
use std::collections::HashSet;

/// Height of a panel without a vertical axis, and beside a colour bar.
const STRIP: [i32; 2] = [px(56), px(120)];
/// Height of a single panel, and of several times their number per row.
const HEIGHTS: [i32; 2] = [px(400), px(560)];
/// Least height of a panel.
const LEAST_HEIGHT: i32 = px(90);
/// Greatest height of the colour bar.
const LONGEST_BAR: i32 = px(480);

/// How a cell looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Look {
    pub(super) fill: Fill,
    /// The share of the seeds that agree, which a mark shows where it is not 1.
    pub(super) agreement: f64,
    /// A line is drawn between neighbours of different groups, such as codes of labels.
    pub(super) group: Option<i8>,
    /// The colour of a dot that shows that something is there, such as a run.
    pub(super) mark: Option<RGBColor>,
}

impl Look {
    /// A cell on which all seeds agree.
    pub(super) fn new(fill: Fill, group: Option<i8>) -> Self {
        Self {
            fill,
            agreement: 1.0,
            group,
            mark: None,
        }
    }
}

/// A cell along one axis, in units of the canvas.
struct Side {
    /// The value it stands for.
    value: f64,
    length: f64,
    /// Twice the way from the value to the nearer end.
    around: f64,
}

/// The cells of an axis of this length.
fn sides(axis: &GridAxis, scale: &AxisScale, length: i32) -> Vec<Side> {
    let at = |value: f64| scale.fraction(value) * f64::from(length);
    let edges = axis.edges();
    let cells = axis.values.iter().zip(edges.windows(2));
    let side = |(&value, ends): (&f64, &[f64])| {
        let [low, here, high] = [ends[0], axis.show(value), ends[1]].map(at);
        Side {
            value,
            length: high - low,
            around: 2.0 * (here - low).min(high - here),
        }
    };
    cells.map(side).collect()
}

/// A diagram: what differs between the figures that are one.
pub(super) struct Diagram<'a, P = Point> {
    /// Name of the figure.
    pub(super) name: &'a str,
    pub(super) grid: &'a PanelGrid<P>,
    /// How a point looks; `None` where it has no value.
    pub(super) look: &'a dyn Fn(&P) -> Option<Look>,
    /// What a cell without a value is called.
    pub(super) empty: String,
    /// Cells without a value because the runs failed: panels, and places in them.
    pub(super) failed: HashSet<(usize, usize)>,
    /// First entries of the legend; the curve and empty cells follow.
    pub(super) legend: Vec<LegendEntry>,
    pub(super) bar: Option<ColorBar>,
}

impl Diagram<'_> {
    /// Draws it with the curves of the critical rotation.
    pub(super) fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let curves = |panel: &GridPanel| critical::curves(source.sweep, self.grid, panel);
        self.draw_with(source, &curves, critical::WORDS)
    }

    /// Draws it with curves of each panel, of which these words tell in the legend.
    pub(super) fn draw_with(
        &self,
        source: &Source<'_>,
        curves: &dyn Fn(&GridPanel) -> Vec<PanelCurve>,
        words: [&str; 2],
    ) -> Result<Svg, PlotError> {
        let curves: Vec<Vec<PanelCurve>> = self.grid.panels.iter().map(curves).collect();
        let entries = PanelCurve::entries(&curves, words);
        let title = source.sweep.title.as_deref();
        let body = self.body(title, &curves, entries)?;
        Ok(Svg::new(self.name, &source.origin(), &body))
    }
}

impl<P> Diagram<'_, P> {
    /// Size of the canvas, and what is drawn on it: below a title the panels, each with curves, of
    /// which the last entries of the legend tell.
    pub(super) fn body(
        &self,
        title: Option<&str>,
        curves: &[Vec<PanelCurve>],
        of_curves: impl IntoIterator<Item = LegendEntry>,
    ) -> Result<Body, PlotError> {
        let columns = self.grid.panels_per_row();
        let height = match (&self.grid.y, columns) {
            (None, _) => STRIP[usize::from(self.bar.is_some())],
            (_, 1) => HEIGHTS[0],
            (_, columns) => (HEIGHTS[1] / columns as i32).max(LEAST_HEIGHT),
        };
        let rows = self.grid.panels.len().div_ceil(columns) as i32;
        let bar = self.bar.clone();
        let bar = bar.map(|bar| bar.fitted(LONGEST_BAR.min(rows * height)));
        let mut legend = self.entries();
        legend.extend(of_curves);
        let y_label = self.grid.y.as_ref().map(|axis| axis.label());
        let mut page = FigurePage::new(PagePlan {
            title,
            frames: self.frames(columns),
            columns,
            row_heads: self.grid.row_heads(),
            height,
            aside: bar.as_ref().map_or(0, ColorBar::width),
            labels: [self.grid.x.label(), y_label.unwrap_or_default()],
            legend,
            beside: columns == 1 && bar.is_none() && self.grid.y.is_some(),
            ..PagePlan::default()
        });
        page.legend.0.cell = self.smallest_cell(&page);
        let mut body = page.draw(|sheet| {
            for (index, curves) in curves.iter().enumerate() {
                self.draw_panel(sheet, &page, index, curves)?;
            }
            bar.iter().try_for_each(|bar| bar.draw(sheet, page.aside))
        })?;
        body.warnings = self.warnings(&page);
        Ok(body)
    }

    fn frames(&self, columns: usize) -> Vec<PanelFrame> {
        let panels = self.grid.panels.iter().enumerate();
        let frame = |(index, panel): (usize, &GridPanel<P>)| {
            let (x, y) = self.grid.axes(panel);
            PanelFrame {
                // If rows have heads too, columns have theirs above the first row only.
                head: match &panel.head {
                    Some(head) if index < columns || self.grid.rows.is_none() => vec![head.clone()],
                    _ => Vec::new(),
                },
                x: x.span(),
                y: y.map_or_else(grid::strip, GridAxis::span),
            }
        };
        panels.map(frame).collect()
    }

    fn looks(&self, panel: usize) -> Vec<Option<Look>> {
        let look = |(place, cell): (usize, &Option<P>)| match cell {
            Some(cell) => (self.look)(cell),
            None => {
                let is_failed = self.failed.contains(&(panel, place));
                is_failed.then(|| Look::new(Fill::Cross, None))
            }
        };
        let cells = self.grid.panels[panel].cells.iter().enumerate();
        cells.map(look).collect()
    }

    /// Entries of the legend but for curves.
    fn entries(&self) -> Vec<LegendEntry> {
        let mut entries = self.legend.clone();
        if !self.failed.is_empty() {
            entries.push(LegendEntry::new(LegendKey::Fill(Fill::Cross), "failed"));
        }
        if (0..self.grid.panels.len()).any(|panel| self.looks(panel).contains(&None)) {
            entries.push(LegendEntry::new(LegendKey::Fill(Fill::Hatch), &self.empty));
        }
        entries
    }

    fn draw_panel(
        &self,
        sheet: &FigureSheet<'_>,
        page: &FigurePage,
        index: usize,
        curves: &[PanelCurve],
    ) -> Drawn {
        let axes = page.axes(sheet, index)?;
        let plot = axes.plot();
        let panel = &self.grid.panels[index];
        let looks = self.looks(index);
        let cells = || self.cells(panel, plot).into_iter().zip(&looks);
        if looks.contains(&None) {
            // One pattern under all cells: most of a refined sweep's are empty.
            style::paint(sheet, self.ground(panel, plot), Fill::Hatch)?;
        }
        for (corners, look) in cells() {
            if let Some(look) = look {
                style::paint(sheet, corners, look.fill)?;
            }
        }
        self.draw_borders(sheet, (panel, plot), &looks)?;
        for PanelCurve { pieces, stroke } in curves {
            let draw = match stroke {
                Stroke::Full => style::curve,
                Stroke::Dashed => style::dashes,
                Stroke::Border => style::border,
            };
            for piece in pieces {
                let pixels = piece.iter().map(|point| plot.map_coordinate(point));
                draw(sheet, &pixels.collect::<Vec<_>>())?;
            }
        }
        for (point, look) in self.points(panel, plot).into_iter().zip(&looks) {
            // A mark where seeds disagree.
            if let Some(look) = look
                && look.agreement < 1.0
            {
                style::disagreement(sheet, point, look.agreement, page.legend.0.cell)?;
            }
            if let Some(color) = look.and_then(|look| look.mark) {
                style::mark(sheet, point, color)?;
            }
        }
        axes.draw()
    }

    /// The points of all cells on the canvas: at their values, which are not in the middle of
    /// uneven cells.
    fn points(&self, panel: &GridPanel<P>, plot: &Plot<'_>) -> Vec<(i32, i32)> {
        let (x, y) = self.grid.axes(panel);
        let y = y.map_or(vec![0.5], GridAxis::shown);
        let row = |y: &f64| {
            let across = x.shown().into_iter();
            let points = across.map(|x| plot.map_coordinate(&(x, *y)));
            points.collect::<Vec<_>>()
        };
        y.iter().flat_map(row).collect()
    }

    /// Edges of the cells on the canvas, horizontally and vertically.
    fn edges(&self, panel: &GridPanel<P>, plot: &Plot<'_>) -> (Vec<i32>, Vec<i32>) {
        let (x, y) = self.grid.axes(panel);
        let (x_edges, y_edges) = (x.edges(), y.map_or(vec![0.0, 1.0], GridAxis::edges));
        let corner = (x_edges[0], y_edges[0]);
        let x = |edge: &f64| plot.map_coordinate(&(*edge, corner.1)).0;
        let y = |edge: &f64| plot.map_coordinate(&(corner.0, *edge)).1;
        (
            x_edges.iter().map(x).collect(),
            y_edges.iter().map(y).collect(),
        )
    }

    /// Corners of all cells on the canvas.
    fn cells(&self, panel: &GridPanel<P>, plot: &Plot<'_>) -> Vec<Corners> {
        let (x, y) = self.edges(panel, plot);
        let row = |y: &[i32]| {
            let (bottom, top) = (y[0], y[1]);
            let cells = x.windows(2);
            cells
                .map(move |x| [(x[0], top), (x[1], bottom)])
                .collect::<Vec<_>>()
        };
        y.windows(2).flat_map(row).collect()
    }

    /// Corners of what all cells cover on the canvas.
    fn ground(&self, panel: &GridPanel<P>, plot: &Plot<'_>) -> Corners {
        let (x, y) = self.edges(panel, plot);
        let (last_x, last_y) = (x.len() - 1, y.len() - 1);
        [(x[0], y[last_y]), (x[last_x], y[0])]
    }

    /// The cells of both axes on the canvas, in all panels.
    fn sides(&self, page: &FigurePage) -> [Vec<Side>; 2] {
        let (width, height) = page.panel;
        let mut all = [Vec::new(), Vec::new()];
        for (index, panel) in self.grid.panels.iter().enumerate() {
            if index > 0 && panel.own.iter().all(Option::is_none) {
                break;
            }
            let ((x, y), (across, up)) = (page.scales(index), self.grid.axes(panel));
            all[0].extend(sides(across, x, width));
            all[1].extend(up.into_iter().flat_map(|axis| sides(axis, y, height)));
        }
        all
    }

    /// Shortest side of a cell around its point, as far as marks grow with it.
    fn smallest_cell(&self, page: &FigurePage) -> i32 {
        let sides = self.sides(page).into_iter().flatten();
        let strip = f64::from(page.panel.1);
        let shortest = sides.map(|side| side.around).fold(strip, f64::min);
        (shortest as i32).min(style::LARGEST_CELL)
    }

    /// Says which axes have cells that are too narrow to be seen.
    fn warnings(&self, page: &FigurePage) -> Vec<String> {
        let axes = [Some(&self.grid.x), self.grid.y.as_ref()];
        let axes = axes.into_iter().zip(self.sides(page));
        let warning = |(axis, sides): (Option<&GridAxis>, Vec<Side>)| {
            let (name, least) = (&axis?.name, f64::from(px(1)));
            let narrow = sides.into_iter().find(|side| side.length < least)?;
            Some(format!(
                "cells of the axis `{name}` are narrower than a pixel, such as the one at {}; with \
                 `equal_steps = [\"{name}\"]` in [plot] its values stand at equal distances",
                narrow.value
            ))
        };
        axes.filter_map(warning).collect()
    }

    /// Draws the lines between cells of different groups.
    fn draw_borders(
        &self,
        sheet: &FigureSheet<'_>,
        (panel, plot): (&GridPanel<P>, &Plot<'_>),
        looks: &[Option<Look>],
    ) -> Drawn {
        let (x, y) = self.edges(panel, plot);
        let (columns, rows) = self.grid.cells();
        let group = |column: usize, row: usize| looks[column + row * columns].map(|at| at.group);
        let line = |here: Option<Option<i8>>, there, ends: [(i32, i32); 2]| match here.zip(there) {
            Some((here, there)) if here != there => {
                sheet.draw(&PathElement::new(ends, BLACK.mix(0.7).stroke_width(8)))
            }
            _ => Ok(()),
        };
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |it| (row, it))) {
            let here = group(column, row);
            let (left, bottom) = (x[column], y[row]);
            if column > 0 {
                line(
                    here,
                    group(column - 1, row),
                    [(left, bottom), (left, y[row + 1])],
                )?;
            }
            if row > 0 {
                line(
                    here,
                    group(column, row - 1),
                    [(left, bottom), (x[column + 1], bottom)],
                )?;
            }
        }
        Ok(())
    }
}
