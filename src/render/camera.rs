//! Orthographic cameras.

use super::Stage;
use crate::particles::vector::Vector;

/// An orthographic camera: parallel rays, so that lengths can be measured in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Unit vector to the right of the picture.
    pub(super) right: Vector,
    /// Unit vector to the top of the picture.
    pub(super) up: Vector,
    /// Unit vector from the scene to the viewer.
    pub(super) viewer: Vector,
    /// The point at the centre of the picture (m).
    pub(super) centre: Vector,
    /// Width and height of the view (m).
    view: [f64; 2],
}

/// White margin, over the size of the view.
const MARGIN: f64 = 0.02;

impl Camera {
    /// From the side: x to the right, z up.
    pub fn side(stage: &Stage) -> Self {
        Self::raised(stage, 0.0)
    }

    /// From above: x to the right, y up.
    pub fn top(stage: &Stage) -> Self {
        Self::raised(stage, 90.0)
    }

    /// From the side and above; `elevation` in degrees: 0 is the side view, 90 the view from above.
    pub fn raised(stage: &Stage, elevation: f64) -> Self {
        let (sine, cosine) = match elevation {
            0.0 => (0.0, 1.0),
            90.0 => (1.0, 0.0),
            _ => libm::sincos(elevation.to_radians()),
        };
        let mut camera = Self {
            right: Vector::new(1.0, 0.0, 0.0),
            up: Vector::new(0.0, sine, cosine),
            viewer: Vector::new(0.0, -cosine, sine),
            centre: Vector::ZERO,
            view: [0.0; 2],
        };
        // The view is the smallest rectangle around the stage.
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for [across, along] in stage.outline(camera.up) {
            for (axis, value) in [across, along].into_iter().enumerate() {
                low[axis] = low[axis].min(value);
                high[axis] = high[axis].max(value);
            }
        }
        camera.centre =
            camera.right * (0.5 * (low[0] + high[0])) + camera.up * (0.5 * (low[1] + high[1]));
        // A point has no size to fill a view with.
        let size = |length: f64| if length > 0.0 { length } else { 1.0 };
        camera.view = [0, 1].map(|axis| size(high[axis] - low[axis]) * (1.0 + 2.0 * MARGIN));
        camera
    }

    /// Width over height of the view: a picture of these proportions has no empty margins.
    pub fn aspect(&self) -> f64 {
        self.view[0] / self.view[1]
    }

    /// Width and height of the view (m).
    pub fn view(&self) -> [f64; 2] {
        self.view
    }

    /// Pixels per metre in a picture of this size.
    pub fn scale(&self, width: usize, height: usize) -> f64 {
        (width as f64 / self.view[0]).min(height as f64 / self.view[1])
    }
}
