//! Where the parts of a diagram go: title, panels, axis labels, colour bar, legend.

use super::color_bar::ColorBar;
use super::grid::Grid;
use super::legend::{Entry, Legend};
use super::scale::{Direction, Room, Scale};
use super::style::{LABEL, MARGIN, SMALL, TICK, TITLE, WIDTH, px};
use super::text;

/// Room between panels.
const GAP: i32 = px(18);
/// Height of the head of a panel.
pub(super) const HEAD: i32 = px(20);
/// Room of the head of a row of panels.
const SIDE_HEAD: i32 = px(26);
/// Room between panels and what stands beside them.
const ASIDE: i32 = px(16);
/// Distance of the title's lines.
pub(super) const TITLE_LINE: i32 = px(20);
/// Least width of a panel; a figure of many panels gets wider than [`WIDTH`].
const LEAST_PANEL: i32 = px(90);
/// Height of a panel without a vertical axis.
const STRIP: i32 = px(56);
/// The same beside a colour bar.
const STRIP_WITH_BAR: i32 = px(120);
/// Greatest height of the colour bar.
const LONGEST_BAR: i32 = px(480);
/// Room of tick labels below a panel.
pub(super) const TICKS_BELOW: i32 = 2 * TICK + SMALL + px(2);

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
    /// How many panels stand where.
    pub(super) shape: Shape,
    /// Room for tick labels, left of and below a panel.
    pub(super) ticks: (i32, i32),
    /// The colour bar, its upper left corner and its height.
    pub(super) bar: Option<(ColorBar, (i32, i32), i32)>,
    /// The legend and its upper left corner.
    pub(super) legend: (Legend, (i32, i32)),
    /// Scales of the panels.
    pub(super) scales: (Scale, Scale),
}

impl Layout {
    /// Places the parts of a diagram: the legend beside a single panel, else below all.
    pub(super) fn new<P>(
        title: Option<&str>,
        grid: &Grid<P>,
        bar: Option<ColorBar>,
        entries: Vec<Entry>,
    ) -> Self {
        let shape = Shape::new(grid, bar.is_some());
        let beside = shape.columns == 1 && bar.is_none() && !shape.strip;
        let (left, ticks_left) = shape.left(grid);
        // Below the panels it begins where they do.
        let room = WIDTH - 2 * MARGIN - left;
        let legend = Legend::new(entries, if beside { 0 } else { room });
        let bar = bar.map(|bar| bar.fitted(shape.rough_height()));

        let row_heads = if grid.rows.is_some() { SIDE_HEAD } else { 0 };
        let right = row_heads
            + match &bar {
                Some(bar) => ASIDE + bar.width(shape.rough_height()),
                None if beside && legend.size().0 > 0 => ASIDE + legend.size().0,
                None => 0,
            };
        let title = title_lines(title);
        let column_heads = if grid.has_heads() { HEAD } else { 0 };
        let origin = (MARGIN + left, title_height(&title) + column_heads);
        let panel = shape.panel(WIDTH - 2 * MARGIN - left - right);
        let heads_between = if grid.rows.is_some() { 0 } else { column_heads };
        let mut layout = Self {
            size: (0, 0),
            title,
            origin,
            panel,
            pitch: (panel.0 + GAP, panel.1 + GAP + heads_between),
            shape,
            ticks: (ticks_left, TICKS_BELOW),
            bar: None,
            legend: (legend, (0, 0)),
            scales: (
                x_scale(grid, panel.0, shape.columns),
                y_scale(grid, panel.1),
            ),
        };

        let end = layout.end();
        let mut bottom = end.1 + TICKS_BELOW + px(6) + LABEL + px(4);
        let aside = end.0 + row_heads + ASIDE;
        layout.bar = bar.map(|bar| (bar, (aside, origin.1), LONGEST_BAR.min(end.1 - origin.1)));
        layout.legend.1 = if beside {
            (aside, origin.1)
        } else {
            (origin.0, bottom + px(8))
        };
        if layout.legend.0.size().1 > 0 {
            bottom = bottom.max(layout.legend.1.1 + layout.legend.0.size().1);
        }
        layout.size = (
            whole((end.0 + right + MARGIN).max(WIDTH)),
            whole(bottom + MARGIN),
        );
        layout
    }

    /// Upper left corner of a panel.
    pub(super) fn corner(&self, panel: usize) -> (i32, i32) {
        let (column, row) = (
            (panel % self.shape.columns) as i32,
            (panel / self.shape.columns) as i32,
        );
        (
            self.origin.0 + column * self.pitch.0,
            self.origin.1 + row * self.pitch.1,
        )
    }

