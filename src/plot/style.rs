//! Sizes, strokes and letters that all figures share.

use super::canvas::{Drawn, FigureSheet, UNITS};
use super::palette;
use crate::fonts;
use plotters::element::{Circle, DashedPathElement, PathElement, Rectangle};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    BLACK, Color, FontDesc, FontFamily, FontStyle, RGBColor, ShapeStyle, TextStyle, WHITE,
};

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
    let font = FontDesc::new(
        FontFamily::Name(fonts::FAMILY),
        f64::from(size),
        FontStyle::Normal,
    );
    TextStyle::from(font).pos(Pos::new(horizontal, vertical))
}

/// A rectangle by its corners (left, top), (right, bottom).
pub(super) type Corners = [(i32, i32); 2];

/// Fills a rectangle.
pub(super) fn fill(sheet: &FigureSheet<'_>, corners: Corners, color: RGBColor) -> Drawn {
    sheet.draw(&Rectangle::new(corners, color.filled()))
}

/// Draws the outline of a rectangle.
pub(super) fn outline(sheet: &FigureSheet<'_>, corners: Corners, style: ShapeStyle) -> Drawn {
    sheet.draw(&Rectangle::new(corners, style))
}

/// What a rectangle is filled with. The patterns differ in shape, so that they need no colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fill {
    Color(RGBColor),
    /// Falling lines on a colour: a run that was still not steady at its end.
    Falling(RGBColor),
    /// Oblique lines: no value.
    Hatch,
    /// Crossing oblique lines on white: what went numerically wrong.
    CrossHatch,
    /// Points on white: seeds without a majority.
    Stipple,
    /// One cross on grey: runs that failed.
    Cross,
}

/// Distance of the lines and points of patterns.
const SPACING: i32 = px(5);

/// Fills a rectangle. Patterns go through from one to the next.
pub(super) fn paint(sheet: &FigureSheet<'_>, corners: Corners, with: Fill) -> Drawn {
    match with {
        Fill::Color(color) => fill(sheet, corners, color),
        Fill::Falling(color) => {
            fill(sheet, corners, color)?;
            oblique(sheet, corners, BLACK.mix(0.6).stroke_width(6), false)
        }
        Fill::Hatch => {
            fill(sheet, corners, palette::EMPTY)?;
            oblique(sheet, corners, palette::HATCH.stroke_width(6), true)
        }
        Fill::CrossHatch => {
            fill(sheet, corners, WHITE)?;
            let ink = BLACK.mix(0.75).stroke_width(8);
            oblique(sheet, corners, ink, true)?;
            oblique(sheet, corners, ink, false)
        }
        Fill::Stipple => {
            fill(sheet, corners, WHITE)?;
            stipple(sheet, corners)
        }
        Fill::Cross => {
            fill(sheet, corners, palette::EMPTY)?;
            cross(sheet, corners)
        }
    }
}

/// Draws a cross in the middle of a rectangle.
fn cross(sheet: &FigureSheet<'_>, [(left, top), (right, bottom)]: Corners) -> Drawn {
    let (x, y) = (left.midpoint(right), top.midpoint(bottom));
    let arm = (right - left).min(bottom - top).min(LARGEST_CELL) / 4;
    for turned in [arm, -arm] {
        let ends = [(x - arm, y - turned), (x + arm, y + turned)];
        sheet.draw(&PathElement::new(ends, BLACK.stroke_width(12)))?;
    }
    Ok(())
}

/// Draws oblique lines in a rectangle, to the right upward or downward.
fn oblique(sheet: &FigureSheet<'_>, corners: Corners, ink: ShapeStyle, upward: bool) -> Drawn {
    let [(left, top), (right, bottom)] = corners;
    // Downward lines are upward ones in a rectangle that is turned over.
    let turned = |y: i32| if upward { y } else { -y };
    let (top, bottom) = match upward {
        true => (top, bottom),
        false => (-bottom, -top),
    };
    let mut sum = (left + top).div_euclid(SPACING) * SPACING + SPACING;
    while sum < right + bottom {
        let from = (left.max(sum - bottom), turned(bottom.min(sum - left)));
        let to = (right.min(sum - top), turned(top.max(sum - right)));
        sheet.draw(&PathElement::new([from, to], ink))?;
        sum += SPACING;
    }
    Ok(())
}

