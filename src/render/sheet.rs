//! Panels with title, legend of the colours, and a scale bar.

use super::vector::{self, TextAnchor};
use super::{Camera, ColorBy, Image, Scenery, Stage, panel, strip};
use crate::color::ColorMap;
use crate::markup::words;
use crate::observe::Snapshot;
use crate::scene::Units;

/// Size of the letters over the width of a panel.
const LETTERS: f64 = 0.048;
/// Height of a line over the size of its letters.
const LINE: f64 = 1.6;
/// Space between words and panels, in lines.
const GAP: f64 = 0.4;
/// Length of the colour bar over the size of the letters.
const BAR: f64 = 5.0;
/// From this number of panels on, legend and scale bar are side by side.
const WIDE: usize = 2;

/// Which sides of the spheres are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sides {
    /// The views from the side and from above.
    #[default]
    Both,
    /// The view from the side.
    Side,
    /// The half behind the axis from the side: a cut through the middle.
    Cut,
}

/// The common part of a run's pictures.
#[derive(Clone, Debug)]
pub struct PictureSheet {
    /// Lines above the panels.
    pub title: Vec<String>,
    /// Radius of every sphere (m).
    pub radius: Vec<f64>,
    /// The walls, and the visible part of the scene.
    pub stage: Stage,
    /// The meaning of colours.
    pub color: ColorBy,
    /// The sides shown if the view is not flat.
    pub sides: Sides,
    /// Fixed parts in a flat view. Without them, panels show the views from the side and from
    /// above.
    pub flat: Option<Scenery>,
    /// Units of the scene.
    pub units: Units,
}

impl PictureSheet {
    /// A panel of a state, `width` pixels wide, below the lines of a caption.
    pub fn panel(&self, snapshot: &Snapshot, width: usize, caption: &[String]) -> Image {
        let colors = self.color.colors(snapshot, &self.radius);
        let (radius, stage) = (&self.radius, &self.stage);
        let views = match &self.flat {
            Some(scenery) => {
                let colors = (self.color != ColorBy::Nothing).then_some(&colors[..]);
                let view = panel::flat_view(snapshot, radius, colors, scenery, stage, width);
                vec![view]
            }
            None => {
                let shown = match self.sides {
                    Sides::Cut => &without_front(snapshot),
                    Sides::Both | Sides::Side => snapshot,
                };
                panel::views(shown, radius, &colors, stage, &self.cameras(), width)
            }
        };
        panel::panel(&views, width, caption)
    }

    /// The views of a panel, from above.
    fn cameras(&self) -> Vec<Camera> {
        let mut cameras = vec![Camera::side(&self.stage)];
        if self.flat.is_none() && self.sides == Sides::Both {
            cameras.push(Camera::top(&self.stage));
        }
        cameras
    }

    /// Height of a picture of `count` panels of this width (pixels), with this number of caption
    /// lines.
    pub fn height(&self, count: usize, lines: usize, width: usize) -> usize {
        let words = SheetWords::new(self, count, width);
        let panel = panel::height(&self.cameras(), lines, width);
        words.head + panel + words.foot
    }

    /// Panels of equal size side by side, with title, legend and scale bar.
    ///
    /// # Panics
    /// Without any panel.
    pub fn picture(&self, panels: &[Image]) -> Image {
        let strip = strip(panels);
        let words = SheetWords::new(self, panels.len(), panels[0].width);
        let mut picture = Image::white(strip.width, words.head + strip.height + words.foot);
        picture.paste(&words.draw_head(), 0, 0);
        picture.paste(&strip, 0, words.head);
        let foot = words.draw_foot(self, panels[0].width);
        picture.paste(&foot, 0, words.head + strip.height);
        picture
    }
}

/// The state without the spheres in front of the axis.
fn without_front(snapshot: &Snapshot) -> Snapshot {
    let mut behind = snapshot.clone();
    for mut centre in behind.position.rows_mut() {
        if centre[1] < 0.0 {
            centre.fill(f64::NAN);
        }
    }
    behind
}

/// The words of a sheet, and the space for them (pixels).
struct SheetWords {
    width: usize,
    /// Size of the letters.
    size: f64,
    title: Vec<String>,
    head: usize,
    foot: usize,
    /// Whether the legend and the scale bar are side by side.
    is_wide: bool,
}

