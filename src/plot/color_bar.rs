//! The colour bar: which colour stands for which value.

use super::canvas::{Drawn, FigureSheet};
use super::chart::ends;
use super::palette;
use super::scale::{AxisRoom, AxisScale, AxisSpan};
use super::style::{self, LABEL, SMALL, TICK, frame, letters, px};
use super::text;
use crate::color::ColorMap;
use plotters::coord::ranged1d::Ranged;
use plotters::element::PathElement;
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{FontTransform, RGBColor};

/// Width of the bar itself.
const BAR: i32 = px(16);
/// Distance of the label's lines.
const LINE: i32 = px(17);
/// Steps of colour.
const STEPS: i32 = 128;

/// A range of values and their colours.
#[derive(Clone, Debug)]
pub(super) struct ColorBar {
    low: f64,
    high: f64,
    map: ColorMap,
    /// Name and unit of the values, with markup, line by line.
    label: Vec<String>,
    height: i32,
}

impl ColorBar {
    /// The bar for these values; `None` if empty. A `signed` quantity gets a map with zero in the
    /// middle, even if all values have one sign.
    pub(super) fn new(
        values: impl Iterator<Item = f64>,
        signed: bool,
        label: String,
    ) -> Option<Self> {
        let (mut low, mut high) = ends(values);
        if low > high {
            return None;
        }
        let map = if signed {
            high = high.abs().max(low.abs());
            low = -high;
            ColorMap::Diverging
        } else {
            ColorMap::Sequential
        };
        if high - low <= 1e-9 * high.abs().max(low.abs()) {
            let widening = if high == 0.0 { 1.0 } else { 0.5 * high.abs() };
            (low, high) = (low - widening, high + widening);
        }
        Some(Self {
            low,
            high,
            map,
            label: vec![label],
            height: 0,
        })
    }

    /// The same with a height, and with a label in lines that fit.
    pub(super) fn fitted(self, height: i32) -> Self {
        let label = text::wrap(&self.label.join(" "), f64::from(LABEL), f64::from(height));
        Self {
            label,
            height,
            ..self
        }
    }

    /// Colour of a value.
    pub(super) fn color(&self, value: f64) -> RGBColor {
        palette::mapped(self.map, (value - self.low) / (self.high - self.low))
    }

    fn scale(&self) -> AxisScale {
        AxisScale::new(
            &AxisSpan::linear((self.low, self.high)),
            AxisRoom::Up(self.height),
        )
    }

    /// Its width with numbers and label.
    pub(super) fn width(&self) -> i32 {
        let numbers = 2 * TICK + self.scale().label_width();
        BAR + numbers + px(6) + LINE * self.label.len() as i32
    }

    /// Draws it with its upper left corner at `origin`.
    pub(super) fn draw(&self, sheet: &FigureSheet<'_>, origin: (i32, i32)) -> Drawn {
        let (left, top) = origin;
        let (right, bottom) = (left + BAR, top + self.height);
        for step in 0..STEPS {
            let edge = |index: i32| bottom - self.height * index / STEPS;
            let color = palette::mapped(self.map, (f64::from(step) + 0.5) / f64::from(STEPS));
            style::fill(sheet, [(left, edge(step + 1)), (right, edge(step))], color)?;
        }
        style::outline(sheet, [(left, top), (right, bottom)], frame())?;
        let scale = self.scale();
        let numbers = letters(SMALL, HPos::Left, VPos::Center);
        for (value, text) in scale.ticks() {
            let y = scale.map(value, (bottom, top));
            sheet.draw(&PathElement::new([(right, y), (right + TICK, y)], frame()))?;
            sheet.draw_text(text, &numbers, (right + 2 * TICK, y))?;
        }
        // The label is read from below, its last line on the right.
        let name = letters(LABEL, HPos::Center, VPos::Bottom).transform(FontTransform::Rotate270);
        let (end, middle) = (left + self.width(), top + self.height / 2);
        for (index, line) in self.label.iter().rev().enumerate() {
            sheet.draw_text(line, &name, (end - LINE * index as i32, middle))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bar(values: &[f64], signed: bool) -> ColorBar {
        ColorBar::new(values.iter().copied(), signed, String::new()).unwrap()
    }

    #[test]
    fn spans_the_values() {
        let bar = bar(&[3.0, -1.0, 2.0], false);
        assert_eq!(
            (bar.low, bar.high, bar.map),
            (-1.0, 3.0, ColorMap::Sequential)
        );
        assert_eq!(bar.color(3.0), palette::mapped(ColorMap::Sequential, 1.0));
    }

    #[test]
    fn zero_is_in_the_middle_of_a_signed_quantity() {
        for values in [[3.0, -1.0], [-3.0, -1.0], [1.0, 3.0]] {
            let bar = bar(&values, true);
            assert_eq!(
                (bar.low, bar.high, bar.map),
                (-3.0, 3.0, ColorMap::Diverging)
            );
        }
    }

    #[test]
    fn equal_values_have_a_range_and_none_have_no_bar() {
        for values in [&[0.0][..], &[2.0, 2.0], &[-5.0]] {
            for signed in [false, true] {
                let bar = bar(values, signed);
                assert!(bar.low < bar.high, "{values:?}");
            }
        }
        assert!(ColorBar::new(std::iter::empty(), true, String::new()).is_none());
    }
}
