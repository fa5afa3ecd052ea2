//! Phase diagrams of the numerics: over any two keys of a scene, and for each integrator, whether
//! its runs are stable, gain energy, lose a sphere, or end in what is not a number.
//!
//! A study differs from a sweep in that the time step may be above the limit at which scenes are
//! refused: that is what it looks at. Nothing else that is wrong with a scene is let through.

mod finding;
mod load;

pub use finding::Tried;
pub(crate) use load::{STABILITY, of_document};
pub use load::{from_str, load};

use crate::document::{Problem, number};
use crate::grid::{PointError, PointScenes};
use crate::scene::{Output, Scene, Time};
use crate::study::comparison::Comparison;
use crate::sweep::{Job, Sweep};

/// A study of stability, fully resolved.
#[derive(Clone, Debug)]
pub struct StabilityStudy {
    /// The integrators, as settings over two axes, the horizontal one first.
    pub comparison: Comparison,
    /// Frames of a run.
    pub frames: Frames,
}

/// Frames of a run, at which energies are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frames(pub u64);

impl Frames {
    /// The run at a point of a sweep.
    fn job(self, sweep: &Sweep, values: Vec<f64>) -> Result<Job, PointError> {
        let scene = self.scene_at(sweep, &values)?;
        Ok(Job {
            id: scene.identity(),
            seed: scene.seed,
            values,
            scene,
        })
    }

    /// The scene that is run at a point of a sweep. It lasts the duration of the sweep's scene but
    /// for rounding to whole steps and frames, balances the energy, and stores nothing else.
    ///
    /// # Errors
    /// What is wrong with it, a time step above the limit excepted.
    pub fn scene_at(self, sweep: &Sweep, values: &[f64]) -> Result<Scene, PointError> {
        let fail = |problems| PointError::new(&sweep.axes, values, problems);
        let mut scene = PointScenes::new(&sweep.scene, &sweep.axes)?.unchecked(values)?;
        scene.output = output();
        if scene.time.safety_factor.is_some() {
            scene.time.frame_interval = scene.time.duration / self.0 as f64;
            scene = scene.with_chosen_step().map_err(fail)?;
        }
        if scene.time.dt > scene.time.duration {
            let message = format!(
                "`time.dt` = {} s is longer than the run, `time.duration` = {} s",
                number(scene.time.dt),
                number(scene.time.duration)
            );
            let help = "use a smaller step, or a longer `duration`";
            return Err(fail(vec![Problem::new("time.dt", message).help(help)]));
        }
        fit_frames(&mut scene.time, self.0);
        match scene.problems_but_of_limit() {
            problems if problems.is_empty() => Ok(scene),
            problems => Err(fail(problems)),
        }
    }
}

/// What a run of a study stores: the energy balance and nothing else.
fn output() -> Output {
    Output {
        snapshot_interval: 0.0,
        ledger: true,
        rise_speeds: Vec::new(),
        rise_radii: Vec::new(),
        ..Output::default()
    }
}

/// Makes frames whole numbers of steps, and the duration a whole number of frames: about as many as
/// are asked for, fewer if the step is longer than they are.
fn fit_frames(time: &mut Time, frames: u64) {
    let steps = libm::round(time.duration / time.dt / frames as f64).max(1.0);
    let interval = steps * time.dt;
    let frames = libm::round(time.duration / interval).max(1.0);
    time.frame_interval = interval;
    time.duration = frames * interval;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Integrator;

    #[test]
    fn any_step_fits_into_frames() {
        for dt in [1e-6, 3.3e-4, 1.7e-3, 0.09, 0.4, 7.0] {
            let mut time = Time {
                dt,
                safety_factor: None,
                resolution: None,
                duration: 1.0,
                frame_interval: 0.1,
                integrator: Integrator::default(),
            };
            fit_frames(&mut time, 100);
            let (steps, frames) = (
                time.frame_interval / dt,
                time.duration / time.frame_interval,
            );
            assert!((steps - steps.round()).abs() < 1e-9 && steps > 0.5, "{dt}");
            assert!(
                (frames - frames.round()).abs() < 1e-9 && frames > 0.5,
                "{dt}"
            );
            assert!(frames < 151.0, "{dt}: {frames}");
            let missed = (time.duration - 1.0).abs();
            assert!(
                missed <= 0.500_001 * time.frame_interval || dt > 1.0,
                "{dt}"
            );
        }
    }
}
