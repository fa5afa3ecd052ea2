//! Scenes that the tests of the engine share.
#![allow(dead_code, reason = "each test program uses a part of it")]

use phase::dem::DemSimulation;
use phase::particles::Particles;
use phase::particles::vector::Vector;
use phase::scene::{
    Contact, Coulomb, Friction, Hertz, Integrator, Mindlin, Scene, Shaking, Spin, Start,
    StartSphere,
};
use proptest::prelude::*;

pub(crate) const INTEGRATORS: [Integrator; 4] = Integrator::ALL;

/// No friction, and every law of it.
pub(crate) fn frictions() -> [Option<Friction>; 5] {
    [
        None,
        Some(Friction::Spin(Spin { coefficient: 0.01 })),
        Some(Friction::Coulomb(Coulomb {
            coefficient: 0.3,
            regularisation: 1e-2,
        })),
        Some(Friction::Mindlin(Mindlin {
            coefficient: 0.3,
            rescale: false,
        })),
        Some(Friction::Mindlin(Mindlin {
            coefficient: 0.3,
            rescale: true,
        })),
    ]
}

/// A small tank with every effect, in which spheres collide, rise, turn and pile up.
pub(crate) fn tank(friction: Option<Friction>, integrator: Integrator) -> Scene {
    let mut scene: Scene = toml::from_str(
        r#"
        spheres.count = 60
        spheres.radius = [{ radius = 0.003, share = 1 }, { radius = 0.004, share = 1 }]
        spheres.density = 3750.0
        contact.law = "hertz"
        contact.young_modulus = 5.657e5
        contact.poisson_ratio = 0.3
        contact.dissipation_time = 1e-4
        tank = { radius = 0.03, floor = -0.05 }
        start = { kind = "random", z_min = -0.04, z_max = 0.06, speed = 0.3, spin = 5.0 }
        gravity = { acceleration = 9.8 }
        drag = { law = "cross-section", linear = 100.0, quadratic = 200.0, form = "component" }
        swirl = { omega = 12.0 }
        updraught = { speed = 5.88, decay = 25.0, origin = -0.05, alpha = 0.5 }
        time = { dt = 1e-4, duration = 0.2, frame_interval = 1e-3 }
        "#,
    )
    .unwrap();
    scene.dem.friction = friction;
    scene.time.integrator = integrator;
    scene
}

/// Beads in a tank of turning water: with every effect of a fluid.
pub(crate) fn water(integrator: Integrator) -> Scene {
    let mut scene = Scene::load("tests/good/water.toml".as_ref()).unwrap();
    scene.time.integrator = integrator;
    scene
}

/// The small tank without air, shaken obliquely.
pub(crate) fn shaken(integrator: Integrator) -> Scene {
    let mut scene = tank(frictions()[3].clone(), integrator);
    shake(&mut scene);
    scene
}

/// Scenes between listed walls and periodic sides: a drum with a blade that turns with its ends,
/// and a shaken slope under a belt.
pub(crate) fn walled(integrator: Integrator) -> [Scene; 2] {
    let text = |tables: &str| {
        format!(
            r#"
            spheres = {{ count = 60, radius = 0.004, density = 1000.0 }}
            time = {{ dt = 2e-5, duration = 0.1, frame_interval = 2e-3, integrator = "velocity-verlet" }}
            gravity = {{ acceleration = 9.81, tilt = 0.1 }}
            start = {{ kind = "random", x = [-0.03, 0.03], y = [-0.02, 0.02], z_min = -0.03, z_max = 0.03, speed = 1.0, spin = 50.0 }}
            {tables}"#
        )
    };
    let drum = r#"
        contact = { law = "hooke", stiffness = 2000.0, damping_rate = 200.0 }
        friction = { law = "hooke", coefficient = 0.5, stiffness = 600.0, damping_rate = 100.0 }
        wall = [
            { cylinder = { base = [0.0, -0.03, 0.0], axis = [0.0, 1.0, 0.0], radius = 0.05, length = 0.06 }, angular_velocity = 12.0 },
            { disc = { centre = [0.0, -0.03, 0.0], axis = [0.0, 1.0, 0.0], radius = 0.05 }, angular_velocity = 12.0 },
            { disc = { centre = [0.0, 0.03, 0.0], axis = [0.0, 1.0, 0.0], radius = 0.05 }, friction_coefficient = 0.2 },
            { plate = { corner = [-0.05, -0.03, 0.0], first_edge = [0.01, 0.0, 0.0], second_edge = [0.0, 0.06, 0.0] } },
        ]"#;
    let slope = r#"
        contact = { law = "tsuji", young_modulus = 1e6, poisson_ratio = 0.3, restitution = 0.7 }
        friction = { law = "mindlin", coefficient = 0.4 }
        periodic = { x = 0.06, y = 0.04 }
        tank = { floor = -0.034 }
        wall = [{ plane = { point = [0.0, 0.0, 0.036], normal = [0.0, 0.0, -1.0] }, velocity = [0.5, 0.2, 0.0] }]
        shaking = { amplitude = 1e-3, frequency = 40.0, direction = [0.2, 0.0, 1.0], phase = 0.3 }"#;
    [drum, slope].map(|tables| {
        let mut scene: Scene = toml::from_str(&text(tables)).unwrap();
        assert_eq!(scene.problems(), []);
        scene.time.integrator = integrator;
        scene
    })
}

