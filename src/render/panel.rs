//! The state of the tank at a glance: a caption, the view from the side, the view from above.

use super::vector::{self, Anchor};
use super::{Camera, Image, Rgb, Stage, picture};
use crate::observe::Snapshot;

/// Height of the caption over the width of a panel.
const CAPTION: f64 = 0.08;
/// Size of the letters of the caption over its height.
const LETTERS: f64 = 0.7;
/// Space between pictures over the width of a panel.
const GAP: f64 = 0.03;

/// A caption, the view from the side and below it that from above, at one scale. The panel is
/// `width` pixels wide and as high as the stage asks for.
///
/// Units of `radius` and meaning of `color` are those of [`picture`].
pub fn panel(
    snapshot: &Snapshot,
    radius: &[f64],
    color: &[Rgb],
    stage: &Stage,
    width: usize,
    text: &str,
) -> Image {
    let mut views = [Camera::side(stage), Camera::top(stage)].map(|camera| {
        let height = share(1.0 / camera.aspect(), width);
        picture(snapshot, radius, color, stage, &camera, width, height)
    });
    if stage.radius.is_none() {
        // No wall shows where the picture ends.
        views.iter_mut().for_each(Image::outline);
    }
    let (caption, gap) = (share(CAPTION, width), share(GAP, width));
    let mut panel = Image::white(width, height(stage, width));
    let (middle, base) = (0.5 * width as f64, 0.75 * caption as f64);
    let words = vector::text(
        text,
        (middle, base),
        LETTERS * caption as f64,
        Anchor::Middle,
    );
    panel.paste(&vector::drawing(&words, width, caption), 0, 0);
    let mut top = caption + gap;
    for view in &views {
        panel.paste(view, 0, top);
        top += view.height + gap;
    }
    panel
}

/// A share of a width, in whole pixels.
fn share(share: f64, width: usize) -> usize {
    (share * width as f64).round().max(1.0) as usize
}

/// Height of a panel of that width (pixels).
pub(super) fn height(stage: &Stage, width: usize) -> usize {
    let cameras = [Camera::side(stage), Camera::top(stage)];
    let views = cameras.map(|camera| share(1.0 / camera.aspect(), width));
    share(CAPTION, width) + 2 * share(GAP, width) + views[0] + views[1]
}

/// Room between panels of that width (pixels).
fn gap(width: usize) -> usize {
    (GAP * width as f64).round() as usize
}

/// Width of a strip of `count` panels of that width (pixels).
pub(super) fn strip_width(count: usize, width: usize) -> usize {
    count * (width + gap(width))
}

/// Panels of equal size beside each other.
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
