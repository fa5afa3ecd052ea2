//! The legend: entries in lines that break where the room ends.

use super::canvas::{Drawn, FigureSheet};
use super::style::{self, Fill, SMALL, letters, px};
use super::text;
use plotters::element::{Circle, PathElement};
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{BLACK, Color, RGBColor, WHITE};

/// Size of a key, the small picture of an entry.
const KEY: (i32, i32) = (px(20), px(13));
/// Distance of lines.
const LINE: i32 = px(20);
/// Room between key and text, and between entries.
const GAPS: (i32, i32) = (px(7), px(16));

/// The small picture of an entry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LegendKey {
    /// A colour or pattern.
    Fill(Fill),
    /// The mark of cells in which only this share of the seeds agree.
    Agreement(f64),
    /// The curve of a theory.
    Curve,
    /// The curve of an advice.
    Dashes,
    /// A border between labels.
    Border,
    /// The dot of a run, of a colour.
    Mark(RGBColor),
    /// A line of a chart.
    Line(RGBColor),
    /// A dot.
    Dot(RGBColor),
    /// A ring.
    Ring(RGBColor),
}

/// An entry of a legend.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LegendEntry {
    pub(super) key: LegendKey,
    pub(super) text: String,
}

impl LegendEntry {
    pub(super) fn new(key: LegendKey, text: &str) -> Self {
        let text = text.to_owned();
        Self { key, text }
    }
}

/// Entries with their places.
pub(super) struct Legend {
    entries: Vec<(LegendEntry, (i32, i32))>,
    width: i32,
    height: i32,
    /// Side of the cells whose marks of disagreement are explained.
    pub(super) cell: i32,
}

impl Legend {
    /// Places the entries in lines no wider than `room`.
    pub(super) fn new(entries: Vec<LegendEntry>, room: i32) -> Self {
        let mut legend = Self {
            entries: Vec::new(),
            width: 0,
            height: 0,
            cell: style::LARGEST_CELL,
        };
        let (mut x, mut y) = (0, 0);
        for entry in entries {
            let letters = text::width(&entry.text, f64::from(SMALL)).ceil() as i32;
            let width = KEY.0 + GAPS.0 + letters;
            if x > 0 && x + width > room {
                (x, y) = (0, y + LINE);
            }
            legend.entries.push((entry, (x, y)));
            legend.width = legend.width.max(x + width);
            legend.height = y + LINE;
            x += width + GAPS.1;
        }
        legend
    }

    /// Its width and height.
    pub(super) fn size(&self) -> (i32, i32) {
        (self.width, self.height)
    }

    /// Draws it with its upper left corner at `origin`.
    pub(super) fn draw(&self, sheet: &FigureSheet<'_>, origin: (i32, i32)) -> Drawn {
        for (entry, place) in &self.entries {
            let (left, top) = (origin.0 + place.0, origin.1 + place.1);
            let middle = top + LINE / 2;
            draw_key(sheet, entry.key, (left, middle), self.cell)?;
            let letters = letters(SMALL, HPos::Left, VPos::Center);
            sheet.draw_text(&entry.text, &letters, (left + KEY.0 + GAPS.0, middle))?;
        }
        Ok(())
    }
}

fn draw_key(
    sheet: &FigureSheet<'_>,
    key: LegendKey,
    (left, middle): (i32, i32),
    cell: i32,
) -> Drawn {
    let (right, top, bottom) = (left + KEY.0, middle - KEY.1 / 2, middle + KEY.1 / 2);
    let corners = [(left, top), (right, bottom)];
    let centre = (left.midpoint(right), middle);
    match key {
        LegendKey::Fill(fill) => style::paint(sheet, corners, fill)?,
        LegendKey::Agreement(agreement) => {
            style::fill(sheet, corners, WHITE)?;
            style::disagreement(sheet, centre, agreement, cell)?;
        }
        LegendKey::Curve => return style::curve(sheet, &[(left, middle), (right, middle)]),
        LegendKey::Border => return style::border(sheet, &[(left, middle), (right, middle)]),
        LegendKey::Mark(color) => return style::mark(sheet, centre, color),
        LegendKey::Dashes => return style::dashes(sheet, &[(left, middle), (right, middle)]),
        LegendKey::Dot(color) => {
            let middle = (left.midpoint(right), middle);
            return sheet.draw(&Circle::new(middle, px(3), color.filled()));
        }
        LegendKey::Ring(color) => {
            let middle = (left.midpoint(right), middle);
            return sheet.draw(&Circle::new(middle, px(5), color.stroke_width(15)));
        }
        LegendKey::Line(color) => {
            let ends = [(left, middle), (right, middle)];
            return sheet.draw(&PathElement::new(ends, style::line(color)));
        }
    }
    style::outline(sheet, corners, BLACK.mix(0.6).stroke_width(4))
}
