//! Phase diagrams of the numerics: over any two keys of a scene, and for each integrator, whether
//! its runs are stable, gain energy, lose a sphere, or end in what is not a number.
//!
//! A study differs from a sweep in that the time step may be above the limit at which scenes are
//! refused: that is what it looks at. Nothing else that is wrong with a scene is let through.

mod label;
mod load;
mod run;
mod table;

pub use label::{Label, energy_gain};
pub(crate) use load::{STUDY, of_document};
pub use load::{from_str, load};
pub use run::{Report, Row, Trials, TrialsError};
pub use table::{read_makers, read_stability, write_makers, write_stability};

use crate::dem::timestep::{Limit, limits};
use crate::document::{Problem, number};
use crate::scene::{Integrator, Output, Scene, Time};
use crate::sweep::{Axis, Job, PointError, PointScenes, grid, points};

/// A study of stability, fully resolved.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// Free text, the title of the figure.
    pub title: Option<String>,
    /// The scene that every run starts from, before its axes' values are put in.
    pub scene: Scene,
    /// Two axes, the horizontal one first.
    pub axes: Vec<Axis>,
    /// The integrators, each of which runs at every point.
    pub integrators: Vec<Integrator>,
    /// Frames of a run, at which energies are looked at.
    pub frames: u64,
    /// Largest energy out of nothing, over the scale of [`energy_gain`], that counts as stable.
    pub energy_gain: f64,
}

impl Study {
    /// All runs: every point of the grid with every integrator. The integrator varies slowest, then
    /// the first axis.
    ///
    /// # Errors
    /// The first point whose scene cannot be run. Never for a study that [`load`] returned.
    pub fn jobs(&self) -> Result<Vec<Job>, PointError> {
        let mut jobs = Vec::with_capacity(points(&self.axes) * self.integrators.len());
        for &integrator in &self.integrators {
            for values in grid(&self.axes) {
                let scene = self.scene_at(&values, integrator)?;
                jobs.push(Job {
                    id: scene.identity(),
                    seed: scene.seed,
                    values,
                    scene,
                });
            }
        }
        Ok(jobs)
    }

    /// The scene that is run at a point with an integrator. It lasts the duration of the study's
    /// scene but for rounding to whole steps and frames, balances the energy, and stores
    /// nothing else.
    ///
    /// # Errors
    /// What is wrong with it, a time step above the limit excepted.
    pub fn scene_at(&self, values: &[f64], integrator: Integrator) -> Result<Scene, PointError> {
        let fail = |problems| PointError::new(&self.axes, values, problems);
        let mut scene = PointScenes::new(&self.scene, &self.axes)?.unchecked(values)?;
        scene.time.integrator = integrator;
        scene.output = output();
        if scene.time.safety_factor.is_some() {
            scene.time.frame_interval = scene.time.duration / self.frames as f64;
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
        fit_frames(&mut scene.time, self.frames);
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

/// The limits of the time step that a study compares with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Theory {
    /// The least of those that decide; none if nothing in the scene can become unstable.
    pub decisive: Option<Limit>,
    /// That of a sphere with twelve contacts, which is advice; none with sub-steps or without
    /// contacts.
    pub twelve_contacts: Option<Limit>,
}

impl Theory {
    /// Those of a scene with its integrator.
    pub fn of(scene: &Scene) -> Self {
        let limits = limits(scene);
        let find = |which: fn(&&Limit) -> bool| limits.iter().find(which).copied();
        Self {
            decisive: find(|limit| limit.decisive),
            twelve_contacts: find(|limit| limit.name == "twelve contacts"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
