//! A diagram over the axes of a sweep: coloured cells, small multiples, axes, title, legend.

use super::axes::{Axes, Plot};
use super::color_bar::ColorBar;
use super::grid::{Grid, Panel};
use super::layout::{Layout, TITLE_LINE};
use super::legend::{Entry, Key};
use super::scale::Scale;
use super::style::{self, Drawn, Fill, LABEL, SMALL, Sheet, TITLE, letters, px};
use super::svg::Svg;
use super::{PlotError, Source, canvas, critical};
use crate::classify::Point;
use plotters::drawing::IntoDrawingArea;
use plotters::element::PathElement;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{BLACK, Color, FontTransform, TextStyle};

/// How a cell looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Look {
    pub(super) fill: Fill,
    /// The share of the seeds that agree, which a mark shows where it is not 1.
    pub(super) agreement: f64,
    /// A line is drawn between neighbours of different groups, such as codes of labels.
    pub(super) group: Option<i8>,
}

/// A curve over a panel: pieces in shown values.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    pub(super) pieces: Vec<critical::Piece>,
    /// Whether it is a thin dashed one.
    pub(super) dashed: bool,
}

/// A diagram: what differs between the figures that are one.
pub(super) struct Diagram<'a, P = Point> {
    /// Name of the figure.
    pub(super) name: &'a str,
    pub(super) grid: &'a Grid<P>,
    /// How a point looks; `None` where it has no value.
    pub(super) look: &'a dyn Fn(&P) -> Option<Look>,
    /// What a cell without a value is called.
    pub(super) empty: String,
    /// Entries of the legend, before those of the curve and of empty cells.
    pub(super) legend: Vec<Entry>,
    pub(super) bar: Option<ColorBar>,
}

impl Diagram<'_> {
    /// Draws it with the curve of the critical rotation.
    pub(super) fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let scene = &source.sweep.scene;
        let curve = |panel| Curve {
            pieces: critical::curve(scene, self.grid, panel),
            dashed: false,
        };
        let curves: Vec<Vec<Curve>> = self
            .grid
            .panels
            .iter()
            .map(|panel| vec![curve(panel)])
            .collect();
        let is_there = |curve: &Curve| !curve.pieces.is_empty();
        let entry = curves.iter().flatten().any(is_there).then(|| Entry {
            key: Key::Curve,
            text: critical::NAME.to_owned(),
        });
        let title = source.sweep.title.as_deref();
        let (size, body) = self.body(title, &curves, entry)?;
        Ok(Svg::new(self.name, source, size, &body))
    }
}

