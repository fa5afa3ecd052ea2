//! What the adaptive integrator does beyond the cases of the verification tables.

use phase::dem::DemSimulation;
use phase::dem::timestep::Impact;
use phase::scene::{Integrator, Scene, Shape, Start, StartSphere};

/// Steel spheres in empty space, of 4 mm unless they say otherwise.
fn steel(spheres: Vec<StartSphere>, dissipation: f64, dt: f64) -> Scene {
    let mut scene: Scene = toml::from_str(
        r#"
        spheres = { count = 1, radius = 0.004, density = 7850.0 }
        contact.law = "hertz"
        contact.young_modulus = 2.1e11
        contact.poisson_ratio = 0.3
        contact.dissipation_time = 0.0
        contact.dissipation_factor = 1.5
        start = { kind = "list", spheres = [] }
        time = { dt = 1e-5, duration = 1.0, frame_interval = 1.0, integrator = "adaptive-verlet" }
        "#,
    )
    .unwrap();
    scene.spheres.count = spheres.len();
    scene.start = Start::list(spheres);
    scene.time.dt = dt;
    if let Some(phase::scene::Contact::Hertz(phase::scene::Hertz {
        dissipation_time, ..
    })) = &mut scene.dem.contact
    {
        *dissipation_time = Some(dissipation);
    }
    scene
}

fn sphere(x: f64, speed: f64) -> StartSphere {
    StartSphere {
        velocity: [speed, 0.0, 0.0],
        ..StartSphere::at([x, 0.0, 0.0])
    }
}

fn speeds(simulation: &DemSimulation) -> Vec<f64> {
    let velocities = &simulation.particles().velocity;
    velocities.iter().map(|velocity| velocity.x).collect()
}

fn momentum(simulation: &DemSimulation) -> f64 {
    let particles = simulation.particles();
    let momenta = particles.velocity.iter().zip(&particles.mass);
    momenta.map(|(velocity, mass)| velocity.x * mass).sum()
}

fn kinetic(simulation: &DemSimulation) -> f64 {
    let particles = simulation.particles();
    let energies = particles.velocity.iter().zip(&particles.mass);
    energies
        .map(|(velocity, mass)| 0.5 * mass * velocity.norm_squared())
        .sum()
}

/// An impact that lasts a fortieth of a step has the restitution of the law to 2e-3, which is what
/// the sub-steps resolve: .800472224 for steel with A = 1e-6 s and c = 3/2 at 1 m/s, by an
/// independent integration.
#[test]
fn an_impact_within_a_step_is_resolved() {
    let mass = Shape::Sphere.mass(7850.0, 0.004);
    let contact_time = Impact::of_equal_spheres(0.004, mass, 2.1e11, 0.3, 1.0).contact_time();
    let dt = 40.0 * contact_time;
    for phase in 0..16 {
        let gap = f64::from(phase) / 16.0 * dt;
        let pair = vec![sphere(0.0, 0.5), sphere(0.008 + gap, -0.5)];
        let mut simulation = DemSimulation::new(&steel(pair, 1e-6, dt)).unwrap();
        simulation.advance(3).unwrap();
        let [left, right] = speeds(&simulation)[..] else {
            panic!("two spheres")
        };
        let restitution = right - left;
        assert!((restitution - 0.800_472_224).abs() < 2e-3, "{restitution}");
        assert!(momentum(&simulation).abs() < 1e-15);
    }
}

/// Of a hundred spheres two collide: the others take one move per step.
#[test]
fn only_spheres_that_collide_take_sub_steps() {
    let (dt, steps) = (1e-3, 20);
    let mut spheres: Vec<StartSphere> = (0..98)
        .map(|i| StartSphere::at([f64::from(i) * 0.02, 0.5, 0.0]))
        .collect();
    spheres.extend([sphere(0.0, 0.5), sphere(0.018, -0.5)]);
    let mut simulation = DemSimulation::new(&steel(spheres, 0.0, dt)).unwrap();
    simulation.advance(steps).unwrap();
    assert!(speeds(&simulation)[98] < -0.499);
    // 23 us of contact in a step of 1 ms, 27 sub-steps or more in each contact.
    let in_collision = simulation.moves() - 98 * steps;
    assert!(
        (2 * (steps + 800)..2 * (steps + 8_000)).contains(&in_collision),
        "{in_collision}"
    );
}

/// A sphere runs through a row of others at rest, with gaps that it crosses within the step: all
/// are knocked on in turn, none is passed through, as if each impact had been waited for.
#[test]
fn spheres_that_are_knocked_on_within_a_step_are_seen() {
    let gap = 1e-4;
    for count in [2, 3, 5, 8] {
        let mut row: Vec<StartSphere> = (0..count)
            .map(|i| sphere(f64::from(i) * (0.008 + gap), 0.0))
            .collect();
        row[0].velocity[0] = 1.0;
        let dt = 1.2e-3;
        let mut simulation = DemSimulation::new(&steel(row, 0.0, dt)).unwrap();
        simulation.advance(3).unwrap();
        let speeds = speeds(&simulation);
        let (last, others) = speeds.split_last().unwrap();
        assert!((last - 1.0).abs() < 1e-3, "{speeds:?}");
        assert!(others.iter().all(|speed| speed.abs() < 2e-3), "{speeds:?}");
        let mass = simulation.particles().mass[0];
        assert!((momentum(&simulation) / mass - 1.0).abs() < 1e-12);
        assert!((kinetic(&simulation) / (0.5 * mass) - 1.0).abs() < 2e-3);
    }
}

