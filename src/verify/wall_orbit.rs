//! A sphere that rotating air drives along the cylinder.

use super::bench::{Bench, at, unguarded};
use super::material::Material;
use super::{CaseFamily, MeasuredValues, VerifyError, named};
use crate::dem::DemSimulation;
use crate::particles::vector::Vector;
use crate::scene::{DemScene, Drag, DragForm, DragLaw, Effects, Scene, Swirl, Tank};
use serde::Deserialize;

/// A sphere at the frictionless cylinder that rotating air accelerates to its own rotation.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WallOrbit {
    /// Radius of the sphere (m).
    radius: f64,
    /// Radius of the cylinder (m).
    tank_radius: f64,
    material: Material,
    /// Rotation of the air (rad/s).
    omega: f64,
    /// Rate of the linear drag, c1 over the mass (1/s).
    drag_rate: f64,
    /// Time step (s).
    dt: f64,
    /// Duration (s), long enough to reach the air's rotation.
    duration: f64,
}

impl CaseFamily for WallOrbit {
    fn name(&self) -> &'static str {
        "wall-orbit"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let scene = Scene {
            tank: Some(Tank {
                radius: Some(self.tank_radius),
                ..Tank::default()
            }),
            dem: DemScene {
                contact: Some(self.material.contact()),
                effects: Effects {
                    drag: Some(Drag {
                        linear: self.drag_rate * self.material.mass(self.radius),
                        quadratic: 0.0,
                        viscosity: None,
                        density: None,
                        law: DragLaw::Constant,
                        form: DragForm::Vector,
                    }),
                    swirl: Some(Swirl { omega: self.omega }),
                    ..Effects::default()
                },
                ..unguarded()
            },
            ..bench.scene(
                self.material.density,
                self.radius,
                vec![at([self.tank_radius - self.radius, 0.0, 0.0])],
                self.dt,
            )
        };
        let mut simulation = DemSimulation::new(&scene)?;
        bench.advance_for(&mut simulation, self.duration, self.dt)?;
        let particles = simulation.particles();
        let (place, velocity) = (particles.position[0], particles.velocity[0]);
        let distance = Vector::new(place.x, place.y, 0.0).norm();
        let wall = bench.force_of_walls(&scene, particles)?;
        Ok(named([
            ("overlap", distance - (self.tank_radius - self.radius)),
            ("wall_force", wall.norm()),
            (
                "rotation",
                (place.x * velocity.y - place.y * velocity.x) / (distance * distance),
            ),
        ]))
    }
}
