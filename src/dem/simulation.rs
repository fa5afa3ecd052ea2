//! From a scene to a running simulation.

use super::contact::{Hertz, NoContact, NormalLaw};
use super::friction::{Coulomb, Frictionless, Mindlin, SpinFriction, TangentialLaw};
use super::guard::Limits;
use super::neighbours::VerletList;
use super::particles::Particles;
use super::start::{self, StartError};
use super::system::{Engine, Parts, System};
use super::walls::{Cylinder, Floor};
use super::{effects, timestep};
use crate::observe::FrameView;
use crate::record::Instability;
use crate::scene::{Contact, Friction, Scene};

/// Why a scene cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// The spheres cannot be placed.
    #[error(transparent)]
    Start(#[from] StartError),
    /// Friction acts at contacts.
    #[error("friction acts at contacts; add [contact] with law = \"hertz\"")]
    FrictionWithoutContact,
}

/// First skin of a neighbour list for contacts, in radii of the largest sphere: where lists are
/// long-lived and not yet long.
const CONTACT_SKIN: f64 = 0.5;

/// The same with the columns of an updraught's shield, whose list grows less with its skin.
const COLUMN_SKIN: f64 = 1.0;

/// A running simulation.
pub struct Simulation {
    engine: Box<dyn Engine>,
    dt: f64,
    components: [[Vec<f64>; 3]; 3],
}

impl Simulation {
    /// Places the spheres of a scene and makes it ready to run.
    ///
    /// # Errors
    /// If the spheres cannot be placed, or laws do not fit together.
    pub fn new(scene: &Scene) -> Result<Self, BuildError> {
        let skin = match scene.updraught {
            None => CONTACT_SKIN,
            Some(_) => COLUMN_SKIN,
        };
        Self::with_skin(scene, skin)
    }

    /// The same with another first skin of the neighbour list, in radii of the largest sphere: 0
    /// builds it at every step, a large one lists all pairs. Nothing but the speed depends on it: a
    /// test compares the bits.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_skin(scene: &Scene, skin: f64) -> Result<Self, BuildError> {
        let particles = start::place(scene)?;
        let tank = scene.tank.as_ref();
        let parts = Parts {
            floor: tank
                .and_then(|tank| tank.floor)
                .map(|height| Floor { height }),
            cylinder: tank
                .and_then(|tank| tank.radius)
                .map(|radius| Cylinder { radius }),
            effects: effects::of_scene(scene, &particles),
            shielded: scene.updraught.is_some(),
            limits: Limits::new(scene, &particles),
            dt: scene.time.dt,
            integrator: scene.time.integrator,
            skin: skin * particles.largest_radius(),
            particles,
        };
        let engine = engine(scene, parts)?;
        Ok(Self {
            engine,
            dt: scene.time.dt,
            components: Default::default(),
        })
    }

    /// Advances by a number of steps.
    ///
    /// # Errors
    /// The guard that was broken; the simulation must not be advanced any further.
    pub fn advance(&mut self, steps: u64) -> Result<(), Instability> {
        self.engine.advance(steps)
    }

    /// Keeps to the instructions that every machine of this architecture has. Slower, and the
    /// same bits: a test compares the two.
    pub fn use_baseline_instructions(&mut self) {
        self.engine.use_baseline_instructions();
    }

    /// The spheres.
    pub fn particles(&self) -> &Particles {
        self.engine.particles()
    }

    /// Steps done.
    pub fn step(&self) -> u64 {
        self.engine.step()
    }

    /// Time (s).
    pub fn time(&self) -> f64 {
        self.engine.step() as f64 * self.dt
    }

    /// The neighbour list, if any pairs interact.
    pub fn list(&self) -> Option<&VerletList> {
        self.engine.list()
    }

    /// Elastic energy of all contacts (J). Asking for it never changes the motion.
    pub fn elastic_energy(&mut self) -> f64 {
        self.engine.elastic_energy()
    }

    /// Everything an observer may see now.
    pub fn frame(&mut self) -> FrameView<'_> {
        let elastic_energy = self.engine.elastic_energy();
        let particles = self.engine.particles();
        let vectors = [&particles.position, &particles.velocity, &particles.spin];
        for (components, vectors) in self.components.iter_mut().zip(vectors) {
            components[0].clear();
            components[1].clear();
            components[2].clear();
            components[0].extend(vectors.iter().map(|vector| vector.x));
            components[1].extend(vectors.iter().map(|vector| vector.y));
            components[2].extend(vectors.iter().map(|vector| vector.z));
        }
        let [position, velocity, spin] = self
            .components
            .each_ref()
            .map(|c| c.each_ref().map(|c| &c[..]));
        FrameView {
            position,
            velocity,
            spin: particles.rotate().then_some(spin),
            radius: &particles.radius,
            mass: &particles.mass,
            inertia: &particles.inertia,
            elastic_energy,
        }
    }
}

/// The engine compiled for the scene's contact and friction. Each pair of laws costs time to compile,
/// so only those are here that go together.
fn engine(scene: &Scene, parts: Parts) -> Result<Box<dyn Engine>, BuildError> {
    fn boxed<N: NormalLaw, T: TangentialLaw>(
        normal: N,
        tangential: T,
        parts: Parts,
    ) -> Box<dyn Engine> {
        Box::new(System::new(normal, tangential, parts))
    }
    let Some(Contact::Hertz {
        young_modulus,
        poisson_ratio,
        dissipation_factor,
        ..
    }) = scene.contact
    else {
        return match scene.friction {
            None => Ok(boxed(NoContact, Frictionless, parts)),
            Some(_) => Err(BuildError::FrictionWithoutContact),
        };
    };
    let dissipation_time = timestep::dissipation_time(scene);
    let normal = Hertz::new(
        young_modulus,
        poisson_ratio,
        dissipation_time,
        dissipation_factor,
    );
    let dt = scene.time.dt;
    Ok(match scene.friction {
        None => boxed(normal, Frictionless, parts),
        Some(Friction::Spin { coefficient }) => {
            boxed(normal, SpinFriction::new(coefficient, dt), parts)
        }
        Some(Friction::Coulomb {
            coefficient,
            regularisation,
        }) => boxed(normal, Coulomb::new(coefficient, regularisation), parts),
        Some(Friction::Mindlin { coefficient }) => {
            let law = Mindlin::new(coefficient, young_modulus, poisson_ratio, dt);
            boxed(normal, law, parts)
        }
    })
}