/// Integrators that know listed walls and periodic sides.
pub(crate) fn integrators_at_walls() -> impl Iterator<Item = Integrator> {
    let all = INTEGRATORS.into_iter();
    all.filter(|it| *it != Integrator::AdaptiveVerlet)
}

/// Takes the air out of a scene and shakes it.
pub(crate) fn shake(scene: &mut Scene) {
    let effects = &mut scene.dem.effects;
    (effects.drag, effects.swirl, effects.updraught) = (None, None, None);
    effects.shaking = Some(Shaking {
        amplitude: 1e-3,
        frequency: Some(40.0),
        gamma: None,
        direction: [0.2, 0.0, 1.0],
        phase: 0.3,
        frames_per_period: None,
        periods: None,
    });
}

/// Spheres in empty space that fly at one another.
pub(crate) fn cluster(spheres: Vec<StartSphere>, friction: Option<Friction>, dt: f64) -> Scene {
    let mut scene: Scene = toml::from_str(
        r#"
        spheres = { count = 1, radius = 0.004, density = 1e4 }
        contact.law = "hertz"
        contact.young_modulus = 1e6
        contact.poisson_ratio = 0.3
        contact.dissipation_time = 0.0
        start = { kind = "list", spheres = [] }
        time = { dt = 1e-5, duration = 1.0, frame_interval = 1e-3, integrator = "velocity-verlet" }
        "#,
    )
    .unwrap();
    scene.spheres.count = spheres.len();
    scene.start = Start::list(spheres);
    scene.dem.friction = friction;
    scene.time.dt = dt;
    scene
}

/// Two to ten spheres of 2.5 to 4 mm near the corners of a lattice, which fall towards the
/// middle with about 1 m/s and spin.
pub(crate) fn converging_spheres() -> impl Strategy<Value = Vec<StartSphere>> {
    let triple = || prop::array::uniform3(-1.0..1.0_f64);
    let sphere = (triple(), triple(), triple(), 2.5e-3..4e-3);
    prop::collection::vec(sphere, 2..10).prop_map(|spheres| {
        let place = |(i, (shift, velocity, spin, radius)): (usize, ([f64; 3], _, _, _))| {
            let velocity: [f64; 3] = velocity;
            let spin: [f64; 3] = spin;
            let corner = [i % 2, i / 2 % 2, i / 4].map(|k| 0.01 * (k as f64 - 0.5));
            let position = std::array::from_fn(|k| corner[k] + 5e-4 * shift[k]);
            StartSphere {
                position,
                velocity: std::array::from_fn(|k| 0.3 * velocity[k] - 100.0 * position[k]),
                spin: spin.map(|component| 200.0 * component),
                radius: Some(radius),
            }
        };
        spheres.into_iter().enumerate().map(place).collect()
    })
}

pub(crate) fn momentum(particles: &Particles) -> Vector {
    (0..particles.len()).fold(Vector::ZERO, |sum, i| {
        sum + particles.velocity[i] * particles.mass[i]
    })
}

pub(crate) fn angular_momentum(particles: &Particles) -> Vector {
    (0..particles.len()).fold(Vector::ZERO, |sum, i| {
        let orbital = particles.position[i].cross(particles.velocity[i]) * particles.mass[i];
        let spin = particles.spin.get(i).copied().unwrap_or_default();
        let inertia = particles.inertia.get(i).copied().unwrap_or_default();
        sum + orbital + spin * inertia
    })
}