/// A light sphere that leaves a heavy one at nearly twice its speed hits the next within the step.
#[test]
fn a_sphere_that_is_knocked_far_is_seen() {
    let heavy = StartSphere {
        radius: Some(0.02),
        ..sphere(-0.0211, 1.0)
    };
    let light = StartSphere {
        radius: Some(0.001),
        ..sphere(0.0, 0.0)
    };
    let target = sphere(0.0051, 0.0);
    let mut simulation =
        DemSimulation::new(&steel(vec![heavy, light, target], 0.0, 1.5e-4)).unwrap();
    let (before, start) = (momentum(&simulation), kinetic(&simulation));
    for _ in 0..10 {
        simulation.advance(1).unwrap();
        let place = &simulation.particles().position;
        assert!(place[0].x < place[1].x && place[1].x < place[2].x);
    }
    assert!((momentum(&simulation) / before - 1.0).abs() < 1e-12);
    assert!((kinetic(&simulation) / start - 1.0).abs() < 1e-3);
    assert!(speeds(&simulation)[2] > 0.0);
}

/// Where the step resolves the contacts, one move per step is all that is taken.
#[test]
fn a_fine_step_is_not_cut() {
    let pair = vec![sphere(0.0, 0.5), sphere(0.0081, -0.5)];
    let mut simulation = DemSimulation::new(&steel(pair, 0.0, 1e-7)).unwrap();
    simulation.advance(5_000).unwrap();
    assert_eq!(simulation.moves(), 2 * simulation.step());
    assert!(speeds(&simulation)[0] < -0.499);
}

/// A step of adaptive Verlet costs the pile what its contacts need, whatever the step: the spheres
/// rest at the overlaps of the law.
#[test]
fn a_pile_rests_at_large_steps() {
    let column: Vec<StartSphere> = (0..4)
        .map(|i| StartSphere::at([0.0, 0.0, 0.004 + f64::from(i) * 0.008]))
        .collect();
    let mut scene = steel(column, 1e-5, 1e-3);
    scene.dem.effects.gravity = Some(phase::scene::Gravity {
        acceleration: 9.8,
        tilt: 0.0,
    });
    scene.tank = Some(phase::scene::Tank {
        floor: Some(0.0),
        ..phase::scene::Tank::default()
    });
    let mut simulation = DemSimulation::new(&scene).unwrap();
    simulation.advance(300).unwrap();
    let particles = simulation.particles();
    assert!(
        particles.velocity.iter().all(|it| it.norm() < 1e-9),
        "{:?}",
        particles.velocity
    );
    // F = K xi^1.5 of the weight of those above, K = 2 Y sqrt(R_eff) / (3 (1 - nu^2)).
    let modulus = 2.0 * 2.1e11 / (3.0 * (1.0 - 0.3 * 0.3));
    let overlap = 0.008 - (particles.position[1].z - particles.position[0].z);
    let force = modulus * (0.002 * overlap).sqrt() * overlap;
    assert!(
        (force / (3.0 * particles.mass[0] * 9.8) - 1.0).abs() < 1e-6,
        "{force}"
    );
}

/// A pile at rest is followed as coarsely as stability allows, and one that falls is not.
#[test]
fn contacts_that_are_held_take_few_sub_steps() {
    let steps = |height: f64, resolution: Option<f64>| {
        let column: Vec<StartSphere> = (0..4)
            .map(|i| StartSphere::at([0.0, 0.0, 0.004 + height + f64::from(i) * 0.008]))
            .collect();
        let mut scene = steel(column, 1e-5, 1e-3);
        scene.time.resolution = resolution;
        scene.dem.effects.gravity = Some(phase::scene::Gravity {
            acceleration: 9.8,
            tilt: 0.0,
        });
        scene.tank = Some(phase::scene::Tank {
            floor: Some(0.0),
            ..phase::scene::Tank::default()
        });
        let mut simulation = DemSimulation::new(&scene).unwrap();
        simulation
            .advance(if height > 0.0 { 1 } else { 300 })
            .unwrap();
        let before = simulation.moves();
        simulation.advance(10).unwrap();
        simulation.moves() - before
    };
    let (fine, coarse) = (steps(0.0, None), steps(0.0, Some(0.6)));
    let ratio = fine as f64 / coarse as f64;
    assert!((ratio - 1.0).abs() < 0.01, "{fine} {coarse}");
    // Falls from a tenth of a millimetre, and collides.
    let (fine, coarse) = (steps(1e-4, None), steps(1e-4, Some(0.6)));
    assert!(fine > 2 * coarse, "{fine} {coarse}");
}

