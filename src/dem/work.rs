//! The work of a run, known before it starts: sphere-steps, which are steps times spheres.

use crate::scene::{Scene, Start};

/// Sphere-steps of a whole run. If spheres come and go, this is an upper bound: no sphere leaves,
/// and the run lasts its whole duration.
pub(super) fn sphere_steps(scene: &Scene) -> u64 {
    let (steps_per_frame, frames) = (scene.time.steps_per_frame(), scene.time.frames());
    let steps = steps_per_frame.saturating_mul(frames);
    let count = scene.spheres.count as u64;
    let Start::Feed { interval, .. } = scene.start else {
        return steps.saturating_mul(count);
    };
    // One more sphere comes in at every interval, until all are in.
    let interval = ((interval / scene.time.dt).round() as u64).max(1);
    let coming = count.min(steps.div_ceil(interval));
    let missed = interval.saturating_mul(coming.saturating_mul(coming.saturating_sub(1)) / 2);
    steps.saturating_mul(coming).saturating_sub(missed)
}
