//! A sphere hits a sphere or a wall, head-on or obliquely, with or without spin.

use super::bench::{Bench, floor, moving, reduced, unguarded};
use super::material::Material;
use super::{CaseFamily, MeasuredValues, VerifyError, named};
use crate::dem::{DemSimulation, timestep};
use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::scene::{
    AddedMass, Contact, DemScene, Effects, Friction, Hertz, Scene, StartSphere, Tank, Time,
};
use serde::Deserialize;
use std::f64::consts::PI;

/// A sphere hits a sphere or a wall.
///
/// The normal n points from the partner to the sphere, the tangent t along the tangential part of
/// its velocity; spins are about n x t, positive if the sphere rolls forward. Two spheres move in
/// the frame of their centre of mass.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImpactCase {
    partner: ImpactPartner,
    /// Radius of the sphere (m).
    radius: f64,
    /// Radius of the partner, if it is a sphere of different radius (m).
    #[serde(default)]
    partner_radius: Option<f64>,
    material: Material,
    /// Whether the partner is rigid: a wall of the same material yields as much as the sphere, so a
    /// rigid one is modelled by twice the modulus.
    #[serde(default)]
    rigid: bool,
    /// b = c A / T, instead of the material's dissipation time.
    #[serde(default)]
    damping: Option<f64>,
    /// Restitution at the normal speed, instead of the dissipation time: the scene's key, for two
    /// spheres of this radius.
    #[serde(default)]
    restitution: Option<f64>,
    #[serde(default)]
    friction: Option<Friction>,
    #[serde(default)]
    added_mass: Option<AddedMass>,
    /// Relative speed (m/s).
    speed: f64,
    /// Angle between velocity and normal (degrees).
    #[serde(default)]
    angle: f64,
    /// Spins before the impact (rad/s).
    #[serde(default)]
    spin: f64,
    #[serde(default)]
    partner_spin: f64,
    /// Time steps in the duration of the elastic impact.
    #[serde(default = "thousand")]
    steps_per_contact: f64,
    /// Time step (s), instead of `steps_per_contact`.
    #[serde(default)]
    dt: Option<f64>,
    /// Resolution of adaptive Verlet (rad), instead of the default.
    #[serde(default)]
    resolution: Option<f64>,
    /// Number of impacts to average over, which begin at equally spaced parts of a step; one
    /// impact begins with a step.
    #[serde(default = "once")]
    phases: u32,
}

fn thousand() -> f64 {
    1000.0
}

fn once() -> u32 {
    1
}

/// What the sphere hits.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ImpactPartner {
    Sphere,
    Floor,
    /// Tangential motion is along the axis, where a cylinder is straight.
    Cylinder,
}

impl ImpactPartner {
    /// Normal and tangent.
    fn frame(self) -> (Vector, Vector) {
        let (x, z) = (Vector::new(1.0, 0.0, 0.0), Vector::new(0.0, 0.0, 1.0));
        match self {
            Self::Sphere | Self::Floor => (z, x),
            Self::Cylinder => (-x, z),
        }
    }
}

/// Radius of the cylinder, in radii of the sphere.
const CYLINDER: f64 = 100.0;

/// An impact takes less than this many times the duration of the elastic impact.
const PATIENCE: f64 = 100.0;

impl CaseFamily for ImpactCase {
    fn name(&self) -> &'static str {
        "impact"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let mut mean = MeasuredValues::new();
        for phase in 0..self.phases {
            let phase = f64::from(phase) / f64::from(self.phases);
            for (quantity, value) in self.impact(phase, bench)? {
                *mean.entry(quantity).or_default() += value / f64::from(self.phases);
            }
        }
        Ok(mean)
    }
}

/// Overlap and force at one time.
#[derive(Clone, Copy, Default)]
struct ImpactMoment {
    time: f64,
    overlap: f64,
    force: f64,
}

