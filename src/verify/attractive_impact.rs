//! A sphere hits another one, or something fixed, under a contact that attracts at its end, head-on
//! or obliquely with friction.

use super::bench::{Bench, moving, unguarded};
use super::{AnyMaterial, CaseFamily, MeasuredValues, VerifyError, named};
use crate::dem::DemSimulation;
use crate::particles::vector::Vector;
use crate::scene::{DemScene, FixedSphere, Friction, Geometry, Scene, Tank};
use serde::Deserialize;
use std::f64::consts::PI;

/// A sphere hits another one, or something fixed. Two spheres move in the frame of the second.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AttractiveImpact {
    partner: AttractivePartner,
    /// Radius of the sphere (m).
    radius: f64,
    /// Radius of the partner, if it is a sphere of different radius (m).
    #[serde(default)]
    partner_radius: Option<f64>,
    material: AnyMaterial,
    #[serde(default)]
    friction: Option<Friction>,
    /// Relative speed (m/s).
    speed: f64,
    /// Angles between velocity and normal (degrees), one impact each; one head-on if there are
    /// none.
    #[serde(default)]
    angles: Vec<u32>,
    /// Time steps in the duration of the elastic impact.
    steps_per_contact: f64,
}

/// What the sphere hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum AttractivePartner {
    Sphere,
    FixedSphere,
    /// A side of a box.
    Side,
}

/// An impact takes less than this many times the duration of the elastic impact.
const PATIENCE: f64 = 10.0;

impl CaseFamily for AttractiveImpact {
    fn name(&self) -> &'static str {
        "attractive-impact"
    }

    /// Contact time, restitution and deepest overlap of a head-on impact; the spin of the sphere
    /// (rad/s), positive if it rolls forward, after oblique impacts.
    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        if self.angles.is_empty() {
            let outcome = self.impact(0.0, bench)?;
            return Ok(named([
                ("contact_time", outcome.contact_time),
                ("restitution", outcome.restitution),
                ("maximum_overlap", outcome.maximum_overlap),
            ]));
        }
        let spin = |&angle: &u32| {
            let outcome = self.impact(f64::from(angle), bench)?;
            Ok((format!("spin_at_{angle}"), outcome.spin))
        };
        self.angles.iter().map(spin).collect()
    }
}

/// The result of an impact.
struct ReboundOfPair {
    contact_time: f64,
    restitution: f64,
    maximum_overlap: f64,
    spin: f64,
}

impl AttractiveImpact {
    /// An impact at an angle (degrees).
    fn impact(&self, angle: f64, bench: &mut Bench<'_>) -> Result<ReboundOfPair, VerifyError> {
        let (sine, cosine) = libm::sincos(angle * PI / 180.0);
        let velocity = Vector::new(-cosine, 0.0, sine) * self.speed;
        let dt = self.elastic_time(-velocity.x) / self.steps_per_contact;
        let mut simulation = DemSimulation::new(&self.scene(velocity, dt, bench))?;
        let (mut overlap, mut deepest) = (0.0, 0.0_f64);
        for _ in 0..(PATIENCE * self.steps_per_contact) as u64 {
            let earlier = overlap;
            bench.advance(&mut simulation, 1)?;
            let apart;
            (overlap, apart) = self.overlap(&simulation);
            deepest = deepest.max(overlap);
            if overlap <= 0.0 {
                // The overlap reaches zero in between, by linear interpolation.
                let behind = overlap / (overlap - earlier);
                let particles = simulation.particles();
                let spin = particles.spin.get(particles.fixed);
                return Ok(ReboundOfPair {
                    contact_time: simulation.time() - behind * dt,
                    restitution: apart / -velocity.x,
                    maximum_overlap: deepest,
                    spin: spin.map_or(0.0, |spin| -spin.y),
                });
            }
        }
        Err(VerifyError::Unfinished {
            awaited: "the end of the contact",
            steps: simulation.step(),
        })
    }

    fn partner_radius(&self) -> f64 {
        self.partner_radius.unwrap_or(self.radius)
    }

    /// Duration of the same impact without losses (s) at a normal speed (m/s).
    fn elastic_time(&self, speed: f64) -> f64 {
        let (radius, other) = (self.radius, self.partner_radius());
        let mass = |radius| self.material.mass(radius);
        let (effective_radius, effective_mass) = match self.partner {
            AttractivePartner::Sphere => (
                radius * other / (radius + other),
                mass(radius) * mass(other) / (mass(radius) + mass(other)),
            ),
            AttractivePartner::FixedSphere => (radius * other / (radius + other), mass(radius)),
            AttractivePartner::Side => (radius, mass(radius)),
        };
        (self.material).elastic_time(effective_radius, effective_mass, speed)
    }

    /// They touch at the start; the partner is at rest at the origin.
    fn scene(&self, velocity: Vector, dt: f64, bench: &Bench<'_>) -> Scene {
        let distance = match self.partner {
            AttractivePartner::Side => 0.0,
            AttractivePartner::Sphere | AttractivePartner::FixedSphere => {
                self.radius + self.partner_radius()
            }
        };
        let mut spheres = vec![moving(
            [distance, 0.0, 0.0],
            [velocity.x, velocity.y, velocity.z],
        )];
        let (mut geometry, mut tank) = (None, None);
        match self.partner {
            AttractivePartner::Sphere => {
                let mut partner = moving([0.0; 3], [0.0; 3]);
                partner.radius = self.partner_radius;
                spheres.push(partner);
            }
            AttractivePartner::FixedSphere => {
                geometry = Some(Geometry::List {
                    walls: vec![FixedSphere {
                        position: [0.0; 3],
                        radius: self.partner_radius(),
                    }],
                    door: Vec::new(),
                });
            }
            AttractivePartner::Side => {
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
                friction: self.friction.clone(),
                geometry,
                ..unguarded()
            },
            ..bench.scene(self.material.density(), self.radius, spheres, dt)
        }
    }

    /// How far the two overlap (m), and how fast they part (m/s).
    fn overlap(&self, simulation: &DemSimulation) -> (f64, f64) {
        let particles = simulation.particles();
        let (position, velocity) = (&particles.position, &particles.velocity);
        let sphere = particles.fixed;
        let (place, speed) = (position[sphere], velocity[sphere]);
        let other = match self.partner {
            AttractivePartner::Sphere => 1,
            AttractivePartner::FixedSphere => 0,
            AttractivePartner::Side => return (-place.x, speed.x),
        };
        let offset = place - position[other];
        let distance = offset.norm();
        let apart = (speed - velocity[other]).dot(offset) / distance;
        (self.radius + self.partner_radius() - distance, apart)
    }
}
