//! Words and simple shapes in a picture.

use super::Image;
use crate::fonts;
use crate::markup::escape;
use resvg::{tiny_skia, usvg};

/// SVG elements, with letters that are part of the program, in a white picture of this size. A
/// picture that is too large to be drawn stays white.
pub(super) fn drawing(elements: &str, width: usize, height: usize) -> Image {
    let mut image = Image::white(width, height);
    if let Some(pixels) = draw(elements, width, height) {
        for (target, source) in image.rgba.chunks_exact_mut(4).zip(pixels.pixels()) {
            target.copy_from_slice(&[source.red(), source.green(), source.blue(), 255]);
        }
    }
    image
}

fn draw(elements: &str, width: usize, height: usize) -> Option<tiny_skia::Pixmap> {
    let document = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\">\
         {elements}</svg>"
    );
    let tree = usvg::Tree::from_str(&document, &fonts::svg_options()).ok()?;
    let side = |length: usize| u32::try_from(length).ok();
    let mut pixels = tiny_skia::Pixmap::new(side(width)?, side(height)?)?;
    pixels.fill(tiny_skia::Color::WHITE);
    resvg::render(
        &tree,
        tiny_skia::Transform::identity(),
        &mut pixels.as_mut(),
    );
    Some(pixels)
}

/// Alignment of a text at its place.
#[derive(Clone, Copy)]
pub(super) enum TextAnchor {
    Start,
    Middle,
}

/// A line of black text of this size, with its base line at `y`.
pub(super) fn text(text: &str, (x, y): (f64, f64), size: f64, anchor: TextAnchor) -> String {
    let anchor = match anchor {
        TextAnchor::Start => "start",
        TextAnchor::Middle => "middle",
    };
    // XML cannot hold control characters.
    let sound: String = text.chars().filter(|c| !c.is_control()).collect();
    let escaped = escape(&sound);
    format!(
        "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" font-size=\"{size}\">{escaped}</text>"
    )
}

/// Width of a text of this size: an upper bound unless it has only wide letters.
pub(super) fn width(text: &str, size: f64) -> f64 {
    const LETTER: f64 = 0.62;
    LETTER * size * text.chars().count() as f64
}