impl ImpactCase {
    /// One impact that begins after the fraction `phase` of a step.
    fn impact(&self, phase: f64, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let material = self.hardened();
        let contact_time = self.elastic(&material).contact_time();
        let dt = self.dt.unwrap_or(contact_time / self.steps_per_contact);
        let begin = phase * dt;
        let scene = self.scene(&material, begin, dt, bench);
        let mut simulation = DemSimulation::new(&scene)?;
        let before = self.state(simulation.particles());

        let (mut maximum_overlap, mut maximum_force) = (0.0_f64, 0.0_f64);
        let (mut earlier, mut last) = (ImpactMoment::default(), ImpactMoment::default());
        let mut end = None;
        loop {
            let overlap = self.overlap(simulation.particles());
            bench.advance(&mut simulation, 1)?;
            let (age, after) = (bench.age_of_forces(), self.overlap(simulation.particles()));
            let now = ImpactMoment {
                time: simulation.time() - age * dt,
                overlap: after + (overlap - after) * age,
                force: self.force(simulation.particles()),
            };
            maximum_overlap = maximum_overlap.max(now.overlap);
            maximum_force = maximum_force.max(now.force);
            if end.is_none() && last.force > 0.0 && now.force == 0.0 {
                end = Some(end_of_contact(earlier, last, now));
            }
            if end.is_some() && now.overlap <= 0.0 {
                break;
            }
            if simulation.time() > PATIENCE * contact_time {
                return Err(VerifyError::Unfinished {
                    awaited: "the spheres part",
                    steps: simulation.step(),
                });
            }
            (earlier, last) = (last, now);
        }
        let after = self.state(simulation.particles());
        Ok(named([
            ("maximum_overlap", maximum_overlap),
            ("maximum_force", maximum_force),
            ("contact_time", end.unwrap_or(f64::NAN) - begin),
            ("restitution", -after.normal / before.normal),
            (
                "tangential_restitution",
                after.tangential / before.tangential,
            ),
            ("lateral_velocity", after.lateral),
            ("spin", after.spin[0]),
            ("partner_spin", after.spin[1]),
            ("energy_ratio", after.energy / before.energy),
        ]))
    }

    /// The material for which walls of the same material yield as in this set-up.
    fn hardened(&self) -> Material {
        let mut material = self.material.clone();
        if self.rigid {
            material.young_modulus *= 2.0;
        }
        if let Some(damping) = self.damping {
            material.dissipation_time =
                damping * self.elastic(&material).time_scale() / material.dissipation_factor;
        }
        material
    }

    fn normal_speed(&self) -> f64 {
        self.speed * libm::cos(self.angle * PI / 180.0)
    }

    /// The same impact without dissipation and friction.
    fn elastic(&self, material: &Material) -> timestep::Impact {
        let radius = match self.partner {
            ImpactPartner::Sphere => reduced(self.radius, self.partner_radius()),
            ImpactPartner::Floor | ImpactPartner::Cylinder => self.radius,
        };
        let mass = match self.partner {
            ImpactPartner::Sphere => reduced(
                material.mass(self.radius),
                material.mass(self.partner_radius()),
            ),
            ImpactPartner::Floor | ImpactPartner::Cylinder => material.mass(self.radius),
        };
        let inertial_factor = self.added_mass.as_ref().map_or(1.0, |it| {
            1.0 + it.coefficient * it.density / material.density
        });
        material.impact(radius, mass * inertial_factor, self.normal_speed())
    }

    fn partner_radius(&self) -> f64 {
        self.partner_radius.unwrap_or(self.radius)
    }

