//! A page: panels of equal size in rows, with their ticks, and the words around them.

use super::axes::Axes;
use super::canvas::{self, Body, Drawn, Failed, FigureSheet};
use super::legend::{Legend, LegendEntry};
use super::scale::{AxisRoom, AxisScale, AxisSpan};
use super::style::{LABEL, MARGIN, SMALL, TICK, WIDTH, letters, px};
use super::words::{FigureWords, LINE};
use super::{PlotError, text};
use plotters::style::FontTransform;
use plotters::style::text_anchor::{HPos, VPos};

/// Room between panels, beside tick labels and heads.
const GAP: (i32, i32) = (px(14), px(12));
/// Room for the head of a row of panels.
const ROW_HEAD: i32 = px(24);
/// Room between panels and what stands beside them.
const ASIDE: i32 = px(16);
/// Least width of a panel; a page of many panels gets wider than [`WIDTH`], and one of panels that
/// two labels of ticks do not fit below.
const LEAST_PANEL: i32 = px(90);
/// Room of tick labels below a panel.
const TICKS_BELOW: i32 = 2 * TICK + SMALL + px(2);
/// The frame of a panel.
#[derive(Clone, Debug)]
pub(super) struct PanelFrame {
    /// What stands above it, with markup: items of a list, which breaks between them.
    pub(super) head: Vec<String>,
    pub(super) x: AxisSpan,
    pub(super) y: AxisSpan,
}

/// What stands on a page.
#[derive(Default)]
pub(super) struct PagePlan<'a> {
    pub(super) title: Option<&'a str>,
    /// What stands below the title and holds for all panels, as items of a list.
    pub(super) common: &'a [String],
    /// Panels, row by row.
    pub(super) frames: Vec<PanelFrame>,
    /// Panels per row.
    pub(super) columns: usize,
    /// What stands right of each row.
    pub(super) row_heads: Vec<String>,
    /// Height of a panel; the greatest one if it has an aspect.
    pub(super) height: i32,
    /// Width of a panel over its height; `None` if it takes all the width there is.
    pub(super) aspect: Option<f64>,
    /// Width of what is drawn right of the panels, such as a colour bar; zero for none.
    pub(super) aside: i32,
    /// Labels of the horizontal and the vertical axis.
    pub(super) labels: [String; 2],
    pub(super) legend: Vec<LegendEntry>,
    /// Whether the legend stands right of the panels, rather than below.
    pub(super) beside: bool,
    /// Sentences below everything.
    pub(super) notes: &'a [String],
}

impl PagePlan<'_> {
    /// Whether a panel has tick labels left of it and below: no neighbour has the same.
    fn has_ticks(&self, index: usize) -> (bool, bool) {
        let frame = &self.frames[index];
        let first = index.is_multiple_of(self.columns);
        let below = self.frames.get(index + self.columns);
        (
            first || self.frames[index - 1].y != frame.y,
            below.is_none_or(|below| below.x != frame.x),
        )
    }

    /// The largest that a length of the scales is, of the axes that `span` chooses.
    fn most(
        &self,
        span: fn(&PanelFrame) -> &AxisSpan,
        room: AxisRoom,
        length: impl Fn(&AxisScale) -> i32,
    ) -> i32 {
        let scales = self
            .frames
            .iter()
            .map(|frame| AxisScale::new(span(frame), room));
        scales.map(|scale| length(&scale)).max().unwrap_or(0)
    }
}

/// Lengths across a page.
struct Across {
    /// Left ends of the columns of panels.
    columns: Vec<i32>,
    /// Width of a panel, and room for tick labels left of it.
    panel: i32,
    ticks: i32,
    /// Left end of what stands beside the panels.
    aside: i32,
    page: i32,
}

