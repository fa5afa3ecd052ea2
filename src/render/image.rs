//! A picture in memory.

use super::palette::Palette;

/// A picture, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width (pixels).
    pub width: usize,
    /// Height (pixels).
    pub height: usize,
    /// Red, green, blue and opacity of every pixel, 4 x `width` x `height` bytes.
    pub rgba: Vec<u8>,
}

impl Image {
    /// A white picture.
    pub fn white(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            rgba: vec![255; 4 * width * height],
        }
    }

    /// The pixel in column `x` and row `y`.
    ///
    /// # Panics
    /// Outside the picture.
    pub fn pixel(&self, x: usize, y: usize) -> [u8; 4] {
        let at = 4 * (x + y * self.width);
        [0, 1, 2, 3].map(|channel| self.rgba[at + channel])
    }

    /// Puts another picture into this one, with its top left pixel in column `left` and row `top`;
    /// parts beyond the border are cut off.
    pub fn paste(&mut self, other: &Self, left: usize, top: usize) {
        let columns = other.width.min(self.width.saturating_sub(left));
        for row in 0..other.height.min(self.height.saturating_sub(top)) {
            let from = 4 * row * other.width;
            let to = 4 * (left + (top + row) * self.width);
            self.rgba[to..to + 4 * columns].copy_from_slice(&other.rgba[from..from + 4 * columns]);
        }
    }

    /// Draws a grey line along the border.
    pub(super) fn outline(&mut self) {
        const GREY: [u8; 4] = [160, 160, 160, 255];
        for y in 0..self.height {
            for x in 0..self.width {
                if x == 0 || y == 0 || x + 1 == self.width || y + 1 == self.height {
                    let at = 4 * (x + y * self.width);
                    self.rgba[at..at + 4].copy_from_slice(&GREY);
                }
            }
        }
    }

    /// The picture as a PNG file, with texts (keyword, text) in its metadata.
    ///
    /// # Errors
    /// Errors of the encoder, for example for a keyword that PNG does not allow.
    pub fn to_png(&self, texts: &[(&str, String)]) -> Result<Vec<u8>, png::EncodingError> {
        self.encode(texts, &self.rgba, |encoder| {
            encoder.set_color(png::ColorType::Rgba);
        })
    }

    /// The same in at most 256 colours, a smaller file.
    ///
    /// # Errors
    /// As for [`to_png`](Self::to_png).
    pub fn to_png_of_palette(
        &self,
        texts: &[(&str, String)],
    ) -> Result<Vec<u8>, png::EncodingError> {
        let palette = Palette::new(std::slice::from_ref(self));
        self.encode(texts, &palette.indices(self), |encoder| {
            encoder.set_color(png::ColorType::Indexed);
            encoder.set_palette(palette.colors.concat());
            // Indices of neighbouring pixels are unrelated.
            encoder.set_filter(png::Filter::NoFilter);
        })
    }

    fn encode(
        &self,
        texts: &[(&str, String)],
        data: &[u8],
        set_color: impl FnOnce(&mut png::Encoder<'_, &mut Vec<u8>>),
    ) -> Result<Vec<u8>, png::EncodingError> {
        let mut file = Vec::new();
        let side = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
        let mut encoder = png::Encoder::new(&mut file, side(self.width), side(self.height));
        set_color(&mut encoder);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        add_texts(&mut encoder, texts)?;
        let mut writer = encoder.write_header()?;
        writer.write_image_data(data)?;
        writer.finish()?;
        Ok(file)
    }
}

/// Adds texts (keyword, text) to the metadata of a PNG file.
pub(super) fn add_texts<W: std::io::Write>(
    encoder: &mut png::Encoder<'_, W>,
    texts: &[(&str, String)],
) -> Result<(), png::EncodingError> {
    for (keyword, text) in texts {
        // A tEXt chunk holds Latin-1 only.
        if text.is_ascii() {
            encoder.add_text_chunk((*keyword).to_owned(), text.clone())?;
        } else {
            encoder.add_itxt_chunk((*keyword).to_owned(), text.clone())?;
        }
    }
    Ok(())
}
