//! When a run is steady.

use crate::observe::Observations;
use crate::scene::{Scene, Steady};
use crate::statistics::Trend;

/// The share of a run that is tested, if longer than the window. A slow relaxation that began with
/// the run still changes much in its last third, even if it looks flat over the window.
const SHARE: u64 = 3;

/// The test whether a run is steady, at frames that its scene chooses. It depends only on the
/// observations: a resumed run ends at the same frame.
pub(super) struct SteadyTest {
    settings: Steady,
    frames_of_window: u64,
    frames_per_check: u64,
    scales: Scales,
}

/// Lower bounds of the scales by which changes are measured.
#[derive(Clone, Copy)]
struct Scales {
    /// m g r of all spheres (J).
    energy: f64,
    /// Rotation at which a sphere at the wall has the energy m g r (rad/s).
    rotation: f64,
    /// Radius of the tank, half its narrower side, or the diameter of a sphere (m).
    length: f64,
}

impl Scales {
    fn new(scene: &Scene, radius: &[f64], mass: &[f64]) -> Self {
        let gravity = scene.dem.effects.gravity.as_ref();
        let gravity = gravity.map_or(0.0, |it| it.acceleration);
        let mean_radius = radius.iter().sum::<f64>() / radius.len() as f64;
        let tank = scene.tank.as_ref();
        let sides = tank.into_iter().flat_map(|it| [it.width, it.depth]);
        let side = sides.flatten().reduce(f64::min);
        let half = side.map(|it| 0.5 * it);
        let room = tank.and_then(|it| it.radius).or(half);
        Self {
            energy: mass.iter().sum::<f64>() * gravity * mean_radius,
            rotation: room.map_or(0.0, |room| (2.0 * gravity * mean_radius).sqrt() / room),
            length: room.unwrap_or(2.0 * mean_radius),
        }
    }
}

impl SteadyTest {
    /// The test, if the scene has one.
    pub(super) fn new(scene: &Scene, radius: &[f64], mass: &[f64]) -> Option<Self> {
        let settings = scene.steady.clone()?;
        let interval = scene.time.frame_interval;
        Some(Self {
            frames_of_window: settings.frames_of_window(interval),
            frames_per_check: settings.frames_per_check(interval),
            scales: Scales::new(scene, radius, mass),
            settings,
        })
    }

    /// Start (s) of the steady state, if the run is checked at this frame and is steady, from the
    /// observations up to this frame.
    pub(super) fn since(&self, frame: u64, observations: &Observations) -> Option<f64> {
        let length = self.frames_of_window.max(frame.div_ceil(SHARE));
        if frame < length || !frame.is_multiple_of(self.frames_per_check) {
            return None;
        }
        let first = (frame - length) as usize;
        let part = |values: &[f32]| -> Vec<f64> {
            let part = values.get(first..=frame as usize).unwrap_or_default();
            part.iter().map(|&value| f64::from(value)).collect()
        };
        let rotational = part(&observations.rotational);
        let kinetic = part(&observations.kinetic).into_iter().zip(rotational);
        let energy: Vec<f64> = kinetic.map(|(one, other)| one + other).collect();
        let rotation = part(&observations.rotation);
        let scales = self.scales;
        let is_steady = self.is_still(&energy, scales.energy.max(mean(&energy).abs()))
            && self.is_still(&part(&observations.height_mean), scales.length)
            // Without an axis there is no rotation.
            && (observations.rotation.is_empty()
                || self.is_still(&rotation, scales.rotation.max(mean(&rotation).abs())));
        is_steady.then(|| observations.time[first])
    }

    fn is_still(&self, values: &[f64], scale: f64) -> bool {
        let trend = Trend::of(values, self.settings.confidence);
        trend.is_some_and(|it| it.is_within(self.settings.tolerance * scale))
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests;
