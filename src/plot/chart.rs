//! A chart: lines over a horizontal axis, in panels of equal size.

use super::axes::Axes;
use super::canvas::Canvas;
use super::layout::{HEAD, TICKS_BELOW, TITLE_LINE, title_height, title_lines, whole};
use super::legend::{Entry, Key, Legend};
use super::scale::{Direction, Room, Scale};
use super::style::{self, Drawn, LABEL, MARGIN, SMALL, Sheet, TICK, TITLE, WIDTH, letters, px};
use super::svg::Svg;
use super::text;
use super::{PlotError, Source};
use plotters::drawing::IntoDrawingArea;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{FontTransform, RGBColor};

/// Room between panels beside the halves of tick labels that reach into it.
const GAP: i32 = px(16);
/// Distance of the lines of heads and notes.
const LINE: i32 = px(16);

/// A line: points in the order of x, and its colour.
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub(super) points: Vec<(f64, f64)>,
    pub(super) color: RGBColor,
}

/// The mean of several values and its interval, a point between two ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bar {
    pub(super) at: (f64, f64),
    /// Ends of the interval, the lower first; both at the point where there is none.
    ends: [f64; 2],
    pub(super) color: RGBColor,
}

impl Bar {
    /// An interval that reaches as far down as up; none if that is infinite.
    pub(super) fn about(at: (f64, f64), half: f64, color: RGBColor) -> Self {
        let half = if half.is_finite() { half } else { 0.0 };
        Self::between(at, [at.1 - half, at.1 + half], color)
    }

    /// An interval between two ends, the lower first.
    pub(super) fn between(at: (f64, f64), ends: [f64; 2], color: RGBColor) -> Self {
        Self { at, ends, color }
    }

    /// Ends of what is drawn, the lower first.
    pub(super) fn ends(&self) -> [f64; 2] {
        self.ends
    }
}

/// A panel.
#[derive(Clone, Debug, Default)]
pub(super) struct Panel {
    /// What stands above it, with markup: items of a list, which breaks between them.
    pub(super) head: Vec<String>,
    /// Ends of its axes. What lies left of them or right is not drawn.
    pub(super) x: (f64, f64),
    pub(super) y: (f64, f64),
    pub(super) lines: Vec<Line>,
    /// Drawn over the lines.
    pub(super) bars: Vec<Bar>,
}

/// A chart.
pub(super) struct Chart {
    /// Name of the figure.
    pub(super) name: &'static str,
    /// What stands below the title and holds for all panels, as items of a list.
    pub(super) common: Vec<String>,
    /// Panels, row by row.
    pub(super) panels: Vec<Panel>,
    /// Panels per row.
    pub(super) columns: usize,
    /// Height of a panel.
    pub(super) height: i32,
    /// Labels of the axes, with markup.
    pub(super) x_label: String,
    pub(super) y_label: String,
    /// Names of the lines, by colour.
    pub(super) legend: Vec<(RGBColor, String)>,
    /// Sentences below everything.
    pub(super) notes: Vec<String>,
}