    /// Whether a panel is the first of its row, and whether none is below it.
    pub(super) fn outer(&self, panel: usize) -> (bool, bool) {
        (
            panel.is_multiple_of(self.shape.columns),
            panel + self.shape.columns >= self.shape.panels,
        )
    }

    /// Lower right corner of all panels together.
    pub(super) fn end(&self) -> (i32, i32) {
        let last_row = self.corner(self.shape.panels - 1).1;
        (
            self.corner(self.shape.columns - 1).0 + self.panel.0,
            last_row + self.panel.1,
        )
    }
}

/// The length, made an even number of CSS pixels: a whole number of pixels of the PNG.
pub(super) fn whole(length: i32) -> i32 {
    (length + px(2) - 1) / px(2) * px(2)
}

/// Lines of the title, none without one.
pub(super) fn title_lines(title: Option<&str>) -> Vec<String> {
    let title = title.unwrap_or_default();
    let mut lines = text::wrap(title, f64::from(TITLE), f64::from(WIDTH - 2 * MARGIN));
    lines.retain(|line| !line.is_empty());
    lines
}

/// Lower end of the title.
pub(super) fn title_height(lines: &[String]) -> i32 {
    let below = if lines.is_empty() { 0 } else { px(8) };
    MARGIN + TITLE_LINE * lines.len() as i32 + below
}

/// How many panels there are, and what they look like.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// Number of panels.
    panels: usize,
    /// Panels per row.
    pub(super) columns: usize,
    rows: usize,
    /// Whether panels have no vertical axis.
    strip: bool,
    with_bar: bool,
}

impl Shape {
    fn new<P>(grid: &Grid<P>, with_bar: bool) -> Self {
        let panels = grid.panels.len();
        let columns = match &grid.columns {
            Some(axis) if grid.rows.is_some() => axis.values.len(),
            _ if panels <= 3 => panels,
            _ => (1..panels)
                .find(|side| side * side >= panels)
                .unwrap_or(panels),
        };
        Self {
            panels,
            columns,
            rows: panels.div_ceil(columns),
            strip: grid.y.is_none(),
            with_bar,
        }
    }

    /// Width and height of a panel if all of them have `room` side by side.
    fn panel(self, room: i32) -> (i32, i32) {
        let columns = self.columns as i32;
        let width = ((room - GAP * (columns - 1)) / columns).max(LEAST_PANEL);
        let height = match (self.strip, self.with_bar) {
            (true, false) => STRIP,
            (true, true) => STRIP_WITH_BAR,
            (false, _) if columns == 1 => width * 8 / 10,
            (false, _) => width * 9 / 10,
        };
        (width, height)
    }

    /// Height of all panels together, at least, before it is known.
    fn rough_height(self) -> i32 {
        let panel = self.panel(WIDTH - px(220)).1;
        LONGEST_BAR.min(self.rows as i32 * panel)
    }

    /// Room left of the panels, and that of the tick labels therein.
    fn left<P>(self, grid: &Grid<P>) -> (i32, i32) {
        if self.strip {
            return (px(8), 0);
        }
        let scale = y_scale(grid, self.panel(WIDTH - px(220)).1);
        let ticks = 2 * TICK + scale.label_width(f64::from(SMALL)).ceil() as i32;
        (LABEL + px(8) + ticks, ticks)
    }
}

/// The horizontal scale of panels of a length, for that many side by side.
fn x_scale<P>(grid: &Grid<P>, length: i32, columns: usize) -> Scale {
    let scale = scale(&grid.x, length, Direction::Horizontal);
    if columns == 1 {
        return scale;
    }
    // The room between panels is shared with the next one.
    scale.with_labels_within(room(length, Direction::Horizontal), f64::from(GAP / 3))
}

/// The vertical scale; that of a strip goes from 0 to 1 without ticks.
fn y_scale<P>(grid: &Grid<P>, length: i32) -> Scale {
    match &grid.y {
        Some(axis) => scale(axis, length, Direction::Vertical),
        None => Scale::bare(0.0, 1.0),
    }
}

fn scale(axis: &super::grid::GridAxis, length: i32, direction: Direction) -> Scale {
    let edges = axis.edges();
    let room = room(length, direction);
    let (low, high) = (edges[0], edges[edges.len() - 1]);
    Scale::new(low, high, axis.logarithmic(), &axis.shown(), room)
}

fn room(length: i32, direction: Direction) -> Room {
    Room {
        length: f64::from(length),
        size: f64::from(SMALL),
        direction,
    }
}