impl SheetWords {
    fn new(sheet: &PictureSheet, count: usize, panel: usize) -> Self {
        let width = panel::strip_width(count, panel);
        let size = LETTERS * panel as f64;
        let title: Vec<String> = sheet
            .title
            .iter()
            .flat_map(|line| wrap(line, size, width as f64 - 2.0 * size))
            .collect();
        let is_wide = count >= WIDE;
        let rows = match sheet.color {
            ColorBy::Nothing => 1.0,
            _ if is_wide => 1.0,
            _ => 2.0,
        };
        let lines = |count: f64| (count * LINE * size).ceil() as usize;
        Self {
            width,
            size,
            head: lines(title.len() as f64 + GAP),
            title,
            foot: lines(GAP + rows + 0.2),
            is_wide,
        }
    }

    /// Base line of a line of text.
    fn base(&self, line: usize) -> f64 {
        (line as f64 + 0.75) * LINE * self.size
    }

    /// Space between the panels and the words below.
    fn gap(&self) -> f64 {
        GAP * LINE * self.size
    }

    fn draw_head(&self) -> Image {
        let middle = 0.5 * self.width as f64;
        let lines = self.title.iter().enumerate();
        let elements: String = lines
            .map(|(index, line)| {
                vector::text(
                    line,
                    (middle, self.base(index)),
                    self.size,
                    TextAnchor::Middle,
                )
            })
            .collect();
        vector::drawing(&elements, self.width, self.head)
    }

    fn draw_foot(&self, sheet: &PictureSheet, panel: usize) -> Image {
        let legend = self.legend(&sheet.color, sheet.units);
        let row = usize::from(!legend.is_empty() && !self.is_wide);
        let elements = legend + &self.length(sheet, panel, row);
        vector::drawing(&elements, self.width, self.foot)
    }

    /// The legend of the colours, as elements.
    fn legend(&self, color: &ColorBy, units: Units) -> String {
        let (size, base) = (self.size, self.base(0) + self.gap());
        let words = |words: &str| vector::text(words, (size, base), size, TextAnchor::Start);
        let labelled = |word: &str, unit| format!("{word} ({})", units.shown(unit));
        let (label, low, high) = match *color {
            ColorBy::Nothing => return String::new(),
            ColorBy::Index => return words("colours distinguish spheres"),
            ColorBy::Speed { fastest } => (labelled("speed", "m/s"), 0.0, fastest),
            ColorBy::Height { low, high } => (labelled("height", "m"), low, high),
            ColorBy::Radius { low, high } if units == Units::OfSpheres => {
                (labelled("radius", "m"), low, high)
            }
            ColorBy::Radius { low, high } => (labelled("radius", "mm"), 1e3 * low, 1e3 * high),
            ColorBy::Layer { thickness, .. } => {
                let thickness = number(thickness);
                let unit = units.shown("m");
                return words(&format!(
                    "colours: layers of {thickness} {unit} at the start"
                ));
            }
            ColorBy::PackingFraction { .. } => {
                let label = "packing fraction".to_owned();
                (label, ColorBy::LOOSEST, ColorBy::DENSEST)
            }
        };
        if low >= high {
            return words(&format!("{label}: {} everywhere", number(low)));
        }
        let mut elements = words(&label);
        let mut x = 1.5 * size + vector::width(&label, size);
        let mut number = |x: &mut f64, text: &str| {
            elements += &vector::text(text, (*x, base), size, TextAnchor::Start);
            *x += vector::width(text, size) + 0.5 * size;
        };
        let [low, high] = pair(low, high);
        number(&mut x, &low);
        let bar = x;
        x += (BAR + 0.5) * size;
        number(&mut x, &high);
        elements + &color_bar((bar, base - 0.75 * size), (BAR * size, 0.8 * size))
    }