impl Chart {
    pub(super) fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let (size, body) = self.body(source.sweep.title.as_deref())?;
        Ok(Svg::new(self.name, source, size, &body))
    }

    /// Size of the canvas, and what is drawn on it below a title.
    pub(super) fn body(&self, title: Option<&str>) -> Result<((u32, u32), String), PlotError> {
        let layout = Layout::new(self, title);
        let size = (layout.size.0 as u32, layout.size.1 as u32);
        let mut body = String::new();
        {
            let sheet = Canvas::new(&mut body, size).into_drawing_area();
            for index in 0..self.panels.len() {
                self.draw_panel(&sheet, &layout, index)?;
            }
            self.draw_words(&sheet, &layout)?;
            layout.legend.0.draw(&sheet, layout.legend.1)?;
        }
        Ok((size, body))
    }

    fn draw_panel(&self, sheet: &Sheet<'_>, layout: &Layout, index: usize) -> Drawn {
        let panel = &self.panels[index];
        let (left, top) = layout.corner(index);
        let width = layout.panel.0;
        let axes = Axes::new(
            sheet,
            (left, top),
            layout.panel,
            layout.ticks[index],
            layout.scales[index].clone(),
        )?;
        let plot = axes.plot();
        if panel.y.0 < 0.0 && panel.y.1 > 0.0 {
            let zero = plot.map_coordinate(&(panel.x.0, 0.0)).1;
            style::guide(sheet, [(left, zero), (left + width, zero)])?;
        }
        for line in &panel.lines {
            let inside = |point: &&(f64, f64)| (panel.x.0..=panel.x.1).contains(&point.0);
            let places = line.points.iter().filter(inside);
            let places = thinned(places.map(|point| plot.map_coordinate(point)));
            style::line(sheet, &places, line.color)?;
        }
        for bar in &panel.bars {
            let point = plot.map_coordinate(&bar.at);
            let ends = bar
                .ends()
                .map(|end| plot.map_coordinate(&(bar.at.0, end)).1);
            style::bar(sheet, point, ends, bar.color)?;
        }
        axes.draw()?;
        let head = letters(SMALL, HPos::Center, VPos::Bottom);
        for (index, line) in layout.heads[index].iter().rev().enumerate() {
            let place = (left + width / 2, top - px(3) - index as i32 * LINE);
            sheet.draw_text(line, &head, place)?;
        }
        Ok(())
    }

    fn draw_words(&self, sheet: &Sheet<'_>, layout: &Layout) -> Drawn {
        for (index, line) in layout.title.iter().enumerate() {
            let style = letters(TITLE, HPos::Center, VPos::Top);
            let y = MARGIN + index as i32 * TITLE_LINE;
            sheet.draw_text(line, &style, (WIDTH / 2, y))?;
        }
        let small = letters(SMALL, HPos::Center, VPos::Top);
        for (lines, top) in [&layout.common, &layout.notes] {
            for (index, line) in lines.iter().enumerate() {
                sheet.draw_text(line, &small, (WIDTH / 2, top + index as i32 * LINE))?;
            }
        }
        let (left, top) = layout.origin;
        let (right, bottom) = layout.end();
        let x_label = letters(LABEL, HPos::Center, VPos::Top);
        let below = (left.midpoint(right), bottom + TICKS_BELOW + px(6));
        sheet.draw_text(&self.x_label, &x_label, below)?;
        let y_label = x_label.transform(FontTransform::Rotate270);
        sheet.draw_text(&self.y_label, &y_label, (MARGIN, top.midpoint(bottom)))
    }
}

/// Where the parts of a chart go, in units of the canvas.
struct Layout {
    size: (i32, i32),
    title: Vec<String>,
    /// Lines that hold for all panels and lines of notes, with their upper ends.
    common: (Vec<String>, i32),
    notes: (Vec<String>, i32),
    /// Lines above each panel.
    heads: Vec<Vec<String>>,
    /// Upper left corner of the first panel.
    origin: (i32, i32),
    panel: (i32, i32),
    /// From the corner of a panel to that of the next one to the right and below.
    pitch: (i32, i32),
    columns: usize,
    scales: Vec<(Scale, Scale)>,
    /// Room for tick labels left of and below a panel; zero where the panel before has the same.
    ticks: Vec<(i32, i32)>,
    legend: (Legend, (i32, i32)),
}

