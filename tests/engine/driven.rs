//! Spheres that move along prescribed paths.

use phase::dem::Simulation;
use phase::particles::vector::Vector;
use phase::scene::{Integrator, Scene};

/// A row of spheres in empty space, the first of which swings into the second.
fn row(integrator: Integrator) -> Scene {
    let mut scene: Scene = toml::from_str(
        r#"
        spheres = { count = 3, radius = 0.004, density = 2500.0 }
        contact = { law = "hertz", young_modulus = 1e7, poisson_ratio = 0.3, dissipation_time = 1e-5 }
        friction = { law = "mindlin", coefficient = 0.3 }
        time = { dt = 1e-5, duration = 1.0, frame_interval = 1.0 }

        [start]
        kind = "list"
        spheres = [
            { position = [0.0, 0.0, 0.0], velocity = [9.0, 9.0, 9.0], spin = [1.0, 2.0, 3.0] },
            { position = [0.0085, 0.001, 0.0] },
            { position = [0.0, 0.5, 0.0] },
        ]

        [[driven]]
        sphere = 0
        velocity = [0.1, 0.0, -0.02]
        amplitude = [0.002, 0.001, 0.0]
        angular_frequency = 300.0
        phase = 0.4
        "#,
    )
    .unwrap();
    scene.time.integrator = integrator;
    scene
}

/// Where the path of the first sphere is at a time (s).
fn path(time: f64) -> Vector {
    let swing = libm::sin(300.0 * time + 0.4) - libm::sin(0.4);
    Vector::new(0.1, 0.0, -0.02) * time + Vector::new(0.002, 0.001, 0.0) * swing
}

#[test]
fn a_driven_sphere_keeps_to_its_path_and_pushes_others() {
    for integrator in Integrator::ALL {
        let mut simulation = Simulation::new(&row(integrator)).unwrap();
        for steps in [1, 99, 400, 2500] {
            simulation.advance(steps).unwrap();
            let off = simulation.particles().position[0] - path(simulation.time());
            assert!(off.norm() < 1e-12, "{integrator:?}: {off:?}");
        }
        let particles = simulation.particles();
        // It was hit off its centre, and keeps its spin.
        assert_eq!(particles.spin[0], Vector::new(1.0, 2.0, 3.0));
        assert!(particles.velocity[1].x > 0.3, "{:?}", particles.velocity[1]);
        assert!(particles.spin[1].norm() > 1.0);
        assert_eq!(particles.velocity[2], Vector::ZERO);
    }
}

/// As a sphere that moves at the same velocity and is too heavy to be slowed.
#[test]
fn it_pushes_as_a_heavy_sphere_does() {
    let mut scene = row(Integrator::SynchronisedVerlet);
    scene.dem.driven[0].amplitude = [0.0; 3];
    scene.dem.driven[0].velocity = [0.5, 0.0, 0.0];
    let pushed = |scene: &Scene| {
        let mut simulation = Simulation::new(scene).unwrap();
        simulation.advance(2000).unwrap();
        simulation.particles().velocity[1]
    };
    let driven = pushed(&scene);
    // Elastic enough that it leaves at nearly twice the speed.
    assert!(driven.x > 0.7, "{driven:?}");
    scene.dem.driven[0].velocity = [0.4, 0.0, 0.0];
    assert!(pushed(&scene).x < driven.x);
}

/// A scene that drives no sphere has neither the key nor another identity.
#[test]
fn a_scene_without_driven_spheres_knows_none() {
    let mut scene = row(Integrator::VelocityVerlet);
    let with = scene.identity();
    scene.dem.driven.clear();
    assert_ne!(scene.identity(), with);
    let text = serde_json::to_string(&scene).unwrap();
    assert!(
        !text.contains("driven") && !text.contains("resolution"),
        "{text}"
    );
}

/// Symptom: the run was ended by its first step, as not a number. Cause: the effective mass, or the
/// inertia against rolling, of two partners that both keep to their ways was infinite.
#[test]
fn a_driven_sphere_may_touch_the_floor_and_another_driven_one() {
    let silbert = "contact = { law = 'silbert', stiffness = 2e5, damping = 50.0 }
        friction = { law = 'silbert', coefficient = 0.5, stiffness = 57e3, damping = 25.0 }";
    let hertz = "contact = { law = 'hertz', young_modulus = 1e7, poisson_ratio = 0.3, dissipation_time = 1e-5 }
        friction = { law = 'mindlin', coefficient = 0.3 }
        rolling = { coefficient = 0.1, damping = 0.3 }";
    for laws in [silbert, hertz] {
        for integrator in Integrator::ALL {
            let text = format!(
                "{laws}
                spheres = {{ count = 2, radius = 0.5, density = 1.9 }}
                tank = {{ width = 6.0, depth = 4.0, floor = 0.0 }}
                time = {{ dt = 1e-5, duration = 1.0, frame_interval = 1.0 }}
                start = {{ kind = 'list', spheres = [
                    {{ position = [0.0, 0.0, 0.499] }}, {{ position = [0.999, 0.0, 0.499] }},
                ] }}
                driven = [
                    {{ sphere = 0, velocity = [0.5, 0.0, 0.0] }},
                    {{ sphere = 1, velocity = [0.5, 0.0, 0.0] }},
                ]"
            );
            let mut scene: Scene = toml::from_str(&text).unwrap();
            scene.time.integrator = integrator;
            let mut simulation = Simulation::new(&scene).unwrap();
            simulation.advance(1000).unwrap();
            let particles = simulation.particles();
            assert!((particles.position[1].x - 1.004).abs() < 1e-9);
            assert!(
                particles.spin.iter().all(|it| it.norm() == 0.0),
                "{:?}",
                particles.spin
            );
        }
    }
}
