//! Two discs, or a disc and a fixed one, hit each other head-on under the linear spring-dashpot.

use super::bench::{Bench, moving, reduced};
use super::{CaseFamily, MeasuredValues, VerifyError, named};
use crate::dem::DemSimulation;
use crate::dem::timestep::LinearImpact;
use crate::scene::{
    Contact, ContactDrag, DemScene, FixedSphere, Geometry, Linear, Scene, Shape, Spheres,
};
use serde::Deserialize;

/// Two discs, or a disc and a fixed one, hit each other head-on.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dashpot {
    /// Radius of the disc, and of its partner (m).
    radius: f64,
    partner_radius: f64,
    /// Whether the partner is fixed.
    #[serde(default)]
    fixed: bool,
    /// rho in the mass rho r^2 (kg/m2).
    density: f64,
    /// Spring constant k (N/m).
    stiffness: f64,
    /// Drag constant b (N s/m).
    damping: f64,
    drag: ContactDrag,
    /// Relative speed (m/s).
    speed: f64,
    /// Time steps in the duration of the contact.
    steps_per_contact: f64,
}

/// An impact takes less than this many times its closed-form duration.
const PATIENCE: f64 = 10.0;

impl CaseFamily for Dashpot {
    fn name(&self) -> &'static str {
        "dashpot"
    }

    /// Contact time and restitution, measured; the limit of the time step, 2/w, in closed form.
    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let impact = self.closed_form();
        let dt = impact.contact_time() / self.steps_per_contact;
        let mut simulation = DemSimulation::new(&self.scene(dt, bench))?;
        let mut overlap = 0.0;
        for _ in 0..(PATIENCE * self.steps_per_contact) as u64 {
            let earlier = overlap;
            bench.advance(&mut simulation, 1)?;
            let apart;
            (overlap, apart) = self.overlap(&simulation);
            if overlap <= 0.0 {
                // The overlap reaches zero in between, by linear interpolation.
                let behind = overlap / (overlap - earlier);
                return Ok(named([
                    ("contact_time", simulation.time() - behind * dt),
                    ("restitution", apart / self.speed),
                    ("step_limit", 2.0 / impact.angular_frequency()),
                ]));
            }
        }
        Err(VerifyError::Unfinished {
            awaited: "the end of the contact",
            steps: simulation.step(),
        })
    }
}

impl Dashpot {
    fn closed_form(&self) -> LinearImpact {
        let mass = |radius| Shape::Disc.mass(self.density, radius);
        let (one, other) = (mass(self.radius), mass(self.partner_radius));
        LinearImpact {
            effective_mass: if self.fixed { one } else { reduced(one, other) },
            stiffness: self.stiffness,
            damping: self.damping,
        }
    }

    /// They touch at the start; the partner is at rest at the origin.
    fn scene(&self, dt: f64, bench: &Bench<'_>) -> Scene {
        let distance = self.radius + self.partner_radius;
        let mut spheres = vec![moving([distance, 0.0, 0.0], [-self.speed, 0.0, 0.0])];
        let mut geometry = None;
        if self.fixed {
            geometry = Some(Geometry::List {
                walls: vec![FixedSphere {
                    position: [0.0; 3],
                    radius: self.partner_radius,
                }],
                door: Vec::new(),
            });
        } else {
            let mut partner = moving([0.0; 3], [0.0; 3]);
            partner.radius = Some(self.partner_radius);
            spheres.push(partner);
        }
        let scene = bench.scene(self.density, self.radius, spheres, dt);
        Scene {
            spheres: Spheres {
                shape: Shape::Disc,
                ..scene.spheres
            },
            dem: DemScene {
                contact: Some(Contact::Linear(Linear {
                    stiffness: self.stiffness,
                    damping: self.damping,
                    drag: self.drag,
                })),
                geometry,
                ..scene.dem
            },
            ..scene
        }
    }

    /// How far the two overlap (m), and how fast they part (m/s).
    fn overlap(&self, simulation: &DemSimulation) -> (f64, f64) {
        let particles = simulation.particles();
        let (disc, partner) = match self.fixed {
            true => (1, 0),
            false => (0, 1),
        };
        let distance = particles.position[disc].x - particles.position[partner].x;
        let apart = particles.velocity[disc].x - particles.velocity[partner].x;
        (self.radius + self.partner_radius - distance, apart)
    }
}
