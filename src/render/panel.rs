//! The state of the tank at a glance: a caption, the view from the side, the view from above.

use super::caption::caption;
use super::{Camera, Image, Rgb, Stage, picture};
use crate::observe::Snapshot;

/// Height of the caption over the width of a panel.
const CAPTION: f64 = 0.08;
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
    let share = |share: f64| (share * width as f64).round().max(1.0) as usize;
    let views = [Camera::side(stage), Camera::top(stage)].map(|camera| {
        let height = share(1.0 / camera.aspect());
        picture(snapshot, radius, color, stage, &camera, width, height)
    });
    let mut top = share(CAPTION) + share(GAP);
    let height = top + share(GAP) + views[0].height + views[1].height;
    let mut panel = Image::white(width, height);
    panel.paste(&caption(text, width, share(CAPTION)), 0, 0);
    for view in &views {
        panel.paste(view, 0, top);
        top += view.height + share(GAP);
    }
    panel
}

/// Panels of equal size beside each other.
pub fn strip(panels: &[Image]) -> Image {
    let gap = |panel: &Image| (GAP * panel.width as f64).round() as usize;
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
