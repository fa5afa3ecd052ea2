//! The runs of studies: how the points of their sweeps become runs.

use super::Sweep;
use crate::document::{Problem, number};
use crate::grid::{PointError, PointScenes};
use crate::scene::{Output, Scene, Time};
use serde::{Deserialize, Serialize};

/// How the points of the sweep of a study become runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StudyRuns {
    /// Each point is run with its scene, as in any sweep. Variants may share runs.
    Compared,
    /// The same, but no two variants share a run, so that each is timed by itself: what changes no
    /// motion, such as the search for neighbours, changes no identity of a run.
    Timed,
    /// The energy is balanced at so many frames. The time step may be above its limit: that is what
    /// such a study looks at. Nothing else that is wrong with a scene is let through.
    Numerics {
        /// Frames of a run.
        frames: u64,
    },
}

/// The scenes of the runs of a sweep.
pub(crate) struct RunScenes {
    points: PointScenes,
    study: Option<StudyRuns>,
}

impl RunScenes {
    /// The scenes of the runs of this sweep.
    pub(crate) fn new(sweep: &Sweep) -> Result<Self, PointError> {
        Ok(Self {
            points: PointScenes::new(&sweep.scene, &sweep.axes)?,
            study: sweep.study,
        })
    }

    /// The scene that is run at a point.
    pub(crate) fn at(&self, values: &[f64]) -> Result<Scene, PointError> {
        match self.study {
            Some(StudyRuns::Numerics { frames }) => {
                let scene = balanced(self.points.unchecked(values)?, frames);
                scene.map_err(|problems| self.points.error(values, problems))
            }
            _ => self.points.checked(values),
        }
    }
}

impl Sweep {
    /// The scene of a point, as its run takes it.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn scene_at(&self, values: &[f64]) -> Result<Scene, PointError> {
        RunScenes::new(self)?.at(values)
    }

    /// The identity of the run of a scene at a point.
    pub(super) fn id_of_run(&self, scene: &Scene, values: &[f64]) -> String {
        let id = scene.identity();
        let mut places = self.axes.iter().zip(values);
        let variant = places.find_map(|(axis, value)| axis.variant(*value));
        match (self.study, variant) {
            (Some(StudyRuns::Timed), Some(variant)) => {
                let text = format!("{id} timed with {}", variant.name);
                blake3::hash(text.as_bytes()).to_hex()[..id.len()].to_owned()
            }
            _ => id,
        }
    }
}

/// The scene that balances the energy. It lasts the duration of `scene` but for rounding to whole
/// steps and frames, and stores nothing else.
fn balanced(mut scene: Scene, frames: u64) -> Result<Scene, Vec<Problem>> {
    scene.output = output_of_balance();
    scene.set_times_of_shaking();
    scene.forget_periods();
    if scene.time.safety_factor.is_some() {
        scene.time.frame_interval = scene.time.duration / frames as f64;
        scene = scene.with_chosen_step()?;
    }
    if scene.time.dt > scene.time.duration {
        let message = format!(
            "`time.dt` = {} s is longer than the run, `time.duration` = {} s",
            number(scene.time.dt),
            number(scene.time.duration)
        );
        let help = "use a smaller step, or a longer `duration`";
        return Err(vec![Problem::new("time.dt", message).help(help)]);
    }
    fit_frames(&mut scene.time, frames);
    match scene.problems_but_of_limit() {
        problems if problems.is_empty() => Ok(scene),
        problems => Err(problems),
    }
}

/// What a run that balances the energy stores: the balance and nothing else.
pub(crate) fn output_of_balance() -> Output {
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
pub(crate) fn fit_frames(time: &mut Time, frames: u64) {
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
