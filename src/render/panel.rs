//! A panel of a state: a caption, and below it the views from the side and from above, or one flat
//! view.

use super::vector::{self, TextAnchor};
use super::{Camera, Image, Rgb, Scenery, Stage, flat, picture};
use crate::observe::Snapshot;

/// Height of a line of the caption over the width of a panel.
const CAPTION: f64 = 0.08;
/// Size of the letters of the caption over the height of a line, of one line and of several.
const LETTERS: [f64; 2] = [0.7, 0.55];
/// Space between pictures over the width of a panel.
const GAP: f64 = 0.03;

/// Views of cameras, at one scale.
///
/// Units of `radius` and meaning of `color` are as in [`picture`].
pub(super) fn views(
    snapshot: &Snapshot,
    radius: &[f64],
    color: &[Rgb],
    stage: &Stage,
    cameras: &[Camera],
    width: usize,
) -> Vec<Image> {
    let views = cameras.iter().map(|camera| {
        let height = share(1.0 / camera.aspect(), width);
        picture(snapshot, radius, color, stage, camera, width, height)
    });
    let mut views: Vec<Image> = views.collect();
    if stage.radius.is_none() {
        // No wall marks where the picture ends.
        views.iter_mut().for_each(Image::outline);
    }
    views
}

/// The flat view; without colours, spheres have the colour of grains.
pub(super) fn flat_view(
    snapshot: &Snapshot,
    radius: &[f64],
    colors: Option<&[Rgb]>,
    scenery: &Scenery,
    stage: &Stage,
    width: usize,
) -> Image {
    let camera = Camera::side(stage);
    let height = share(1.0 / camera.aspect(), width);
    let elements = scenery.elements(snapshot, radius, colors, &flat::window(stage));
    let scale = camera.scale(width, height);
    let left = 0.5 * width as f64 - scale * camera.centre.x;
    let top = 0.5 * height as f64 + scale * camera.centre.z;
    let scaled = format!("<g transform=\"translate({left} {top}) scale({scale})\">{elements}</g>");
    let mut view = vector::drawing(&scaled, width, height);
    view.outline();
    view
}

/// Views below each other, below a caption.
pub(super) fn panel(views: &[Image], width: usize, caption: &[String]) -> Image {
    let (line, gap) = (share(CAPTION, width), share(GAP, width));
    let heights = views.iter().map(|view| gap + view.height);
    let mut top = caption.len() * line;
    let mut panel = Image::white(width, top + heights.sum::<usize>());
    panel.paste(&words(caption, width, line), 0, 0);
    for view in views {
        panel.paste(view, 0, top + gap);
        top += gap + view.height;
    }
    panel
}

/// The lines of a caption; long lines have smaller letters.
fn words(caption: &[String], width: usize, line: usize) -> Image {
    let middle = 0.5 * width as f64;
    let [one, several] = LETTERS;
    let letters = if caption.len() > 1 { several } else { one };
    let elements: String = caption
        .iter()
        .enumerate()
        .map(|(index, text)| {
            let fitting = width as f64 / vector::width(text, 1.0).max(1.0);
            let base = (index as f64 + 0.75) * line as f64;
            let size = (letters * line as f64).min(fitting);
            vector::text(text, (middle, base), size, TextAnchor::Middle)
        })
        .collect();
    vector::drawing(&elements, width, caption.len() * line)
}

/// A fraction of a width, in whole pixels.
fn share(share: f64, width: usize) -> usize {
    (share * width as f64).round().max(1.0) as usize
}

/// Height of a panel of this width (pixels), with these views and this number of caption lines.
pub(super) fn height(cameras: &[Camera], lines: usize, width: usize) -> usize {
    let gap = share(GAP, width);
    let views = cameras
        .iter()
        .map(|camera| gap + share(1.0 / camera.aspect(), width));
    lines * share(CAPTION, width) + views.sum::<usize>()
}

/// Space between panels of this width (pixels).
fn gap(width: usize) -> usize {
    (GAP * width as f64).round() as usize
}

/// Width of a strip of `count` panels of this width (pixels).
pub(super) fn strip_width(count: usize, width: usize) -> usize {
    count * (width + gap(width))
}

/// Panels of equal size side by side.
pub fn strip(panels: &[Image]) -> Image {
    let gap = |panel: &Image| gap(panel.width);
    let width = panels.iter().map(|panel| panel.width + gap(panel)).sum();
    let height = panels.iter().map(|panel| panel.height).max().unwrap_or(0);
    let mut strip = Image::white(width, height);
    let mut left = 0;
    for panel in panels {
        strip.paste(panel, left + gap(panel) / 2, 0);
        left += panel.width + gap(panel);
    }
    strip
}