    /// The scale bar, as elements.
    fn length(&self, sheet: &PictureSheet, panel: usize, row: usize) -> String {
        let camera = Camera::side(&sheet.stage);
        let length = round_down(0.5 * camera.view()[0]);
        let pixels = length * panel as f64 / camera.view()[0];
        let text = match length {
            length if length < 1.0 && sheet.units == Units::Si => {
                format!("{} mm", number(1e3 * length))
            }
            length => format!("{} {}", number(length), sheet.units.shown("m")),
        };
        let (size, base) = (self.size, self.base(row) + self.gap());
        let left = if self.is_wide {
            self.width as f64 - 1.5 * size - pixels - vector::width(&text, size)
        } else {
            size
        };
        let (right, foot, top) = (left + pixels, base, base - 0.4 * size);
        let line = format!(
            "<path d=\"M{left} {top}V{foot}H{right}V{top}\" fill=\"none\" stroke=\"#000\" \
             stroke-width=\"{}\"/>",
            0.08 * size
        );
        line + &vector::text(&text, (right + 0.5 * size, base), size, TextAnchor::Start)
    }
}

/// The colours from low to high, as elements.
fn color_bar((left, top): (f64, f64), (width, height): (f64, f64)) -> String {
    const STEPS: usize = 64;
    let step = width / STEPS as f64;
    (0..STEPS)
        .map(|index| {
            let [red, green, blue] = ColorMap::Sequential.at((index as f64 + 0.5) / STEPS as f64);
            let x = left + index as f64 * step;
            // Neighbours overlap, so that no white shows between them.
            format!(
                "<rect x=\"{x}\" y=\"{top}\" width=\"{}\" height=\"{height}\" \
                 fill=\"#{red:02x}{green:02x}{blue:02x}\"/>",
                if index + 1 < STEPS { 1.5 * step } else { step }
            )
        })
        .collect()
}

/// Breaks a text into lines of at most `limit`, at spaces.
fn wrap(text: &str, size: f64, limit: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words(text, |word| vector::width(word, size) <= limit) {
        match lines.last_mut() {
            Some(line) if vector::width(&format!("{line} {word}"), size) <= limit => {
                line.push(' ');
                line.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    lines
}

/// A number to three digits.
fn number(value: f64) -> String {
    rounded(value, 3)
}

/// Two different numbers with enough digits to differ, at least three; if they are close, the
/// second is written as its excess over the first.
fn pair(low: f64, high: f64) -> [String; 2] {
    let mut pairs = (3..=5).map(|digits| [low, high].map(|value| rounded(value, digits)));
    let told = pairs.find(|[low, high]| low != high);
    told.unwrap_or_else(|| [number(low), format!("+{}", number(high - low))])
}

/// A number to `digits` digits.
fn rounded(value: f64, digits: usize) -> String {
    let rounded: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    match rounded.abs() {
        0.0 | 1e-3..1e5 => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}

/// The largest of 1, 2 and 5 times a power of ten that is not above a positive number.
pub(crate) fn round_down(value: f64) -> f64 {
    let decade = libm::exp10(libm::log10(value).floor());
    let fits = |mantissa: &&f64| *mantissa * decade <= value;
    [5.0, 2.0, 1.0]
        .iter()
        .find(fits)
        .map_or(decade, |mantissa| mantissa * decade)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        for (value, text) in [
            (0.0, "0"),
            (0.52349, "0.523"),
            (1234.0, "1230"),
            (-0.2, "-0.2"),
            (4.0e-7, "4e-7"),
            (1e300, "1e300"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn lengths_are_round() {
        for (value, length) in [(0.062, 0.05), (0.05, 0.05), (3.0, 2.0), (0.19, 0.1)] {
            assert!((round_down(value) - length).abs() < 1e-12);
        }
    }

    #[test]
    fn titles_break_between_words() {
        let lines = wrap("Vortex tank, theoretical, linear drag", 10.0, 130.0);
        assert_eq!(lines, ["Vortex tank,", "theoretical, linear", "drag"]);
        let lines = wrap("vortex_tank_theoretical_linear_drag", 10.0, 130.0);
        assert_eq!(lines, ["vortex_tank_theoreti", "cal_linear_drag"]);
    }

    /// Symptom: a scale of colours from "3" to "3" mm. Cause: always three digits.
    #[test]
    fn ends_of_a_scale_differ() {
        assert_eq!(pair(3.0001, 3.0003), ["3.0001", "3.0003"]);
        assert_eq!(pair(0.0, 2.0 / 3.0), ["0", "0.667"]);
        assert_eq!(pair(0.2, 0.200_000_3), ["0.2", "+3e-7"]);
    }
}
