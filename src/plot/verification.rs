//! Errors of all verification cases over what they may be.

use super::canvas::Canvas;
use super::legend::{Entry, Key, Legend};
use super::style::{self, Drawn, MARGIN, SMALL, Sheet, TICK, TITLE, WIDTH, letters, px};
use super::svg::Svg;
use super::{PlotError, palette, text};
use crate::record::Program;
use crate::scene::Integrator;
use plotters::drawing::IntoDrawingArea;
use plotters::element::{Circle, PathElement};
use plotters::style::Color;
use plotters::style::text_anchor::{HPos, VPos};

/// What became of a case with one integrator.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseError {
    /// The family and the name of the case.
    pub name: String,
    /// The integrator.
    pub integrator: Integrator,
    /// Largest error of its quantities, over the tolerance.
    pub ratio: f64,
}

/// Least and largest ratio that is told apart, as powers of ten.
const DECADES: (i32, i32) = (-6, 1);
/// Height of a row.
const ROW: i32 = px(15);
/// Size of the letters of a row.
const LETTERS: i32 = px(10);
/// Room between title, rows, axis and legend.
const GAP: i32 = px(8);
/// Room for half of the last number of the axis.
const RIGHT: i32 = px(14);
/// Radius of a dot.
const DOT: i32 = px(3);

/// Draws a dot for every case and integrator, at its error over the tolerance.
///
/// # Errors
/// [`PlotError`] if the figure cannot be drawn.
pub fn draw(errors: &[CaseError], program: &Program) -> Result<Svg, PlotError> {
    let layout = Layout::new(errors);
    let size = (WIDTH as u32, layout.height as u32);
    let mut body = String::new();
    {
        let sheet = Canvas::new(&mut body, size).into_drawing_area();
        layout.draw_rows(&sheet)?;
        layout.draw_axis(&sheet)?;
        for error in errors {
            layout.draw_dot(&sheet, error)?;
        }
        let legend = (MARGIN, layout.panel[1].1 + px(46));
        layout.legend.draw(&sheet, legend)?;
    }
    let title = "Verification".to_owned();
    Ok(Svg::of_program("verification", title, program, size, &body))
}

struct Layout {
    /// Names of the rows, from the top.
    rows: Vec<String>,
    panel: style::Corners,
    height: i32,
    legend: Legend,
}

impl Layout {
    fn new(errors: &[CaseError]) -> Self {
        let mut rows: Vec<String> = Vec::new();
        for error in errors {
            if rows.last() != Some(&error.name) {
                rows.push(error.name.clone());
            }
        }
        let widths = rows
            .iter()
            .map(|name| text::width(name, f64::from(LETTERS)));
        let names = widths.fold(0.0, f64::max).ceil() as i32;
        let left = MARGIN + names.min(WIDTH * 2 / 3) + GAP;
        let top = MARGIN + TITLE + 2 * GAP;
        let bottom = top + ROW * rows.len() as i32 + GAP;
        let is_used =
            |integrator: &Integrator| errors.iter().any(|error| error.integrator == *integrator);
        let entries = Integrator::ALL.into_iter().filter(is_used);
        let entries = entries.map(|integrator| Entry {
            key: Key::Dot(color(integrator)),
            text: integrator.name().to_owned(),
        });
        let legend = Legend::new(entries.collect(), WIDTH - 2 * MARGIN);
        Self {
            rows,
            panel: [(left, top), (WIDTH - MARGIN - RIGHT, bottom)],
            height: bottom + px(46) + legend.size().1 + MARGIN,
            legend,
        }
    }

    /// Place of a power of ten on the axis.
    fn across(&self, power: f64) -> i32 {
        let [(left, _), (right, _)] = self.panel;
        let (low, high) = (f64::from(DECADES.0), f64::from(DECADES.1));
        let share = (power.clamp(low, high) - low) / (high - low);
        left + (share * f64::from(right - left)).round() as i32
    }

    /// Middle of a row.
    fn down(&self, row: usize) -> i32 {
        self.panel[0].1 + GAP / 2 + ROW * row as i32 + ROW / 2
    }

    fn draw_rows(&self, sheet: &Sheet<'_>) -> Drawn {
        let [(left, _), (right, _)] = self.panel;
        let title = letters(TITLE, HPos::Center, VPos::Top);
        sheet.draw_text("Verification", &title, (WIDTH / 2, MARGIN))?;
        let name = letters(LETTERS, HPos::Right, VPos::Center);
        for (row, text) in self.rows.iter().enumerate() {
            let y = self.down(row);
            sheet.draw_text(text, &name, (left - GAP, y))?;
            let line = palette::GUIDE.mix(0.5).stroke_width(4);
            sheet.draw(&PathElement::new([(left, y), (right, y)], line))?;
        }
        Ok(())
    }

    fn draw_axis(&self, sheet: &Sheet<'_>) -> Drawn {
        let [(_, top), (_, bottom)] = self.panel;
        style::outline(sheet, self.panel, style::frame())?;
        let label = letters(SMALL, HPos::Center, VPos::Top);
        for power in DECADES.0..=DECADES.1 {
            let x = self.across(f64::from(power));
            let tick = [(x, bottom), (x, bottom + TICK)];
            sheet.draw(&PathElement::new(tick, style::frame()))?;
            let text = match power {
                low if low == DECADES.0 => format!("≤ 1e{low}"),
                0 => "1".to_owned(),
                1 => "≥ 10".to_owned(),
                power => format!("1e{power}"),
            };
            sheet.draw_text(&text, &label, (x, bottom + 2 * TICK))?;
        }
        let limit = self.across(0.0);
        let line = [(limit, top), (limit, bottom)];
        sheet.draw(&PathElement::new(line, palette::GUIDE.stroke_width(16)))?;
        let [(left, _), (right, _)] = self.panel;
        let words = "largest error over the tolerance";
        sheet.draw_text(words, &label, (left.midpoint(right), bottom + px(24)))
    }

    fn draw_dot(&self, sheet: &Sheet<'_>, error: &CaseError) -> Drawn {
        let Some(row) = self.rows.iter().position(|name| *name == error.name) else {
            return Ok(());
        };
        // An error of zero has no logarithm, and belongs to the left end.
        let power = match error.ratio {
            ratio if ratio > 0.0 => libm::log10(ratio),
            _ => f64::from(DECADES.0),
        };
        // One integrator above the other, or equal errors would hide each other.
        let middle = px(2) * (Integrator::ALL.len() as i32 - 1);
        let shift = px(4) * index_of(error.integrator) as i32 - middle;
        let place = (self.across(power), self.down(row) + shift);
        sheet.draw(&Circle::new(place, DOT, color(error.integrator).filled()))
    }
}

fn color(integrator: Integrator) -> plotters::style::RGBColor {
    palette::LINES[index_of(integrator) % palette::LINES.len()]
}

/// Place of an integrator among all.
fn index_of(integrator: Integrator) -> usize {
    let mut all = Integrator::ALL.into_iter();
    all.position(|it| it == integrator).unwrap_or(0)
}