impl Layout {
    fn new(chart: &Chart, title: Option<&str>) -> Self {
        let count = chart.panels.len();
        let columns = chart.columns.min(count).max(1);
        let y_scales: Vec<Scale> = chart
            .panels
            .iter()
            .map(|panel| scale(panel.y, chart.height, Direction::Vertical))
            .collect();
        let own_y = |index: usize| {
            index.is_multiple_of(columns) || chart.panels[index].y != chart.panels[index - 1].y
        };
        let own_x = |index: usize| {
            let below = chart.panels.get(index + columns);
            below.is_none_or(|below| below.x != chart.panels[index].x)
        };
        let widths = y_scales.iter().map(|y| y.label_width(f64::from(SMALL)));
        let tick_room = 2 * TICK + widths.fold(0.0, f64::max).ceil() as i32;
        let inner = (0..count).filter(|index| !index.is_multiple_of(columns));
        let left = MARGIN + LABEL + px(8) + tick_room;
        // The widest panel that could be, for the half of a tick label that reaches beyond it.
        let widest = (WIDTH - MARGIN - left) / columns as i32;
        let beyond = chart.panels.iter().map(|panel| beyond(panel.x, widest));
        let beyond = beyond.fold((0, 0), |most, next| {
            (most.0.max(next.0), most.1.max(next.1))
        });
        let gap_x = GAP
            + beyond.1
            + if inner.clone().any(own_y) {
                tick_room.max(beyond.0)
            } else {
                beyond.0
            };
        let room = WIDTH - MARGIN - beyond.1 - left - gap_x * (columns as i32 - 1);
        let panel = (room / columns as i32, chart.height);
        let lines =
            |items: &[String], room: i32| text::wrap_list(items, f64::from(SMALL), f64::from(room));
        let heads: Vec<Vec<String>> = chart
            .panels
            .iter()
            .map(|of| lines(&of.head, panel.0))
            .collect();
        let head = match heads.iter().map(Vec::len).max() {
            None | Some(0) => 0,
            Some(most) => HEAD + LINE * (most as i32 - 1),
        };
        let gap_y = px(10)
            + if (0..count.saturating_sub(columns)).any(own_x) {
                TICKS_BELOW
            } else {
                0
            };
        let title = title_lines(title);
        let common = lines(&chart.common, WIDTH - 2 * MARGIN);
        let below_title = title_height(&title);
        let top = below_title + LINE * common.len() as i32;
        let mut layout = Self {
            size: (WIDTH, 0),
            origin: (left, top + head),
            title,
            common: (common, below_title - px(4)),
            notes: (note_lines(&chart.notes), 0),
            heads,
            panel,
            pitch: (panel.0 + gap_x, panel.1 + gap_y + head),
            columns,
            scales: chart
                .panels
                .iter()
                .zip(y_scales)
                .map(|(panel_of, y)| (scale(panel_of.x, panel.0, Direction::Horizontal), y))
                .collect(),
            ticks: (0..count)
                .map(|index| {
                    let room = |own: bool, room: i32| if own { room } else { 0 };
                    (
                        room(own_y(index), tick_room),
                        room(own_x(index), TICKS_BELOW),
                    )
                })
                .collect(),
            legend: (legend(&chart.legend, WIDTH - MARGIN - left), (left, 0)),
        };
        let mut bottom = layout.end().1 + TICKS_BELOW + px(6) + LABEL + px(4);
        let legend = layout.legend.0.size().1;
        if legend > 0 {
            layout.legend.1.1 = bottom + px(8);
            bottom += px(8) + legend;
        }
        layout.notes.1 = bottom + px(8);
        if !layout.notes.0.is_empty() {
            bottom += px(8) + LINE * layout.notes.0.len() as i32;
        }
        layout.size.1 = whole(bottom + MARGIN);
        layout
    }

    fn corner(&self, index: usize) -> (i32, i32) {
        let (column, row) = ((index % self.columns) as i32, (index / self.columns) as i32);
        (
            self.origin.0 + column * self.pitch.0,
            self.origin.1 + row * self.pitch.1,
        )
    }

    /// Lower right corner of all panels together.
    fn end(&self) -> (i32, i32) {
        let rows = self.scales.len().div_ceil(self.columns).max(1) as i32;
        (
            self.corner(self.columns - 1).0 + self.panel.0,
            self.origin.1 + (rows - 1) * self.pitch.1 + self.panel.1,
        )
    }
}

fn legend(names: &[(RGBColor, String)], room: i32) -> Legend {
    let entry = |(color, text): &(RGBColor, String)| Entry {
        key: Key::Line(*color),
        text: text.clone(),
    };
    Legend::new(names.iter().map(entry).collect(), room)
}

/// How far the first and the last tick label of a horizontal axis reach beyond its ends.
fn beyond(range: (f64, f64), length: i32) -> (i32, i32) {
    let scale = scale(range, length, Direction::Horizontal);
    let ends = [scale.ticks().first(), scale.ticks().last()].map(|tick| {
        let (value, label) = tick?;
        let half = 0.5 * text::width(label, f64::from(SMALL));
        Some((half, scale.fraction(*value) * f64::from(length)))
    });
    let reach = |end: Option<(f64, f64)>, inside: &dyn Fn(f64) -> f64| {
        end.map_or(0.0, |(half, place)| (half - inside(place)).max(0.0))
    };
    (
        reach(ends[0], &|place| place).ceil() as i32,
        reach(ends[1], &|place| f64::from(length) - place).ceil() as i32,
    )
}