impl<P> Diagram<'_, P> {
    /// Size of the canvas, and what is drawn on it: below a title the panels, each with curves, of
    /// which the last entries of the legend tell.
    pub(super) fn body(
        &self,
        title: Option<&str>,
        curves: &[Vec<Curve>],
        of_curves: impl IntoIterator<Item = Entry>,
    ) -> Result<((u32, u32), String), PlotError> {
        let mut entries = self.entries();
        entries.extend(of_curves);
        let mut layout = Layout::new(title, self.grid, self.bar.clone(), entries);
        layout.legend.0.cell = self.smallest_cell(&layout);
        let size = (layout.size.0 as u32, layout.size.1 as u32);
        let mut body = String::new();
        {
            let sheet = canvas::Canvas::new(&mut body, size).into_drawing_area();
            for (index, panel) in self.grid.panels.iter().enumerate() {
                self.draw_panel(&sheet, &layout, index, panel, &curves[index])?;
            }
            self.draw_words(&sheet, &layout)?;
            let (legend, corner) = &layout.legend;
            legend.draw(&sheet, *corner)?;
            if let Some((bar, corner, height)) = &layout.bar {
                bar.draw(&sheet, *corner, *height)?;
            }
        }
        Ok((size, body))
    }

    fn looks(&self, panel: &Panel<P>) -> Vec<Option<Look>> {
        let look = |cell: &Option<P>| cell.as_ref().and_then(self.look);
        panel.cells.iter().map(look).collect()
    }

    /// Entries of the legend but for curves.
    fn entries(&self) -> Vec<Entry> {
        let mut entries = self.legend.clone();
        let empty = |panel: &Panel<P>| self.looks(panel).contains(&None);
        if self.grid.panels.iter().any(empty) {
            entries.push(Entry {
                key: Key::Fill(Fill::Hatch),
                text: self.empty.clone(),
            });
        }
        entries
    }

    fn draw_panel(
        &self,
        sheet: &Sheet<'_>,
        layout: &Layout,
        index: usize,
        panel: &Panel<P>,
        curves: &[Curve],
    ) -> Drawn {
        let (left, top) = layout.corner(index);
        let (first, last) = layout.outer(index);
        let ticks = (
            if first { layout.ticks.0 } else { 0 },
            if last { layout.ticks.1 } else { 0 },
        );
        let axes = Axes::new(
            sheet,
            (left, top),
            layout.panel,
            ticks,
            layout.scales.clone(),
        )?;
        let plot = axes.plot();
        let looks = self.looks(panel);
        self.draw_cells(sheet, plot, &looks)?;
        self.draw_borders(sheet, plot, &looks)?;
        for Curve { pieces, dashed } in curves {
            let draw = if *dashed { style::dashes } else { style::curve };
            for piece in pieces {
                let pixels = piece.iter().map(|point| plot.map_coordinate(point));
                draw(sheet, &pixels.collect::<Vec<_>>())?;
            }
        }
        self.draw_marks(sheet, plot, &looks, layout.legend.0.cell)?;
        axes.draw()
    }

    /// Edges of the cells on the canvas, horizontally and vertically.
    fn edges(&self, plot: &Plot<'_>) -> (Vec<i32>, Vec<i32>) {
        let (x_edges, y_edges) = (
            self.grid.x.edges(),
            self.grid.y.as_ref().map_or(vec![0.0, 1.0], |y| y.edges()),
        );
        let corner = (x_edges[0], y_edges[0]);
        let x = |edge: &f64| plot.map_coordinate(&(*edge, corner.1)).0;
        let y = |edge: &f64| plot.map_coordinate(&(corner.0, *edge)).1;
        (
            x_edges.iter().map(x).collect(),
            y_edges.iter().map(y).collect(),
        )
    }

    fn draw_cells(&self, sheet: &Sheet<'_>, plot: &Plot<'_>, looks: &[Option<Look>]) -> Drawn {
        let (x, y) = self.edges(plot);
        let columns = self.grid.cells().0;
        for (index, look) in looks.iter().enumerate() {
            let (column, row) = (index % columns, index / columns);
            let corners = [(x[column], y[row + 1]), (x[column + 1], y[row])];
            match look {
                Some(look) => style::paint(sheet, corners, look.fill)?,
                None => style::paint(sheet, corners, Fill::Hatch)?,
            }
        }
        Ok(())
    }

    /// Marks the cells in which seeds disagree.
    fn draw_marks(
        &self,
        sheet: &Sheet<'_>,
        plot: &Plot<'_>,
        looks: &[Option<Look>],
        cell: i32,
    ) -> Drawn {
        let (x, y) = self.edges(plot);
        let columns = self.grid.cells().0;
        for (index, look) in looks.iter().enumerate() {
            let (column, row) = (index % columns, index / columns);
            let corners = [(x[column], y[row + 1]), (x[column + 1], y[row])];
            if let Some(look) = look
                && look.agreement < 1.0
            {
                style::disagreement(sheet, corners, look.agreement, cell)?;
            }
        }
        Ok(())
    }

    /// Shortest side of a cell, as far as marks grow with it.
    fn smallest_cell(&self, layout: &Layout) -> i32 {
        let (columns, rows) = (&layout.scales.0, &layout.scales.1);
        let shortest = |edges: Vec<f64>, scale: &Scale, length: i32| {
            let places = edges.windows(2);
            let sides = places.map(|pair| scale.fraction(pair[1]) - scale.fraction(pair[0]));
            (sides.fold(1.0, f64::min) * f64::from(length)) as i32
        };
        let across = shortest(self.grid.x.edges(), columns, layout.panel.0);
        let y = self.grid.y.as_ref();
        let up = y.map_or(layout.panel.1, |y| {
            shortest(y.edges(), rows, layout.panel.1)
        });
        across.min(up).min(style::LARGEST_CELL)
    }

    /// Draws the lines between cells of different groups.
    fn draw_borders(&self, sheet: &Sheet<'_>, plot: &Plot<'_>, looks: &[Option<Look>]) -> Drawn {
        let (x, y) = self.edges(plot);
        let (columns, rows) = self.grid.cells();
        let group = |column: usize, row: usize| looks[column + row * columns].map(|at| at.group);
        type Group = Option<Option<i8>>;
        let differ =
            |one: Group, other: Group| one.zip(other).is_some_and(|(one, other)| one != other);
        let line = |from: (i32, i32), to: (i32, i32)| {
            sheet.draw(&PathElement::new(
                [from, to],
                BLACK.mix(0.7).stroke_width(8),
            ))
        };
        for (edge, &at) in x.iter().enumerate().take(columns).skip(1) {
            let border = |row| differ(group(edge - 1, row), group(edge, row));
            for (from, to) in runs(rows, border) {
                line((at, y[from]), (at, y[to]))?;
            }
        }
        for (edge, &at) in y.iter().enumerate().take(rows).skip(1) {
            let border = |column| differ(group(column, edge - 1), group(column, edge));
            for (from, to) in runs(columns, border) {
                line((x[from], at), (x[to], at))?;
            }
        }
        Ok(())
    }

    /// Draws title, axis labels and heads of panels.
    fn draw_words(&self, sheet: &Sheet<'_>, layout: &Layout) -> Drawn {
        let (left, top) = layout.origin;
        let (right, bottom) = layout.end();
        let (middle_x, middle_y) = ((left + right) / 2, (top + bottom) / 2);
        let rotated = |style: TextStyle<'static>| style.transform(FontTransform::Rotate270);
        for (index, line) in layout.title.iter().enumerate() {
            let style = letters(TITLE, HPos::Center, VPos::Top);
            let y = style::MARGIN + index as i32 * TITLE_LINE;
            sheet.draw_text(line, &style, (layout.size.0 / 2, y))?;
        }
        let x_label = letters(LABEL, HPos::Center, VPos::Top);
        let below = bottom + layout.ticks.1 + px(6);
        sheet.draw_text(&self.grid.x.label(), &x_label, (middle_x, below))?;
        if let Some(y) = &self.grid.y {
            let style = rotated(letters(LABEL, HPos::Center, VPos::Top));
            sheet.draw_text(&y.label(), &style, (style::MARGIN, middle_y))?;
        }
        for (index, panel) in self.grid.panels.iter().enumerate() {
            let (left, top) = layout.corner(index);
            let first_row = index < layout.shape.columns;
            if let Some(head) = &panel.head
                && (first_row || self.grid.rows.is_none())
            {
                let style = letters(SMALL, HPos::Center, VPos::Bottom);
                let place = (left + layout.panel.0 / 2, top - px(3));
                sheet.draw_text(head, &style, place)?;
            }
            let last_column = (index + 1).is_multiple_of(layout.shape.columns);
            if let (Some(axis), Some(value), true) = (&self.grid.rows, panel.row, last_column) {
                let style =
                    letters(SMALL, HPos::Center, VPos::Bottom).transform(FontTransform::Rotate90);
                let place = (left + layout.panel.0 + px(8), top + layout.panel.1 / 2);
                sheet.draw_text(&axis.at(value), &style, place)?;
            }
        }
        Ok(())
    }
}

/// The runs of indices below `count` that satisfy a condition: first, and one past the last.
fn runs(count: usize, condition: impl Fn(usize) -> bool) -> Vec<(usize, usize)> {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for index in (0..count).filter(|&index| condition(index)) {
        match runs.last_mut() {
            Some(run) if run.1 == index => run.1 = index + 1,
            _ => runs.push((index, index + 1)),
        }
    }
    runs
}
