//! A finished figure: its SVG, its PNG, and where it comes from.

use super::canvas::{self, Body, PNG_SCALE, UNITS};
use super::{PlotError, png, text};
use crate::fonts;
use crate::markup::escape;
use crate::record::{Program, RunRecord};
use crate::render::Image;
use crate::scene::Scene;
use resvg::{tiny_skia, usvg};

/// Largest side of a PNG (pixels); a larger figure is scaled down.
const LARGEST_SIDE: f32 = 5000.0;

/// A finished figure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Svg {
    document: String,
    /// Keys and values for the file's metadata.
    metadata: Vec<(&'static str, String)>,
    /// Pictures over everything else.
    pictures: Vec<Placed>,
    /// What a reader would miss.
    warnings: Vec<String>,
}

/// A picture, and its upper left corner in units of the canvas. Its pixels are pixels of the PNG.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Placed {
    pub(super) image: Image,
    pub(super) corner: (i32, i32),
}

/// What the metadata of a figure of several runs say.
pub(super) struct Origin<'a> {
    pub(super) title: Option<&'a str>,
    pub(super) seeds: Vec<u64>,
    pub(super) program: &'a Program,
}

impl Svg {
    /// The figure that is drawn in `body`.
    pub(super) fn new(figure: &str, origin: &Origin<'_>, body: &Body) -> Self {
        let title = origin.title.unwrap_or_default().to_owned();
        let seeds = ranges(origin.seeds.clone());
        let about = [("Title", title), ("Seeds", seeds)];
        Self::about(&about, figure, origin.program, body)
    }

    /// The same for a figure of a single run.
    pub(super) fn of_record(figure: &str, record: &RunRecord, body: &Body) -> Self {
        Self::of_scene(figure, &record.scene, &record.program, body)
    }

    /// The same for a figure of a single scene.
    pub(super) fn of_scene(figure: &str, scene: &Scene, program: &Program, body: &Body) -> Self {
        let title = scene.title.clone().unwrap_or_default();
        let about = [("Title", title), ("Seeds", scene.seed.to_string())];
        Self::about(&about, figure, program, body)
    }

    /// The same for a figure of what the program itself does.
    pub(super) fn of_program(figure: &str, title: String, program: &Program, body: &Body) -> Self {
        Self::about(&[("Title", title)], figure, program, body)
    }

    /// The figure, `about` being what its metadata begin with: the title, and what else there is.
    fn about(
        about: &[(&'static str, String)],
        figure: &str,
        program: &Program,
        body: &Body,
    ) -> Self {
        let mut metadata = about.to_vec();
        metadata.extend([
            ("Software", format!("phase {}", program.version)),
            ("Commit", program.commit.clone()),
            ("Figure", figure.to_owned()),
        ]);
        let title = escape(&text::plain(&about[0].1));
        let lines = metadata.iter();
        let lines: String = lines
            .map(|(key, value)| format!("{key}: {}\n", escape(value)))
            .collect();
        let head = format!("<title>{title}</title>\n<metadata>\n{lines}</metadata>\n");
        Self {
            document: canvas::document(&head, body),
            warnings: warnings(&metadata[0].1, body),
            metadata,
            pictures: Vec::new(),
        }
    }

    /// The figure with pictures over it.
    pub(super) fn with_pictures(mut self, pictures: Vec<Placed>) -> Result<Self, PlotError> {
        let mut elements = String::new();
        for picture in &pictures {
            let file = picture.image.to_png(&[]);
            let file = file.map_err(PlotError::png)?;
            elements.push_str(&canvas::picture(&picture.image, picture.corner, &file));
        }
        if let Some(end) = self.document.rfind("</svg>") {
            self.document.insert_str(end, &elements);
        }
        self.pictures = pictures;
        Ok(self)
    }

    /// What cannot be seen on the figure, and what would show it: letters that the font lacks,
    /// cells without width.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
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
    /// [`PlotError`] if the figure is too large to be drawn.
    pub fn to_png_bytes(&self) -> Result<Vec<u8>, PlotError> {
        let failed = |error: &dyn std::fmt::Display| PlotError::png(error);
        let tree = usvg::Tree::from_str(&self.document, &fonts::svg_options())
            .map_err(|error| failed(&error))?;
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
        // usvg is built without formats of pictures, so they are not in its tree.
        for picture in &self.pictures {
            paste(picture, &mut pixels, scale).ok_or_else(|| failed(&"an empty picture"))?;
        }
        // A CSS pixel is 1/96 of an inch of .0254 m.
        let per_metre = (scale * 96.0 / 0.0254).round() as u32;
        // Shaded spheres have more colours than a palette.
        let all_colors = !self.pictures.is_empty();
        png::encode(&pixels, per_metre, &self.metadata, all_colors).map_err(|e| failed(&e))
    }
}

/// What a reader of a figure with this title would miss.
fn warnings(title: &str, body: &Body) -> Vec<String> {
    let lack = |what: String, letters: &[char]| {
        let letters: Vec<String> = letters.iter().map(|it| format!("`{it}`")).collect();
        format!(
            "{what} has letters that the built-in font lacks: {}; the PNG shows boxes for them, \
             the SVG needs a font that has them",
            letters.join(", ")
        )
    };
    let of_title = fonts::lacking(title);
    let mut warnings = Vec::new();
    if !of_title.is_empty() {
        warnings.push(lack(format!("the key `title`, \"{title}\","), &of_title));
    }
    for (text, letters) in &body.unwritten {
        if letters.iter().any(|letter| !of_title.contains(letter)) {
            warnings.push(lack(format!("the text \"{text}\""), letters));
        }
    }
    warnings.extend(body.warnings.iter().cloned());
    warnings
}

/// Puts a picture where it belongs in a figure of `scale` pixels per CSS pixel; `None` if it is
/// empty.
fn paste(picture: &Placed, pixels: &mut tiny_skia::Pixmap, scale: f32) -> Option<()> {
    let Image {
        width,
        height,
        rgba,
    } = &picture.image;
    let size =
        tiny_skia::IntSize::from_wh(u32::try_from(*width).ok()?, u32::try_from(*height).ok()?)?;
    // Pictures are opaque, so their colours are premultiplied already.
    let image = tiny_skia::Pixmap::from_vec(rgba.clone(), size)?;
    let place = |units: i32| units as f32 / UNITS as f32 * scale;
    let shrink = scale / PNG_SCALE;
    let transform = tiny_skia::Transform::from_row(
        shrink,
        0.0,
        0.0,
        shrink,
        place(picture.corner.0),
        place(picture.corner.1),
    );
    let paint = tiny_skia::PixmapPaint {
        quality: tiny_skia::FilterQuality::Bilinear,
        ..tiny_skia::PixmapPaint::default()
    };
    pixels.draw_pixmap(0, 0, image.as_ref(), &paint, transform, None);
    Some(())
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
