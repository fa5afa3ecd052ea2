//! Sizes, strokes and letters that all figures share.

use super::canvas::{Canvas, UNITS};
use super::palette;
use super::text::FONT;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind};
use plotters::element::{PathElement, Rectangle};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    BLACK, Color, FontDesc, FontFamily, FontStyle, RGBColor, ShapeStyle, TextStyle,
};
use std::convert::Infallible;

/// The sheet a figure is drawn on.
pub(super) type Sheet<'a> = DrawingArea<Canvas<'a>, Shift>;

/// Result of drawing.
pub(super) type Drawn = Result<(), DrawingAreaErrorKind<Infallible>>;

/// Units of the canvas of a length in CSS pixels.
pub(super) const fn px(pixels: i32) -> i32 {
    pixels * UNITS
}

/// Width of a figure.
pub(super) const WIDTH: i32 = px(720);
/// White around a figure.
pub(super) const MARGIN: i32 = px(12);
/// Size of the title's letters.
pub(super) const TITLE: i32 = px(15);
/// Size of the letters of axis labels.
pub(super) const LABEL: i32 = px(13);
/// Size of the letters of ticks, legends and heads of panels.
pub(super) const SMALL: i32 = px(12);
/// Length of a tick.
pub(super) const TICK: i32 = px(4);

/// Stroke of frames and ticks.
pub(super) fn frame() -> ShapeStyle {
    BLACK.stroke_width(8)
}

/// Black letters of a size, anchored.
pub(super) fn letters(size: i32, horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    let font = FontDesc::new(FontFamily::Name(FONT), f64::from(size), FontStyle::Normal);
    TextStyle::from(font).pos(Pos::new(horizontal, vertical))
}

/// A rectangle by its corners (left, top), (right, bottom).
pub(super) type Corners = [(i32, i32); 2];

/// Fills a rectangle.
pub(super) fn fill(sheet: &Sheet<'_>, corners: Corners, color: RGBColor) -> Drawn {
    sheet.draw(&Rectangle::new(corners, color.filled()))
}

/// Draws the outline of a rectangle.
pub(super) fn outline(sheet: &Sheet<'_>, corners: Corners, style: ShapeStyle) -> Drawn {
    let [(left, top), (right, bottom)] = corners;
    let path = [
        (left, top),
        (right, top),
        (right, bottom),
        (left, bottom),
        (left, top),
    ];
    sheet.draw(&PathElement::new(path, style))
}

/// Marks a rectangle as one without a value. The hatch goes through from one to the next.
pub(super) fn hatch(sheet: &Sheet<'_>, corners: Corners) -> Drawn {
    const SPACING: i32 = px(5);
    fill(sheet, corners, palette::EMPTY)?;
    let [(left, top), (right, bottom)] = corners;
    let mut sum = (left + top).div_euclid(SPACING) * SPACING + SPACING;
    while sum < right + bottom {
        let from = (left.max(sum - bottom), bottom.min(sum - left));
        let to = (right.min(sum - top), top.max(sum - right));
        sheet.draw(&PathElement::new(
            [from, to],
            palette::HATCH.stroke_width(6),
        ))?;
        sum += SPACING;
    }
    Ok(())
}

/// Draws the curve of a theory: black with a white border, visible on every colour.
pub(super) fn curve(sheet: &Sheet<'_>, points: &[(i32, i32)]) -> Drawn {
    use plotters::style::WHITE;
    sheet.draw(&PathElement::new(points, WHITE.stroke_width(44)))?;
    sheet.draw(&PathElement::new(points, BLACK.stroke_width(20)))
}

/// Draws a line of a chart.
pub(super) fn line(sheet: &Sheet<'_>, points: &[(i32, i32)], color: RGBColor) -> Drawn {
    sheet.draw(&PathElement::new(points, color.stroke_width(15)))
}

/// Draws a straight line that helps the eye.
pub(super) fn guide(sheet: &Sheet<'_>, ends: [(i32, i32); 2]) -> Drawn {
    sheet.draw(&PathElement::new(ends, palette::GUIDE.stroke_width(8)))
}