/// Bits do not depend on how the pairs are found, nor on where the advance is cut.
#[test]
fn adaptive_bits_depend_on_the_scene_alone() {
    let row = || -> Vec<StartSphere> {
        (0..6)
            .map(|i| sphere(f64::from(i) * 0.0083, if i % 2 == 0 { 0.7 } else { -0.4 }))
            .collect()
    };
    let scene = steel(row(), 1e-6, 4e-4);
    assert_eq!(scene.time.integrator, Integrator::AdaptiveVerlet);
    let state = |skin: f64, cuts: u64| {
        let mut simulation = DemSimulation::with_skin(&scene, skin).unwrap();
        for _ in 0..cuts {
            simulation.advance(40 / cuts).unwrap();
            simulation.elastic_energy();
        }
        let places = simulation.particles().position.clone();
        let bits = |it: &phase::particles::vector::Vector| [it.x, it.y, it.z].map(f64::to_bits);
        places.iter().map(bits).collect::<Vec<_>>()
    };
    let expected = state(0.5, 1);
    for (skin, cuts) in [(0.0, 1), (0.5, 40), (3.0, 8)] {
        assert_eq!(state(skin, cuts), expected, "{skin} {cuts}");
    }
}

/// Symptom: a run without a contact law never ended and took all memory. Cause: what it saw beyond
/// the walls were contacts that it had missed, so that the step was done again and again.
#[test]
fn without_a_contact_law_spheres_pass_through_walls() {
    let mut scene = steel(vec![sphere(0.0, 0.5), sphere(0.1, -0.5)], 0.0, 1e-3);
    scene.dem.contact = None;
    scene.tank = Some(phase::scene::Tank {
        radius: Some(0.05),
        floor: Some(0.1),
        ..phase::scene::Tank::default()
    });
    let mut simulation = DemSimulation::new(&scene).unwrap();
    simulation.advance(150).unwrap();
    assert_eq!(speeds(&simulation), [0.5, -0.5]);
    assert!((simulation.particles().position[0].x - 0.075).abs() < 1e-12);
}

/// Speeds at the end and largest residual over the kinetic energy of a moving sphere of 4 mm, of 1
/// m/s.
fn compare(scene: &Scene, dt: f64, time: f64) -> Vec<f64> {
    let mut scene = scene.clone();
    scene.time.dt = dt;
    let mut simulation = DemSimulation::new(&scene).unwrap();
    simulation.advance((time / dt).round() as u64).unwrap();
    speeds(&simulation)
}

/// Symptom: a pair at rest that was pressed together flew through a third sphere, and a guard ended
/// the run. Cause: how far spheres may get was found from their speeds alone.
#[test]
fn a_pressed_pair_that_parts_sees_a_third() {
    for gap in [0.1e-3, 0.5e-3, 0.9e-3, 1.3e-3] {
        let row = vec![
            sphere(0.0, 0.0),
            sphere(0.0079, 0.0),
            sphere(0.0159 + gap, 0.0),
        ];
        let mut scene = steel(row, 0.0, 1e-3);
        if let Some(phase::scene::Contact::Hertz(phase::scene::Hertz { young_modulus, .. })) =
            &mut scene.dem.contact
        {
            *young_modulus = 1e7;
        }
        let fine = compare(&scene, 1e-6, 0.02);
        for dt in [1e-3, 2e-3] {
            let coarse = compare(&scene, dt, 0.02);
            for (one, other) in fine.iter().zip(&coarse) {
                assert!(
                    (one - other).abs() < 2e-3,
                    "{gap} {dt}: {fine:?} {coarse:?}"
                );
            }
        }
    }
}

/// Symptom: a sphere that was knocked onto a light one lost a third of the light one's energy, the
/// more the shorter the step. Cause: contacts found late in a step had no part in how finely it was
/// cut.
#[test]
fn a_light_sphere_is_knocked_on_as_finely_as_any() {
    for gap in [0.02e-3, 0.05e-3, 0.1e-3, 0.3e-3] {
        let heavy = |x: f64, speed: f64| StartSphere {
            radius: Some(0.01),
            ..sphere(x, speed)
        };
        let light = StartSphere {
            radius: Some(0.001),
            ..sphere(0.011 + gap, 0.0)
        };
        let row = vec![heavy(-0.02001, 1.0), heavy(0.0, 0.0), light];
        let scene = steel(row, 0.0, 1e-6);
        let fine = compare(&scene, 1e-6, 4e-3);
        for dt in [5e-5, 1e-4, 2e-4] {
            let coarse = compare(&scene, dt, 4e-3);
            for (one, other) in fine.iter().zip(&coarse) {
                assert!(
                    (one - other).abs() < 4e-3,
                    "{gap} {dt}: {fine:?} {coarse:?}"
                );
            }
        }
    }
}
