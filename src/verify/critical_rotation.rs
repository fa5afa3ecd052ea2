//! The critical rotation of the tank, in closed form.

use super::bench::Bench;
use super::{CaseFamily, MeasuredValues, VerifyError, named};
use crate::theory;
use serde::Deserialize;

/// The critical rotation of the tank; nothing is simulated.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CriticalRotation {
    /// Number of spheres.
    count: f64,
    /// Radius (m).
    radius: f64,
    /// Radius of the tank (m).
    tank_radius: f64,
    /// Gravity (m/s2).
    gravity: f64,
}

impl CaseFamily for CriticalRotation {
    fn name(&self) -> &'static str {
        "critical-rotation"
    }

    fn measure(&self, _: &mut Bench) -> Result<MeasuredValues, VerifyError> {
        let omega =
            theory::critical_rotation(self.count, self.radius, self.tank_radius, self.gravity);
        Ok(named([("omega", omega)]))
    }
}
