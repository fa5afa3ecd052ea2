//! Animated pictures: APNG and GIF.

use super::image::add_texts;
use super::palette::Palette;
use super::{Image, Rgb};
use std::borrow::Cow;

/// A loop of pictures of equal size, in at most 256 colours.
pub struct Animation {
    width: usize,
    height: usize,
    colors: Vec<Rgb>,
    /// Index of the colour of every pixel, picture by picture.
    frames: Vec<Vec<u8>>,
    /// Time of each picture (1/100 s).
    delay: u16,
}

impl Animation {
    /// An animation of these pictures, each of which is shown for `delay` hundredths of a second.
    ///
    /// # Panics
    /// Without any picture.
    pub fn new(images: &[Image], delay: u16) -> Self {
        let palette = Palette::new(images);
        Self {
            width: images[0].width,
            height: images[0].height,
            frames: images.iter().map(|image| palette.indices(image)).collect(),
            colors: palette.colors,
            delay,
        }
    }

    /// The animation as a PNG file (APNG), with texts (keyword, text) in its metadata. Programs
    /// without support for animations show the first picture.
    ///
    /// # Errors
    /// Errors of the encoder, for example for a picture without pixels.
    pub fn to_apng(&self, texts: &[(&str, String)]) -> Result<Vec<u8>, png::EncodingError> {
        let mut file = Vec::new();
        let side = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
        let mut encoder = png::Encoder::new(&mut file, side(self.width), side(self.height));
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_palette(self.colors.concat());
        encoder.set_compression(png::Compression::High);
        // Indices of neighbouring pixels are unrelated.
        encoder.set_filter(png::Filter::NoFilter);
        encoder.set_animated(side(self.frames.len()), 0)?;
        encoder.set_frame_delay(self.delay, 100)?;
        add_texts(&mut encoder, texts)?;
        let mut writer = encoder.write_header()?;
        for frame in &self.frames {
            writer.write_image_data(frame)?;
        }
        writer.finish()?;
        Ok(file)
    }

    /// The animation as a GIF file.
    ///
    /// # Errors
    /// Errors of the encoder, for example for a picture larger than the 65535 pixels of GIF.
    pub fn to_gif(&self) -> Result<Vec<u8>, gif::EncodingError> {
        let mut file = Vec::new();
        // A size too large for GIF becomes 0, which is refused.
        let side = |length: usize| u16::try_from(length).unwrap_or(0);
        let (width, height) = (side(self.width), side(self.height));
        let mut encoder = gif::Encoder::new(&mut file, width, height, &self.colors.concat())?;
        encoder.set_repeat(gif::Repeat::Infinite)?;
        for frame in &self.frames {
            encoder.write_frame(&gif::Frame {
                width,
                height,
                delay: self.delay,
                buffer: Cow::Borrowed(frame),
                ..gif::Frame::default()
            })?;
        }
        drop(encoder);
        Ok(file)
    }
}
