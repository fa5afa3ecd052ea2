//! Where the parts of a diagram go: title, panels, axis labels, colour bar, legend.

use super::color_bar::ColorBar;
use super::grid::Grid;
use super::legend::{Entry, Legend};
use super::scale::{Direction, Room, Scale};
use super::style::{LABEL, MARGIN, SMALL, TICK, TITLE, WIDTH, px};
use super::text;

/// Room between panels.
const GAP: i32 = px(14);
/// Height of the head of a panel.
const HEAD: i32 = px(20);
/// Distance of the title's lines.
const TITLE_LINE: i32 = px(20);
/// Least width of a panel; a figure of many panels gets wider than [`WIDTH`].
const LEAST_PANEL: i32 = px(90);
/// Height of a panel without a vertical axis.
const STRIP: i32 = px(56);
/// Greatest height of the colour bar.
const LONGEST_BAR: i32 = px(400);
/// Room of tick labels below a panel.
const TICKS_BELOW: i32 = 2 * TICK + SMALL + px(2);

/// Where the parts of a diagram go, in units of the canvas.
pub(super) struct Layout {
    /// Width and height of the figure.
    pub(super) size: (i32, i32),
    /// Lines of the title.
    pub(super) title: Vec<String>,
    /// Upper left corner of the first panel.
    pub(super) origin: (i32, i32),
    /// Width and height of a panel.
    pub(super) panel: (i32, i32),
    /// From the corner of a panel to that of the next one to the right and below.
    pitch: (i32, i32),
    /// Panels per row.
    pub(super) columns: usize,
    /// Number of panels.
    panels: usize,
    /// Room for tick labels, left of and below a panel.
    pub(super) ticks: (i32, i32),
    /// Upper left corner and height of the colour bar.
    pub(super) bar: ((i32, i32), i32),
    /// The legend and its upper left corner.
    pub(super) legend: (Legend, (i32, i32)),
    /// Scales of the panels.
    pub(super) scales: (Scale, Scale),
}

impl Layout {
    /// Places the parts of a diagram.
    pub(super) fn new(
        title: Option<&str>,
        grid: &Grid,
        bar: Option<&ColorBar>,
        entries: Vec<Entry>,
    ) -> Self {
        let (columns, rows) = arrangement(grid);
        let strip = grid.y.is_none();
        let beside = columns == 1 && bar.is_none() && !strip;
        let legend = Legend::new(entries, if beside { 0 } else { WIDTH - 2 * MARGIN });

        let mut right = if grid.rows.is_some() { HEAD } else { 0 };
        if let Some(bar) = bar {
            right += px(16) + bar.width(LONGEST_BAR);
        } else if beside && legend.size().0 > 0 {
            right += px(16) + legend.size().0;
        }
        let rough = ((WIDTH - right) / columns as i32).max(LEAST_PANEL);
        let rough_y = y_scale(grid, height(strip, columns, rough));
        let ticks_left = match rough_y.label_width(f64::from(SMALL)).ceil() as i32 {
            0 => 0,
            width => width + 2 * TICK,
        };
        let left = if strip {
            px(8)
        } else {
            LABEL + px(8) + ticks_left
        };

        let gaps = GAP * (columns as i32 - 1);
        let room = WIDTH - 2 * MARGIN - left - right - gaps;
        let width = (room / columns as i32).max(LEAST_PANEL);
        let panel = (width, height(strip, columns, width));

        let lines = title.map_or_else(Vec::new, |title| {
            text::wrap(title, f64::from(TITLE), f64::from(WIDTH - 2 * MARGIN))
        });
        let lines: Vec<String> = lines.into_iter().filter(|line| !line.is_empty()).collect();
        let mut top = MARGIN + TITLE_LINE * lines.len() as i32;
        top += if lines.is_empty() { 0 } else { px(8) };
        let head = if grid.columns.is_some() { HEAD } else { 0 };
        let between = if grid.rows.is_some() { GAP } else { GAP + head };
        let origin = (MARGIN + left, top + head);
        let pitch = (width + GAP, panel.1 + between);

        let panels_right = origin.0 + pitch.0 * (columns as i32 - 1) + width;
        let panels_bottom = origin.1 + pitch.1 * (rows as i32 - 1) + panel.1;
        let axes_bottom = panels_bottom + TICKS_BELOW + px(6) + LABEL + px(4);
        let side = panels_right + right - if beside { legend.size().0 } else { 0 };
        let legend_corner = if beside {
            (side, origin.1)
        } else {
            (origin.0, axes_bottom + px(8))
        };
        let legend_bottom = match legend.size().1 {
            0 => 0,
            height => legend_corner.1 + height,
        };
        let bar_height = (panels_bottom - origin.1).min(LONGEST_BAR);
        let bar_left = panels_right + px(16) + if grid.rows.is_some() { HEAD } else { 0 };
        Self {
            size: (
                (panels_right + right + MARGIN).max(WIDTH),
                axes_bottom.max(legend_bottom) + MARGIN,
            ),
            title: lines,
            origin,
            panel,
            pitch,
            columns,
            panels: grid.panels.len(),
            ticks: (ticks_left, TICKS_BELOW),
            bar: ((bar_left, origin.1), bar_height),
            legend: (legend, legend_corner),
            scales: (x_scale(grid, width), y_scale(grid, panel.1)),
        }
    }

    /// Upper left corner of a panel.
    pub(super) fn corner(&self, panel: usize) -> (i32, i32) {
        let (column, row) = ((panel % self.columns) as i32, (panel / self.columns) as i32);
        (
            self.origin.0 + column * self.pitch.0,
            self.origin.1 + row * self.pitch.1,
        )
    }

    /// Whether a panel is the first of its row, and whether none is below it.
    pub(super) fn outer(&self, panel: usize) -> (bool, bool) {
        (
            panel.is_multiple_of(self.columns),
            panel + self.columns >= self.panels,
        )
    }

    /// Lower right corner of all panels together.
    pub(super) fn end(&self) -> (i32, i32) {
        let last_row = self.corner(self.panels - 1).1;
        (
            self.corner(self.columns - 1).0 + self.panel.0,
            last_row + self.panel.1,
        )
    }
}

/// Panels per row, and rows.
fn arrangement(grid: &Grid) -> (usize, usize) {
    let count = grid.panels.len();
    let columns = match &grid.columns {
        Some(axis) if grid.rows.is_some() => axis.values.len(),
        _ if count <= 3 => count,
        _ => (1..count)
            .find(|side| side * side >= count)
            .unwrap_or(count),
    };
    (columns, count.div_ceil(columns))
}

fn height(strip: bool, columns: usize, width: i32) -> i32 {
    match (strip, columns) {
        (true, _) => STRIP,
        (false, 1) => width * 8 / 10,
        (false, _) => width * 9 / 10,
    }
}

fn x_scale(grid: &Grid, length: i32) -> Scale {
    scale(&grid.x, length, Direction::Horizontal)
}

/// The vertical scale; that of a strip goes from 0 to 1 without ticks.
fn y_scale(grid: &Grid, length: i32) -> Scale {
    match &grid.y {
        Some(axis) => scale(axis, length, Direction::Vertical),
        None => Scale::bare(0.0, 1.0),
    }
}

fn scale(axis: &super::grid::GridAxis, length: i32, direction: Direction) -> Scale {
    let edges = axis.edges();
    let room = Room {
        length: f64::from(length),
        size: f64::from(SMALL),
        direction,
    };
    let (low, high) = (edges[0], edges[edges.len() - 1]);
    Scale::new(low, high, axis.logarithmic(), &axis.shown(), room)
}
