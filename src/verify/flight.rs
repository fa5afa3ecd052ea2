//! A single sphere in air, or in a fluid, and gravity.

use super::bench::{Bench, moving, unguarded};
use super::{CaseFamily, MeasuredValues, VerifyError, named};
use crate::dem::DemSimulation;
use crate::scene::{
    AddedMass, Buoyancy, Contact, ContactDrag, Coulomb, DemScene, Drag, Effects, Friction, Gravity,
    Linear, Magnus, Scene, StartSphere, Swirl, Updraught,
};
use serde::Deserialize;

/// A single sphere in air and gravity, without walls. Tables of effects are as in a scene.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Flight {
    /// Radius (m).
    radius: f64,
    /// Density (kg/m3).
    density: f64,
    /// Place at the start (m).
    #[serde(default)]
    position: [f64; 3],
    /// Velocity at the start (m/s).
    #[serde(default)]
    velocity: [f64; 3],
    /// Spin at the start (rad/s), only with [`magnus`](Self::magnus).
    #[serde(default)]
    spin: [f64; 3],
    #[serde(default)]
    gravity: Option<Gravity>,
    #[serde(default)]
    buoyancy: Option<Buoyancy>,
    #[serde(default)]
    added_mass: Option<AddedMass>,
    #[serde(default)]
    drag: Option<Drag>,
    /// A swirl with `omega = 0` means drag toward air at rest.
    #[serde(default)]
    swirl: Option<Swirl>,
    #[serde(default)]
    updraught: Option<Updraught>,
    #[serde(default)]
    magnus: Option<Magnus>,
    /// Time step (s).
    dt: f64,
    /// Duration (s).
    duration: f64,
}

impl CaseFamily for Flight {
    fn name(&self) -> &'static str {
        "flight"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let sphere = StartSphere {
            spin: self.spin,
            ..moving(self.position, self.velocity)
        };
        // Spheres have spins only with friction, which needs a contact law although nothing
        // touches.
        let rotates = self.magnus.is_some();
        let scene = Scene {
            dem: DemScene {
                contact: rotates.then(contact),
                friction: rotates.then(friction),
                effects: Effects {
                    gravity: self.gravity.clone(),
                    buoyancy: self.buoyancy.clone(),
                    added_mass: self.added_mass.clone(),
                    magnus: self.magnus.clone(),
                    drag: self.drag.clone(),
                    swirl: self.swirl.clone(),
                    updraught: self.updraught.clone(),
                    ..Effects::default()
                },
                ..unguarded()
            },
            ..bench.scene(self.density, self.radius, vec![sphere], self.dt)
        };
        let mut simulation = DemSimulation::new(&scene)?;
        bench.advance_for(&mut simulation, self.duration, self.dt)?;
        let particles = simulation.particles();
        let (place, velocity) = (particles.position[0], particles.velocity[0]);
        Ok(named([
            ("x", place.x),
            ("y", place.y),
            ("z", place.z),
            ("velocity_x", velocity.x),
            ("velocity_y", velocity.y),
            ("velocity_z", velocity.z),
            ("speed", velocity.norm()),
        ]))
    }
}

fn contact() -> Contact {
    Contact::Linear(Linear {
        stiffness: 1.0,
        damping: 0.0,
        drag: ContactDrag::Normal,
    })
}

fn friction() -> Friction {
    Friction::Coulomb(Coulomb {
        coefficient: 0.0,
        regularisation: 1.0,
    })
}