/// Draws points in a rectangle, every second row shifted.
fn stipple(sheet: &FigureSheet<'_>, corners: Corners) -> Drawn {
    const POINT: i32 = px(1);
    let [(left, top), (right, bottom)] = corners;
    let first = |edge: i32| (edge + POINT).div_euclid(SPACING) + 1;
    for row in first(top)..=(bottom - POINT).div_euclid(SPACING) {
        let shift = row.rem_euclid(2) * SPACING / 2;
        for column in first(left - shift)..=(right - POINT - shift).div_euclid(SPACING) {
            let centre = (column * SPACING + shift, row * SPACING);
            sheet.draw(&Circle::new(centre, POINT, BLACK.filled()))?;
        }
    }
    Ok(())
}

/// Largest cell that marks of disagreement grow with.
pub(super) const LARGEST_CELL: i32 = px(18);

/// Marks a point at which seeds disagree: a white disc with a black rim, seen on every colour and
/// in grey, the larger the smaller `agreement` is, the share of the seeds in the majority. `cell`
/// is the side of the smallest cell, so that equal agreement has equal discs.
pub(super) fn disagreement(
    sheet: &FigureSheet<'_>,
    centre: (i32, i32),
    agreement: f64,
    cell: i32,
) -> Drawn {
    let diameter = f64::from(cell) * (0.2 + 0.8 * (1.0 - agreement).clamp(0.0, 1.0));
    let radius = (0.5 * diameter).round() as i32;
    sheet.draw(&Circle::new(centre, radius, WHITE.filled()))?;
    sheet.draw(&Circle::new(centre, radius, BLACK.stroke_width(8)))
}

/// Radius of the dot of a run.
const MARK: i32 = px(2);

/// Marks a point at which a run was made: a dot with a white rim. One of a colour has a black ring
/// and is larger.
pub(super) fn mark(sheet: &FigureSheet<'_>, centre: (i32, i32), color: RGBColor) -> Drawn {
    let ring = if color == BLACK { MARK } else { MARK + px(2) };
    sheet.draw(&Circle::new(centre, ring + 8, WHITE.filled()))?;
    sheet.draw(&Circle::new(centre, ring, BLACK.filled()))?;
    if color == BLACK {
        return Ok(());
    }
    sheet.draw(&Circle::new(centre, ring - px(1), color.filled()))
}

/// Draws a border between labels: a thin black line.
pub(super) fn border(sheet: &FigureSheet<'_>, points: &[(i32, i32)]) -> Drawn {
    sheet.draw(&PathElement::new(points, BLACK.mix(0.85).stroke_width(12)))
}

/// Draws the curve of a theory: black with a white border, visible on every colour.
pub(super) fn curve(sheet: &FigureSheet<'_>, points: &[(i32, i32)]) -> Drawn {
    sheet.draw(&PathElement::new(points, WHITE.stroke_width(44)))?;
    sheet.draw(&PathElement::new(points, BLACK.stroke_width(20)))
}

/// Draws the curve of an advice: thin black dashes with a white border.
pub(super) fn dashes(sheet: &FigureSheet<'_>, points: &[(i32, i32)]) -> Drawn {
    for ink in [WHITE.stroke_width(28), BLACK.stroke_width(12)] {
        let points = points.iter().copied();
        sheet.draw(&DashedPathElement::new(points, px(6), px(4), ink))?;
    }
    Ok(())
}

/// Stroke of a line of a chart.
pub(super) fn line(color: RGBColor) -> ShapeStyle {
    color.stroke_width(15)
}
