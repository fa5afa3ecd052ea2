//! The canvas: a plotters backend that writes SVG.
//!
//! One unit of the canvas is a tenth of a CSS pixel, so that curves and letters fall where they
//! belong although plotters counts in whole units. Straight edges are put on the pixels of the
//! PNG, which has [`PNG_SCALE`] of them per CSS pixel: no hairlines between cells, no blur.

use super::PlotError;
use super::text::{SUBSCRIPT_SIZE, plain, runs};
use crate::fonts::{self, FAMILY};
use crate::markup::escape;
use crate::render::Image;
use base64::Engine;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind, IntoDrawingArea};
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
    FontTransform,
};
use std::convert::Infallible;
use std::fmt::Write;

/// Units of the canvas per CSS pixel.
pub(super) const UNITS: i32 = 10;

/// Pixels of the PNG per CSS pixel.
pub(super) const PNG_SCALE: f32 = 2.5;

/// Units of the canvas per pixel of the PNG.
pub(super) const SNAP: i32 = 4;

/// The sheet a figure is drawn on.
pub(super) type FigureSheet<'a> = DrawingArea<Canvas<'a>, Shift>;

/// Why drawing failed.
pub(super) type Failed = DrawingAreaErrorKind<Infallible>;

/// Result of drawing.
pub(super) type Drawn = Result<(), Failed>;

type CanvasResult = Result<(), DrawingErrorKind<Infallible>>;

/// What has been drawn on a canvas.
#[derive(Clone, Debug, Default)]
pub(super) struct Body {
    size: (u32, u32),
    elements: String,
    /// Texts with letters that the font lacks, and these letters.
    pub(super) unwritten: Vec<(String, Vec<char>)>,
    /// What cannot be seen on it.
    pub(super) warnings: Vec<String>,
}

/// Collects the elements of an SVG.
pub(super) struct Canvas<'a> {
    body: &'a mut Body,
}

/// Draws on a canvas of that size.
pub(super) fn draw(
    (width, height): (i32, i32),
    content: impl FnOnce(&FigureSheet<'_>) -> Drawn,
) -> Result<Body, PlotError> {
    let mut body = Body {
        size: (width as u32, height as u32),
        ..Body::default()
    };
    let canvas = Canvas { body: &mut body };
    content(&canvas.into_drawing_area())?;
    Ok(body)
}

impl Canvas<'_> {
    fn element(&mut self, element: &str) -> CanvasResult {
        self.body.elements.push_str(element);
        self.body.elements.push('\n');
        Ok(())
    }
}