/// Whether isolated spheres keep momentum and angular momentum over 1500 steps, to rounding.
pub(crate) fn momentum_is_kept(scene: &Scene) -> Result<(), TestCaseError> {
    let mut simulation = DemSimulation::new(scene).unwrap();
    let before = simulation.particles().clone();
    simulation.advance(1500).unwrap();
    let after = simulation.particles();
    let (linear, angular) = scales(&before);
    let change = (momentum(after) - momentum(&before)).norm();
    prop_assert!(
        change <= 1e-13 * linear,
        "momentum changes by {change} of {linear}"
    );
    let change = (angular_momentum(after) - angular_momentum(&before)).norm();
    prop_assert!(
        change <= 1e-12 * angular,
        "angular momentum by {change} of {angular}"
    );
    Ok(())
}

/// Momentum and angular momentum if all of it had one direction: what rounding is relative to.
pub(crate) fn scales(particles: &Particles) -> (f64, f64) {
    let spin = |i: usize| particles.spin.get(i).map_or(0.0, |spin| spin.norm());
    let inertia = |i: usize| particles.inertia.get(i).copied().unwrap_or_default();
    (0..particles.len()).fold((0.0, 0.0), |(linear, angular), i| {
        let momentum = particles.mass[i] * particles.velocity[i].norm();
        let orbital = momentum * particles.position[i].norm();
        (linear + momentum, angular + orbital + inertia(i) * spin(i))
    })
}

/// Kinetic, rotational, gravitational and elastic energy (J).
pub(crate) fn energy(simulation: &mut DemSimulation, gravity: f64) -> f64 {
    let elastic = simulation.elastic_energy();
    let particles = simulation.particles();
    let of_sphere = |i: usize| {
        let spin = particles
            .spin
            .get(i)
            .map_or(0.0, |spin| spin.norm_squared());
        let inertia = particles.inertia.get(i).copied().unwrap_or_default();
        let translation = 0.5 * particles.velocity[i].norm_squared();
        particles.mass[i] * (translation + gravity * particles.position[i].z) + 0.5 * inertia * spin
    };
    (0..particles.len()).map(of_sphere).sum::<f64>() + elastic
}

pub(crate) fn damped(mut scene: Scene, time: f64) -> Scene {
    let Some(Contact::Hertz(Hertz {
        dissipation_time, ..
    })) = &mut scene.dem.contact
    else {
        panic!("a scene with contacts")
    };
    *dissipation_time = Some(time);
    scene
}

/// Where spheres are and how they move: everything that the motion goes on from.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct State {
    pub(crate) position: Vec<Vector>,
    pub(crate) velocity: Vec<Vector>,
    pub(crate) spin: Vec<Vector>,
}

pub(crate) fn state(simulation: &DemSimulation) -> State {
    let particles = simulation.particles();
    State {
        position: particles.position.clone(),
        velocity: particles.velocity.clone(),
        spin: particles.spin.clone(),
    }
}

impl State {
    /// The same bits, in the order of the spheres.
    pub(crate) fn bits(&self) -> Vec<[u64; 3]> {
        let all = [&self.position, &self.velocity, &self.spin];
        all.into_iter()
            .flatten()
            .map(|v| [v.x, v.y, v.z].map(f64::to_bits))
            .collect()
    }

    /// The state after each vector of it went through `polar`, each spin through `axial`.
    pub(crate) fn map(
        &self,
        polar: impl Fn(Vector) -> Vector,
        axial: impl Fn(Vector) -> Vector,
    ) -> Self {
        Self {
            position: self.position.iter().copied().map(&polar).collect(),
            velocity: self.velocity.iter().copied().map(&polar).collect(),
            spin: self.spin.iter().copied().map(&axial).collect(),
        }
    }

    /// The spheres in another order.
    pub(crate) fn reordered(&self, order: &[usize]) -> Self {
        let pick = |all: &[Vector]| order.iter().filter_map(|&i| all.get(i).copied()).collect();
        Self {
            position: pick(&self.position),
            velocity: pick(&self.velocity),
            spin: pick(&self.spin),
        }
    }

    /// A scene's spheres in this state.
    pub(crate) fn start(&self, radius: &[f64]) -> Start {
        let triple = |v: Vector| [v.x, v.y, v.z];
        let sphere = |i: usize| StartSphere {
            position: triple(self.position[i]),
            velocity: triple(self.velocity[i]),
            spin: self.spin.get(i).copied().map_or([0.0; 3], triple),
            radius: Some(radius[i]),
        };
        Start::list((0..radius.len()).map(sphere).collect())
    }

    /// Largest difference of positions, over `length`.
    pub(crate) fn distance(&self, other: &Self, length: f64) -> f64 {
        let pairs = self.position.iter().zip(&other.position);
        pairs
            .map(|(&a, &b)| (a - b).norm() / length)
            .fold(0.0, f64::max)
    }
}