    fn scene(&self, material: &Material, begin: f64, dt: f64, bench: &Bench<'_>) -> Scene {
        let (normal, tangent) = self.partner.frame();
        let sine = libm::sin(self.angle * PI / 180.0);
        let velocity = tangent * (self.speed * sine) - normal * self.normal_speed();
        let centre = match self.partner {
            ImpactPartner::Sphere | ImpactPartner::Floor => normal * self.radius,
            ImpactPartner::Cylinder => normal * (self.radius * (1.0 - CYLINDER)),
        };
        let sphere = |centre: Vector, velocity: Vector, spin: f64| {
            let start = centre - velocity * begin;
            let spin = normal.cross(tangent) * spin;
            StartSphere {
                spin: [spin.x, spin.y, spin.z],
                ..moving(
                    [start.x, start.y, start.z],
                    [velocity.x, velocity.y, velocity.z],
                )
            }
        };
        let mut spheres = vec![sphere(centre, velocity, self.spin)];
        let mut tank = None;
        match self.partner {
            ImpactPartner::Sphere => {
                let (mine, other) = (
                    material.mass(self.radius),
                    material.mass(self.partner_radius()),
                );
                let share = other / (mine + other);
                spheres = vec![
                    sphere(centre, velocity * share, self.spin),
                    StartSphere {
                        radius: self.partner_radius,
                        ..sphere(
                            normal * -self.partner_radius(),
                            velocity * (share - 1.0),
                            self.partner_spin,
                        )
                    },
                ];
            }
            ImpactPartner::Floor => {
                tank = Some(floor());
            }
            ImpactPartner::Cylinder => {
                tank = Some(Tank {
                    radius: Some(CYLINDER * self.radius),
                    ..Tank::default()
                });
            }
        }
        let bare = bench.scene(material.density, self.radius, spheres, dt);
        let time = Time {
            resolution: self.resolution,
            ..bare.time.clone()
        };
        Scene {
            tank,
            time,
            dem: DemScene {
                contact: Some(self.contact(material)),
                friction: self.friction.clone(),
                effects: Effects {
                    added_mass: self.added_mass.clone(),
                    ..Effects::default()
                },
                ..unguarded()
            },
            ..bare
        }
    }

    fn contact(&self, material: &Material) -> Contact {
        let mut law = material.contact();
        if let (
            Some(given),
            Contact::Hertz(Hertz {
                dissipation_time,
                restitution,
                restitution_speed,
                ..
            }),
        ) = (self.restitution, &mut law)
        {
            *dissipation_time = None;
            *restitution = Some(given);
            *restitution_speed = self.normal_speed();
        }
        law
    }

    fn overlap(&self, particles: &Particles) -> f64 {
        let centre = particles.position[0];
        match self.partner {
            ImpactPartner::Sphere => {
                self.radius + self.partner_radius() - (centre - particles.position[1]).norm()
            }
            ImpactPartner::Floor => self.radius - centre.z,
            ImpactPartner::Cylinder => {
                let distance = Vector::new(centre.x, centre.y, 0.0).norm();
                distance + self.radius - CYLINDER * self.radius
            }
        }
    }

    /// Normal force on the sphere.
    fn force(&self, particles: &Particles) -> f64 {
        let normal = match self.partner {
            ImpactPartner::Sphere => {
                let offset = particles.position[0] - particles.position[1];
                offset * (1.0 / offset.norm())
            }
            ImpactPartner::Floor | ImpactPartner::Cylinder => self.partner.frame().0,
        };
        particles.force[0].dot(normal)
    }

    fn state(&self, particles: &Particles) -> ImpactState {
        let (normal, tangent) = self.partner.frame();
        let axis = normal.cross(tangent);
        let velocity = match self.partner {
            ImpactPartner::Sphere => particles.velocity[0] - particles.velocity[1],
            ImpactPartner::Floor | ImpactPartner::Cylinder => particles.velocity[0],
        };
        let spin = |i: usize| particles.spin.get(i).map_or(0.0, |spin| spin.dot(axis));
        let kinetic = particles.mass.iter().zip(&particles.velocity);
        let rotational = particles.inertia.iter().zip(&particles.spin);
        ImpactState {
            normal: velocity.dot(normal),
            tangential: velocity.dot(tangent),
            lateral: particles.velocity[0].dot(tangent),
            spin: [spin(0), spin(1)],
            energy: kinetic
                .chain(rotational)
                .map(|(inertia, velocity)| 0.5 * inertia * velocity.norm_squared())
                .sum(),
        }
    }
}

/// Motion before or after the impact.
struct ImpactState {
    normal: f64,
    tangential: f64,
    lateral: f64,
    spin: [f64; 2],
    energy: f64,
}

/// When the force ended, between the last two moments, by linear extrapolation to zero: of the
/// overlap if it ends with the force, else of the clipped force.
fn end_of_contact(earlier: ImpactMoment, last: ImpactMoment, now: ImpactMoment) -> f64 {
    if now.overlap <= 0.0 {
        let fraction = last.overlap / (last.overlap - now.overlap);
        last.time + fraction * (now.time - last.time)
    } else {
        let slope = (earlier.force - last.force) / (last.time - earlier.time);
        last.time + last.force / slope
    }
}
