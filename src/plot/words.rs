//! Words on a figure, placed from above.

use super::canvas::{Drawn, FigureSheet};
use super::style::{MARGIN, SMALL, TITLE, letters, px};
use super::text;
use plotters::style::TextStyle;
use plotters::style::text_anchor::{HPos, VPos};

/// Distance of the lines of the title.
const TITLE_LINE: i32 = px(20);
/// Distance of lines of small letters.
pub(super) const LINE: i32 = px(16);

/// Words with their places.
pub(super) struct FigureWords {
    /// Each with its style and its anchor.
    placed: Vec<(String, TextStyle<'static>, (i32, i32))>,
    /// Width of the figure.
    width: i32,
    /// Lower end of what has been placed so far.
    pub(super) bottom: i32,
}

impl FigureWords {
    /// None yet, on a figure of that width.
    pub(super) fn new(width: i32) -> Self {
        Self {
            placed: Vec::new(),
            width,
            bottom: MARGIN,
        }
    }

    /// Places the title, and below it what holds for all panels, items of a list.
    pub(super) fn title(&mut self, title: Option<&str>, common: &[String]) {
        let room = f64::from(self.width - 2 * MARGIN);
        if let Some(title) = title.filter(|title| !title.trim().is_empty()) {
            let style = letters(TITLE, HPos::Center, VPos::Top);
            for line in text::wrap(title, f64::from(TITLE), room) {
                self.put(line, style.clone(), (self.width / 2, self.bottom));
                self.bottom += TITLE_LINE;
            }
        }
        let common = text::wrap_list(common, f64::from(SMALL), room);
        self.bottom = self.lines(common, (self.width / 2, self.bottom));
        if !self.placed.is_empty() {
            self.bottom += px(8);
        }
    }

    /// Places sentences.
    pub(super) fn notes(&mut self, notes: &[String]) {
        let room = f64::from(self.width - 2 * MARGIN);
        for note in notes {
            let lines = text::wrap(note, f64::from(SMALL), room);
            self.bottom = self.lines(lines, (self.width / 2, self.bottom));
        }
    }

    /// Places lines of small letters around a middle, below a height; their lower end.
    pub(super) fn lines(&mut self, lines: Vec<String>, (middle, mut top): (i32, i32)) -> i32 {
        for line in lines {
            let style = letters(SMALL, HPos::Center, VPos::Top);
            self.put(line, style, (middle, top));
            top += LINE;
        }
        top
    }

    /// Places a line anywhere.
    pub(super) fn put(&mut self, line: String, style: TextStyle<'static>, place: (i32, i32)) {
        self.placed.push((line, style, place));
    }

    /// Draws them.
    pub(super) fn draw(&self, sheet: &FigureSheet<'_>) -> Drawn {
        let mut placed = self.placed.iter();
        placed.try_for_each(|(line, style, place)| sheet.draw_text(line, style, *place))
    }
}
