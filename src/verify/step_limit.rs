//! Limits of the time step, in closed form.

use super::bench::{Bench, moving, unguarded};
use super::material::Material;
use super::{CaseFamily, MeasuredValues, VerifyError};
use crate::dem::timestep;
use crate::scene::{DemScene, Scene};
use serde::Deserialize;

/// Limits of the time step for two colliding spheres; nothing is simulated. The quantities have the
/// names of [`timestep::limits`].
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepLimit {
    /// Radius (m).
    radius: f64,
    material: Material,
    /// Relative speed (m/s).
    speed: f64,
}

impl CaseFamily for StepLimit {
    fn name(&self) -> &'static str {
        "step-limit"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let side = |side: f64| {
            let place = [2.0 * side * self.radius, 0.0, 0.0];
            moving(place, [-0.5 * side * self.speed, 0.0, 0.0])
        };
        let spheres = vec![side(-1.0), side(1.0)];
        let scene = Scene {
            dem: DemScene {
                contact: Some(self.material.contact()),
                ..unguarded()
            },
            ..bench.scene(self.material.density, self.radius, spheres, 1.0)
        };
        let limits = timestep::limits(&scene).into_iter();
        Ok(limits
            .map(|limit| (limit.name.to_owned(), limit.seconds))
            .collect())
    }
}
