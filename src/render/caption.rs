//! A line of text in a picture.

use super::Image;
use resvg::{tiny_skia, usvg};
use std::sync::Arc;

/// Size of the letters over the height of their line.
const LETTERS: f32 = 0.7;

/// A line of black text in the middle of a white picture of that size. What is too large to be
/// drawn stays white.
pub(super) fn caption(text: &str, width: usize, height: usize) -> Image {
    let mut image = Image::white(width, height);
    if let Some(pixels) = draw(text, width, height) {
        for (target, source) in image.rgba.chunks_exact_mut(4).zip(pixels.pixels()) {
            target.copy_from_slice(&[source.red(), source.green(), source.blue(), 255]);
        }
    }
    image
}

fn draw(text: &str, width: usize, height: usize) -> Option<tiny_skia::Pixmap> {
    let escaped = text.replace('&', "&amp;").replace('<', "&lt;");
    let document = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\">\
         <text x=\"50%\" y=\"{}\" text-anchor=\"middle\" font-size=\"{}\">{escaped}</text></svg>",
        height as f32 * 0.75,
        height as f32 * LETTERS
    );
    let mut options = usvg::Options {
        font_family: "DejaVu Sans".to_owned(),
        ..usvg::Options::default()
    };
    options
        .fontdb_mut()
        .load_font_source(usvg::fontdb::Source::Binary(Arc::new(
            dejavu::sans::regular(),
        )));
    let tree = usvg::Tree::from_str(&document, &options).ok()?;
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