impl DrawingBackend for Canvas<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.body.size
    }

    fn ensure_prepared(&mut self) -> CanvasResult {
        Ok(())
    }

    fn present(&mut self) -> CanvasResult {
        Ok(())
    }

    fn draw_pixel(&mut self, point: BackendCoord, color: BackendColor) -> CanvasResult {
        self.draw_rect(point, (point.0 + 1, point.1 + 1), &color, true)
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> CanvasResult {
        self.draw_path([from, to], style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        (left, top): BackendCoord,
        (right, bottom): BackendCoord,
        style: &S,
        fill: bool,
    ) -> CanvasResult {
        if !fill {
            let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
            return self.draw_path(corners.into_iter().chain([(left, top)]), style);
        }
        let (left, top, right, bottom) = (snap(left), snap(top), snap(right), snap(bottom));
        let paint = paint("fill", style.color());
        self.element(&format!(
            r#"<rect x="{left}" y="{top}" width="{}" height="{}" {paint}/>"#,
            right - left,
            bottom - top
        ))
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> CanvasResult {
        let mut points: Vec<BackendCoord> = path.into_iter().collect();
        let straight = points
            .windows(2)
            .all(|pair| pair[0].0 == pair[1].0 || pair[0].1 == pair[1].1);
        if straight {
            for point in &mut points {
                *point = (snap(point.0), snap(point.1));
            }
        }
        let kind = if straight {
            r#" class="straight""#
        } else {
            r#" stroke-linejoin="round""#
        };
        let data = path_data(&points);
        let (paint, width) = (paint("stroke", style.color()), style.stroke_width());
        self.element(&format!(
            r#"<path d="{data}" fill="none" {paint} stroke-width="{width}"{kind}/>"#
        ))
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        (x, y): BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> CanvasResult {
        let paint = if fill {
            paint("fill", style.color())
        } else {
            let stroke = paint("stroke", style.color());
            format!(
                r#"fill="none" {stroke} stroke-width="{}""#,
                style.stroke_width()
            )
        };
        self.element(&format!(
            r#"<circle cx="{x}" cy="{y}" r="{radius}" {paint}/>"#
        ))
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        vertices: I,
        style: &S,
    ) -> CanvasResult {
        let points: Vec<BackendCoord> = vertices.into_iter().collect();
        let (data, paint) = (path_data(&points), paint("fill", style.color()));
        self.element(&format!(r#"<path d="{data}Z" {paint}/>"#))
    }

    fn draw_text<T: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &T,
        (x, y): BackendCoord,
    ) -> CanvasResult {
        let size = style.size();
        let lacking = fonts::lacking(text);
        if !lacking.is_empty() {
            self.body.unwritten.push((plain(text), lacking));
        }
        // Top is the top of capitals (.73 em), bottom the end of descenders (.24 em).
        let baseline = match style.anchor().v_pos {
            VPos::Top => 0.73,
            VPos::Center => 0.365,
            VPos::Bottom => -0.24,
        };
        let anchor = match style.anchor().h_pos {
            HPos::Left => "start",
            HPos::Center => "middle",
            HPos::Right => "end",
        };
        let rotation = match style.transform() {
            FontTransform::None => String::new(),
            FontTransform::Rotate90 => format!(r#" transform="rotate(90 {x} {y})""#),
            FontTransform::Rotate180 => format!(r#" transform="rotate(180 {x} {y})""#),
            FontTransform::Rotate270 => format!(r#" transform="rotate(270 {x} {y})""#),
        };
        let y = f64::from(y) + baseline * size;
        let paint = paint("fill", style.color());
        let spans = spans(text, size);
        let place = format!(r#"x="{x}" y="{y:.0}" font-size="{size}" text-anchor="{anchor}""#);
        self.element(&format!("<text {place} {paint}{rotation}>{spans}</text>"))
    }
}

/// Nearest pixel edge of the PNG.
fn snap(unit: i32) -> i32 {
    (unit + SNAP / 2).div_euclid(SNAP) * SNAP
}

/// A `fill` or `stroke` attribute.
fn paint(attribute: &str, color: BackendColor) -> String {
    let (red, green, blue) = color.rgb;
    let mut paint = format!("{attribute}=\"#{red:02x}{green:02x}{blue:02x}\"");
    if color.alpha < 1.0 {
        paint.push_str(&format!(" {attribute}-opacity=\"{}\"", color.alpha));
    }
    paint
}

fn path_data(points: &[BackendCoord]) -> String {
    let mut data = String::new();
    for (index, (x, y)) in points.iter().enumerate() {
        let command = if index == 0 { 'M' } else { 'L' };
        write!(data, "{command}{x} {y}").expect("writing to a string cannot fail");
    }
    data
}

/// The content of a text element: its runs, subscripts lowered.
fn spans(text: &str, size: f64) -> String {
    let drop = (0.2 * size).round();
    let mut lowered = false;
    let mut content = String::new();
    for run in runs(text) {
        let mut attributes = String::new();
        if run.subscript != lowered {
            let shift = if run.subscript { drop } else { -drop };
            attributes.push_str(&format!(r#" dy="{shift}""#));
            lowered = run.subscript;
        }
        if run.subscript {
            attributes.push_str(&format!(r#" font-size="{:.0}""#, SUBSCRIPT_SIZE * size));
        }
        if run.oblique {
            attributes.push_str(r#" font-style="oblique""#);
        }
        let text = escape(&run.text);
        if attributes.is_empty() {
            content.push_str(&text);
        } else {
            content.push_str(&format!("<tspan{attributes}>{text}</tspan>"));
        }
    }
    content
}

/// A picture as an element, its PNG file in it; one pixel of it is one of the PNG of the figure.
pub(super) fn picture(image: &Image, (x, y): (i32, i32), file: &[u8]) -> String {
    let (width, height) = (image.width * SNAP as usize, image.height * SNAP as usize);
    let data = base64::engine::general_purpose::STANDARD.encode(file);
    format!(
        "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" \
         href=\"data:image/png;base64,{data}\"/>\n"
    )
}

/// What is drawn as an SVG document, `head` before it.
pub(super) fn document(head: &str, body: &Body) -> String {
    let (width, height) = body.size;
    let body = &body.elements;
    let pixels = |units: u32| f64::from(units) / f64::from(UNITS);
    let view = format!(r#"viewBox="0 0 {width} {height}""#);
    let font = format!(r#"font-family="'{FAMILY}', Verdana, sans-serif""#);
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" role="img" width="{}" height="{}" {view} {font}>
{head}<style>rect, .straight {{ shape-rendering: crispEdges }}</style>
<rect width="{width}" height="{height}" fill="#ffffff"/>
{body}</svg>
"##,
        pixels(width),
        pixels(height)
    )
}
