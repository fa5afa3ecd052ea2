//! Figures as PNG files with a palette: half the size of those with a colour for each pixel.

use resvg::tiny_skia::Pixmap;
use std::collections::BTreeMap;

/// Red, green and blue.
type Rgb8 = [u8; 3];

/// Most colours of a palette.
const MOST_COLORS: usize = 256;

/// The pixels of a figure, encoded with `dots_per_metre` and texts (keyword, text). With
/// `all_colors` every pixel keeps its colour; else the 256 most frequent colours stand for the
/// others, which are shades at the edges of letters and lines.
///
/// # Errors
/// What the encoder says.
pub(super) fn encode(
    pixels: &Pixmap,
    dots_per_metre: u32,
    texts: &[(&'static str, String)],
    all_colors: bool,
) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, pixels.width(), pixels.height());
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: dots_per_metre,
        yppu: dots_per_metre,
        unit: png::Unit::Meter,
    }));
    for (key, value) in texts {
        // A tEXt chunk holds Latin-1 only.
        if value.is_ascii() {
            encoder.add_text_chunk((*key).to_owned(), value.clone())?;
        } else {
            encoder.add_itxt_chunk((*key).to_owned(), value.clone())?;
        }
    }
    // The background is opaque, so the colours are not premultiplied by anything but one.
    let colors = pixels.pixels().iter();
    let colors = colors.map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]);
    let data = if all_colors {
        encoder.set_color(png::ColorType::Rgb);
        colors.flatten().collect()
    } else {
        let (palette, index_of) = palette(colors.clone());
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette.concat());
        // Indices of neighbours have nothing to do with each other.
        encoder.set_filter(png::Filter::NoFilter);
        colors.map(|color| index_of[&color]).collect::<Vec<u8>>()
    };
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&data)?;
    writer.finish()?;
    Ok(file)
}

/// The most frequent colours, and for every colour the place of the nearest of them.
fn palette(colors: impl Iterator<Item = Rgb8>) -> (Vec<Rgb8>, BTreeMap<Rgb8, u8>) {
    let mut counts: BTreeMap<Rgb8, u64> = BTreeMap::new();
    for color in colors {
        *counts.entry(color).or_default() += 1;
    }
    let mut palette: Vec<Rgb8> = counts.keys().copied().collect();
    palette.sort_by_key(|color| std::cmp::Reverse(counts[color]));
    palette.truncate(MOST_COLORS);
    let distance = |one: Rgb8, other: Rgb8| -> u32 {
        let channels = one.iter().zip(other);
        channels
            .map(|(one, other)| u32::from(one.abs_diff(other)).pow(2))
            .sum()
    };
    let nearest = |color: Rgb8| {
        let places = (0..=u8::MAX).zip(&palette);
        let nearest = places.min_by_key(|(_, it)| distance(color, **it));
        nearest.map_or(0, |(place, _)| place)
    };
    let index_of = counts.keys().map(|color| (*color, nearest(*color)));
    let index_of = index_of.collect();
    (palette, index_of)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colors_stay_as_they_are() {
        let colors = [[255, 255, 255], [1, 2, 3], [1, 2, 3], [9, 8, 7]];
        let (palette, index_of) = palette(colors.into_iter());
        for color in colors {
            assert_eq!(palette[usize::from(index_of[&color])], color);
        }
        assert_eq!(palette.len(), 3);
    }

    #[test]
    fn frequent_colors_stay_and_rare_ones_become_their_neighbours() {
        // 512 colours; those with an even green twice, the others once.
        let colors = (0..=255_u8).flat_map(|green| [[0, green, 0], [200, green, 0]]);
        let twice = colors.flat_map(|color| vec![color; if color[1] % 2 == 0 { 2 } else { 1 }]);
        let (palette, index_of) = palette(twice);
        assert_eq!(palette.len(), 256);
        for (color, place) in index_of {
            let shown = palette[usize::from(place)];
            let off = shown[1].abs_diff(color[1]);
            assert_eq!((shown[0], off), (color[0], color[1] % 2), "{color:?}");
        }
    }
}