impl Across {
    /// The lengths, and the legend that fits.
    fn new(plan: &PagePlan<'_>) -> (Self, Legend) {
        let columns = plan.columns as i32;
        let only = |condition: bool, length: i32| if condition { length } else { 0 };
        let room = AxisRoom::Up(plan.height);
        let ticks = 2 * TICK + plan.most(|frame| &frame.y, room, AxisScale::label_width);
        let left = MARGIN + ticks + only(!plan.labels[1].is_empty(), LABEL + px(8));
        // The half of the first tick label may need more.
        let widest = (WIDTH - MARGIN - left) / columns;
        let first = |scale: &AxisScale| scale.overhangs(widest)[0];
        let left = left.max(MARGIN + plan.most(|frame| &frame.x, AxisRoom::Across(widest), first));
        let room = only(!plan.beside, WIDTH - MARGIN - left);
        let legend = Legend::new(plan.legend.clone(), room);
        let heads = only(!plan.row_heads.is_empty(), ROW_HEAD);
        let aside = plan.aside + only(plan.beside, legend.size().0);
        // The widest panel that could be, for the half of a tick label that reaches beyond it.
        let widest = (WIDTH - MARGIN - left) / columns;
        let room = AxisRoom::Across(widest);
        let beyond = plan.most(
            |frame| &frame.x,
            room,
            |scale| {
                let [before, after] = scale.overhangs(widest);
                before.max(after)
            },
        );
        let beside = beyond.max(heads + only(aside > 0, ASIDE + aside));
        let mut inner = (0..plan.frames.len()).filter(|index| index % plan.columns > 0);
        let has_ticks = inner.any(|index| plan.has_ticks(index).0);
        let gap = GAP.0 + beyond + beyond.max(only(has_ticks, ticks));
        let room = WIDTH - MARGIN - beside - left - gap * (columns - 1);
        let most = match plan.aspect {
            Some(aspect) => (f64::from(plan.height) * aspect) as i32,
            None => i32::MAX,
        };
        let least = AxisRoom::Across(room / columns);
        let least = plan.most(|frame| &frame.x, least, |scale| scale.needed_length(least));
        let panel = most.min((room / columns).max(LEAST_PANEL).max(least));
        let pitch = panel + gap;
        let right = left + columns * pitch - gap;
        let least = only(plan.aspect.is_none(), WIDTH);
        let across = Self {
            columns: (0..columns).map(|column| left + column * pitch).collect(),
            panel,
            ticks,
            aside: right + heads + ASIDE,
            page: whole(least.max(right + beside + MARGIN)),
        };
        (across, legend)
    }
}

/// A panel where it is on the page.
struct PanelPlace {
    corner: (i32, i32),
    scales: (AxisScale, AxisScale),
    /// Room for its tick labels, left of it and below; zero where it has none.
    ticks: (i32, i32),
}

/// Where everything is, in units of the canvas.
pub(super) struct FigurePage {
    size: (i32, i32),
    /// Width and height of a panel.
    pub(super) panel: (i32, i32),
    places: Vec<PanelPlace>,
    words: FigureWords,
    /// The legend and its upper left corner.
    pub(super) legend: (Legend, (i32, i32)),
    /// Upper left corner of what stands beside the panels.
    pub(super) aside: (i32, i32),
}

impl FigurePage {
    /// Places everything, from above.
    pub(super) fn new(mut plan: PagePlan<'_>) -> Self {
        plan.columns = plan.columns.clamp(1, plan.frames.len().max(1));
        let (across, legend) = Across::new(&plan);
        let height = |aspect| (f64::from(across.panel) / aspect) as i32;
        let mut page = Self {
            size: (across.page, 0),
            panel: (across.panel, plan.aspect.map_or(plan.height, height)),
            places: Vec::new(),
            words: FigureWords::new(across.page),
            legend: (legend, (across.columns[0], 0)),
            aside: (across.aside, 0),
        };
        page.words.title(plan.title, plan.common);
        for row in 0..plan.frames.len().div_ceil(plan.columns) {
            page.put_row(&plan, &across, row);
        }
        page.put_labels(plan.labels);
        page.put_legend(plan.beside);
        if !plan.notes.is_empty() {
            page.words.bottom += px(8);
        }
        page.words.notes(plan.notes);
        page.size.1 = whole(page.words.bottom + MARGIN);
        page
    }

