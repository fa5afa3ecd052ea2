//! A finished figure: its SVG, its PNG, and where it comes from.

use super::canvas::{self, PNG_SCALE, escape};
use super::{Input, PlotError, text};
use crate::record::RunRecord;
use resvg::{tiny_skia, usvg};
use std::sync::Arc;

/// Largest side of a PNG (pixels); a larger figure is scaled down.
const LARGEST_SIDE: f32 = 5000.0;

/// A finished figure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Svg {
    document: String,
    /// Keys and values for the file's metadata.
    metadata: Vec<(&'static str, String)>,
}

impl Svg {
    /// The figure whose elements are `body`, on a canvas of `size` units.
    pub(super) fn new(figure: &str, input: &Input<'_>, size: (u32, u32), body: &str) -> Self {
        let program = input.program;
        let metadata = vec![
            ("Title", input.sweep.title.clone().unwrap_or_default()),
            ("Software", format!("phase {}", program.version)),
            ("Commit", program.commit.clone()),
            ("Figure", figure.to_owned()),
            (
                "Seeds",
                ranges(input.table.rows.iter().map(|row| row.seed).collect()),
            ),
        ];
        Self::with_metadata(metadata, size, body)
    }

    /// The same for a figure of a single run.
    pub(super) fn of_record(
        figure: &str,
        record: &RunRecord,
        size: (u32, u32),
        body: &str,
    ) -> Self {
        let program = &record.program;
        let metadata = vec![
            ("Title", record.scene.title.clone().unwrap_or_default()),
            ("Software", format!("phase {}", program.version)),
            ("Commit", program.commit.clone()),
            ("Figure", figure.to_owned()),
            ("Seeds", record.scene.seed.to_string()),
        ];
        Self::with_metadata(metadata, size, body)
    }

    /// The figure with keys and values of its metadata, the title first.
    fn with_metadata(metadata: Vec<(&'static str, String)>, size: (u32, u32), body: &str) -> Self {
        let lines: Vec<String> = metadata
            .iter()
            .map(|(key, value)| format!("{key}: {}", escape(value)))
            .collect();
        let title = escape(&text::plain(&metadata[0].1));
        let head = format!(
            "<title>{title}</title>\n<metadata>\n{}\n</metadata>\n",
            lines.join("\n")
        );
        Self {
            document: canvas::document(size, &head, body),
            metadata,
        }
    }

    /// The SVG file. Its text is text; where the font is missing a browser takes another sans
    /// serif.
    pub fn to_svg_bytes(&self) -> Vec<u8> {
        self.document.clone().into_bytes()
    }

    /// The PNG file, drawn with the font that is part of the program.
    ///
    /// # Errors
    ///
    /// [`PlotError::Png`] when the figure is too large to be drawn.
    pub fn to_png_bytes(&self) -> Result<Vec<u8>, PlotError> {
        let failed = |error: &dyn std::fmt::Display| PlotError::Png(error.to_string());
        let mut options = usvg::Options {
            font_family: text::FONT.to_owned(),
            ..usvg::Options::default()
        };
        let fonts = options.fontdb_mut();
        for font in [dejavu::sans::regular(), dejavu::sans::oblique()] {
            fonts.load_font_source(usvg::fontdb::Source::Binary(Arc::new(font)));
        }
        let tree = usvg::Tree::from_str(&self.document, &options).map_err(|e| failed(&e))?;
        let size = tree.size();
        let scale = PNG_SCALE.min(LARGEST_SIDE / size.width().max(size.height()));
        let side = |length: f32| (length * scale).round() as u32;
        let (width, height) = (side(size.width()), side(size.height()));
        let mut pixels = tiny_skia::Pixmap::new(width, height)
            .ok_or_else(|| failed(&format!("no room for {width} x {height} pixels")))?;
        resvg::render(
            &tree,
            tiny_skia::Transform::from_scale(scale, scale),
            &mut pixels.as_mut(),
        );
        self.encode(&pixels, scale).map_err(|e| failed(&e))
    }

    fn encode(
        &self,
        pixels: &tiny_skia::Pixmap,
        scale: f32,
    ) -> Result<Vec<u8>, png::EncodingError> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, pixels.width(), pixels.height());
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        // A CSS pixel is 1/96 of an inch of .0254 m.
        let per_metre = (scale * 96.0 / 0.0254).round() as u32;
        encoder.set_pixel_dims(Some(png::PixelDimensions {
            xppu: per_metre,
            yppu: per_metre,
            unit: png::Unit::Meter,
        }));
        for (key, value) in &self.metadata {
            // A tEXt chunk holds Latin-1 only.
            if value.is_ascii() {
                encoder.add_text_chunk((*key).to_owned(), value.clone())?;
            } else {
                encoder.add_itxt_chunk((*key).to_owned(), value.clone())?;
            }
        }
        // The background is opaque, so the colours are not premultiplied by anything but one.
        let colours: Vec<u8> = pixels
            .pixels()
            .iter()
            .flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()])
            .collect();
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&colours)?;
        writer.finish()?;
        Ok(file)
    }
}

/// Seeds in order, runs of neighbours drawn together: `1-3, 7`.
fn ranges(mut seeds: Vec<u64>) -> String {
    seeds.sort_unstable();
    seeds.dedup();
    seeds
        .chunk_by(|one, next| one + 1 == *next)
        .map(|run| match run {
            [first, .., last] => format!("{first}-{last}"),
            _ => run[0].to_string(),
        })
        .collect::<Vec<_>>()
        .join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_are_ranges() {
        assert_eq!(ranges(vec![7, 3, 1, 2, 2, 9, 10]), "1-3, 7, 9-10");
        assert_eq!(ranges(vec![u64::MAX, 5]), format!("5, {}", u64::MAX));
        assert_eq!(ranges(vec![]), "");
    }
}