/// Lines of notes below a figure.
pub(super) fn note_lines(notes: &[String]) -> Vec<String> {
    let room = f64::from(WIDTH - 2 * MARGIN);
    let lines = notes.iter();
    lines
        .flat_map(|note| text::wrap(note, f64::from(SMALL), room))
        .collect()
}

fn scale((low, high): (f64, f64), length: i32, direction: Direction) -> Scale {
    let room = Room {
        length: f64::from(length),
        size: f64::from(SMALL),
        direction,
    };
    Scale::new(low, high, false, &[], room)
}

/// A polyline that looks the same with fewer points: of those in one CSS pixel of x only the
/// first, the lowest, the highest and the last.
fn thinned(points: impl Iterator<Item = (i32, i32)>) -> Vec<(i32, i32)> {
    let points: Vec<(i32, i32)> = points.collect();
    let mut kept = Vec::new();
    for column in points.chunk_by(|one, next| one.0.div_euclid(px(1)) == next.0.div_euclid(px(1))) {
        let ends = [0, column.len() - 1];
        let lowest = (0..column.len()).min_by_key(|&index| column[index].1);
        let highest = (0..column.len()).max_by_key(|&index| column[index].1);
        let mut indices: Vec<usize> = ends.into_iter().chain(lowest).chain(highest).collect();
        indices.sort_unstable();
        indices.dedup();
        kept.extend(indices.into_iter().map(|index| column[index]));
    }
    kept.dedup();
    kept
}

/// The range of all values, with a little room at both ends; `None` if no value is finite.
pub(super) fn range(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (value.min(low), value.max(high))
    });
    let room = match high - low {
        span if span > 0.0 => 0.05 * span,
        0.0 if high != 0.0 => 0.5 * high.abs(),
        0.0 => 1.0,
        _ => return None,
    };
    Some((low - room, high + room))
}

/// A unit with the prefix in which `largest` is at least one, from nano to mega, and the factor to
/// it.
pub(super) fn prefixed(unit: &str, largest: f64) -> (String, f64) {
    const PREFIXES: [(f64, &str); 6] = [
        (1e-6, "M"),
        (1e-3, "k"),
        (1.0, ""),
        (1e3, "m"),
        (1e6, "µ"),
        (1e9, "n"),
    ];
    let fits = |prefix: &&(f64, &str)| largest * prefix.0 >= 1.0;
    let (factor, prefix) = PREFIXES.iter().find(fits).unwrap_or(&(1.0, ""));
    (format!("{prefix}{unit}"), *factor)
}

/// Panels per row for figures of one panel per run.
pub(super) fn columns(panels: usize) -> usize {
    match panels {
        0..=3 => panels,
        4 => 2,
        _ => 3,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn prefixes() {
        assert_eq!(prefixed("J", 3.2e-4), ("µJ".to_owned(), 1e6));
        assert_eq!(prefixed("J", 1.0), ("J".to_owned(), 1.0));
        assert_eq!(prefixed("N", 0.02), ("mN".to_owned(), 1e3));
        assert_eq!(prefixed("J", 0.0), ("J".to_owned(), 1.0));
    }

    #[test]
    fn ranges_hold_their_values() {
        assert_eq!(range([1.0, f64::NAN, 3.0]), Some((0.9, 3.1)));
        assert_eq!(range([0.0, 0.0]), Some((-1.0, 1.0)));
        assert_eq!(range([-4.0]), Some((-6.0, -2.0)));
        assert_eq!(range([f64::NAN]), None);
    }

    proptest! {
        #[test]
        fn thinning_keeps_ends_and_extremes(
            heights in prop::collection::vec(-1000..1000_i32, 1..400),
            step in 1..30_i32,
        ) {
            let points: Vec<(i32, i32)> =
                (0..).map(|index| index * step).zip(heights.iter().copied()).collect();
            let kept = thinned(points.iter().copied());
            prop_assert_eq!(kept.first(), points.first());
            prop_assert_eq!(kept.last(), points.last());
            prop_assert_eq!(kept.iter().map(|p| p.1).max(), points.iter().map(|p| p.1).max());
            prop_assert!(kept.len() <= 4 * (points.len() * step as usize / 10 + 1));
            prop_assert!(kept.iter().all(|point| points.contains(point)));
            prop_assert!(kept.windows(2).all(|pair| pair[0].0 <= pair[1].0));
        }
    }
}
