//! Forces of the air on spheres at given places.

use super::bench::{Bench, unguarded};
use super::{CaseFamily, MeasuredValues, VerifyError, numbered};
use crate::dem::DemSimulation;
use crate::particles::vector::Vector;
use crate::scene::{DemScene, Drag, Effects, Scene, StartSphere, Swirl, Updraught};
use serde::Deserialize;

/// Spheres on which only the air acts; the forces on them at the start are measured. Air tables are
/// as in a scene.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AirForce {
    /// Radius (m).
    radius: f64,
    /// Places and velocities, and radii that differ.
    spheres: Vec<StartSphere>,
    drag: Drag,
    #[serde(default)]
    swirl: Option<Swirl>,
    #[serde(default)]
    updraught: Option<Updraught>,
}

/// The step (s) is too short to move anything; forces do not depend on it.
const DT: f64 = 1e-12;

/// Density (kg/m3), without effect on the forces.
const DENSITY: f64 = 1000.0;

impl CaseFamily for AirForce {
    fn name(&self) -> &'static str {
        "air-force"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let scene = Scene {
            dem: DemScene {
                effects: Effects {
                    drag: Some(self.drag.clone()),
                    swirl: self.swirl.clone(),
                    updraught: self.updraught.clone(),
                    ..Effects::default()
                },
                ..unguarded()
            },
            ..bench.scene(DENSITY, self.radius, self.spheres.clone(), DT)
        };
        let mut simulation = DemSimulation::new(&scene)?;
        bench.advance(&mut simulation, 1)?;
        let forces = &simulation.particles().force;
        let components: [fn(&Vector) -> f64; 3] = [|f| f.x, |f| f.y, |f| f.z];
        let names = ["force_x", "force_y", "force_z"];
        Ok(names
            .into_iter()
            .zip(components)
            .flat_map(|(name, component)| numbered(name, forces.iter().map(component)))
            .collect())
    }
}
