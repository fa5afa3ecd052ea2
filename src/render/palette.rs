//! Few colours for many: median cut (Heckbert, 1982).

use super::{Image, Rgb};

/// Bits per channel that distinguish colours.
const BITS: u32 = 5;
/// Number of distinguished colours.
const CELLS: usize = 1 << (3 * BITS);

/// A palette for pictures, and the assignment of colours to it.
pub(super) struct Palette {
    pub(super) colors: Vec<Rgb>,
    /// Index of the colour of each cell.
    lookup: Vec<u8>,
}

/// A cell of the colours that occur: how many pixels, and the sum of their channels.
#[derive(Clone, Copy, Default)]
struct ColorCell {
    pixels: u64,
    sum: [u64; 3],
}

impl Palette {
    /// At most 256 colours for these pictures.
    pub(super) fn new(images: &[Image]) -> Self {
        let mut cells = vec![ColorCell::default(); CELLS];
        for pixel in images.iter().flat_map(|image| image.rgba.chunks_exact(4)) {
            let cell = &mut cells[index([pixel[0], pixel[1], pixel[2]])];
            cell.pixels += 1;
            for channel in 0..3 {
                cell.sum[channel] += u64::from(pixel[channel]);
            }
        }
        let occupied: Vec<usize> = (0..CELLS).filter(|&i| cells[i].pixels > 0).collect();
        let mut boxes = vec![occupied];
        while boxes.len() < 256 {
            // The box with the largest error; among equals the first.
            let worth = |cells_of: &Vec<usize>| {
                let pixels: u64 = cells_of.iter().map(|&i| cells[i].pixels).sum();
                u64::from(widest(cells_of).1) * pixels
            };
            let (most, at) =
                boxes
                    .iter()
                    .enumerate()
                    .fold((0, 0), |(most, at), (number, cells_of)| {
                        let worth = worth(cells_of);
                        if worth > most {
                            (worth, number)
                        } else {
                            (most, at)
                        }
                    });
            if most == 0 {
                break;
            }
            let upper = split(&mut boxes[at], &cells);
            boxes.push(upper);
        }
        let mut lookup = vec![0; CELLS];
        let mut colors = Vec::with_capacity(boxes.len());
        for cells_of in boxes.iter().filter(|cells_of| !cells_of.is_empty()) {
            for &cell in cells_of {
                lookup[cell] = colors.len() as u8;
            }
            let pixels: u64 = cells_of.iter().map(|&i| cells[i].pixels).sum();
            colors.push([0, 1, 2].map(|channel| {
                let sum: u64 = cells_of.iter().map(|&i| cells[i].sum[channel]).sum();
                ((sum + pixels / 2) / pixels) as u8
            }));
        }
        Self { colors, lookup }
    }

    /// The index of the colour of each pixel.
    pub(super) fn indices(&self, image: &Image) -> Vec<u8> {
        let pixels = image.rgba.chunks_exact(4);
        pixels
            .map(|pixel| self.lookup[index([pixel[0], pixel[1], pixel[2]])])
            .collect()
    }
}

/// The cell of a colour.
fn index(color: Rgb) -> usize {
    color.iter().fold(0, |index, &channel| {
        (index << BITS) | usize::from(channel >> (8 - BITS))
    })
}

/// A channel of a cell.
fn channel(cell: usize, channel: u32) -> u8 {
    ((cell >> (BITS * (2 - channel))) & ((1 << BITS) - 1)) as u8
}

/// The channel in which cells differ most, and by how much.
fn widest(cells: &[usize]) -> (u32, u8) {
    let range = |which: u32| {
        let values = cells.iter().map(|&cell| channel(cell, which));
        let (low, high) = values.fold((u8::MAX, 0), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        high.saturating_sub(low)
    };
    (1..3).fold((0, range(0)), |widest, which| {
        let range = range(which);
        if range > widest.1 {
            (which, range)
        } else {
            widest
        }
    })
}

/// Splits a box of at least two cells at the median of its pixels, in its widest channel; returns
/// the upper part.
fn split(cells_of: &mut Vec<usize>, cells: &[ColorCell]) -> Vec<usize> {
    let (which, _) = widest(cells_of);
    cells_of.sort_by_key(|&cell| (channel(cell, which), cell));
    let all: u64 = cells_of.iter().map(|&cell| cells[cell].pixels).sum();
    let mut below = 0;
    let mut at = 0;
    while at + 1 < cells_of.len() && 2 * (below + cells[cells_of[at]].pixels) <= all {
        below += cells[cells_of[at]].pixels;
        at += 1;
    }
    cells_of.split_off(at.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(colors: &[Rgb]) -> Image {
        Image {
            width: colors.len(),
            height: 1,
            rgba: colors
                .iter()
                .flat_map(|[r, g, b]| [*r, *g, *b, 255])
                .collect(),
        }
    }

    #[test]
    fn few_colours_are_kept() {
        let colors = [[255, 255, 255], [0, 0, 0], [200, 10, 30], [200, 40, 30]];
        let picture = image(&colors);
        let palette = Palette::new(std::slice::from_ref(&picture));
        assert_eq!(palette.colors.len(), 4);
        for (index, color) in palette.indices(&picture).into_iter().zip(colors) {
            assert_eq!(palette.colors[usize::from(index)], color);
        }
    }

    #[test]
    fn many_colours_become_near_ones() {
        let colors: Vec<Rgb> = (0..20_000_u32)
            .map(|i| [(i % 256) as u8, (i / 79) as u8, (i * 7 % 251) as u8])
            .collect();
        let picture = image(&colors);
        let palette = Palette::new(std::slice::from_ref(&picture));
        assert_eq!(palette.colors.len(), 256);
        let off = |a: Rgb, b: Rgb| (0..3).map(|c| a[c].abs_diff(b[c])).max().unwrap_or(0);
        let indices = palette.indices(&picture);
        let worst = indices
            .into_iter()
            .zip(&colors)
            .map(|(index, color)| off(palette.colors[usize::from(index)], *color));
        assert!(worst.max() < Some(48));
    }
}
