//! A sphere hits another one, or what does not move, head-on under the Hertz contact of Silbert et
//! al.

use super::bench::{Bench, SilbertMaterial, moving, unguarded};
use super::{Family, Measured, VerifyError, named};
use crate::dem::Simulation;
use crate::scene::{DemScene, FixedSphere, Geometry, Scene, Tank};
use serde::Deserialize;

/// A sphere hits another one, or what does not move, head-on.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SilbertImpact {
    partner: Partner,
    /// Radius of the sphere (m).
    radius: f64,
    /// Radius of the partner, if it is a sphere of another one (m).
    #[serde(default)]
    partner_radius: Option<f64>,
    material: SilbertMaterial,
    /// Relative speed (m/s).
    speed: f64,
    /// Time steps in the duration of the elastic impact.
    steps_per_contact: f64,
}

/// What the sphere hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Partner {
    Sphere,
    FixedSphere,
    /// A side of a box.
    Side,
}

/// An impact takes less than this many times the duration of the elastic one.
const PATIENCE: f64 = 10.0;

impl Family for SilbertImpact {
    fn name(&self) -> &'static str {
        "silbert-impact"
    }

    /// Contact time, restitution and deepest overlap.
    fn measure(&self, bench: &mut Bench<'_>) -> Result<Measured, VerifyError> {
        let dt = self.elastic_time() / self.steps_per_contact;
        let mut simulation = Simulation::new(&self.scene(dt, bench))?;
        let (mut overlap, mut deepest) = (0.0, 0.0_f64);
        for _ in 0..(PATIENCE * self.steps_per_contact) as u64 {
            let earlier = overlap;
            bench.advance(&mut simulation, 1)?;
            let apart;
            (overlap, apart) = self.overlap(&simulation);
            deepest = deepest.max(overlap);
            if overlap <= 0.0 {
                // The overlap is zero in between, if it falls as a straight line.
                let behind = overlap / (overlap - earlier);
                return Ok(named([
                    ("contact_time", simulation.time() - behind * dt),
                    ("restitution", apart / self.speed),
                    ("maximum_overlap", deepest),
                ]));
            }
        }
        Err(VerifyError::Unfinished {
            awaited: "the end of the contact",
            steps: simulation.step(),
        })
    }
}

impl SilbertImpact {
    fn partner_radius(&self) -> f64 {
        self.partner_radius.unwrap_or(self.radius)
    }

    /// Duration of the same impact without losses (s).
    fn elastic_time(&self) -> f64 {
        let (radius, other) = (self.radius, self.partner_radius());
        let mass = |radius| self.material.mass(radius);
        let (effective_radius, effective_mass) = match self.partner {
            Partner::Sphere => (
                radius * other / (radius + other),
                mass(radius) * mass(other) / (mass(radius) + mass(other)),
            ),
            Partner::FixedSphere => (radius * other / (radius + other), mass(radius)),
            Partner::Side => (radius, mass(radius)),
        };
        self.material
            .impact(effective_radius, effective_mass, self.speed)
            .contact_time()
    }

    /// They touch at the start; the partner rests at the origin.
    fn scene(&self, dt: f64, bench: &Bench<'_>) -> Scene {
        let distance = match self.partner {
            Partner::Side => 0.0,
            Partner::Sphere | Partner::FixedSphere => self.radius + self.partner_radius(),
        };
        let mut spheres = vec![moving([distance, 0.0, 0.0], [-self.speed, 0.0, 0.0])];
        let (mut geometry, mut tank) = (None, None);
        match self.partner {
            Partner::Sphere => {
                let mut partner = moving([0.0; 3], [0.0; 3]);
                partner.radius = self.partner_radius;
                spheres.push(partner);
            }
            Partner::FixedSphere => {
                geometry = Some(Geometry::List {
                    walls: vec![FixedSphere {
                        position: [0.0; 3],
                        radius: self.partner_radius(),
                    }],
                    door: Vec::new(),
                });
            }
            Partner::Side => {
                tank = Some(Tank {
                    width: Some(2.0 * self.radius),
                    ..Tank::default()
                });
            }
        }
        Scene {
            tank,
            dem: DemScene {
                contact: Some(self.material.contact()),
                geometry,
                ..unguarded()
            },
            ..bench.scene(self.material.density, self.radius, spheres, dt)
        }
    }

    /// How far the two overlap (m), and how fast they part (m/s).
    fn overlap(&self, simulation: &Simulation) -> (f64, f64) {
        let particles = simulation.particles();
        let (position, velocity) = (&particles.position, &particles.velocity);
        let sphere = particles.fixed;
        let (place, speed) = (position[sphere].x, velocity[sphere].x);
        let sum = self.radius + self.partner_radius();
        match self.partner {
            Partner::Sphere => (sum - (place - position[1].x), speed - velocity[1].x),
            Partner::FixedSphere => (sum - (place - position[0].x), speed),
            Partner::Side => (-place, speed),
        }
    }
}
