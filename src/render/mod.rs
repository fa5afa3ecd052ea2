//! Pictures of spheres in their tank: a small software renderer; and flat ones of discs.
//!
//! An orthographic [`Camera`] looks at a [`Stage`]; [`picture`] draws every sphere exactly, so that
//! overlapping spheres meet in the right circle. Light comes from the upper left of the viewer;
//! spheres cast shadows on each other and on the floor. The same input gives the same pixels on
//! every machine.

mod animation;
mod camera;
mod coloring;
mod depth;
pub(crate) mod flat;
mod image;
mod palette;
mod panel;
mod shade;
mod sheet;
mod stage;
mod vector;

pub use animation::Animation;
pub use camera::Camera;
pub use coloring::{ColorBy, Rgb};
pub use flat::Scenery;
pub use image::Image;
pub use panel::strip;
pub(crate) use sheet::round_down;
pub use sheet::{PictureSheet, Sides};
pub use stage::Stage;

use crate::observe::Snapshot;

/// A picture of `width` x `height` pixels of all spheres of a snapshot.
///
/// The view of the camera fills the picture as far as its proportions allow, centred on white.
/// Spheres outside the view are not drawn; those above or below the stage cast no shadows either.
///
/// * `radius`: radius of every sphere (m)
/// * `stage`: the walls; keep it, and the camera made from it, for all frames of an animation
/// * `color`: colour of every sphere, see [`ColorBy::colors`]
///
/// ```
/// use ndarray::array;
/// use phase::observe::Snapshot;
/// use phase::render::{Camera, ColorBy, Stage, picture};
///
/// let snapshot = Snapshot {
///     position: array![[0.0, 0.0, -0.19], [0.01, 0.0, -0.175]],
///     velocity: array![[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]],
///     ..Snapshot::default()
/// };
/// let radius = [0.01, 0.01];
/// let stage = Stage::new(Some(0.06), Some(-0.2)).around([&snapshot], &radius);
/// let color = ColorBy::Speed { fastest: 0.1 }.colors(&snapshot, &radius);
/// let image = picture(&snapshot, &radius, &color, &stage, &Camera::side(&stage), 300, 200);
/// assert_eq!(image.rgba.len(), 4 * 300 * 200);
/// ```
pub fn picture(
    snapshot: &Snapshot,
    radius: &[f64],
    color: &[Rgb],
    stage: &Stage,
    camera: &Camera,
    width: usize,
    height: usize,
) -> Image {
    let [low, high] = stage.seen;
    let spheres: Vec<shade::ShadedSphere> = snapshot
        .position
        .rows()
        .into_iter()
        .zip(radius)
        .zip(color)
        .map(|((centre, &radius), &color)| shade::ShadedSphere {
            centre: [centre[0], centre[1], centre[2]].into(),
            radius,
            color,
        })
        .filter(|sphere| sphere.is_drawable() && sphere.is_between(low[2], high[2]))
        .collect();
    shade::render(&spheres, stage, camera, width, height)
}

/// The letters of a text that are missing in the font of pictures, which shows boxes for them.
pub fn lacking_letters(text: &str) -> Vec<char> {
    crate::fonts::lacking(text)
}

#[cfg(test)]
mod tests;