    /// Places a row of panels with their heads.
    fn put_row(&mut self, plan: &PagePlan<'_>, across: &Across, row: usize) {
        let (width, height) = self.panel;
        let (x, y) = (AxisRoom::Across(width), AxisRoom::Up(height));
        let first = row * plan.columns;
        let frames = plan
            .frames
            .iter()
            .enumerate()
            .skip(first)
            .take(plan.columns);
        let head =
            |frame: &PanelFrame| text::wrap_list(&frame.head, f64::from(SMALL), f64::from(width));
        let lines = frames.clone().map(|(_, frame)| head(frame).len() as i32);
        let above = lines.max().unwrap_or(0) * LINE;
        let top = self.words.bottom + if row > 0 { GAP.1 } else { 0 } + above;
        let mut below = 0;
        for (column, (index, frame)) in frames.enumerate() {
            let left = across.columns[column];
            let has_ticks = plan.has_ticks(index);
            let ticks = (
                if has_ticks.0 { across.ticks } else { 0 },
                if has_ticks.1 { TICKS_BELOW } else { 0 },
            );
            below = below.max(ticks.1);
            let head = head(frame);
            let begin = top - head.len() as i32 * LINE;
            self.words.lines(head, (left + width / 2, begin));
            self.places.push(PanelPlace {
                corner: (left, top),
                scales: (AxisScale::new(&frame.x, x), AxisScale::new(&frame.y, y)),
                ticks,
            });
        }
        if let Some(head) = plan.row_heads.get(row) {
            let style = letters(SMALL, HPos::Center, VPos::Bottom);
            let style = style.transform(FontTransform::Rotate90);
            let right = across.columns[plan.columns - 1] + width;
            let place = (right + px(8), top + height / 2);
            self.words.put(head.clone(), style, place);
        }
        self.words.bottom = top + height + below;
    }

    /// Places the labels of the axes, in the middle of all panels.
    fn put_labels(&mut self, [x, y]: [String; 2]) {
        let corners = || self.places.iter().map(|place| place.corner);
        let (Some(first), Some(last)) = (corners().next(), corners().next_back()) else {
            return;
        };
        let right = corners().map(|corner| corner.0).fold(0, i32::max) + self.panel.0;
        let below = (first.0.midpoint(right), self.words.bottom + px(6));
        let left = (MARGIN, first.1.midpoint(last.1 + self.panel.1));
        let style = letters(LABEL, HPos::Center, VPos::Top);
        self.words.put(x, style.clone(), below);
        if !y.is_empty() {
            let style = style.transform(FontTransform::Rotate270);
            self.words.put(y, style, left);
        }
        self.words.bottom += px(10) + LABEL;
        self.aside.1 = first.1;
    }

    fn put_legend(&mut self, beside: bool) {
        let (legend, corner) = &mut self.legend;
        let height = legend.size().1;
        let bottom = &mut self.words.bottom;
        if beside {
            *corner = self.aside;
            *bottom = (*bottom).max(corner.1 + height);
        } else if height > 0 {
            corner.1 = *bottom + px(8);
            *bottom = corner.1 + height;
        }
    }

    /// The axes of a panel.
    pub(super) fn axes<'s, 'c>(
        &self,
        sheet: &'s FigureSheet<'c>,
        index: usize,
    ) -> Result<Axes<'s, 'c>, Failed> {
        let place = &self.places[index];
        let scales = place.scales.clone();
        Axes::new(sheet, place.corner, self.panel, place.ticks, scales)
    }

    /// Upper left corner of a panel.
    pub(super) fn corner(&self, index: usize) -> (i32, i32) {
        self.places[index].corner
    }

    /// Scales of a panel.
    pub(super) fn scales(&self, index: usize) -> &(AxisScale, AxisScale) {
        &self.places[index].scales
    }

    /// Draws panels, then the words around them.
    pub(super) fn draw(
        &self,
        panels: impl FnOnce(&FigureSheet<'_>) -> Drawn,
    ) -> Result<Body, PlotError> {
        canvas::draw(self.size, |sheet| {
            panels(sheet)?;
            self.words.draw(sheet)?;
            self.legend.0.draw(sheet, self.legend.1)
        })
    }
}

/// The length, made an even number of CSS pixels: a whole number of pixels of the PNG.
pub(super) fn whole(length: i32) -> i32 {
    (length + px(2) - 1) / px(2) * px(2)
}

/// How many of several panels stand side by side.
pub(super) fn columns(panels: usize) -> usize {
    match panels {
        0..=3 => panels,
        _ => (1..panels)
            .find(|side| side * side >= panels)
            .unwrap_or(panels),
    }
}
