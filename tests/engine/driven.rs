//! Spheres that move along prescribed paths.

use crate::large::large;
use crate::scenes::state;
use phase::dem::DemSimulation;
use phase::dem::timestep::StepMargin;
use phase::particles::vector::Vector;
use phase::record::MilestoneKind;
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
        let mut simulation = DemSimulation::new(&row(integrator)).unwrap();
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
        let mut simulation = DemSimulation::new(scene).unwrap();
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
            let mut simulation = DemSimulation::new(&scene).unwrap();
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

/// A bed of spheres on the floor of a box, the numbers in `paths` driven, which swing by a tenth of
/// a radius and never rest.
fn bed(tables: &str, start: &str, count: usize, paths: &[usize]) -> Scene {
    let paths = paths.iter().map(|sphere| {
        format!("{{ sphere = {sphere}, amplitude = [0.0, 4e-4, 0.0], angular_frequency = 60.0 }}")
    });
    let text = format!(
        "{tables}
        spheres = {{ count = {count}, radius = 0.004, density = 2500.0 }}
        contact = {{ law = 'hertz', young_modulus = 1e6, poisson_ratio = 0.3, restitution = 0.5 }}
        friction = {{ law = 'mindlin', coefficient = 0.5 }}
        rolling = {{ coefficient = 0.2, damping = 0.3 }}
        gravity = {{ acceleration = 9.81 }}
        time = {{ dt = 2e-5, duration = 2.0, frame_interval = 0.01 }}
        driven = [{}]
        start = {start}",
        paths.collect::<Vec<_>>().join(", ")
    );
    toml::from_str(&text).unwrap()
}

/// Places along x, in a row on the floor.
fn row_on_the_floor(places: &[f64]) -> String {
    let spheres = places
        .iter()
        .map(|x| format!("{{ position = [{x}, 0.0, 0.0045] }}"));
    format!(
        "{{ kind = 'list', spheres = [{}] }}",
        spheres.collect::<Vec<_>>().join(", ")
    )
}

/// Runs a scene to its end, saved and restored at a tenth, and with other integrators. Returns the
/// simulations at their ends.
fn to_the_end(scene: &Scene) -> Vec<(Integrator, DemSimulation)> {
    let run = |integrator: Integrator| {
        let mut scene = scene.clone();
        scene.time.integrator = integrator;
        let mut whole = DemSimulation::new(&scene).unwrap();
        let mut part = DemSimulation::new(&scene).unwrap();
        for tenth in 0..10 {
            whole.advance(10_000).unwrap();
            part.advance(10_000).unwrap();
            let mut next = DemSimulation::new(&scene).unwrap();
            next.restore(part.state().into_owned()).unwrap();
            part = next;
            assert_eq!(
                state(&whole).bits(),
                state(&part).bits(),
                "{integrator:?}, part {tenth}"
            );
            assert_eq!(whole.milestones(), part.milestones());
            if whole.ended() {
                break;
            }
        }
        (integrator, whole)
    };
    Integrator::ALL.map(run).into()
}

/// How far the sphere of a number is from its path, which began at a place and a time (s).
fn off_its_path(simulation: &DemSimulation, number: u32, start: Vector, begun: f64) -> f64 {
    let particles = simulation.particles();
    let numbers = &particles.number[particles.fixed..];
    let index = particles.fixed + numbers.iter().position(|it| *it == number).unwrap();
    let sine = |time: f64| libm::sin(60.0 * time);
    let swing = 4e-4 * (sine(simulation.time()) - sine(begun));
    (particles.position[index] - start - Vector::new(0.0, swing, 0.0)).norm()
}

fn kinds(simulation: &DemSimulation) -> Vec<MilestoneKind> {
    simulation.milestones().iter().map(|it| it.kind).collect()
}

/// Symptom: [rest] beside [[driven]] was refused for spheres that come or go, of which there were
/// none.
#[test]
fn a_bed_is_at_rest_while_a_sphere_is_driven() {
    let tables = "tank = { width = 0.1, depth = 0.1, floor = 0.0 }
        rest = { kinetic_energy = 1e-9, hold = 0.1 }";
    let start = row_on_the_floor(&[-0.02, 0.03, 0.0]);
    let scene = bed(tables, &start, 3, &[1]);
    assert_eq!(scene.problems(), []);
    for (integrator, simulation) in to_the_end(&scene) {
        assert!(simulation.ended(), "{integrator:?}");
        assert_eq!(kinds(&simulation), [MilestoneKind::AtRest]);
        let off = off_its_path(&simulation, 1, Vector::new(0.03, 0.0, 0.0045), 0.0);
        assert!(off < 1e-12, "{integrator:?}: {off}");
    }
    // One that it throws up is not.
    let on_top = start.replace("[0, 0.0, 0.0045]", "[0.03, 0.0, 0.0125]");
    assert_ne!(on_top, start);
    let mut shaken = bed(tables, &on_top, 3, &[1]);
    shaken.dem.driven[0].amplitude = [0.0, 0.0, 1e-4];
    shaken.dem.driven[0].angular_frequency = 628.0;
    for (integrator, simulation) in to_the_end(&shaken) {
        assert!(!simulation.ended(), "{integrator:?}");
        assert_eq!(kinds(&simulation), []);
    }
}

/// Its index moves when spheres before it leave, and when a door of fixed ones does. It is below
/// the outlet itself, and stays.
#[test]
fn a_driven_sphere_follows_when_others_leave() {
    let door: Vec<String> = (-2..=2)
        .map(|k| {
            format!(
                "{{ position = [{}, 0.0, 0.0], radius = 0.004 }}",
                f64::from(k) * 0.008
            )
        })
        .collect();
    let tables = format!(
        "geometry = {{ kind = 'list', walls = [{{ position = [0.05, 0.0, 0.0], radius = 0.004 }}], door = [{}] }}
        door = {{ opens = 0.1 }}
        outlet = {{ height = -0.05 }}",
        door.join(", ")
    );
    let at = |x: f64, z: f64| format!("{{ position = [{x}, 0.0, {z}] }}");
    let spheres = [
        at(0.0, 0.008),
        at(-0.008, 0.008),
        at(0.03, -0.06),
        at(0.008, 0.0085),
    ];
    let start = format!("{{ kind = 'list', spheres = [{}] }}", spheres.join(", "));
    let scene = bed(&tables, &start, 4, &[2]);
    let problems = scene.problems();
    // The outlet is to be below the starts of all spheres but the driven one.
    assert_eq!(problems, []);
    for (integrator, simulation) in to_the_end(&scene) {
        assert_eq!(
            kinds(&simulation),
            [MilestoneKind::DoorOpened, MilestoneKind::Emptied]
        );
        assert_eq!(simulation.particles().number[1..], [2], "{integrator:?}");
        let off = off_its_path(&simulation, 2, Vector::new(0.03, 0.0, -0.06), 0.0);
        assert!(off < 1e-12, "{integrator:?}: {off}");
    }
}

/// The one that comes in third moves along its path from then on, and the feed goes on beside it.
#[test]
fn a_driven_sphere_may_be_fed() {
    let tables = "tank = { width = 0.1, depth = 0.1, floor = 0.0 }
        rest = { kinetic_energy = 1e-9, hold = 0.1 }";
    let start = "{ kind = 'feed', position = [0.0, 0.0, 0.03], interval = 0.1 }";
    let mut scene = bed(tables, start, 5, &[2]);
    scene.dem.driven[0].velocity = [0.1, 0.0, 0.0];
    scene.time.duration = 0.45;
    assert_eq!(scene.problems(), []);
    for integrator in Integrator::ALL {
        scene.time.integrator = integrator;
        let mut simulation = DemSimulation::new(&scene).unwrap();
        simulation.advance(22_500).unwrap();
        assert_eq!(simulation.particles().len(), 5, "{integrator:?}");
        let start = Vector::new(0.1 * (0.45 - 0.2), 0.0, 0.03);
        let off = off_its_path(&simulation, 2, start, 0.2);
        assert!(off < 1e-12, "{integrator:?}: {off}");
        let mut part = DemSimulation::new(&scene).unwrap();
        part.advance(12_345).unwrap();
        let mut next = DemSimulation::new(&scene).unwrap();
        next.restore(part.state().into_owned()).unwrap();
        next.advance(22_500 - 12_345).unwrap();
        assert_eq!(
            state(&next).bits(),
            state(&simulation).bits(),
            "{integrator:?}"
        );
    }
}

/// Many spheres are sorted in memory, and may be moved by several threads.
#[test]
fn a_driven_sphere_is_found_among_many() {
    for integrator in Integrator::ALL {
        let mut scene = large(None, integrator);
        let path = "sphere = 4000\nvelocity = [0.0, 0.0, 1.0]\namplitude = [0.0, 4e-4, 0.0]\n\
                    angular_frequency = 60.0";
        scene.dem.driven = vec![toml::from_str(path).unwrap()];
        let start = phase::start::place(&scene).unwrap().position[4000];
        let run = |threads: usize, restored: bool| {
            let mut simulation = DemSimulation::new(&scene).unwrap();
            simulation.use_threads(threads).unwrap();
            simulation.advance(300).unwrap();
            if restored {
                let mut next = DemSimulation::new(&scene).unwrap();
                next.restore(simulation.state().into_owned()).unwrap();
                simulation = next;
            }
            simulation.advance(220).unwrap();
            simulation
        };
        let whole = run(1, false);
        let at = start + Vector::new(0.0, 0.0, whole.time());
        let off = off_its_path(&whole, 4000, at, 0.0);
        assert!(off < 1e-12, "{integrator:?}: {off}");
        for other in [run(3, false), run(1, true)] {
            assert!(
                state(&other).bits() == state(&whole).bits(),
                "{integrator:?}"
            );
        }
    }
}

/// A ball on a sphere that shakes at 100 Hz with four times gravity.
fn shaken(integrator: Integrator, dt: &str) -> Scene {
    let text = format!(
        "spheres = {{ count = 2, radius = 0.01, density = 2500.0 }}
        contact = {{ law = 'hertz', young_modulus = 1e7, poisson_ratio = 0.3, restitution = 0.8 }}
        gravity = {{ acceleration = 9.81 }}
        guards = {{ vertical = 100.0 }}
        time = {{ dt = {dt}, duration = 20.0, frame_interval = 0.01, integrator = '{}' }}

        [start]
        kind = 'list'
        spheres = [{{ position = [0.0, 0.0, 0.0] }}, {{ position = [0.0, 0.0, 0.02] }}]

        [[driven]]
        sphere = 0
        amplitude = [0.0, 0.0, 1e-4]
        angular_frequency = 628.3185307179586",
        integrator.name()
    );
    let scene = Scene::from_toml(&text, std::path::Path::new("shaken.toml"));
    scene.unwrap_or_else(|error| panic!("{error}"))
}

/// Symptom: with `dt = \"auto\"` and adaptive Verlet the step was one whole period, so that neither
/// sphere moved. Cause: no limit knew of the period of a driven sphere.
#[test]
fn a_ball_bounces_on_a_sphere_that_shakes() {
    for integrator in Integrator::ALL {
        let scene = shaken(integrator, "'auto'");
        assert!(scene.time.steps_per_frame() > 60, "{:e}", scene.time.dt);
        let mut simulation = DemSimulation::new(&scene).unwrap();
        let heights = (0..scene.time.frames()).map(|_| {
            simulation.advance(scene.time.steps_per_frame()).unwrap();
            simulation.particles().position[1].z - 0.02
        });
        let heights: Vec<f64> = heights.collect();
        let mean = heights.iter().sum::<f64>() / heights.len() as f64;
        // 2.0 to 2.3 mm with each integrator and a thousand steps in a period.
        assert!((1.6e-3..2.8e-3).contains(&mean), "{integrator:?}: {mean}");
        // In the first second.
        let top = heights[..100]
            .iter()
            .fold(0.0, |top: f64, height| top.max(*height));
        assert!((4e-3..12e-3).contains(&top), "{integrator:?}: {top}");
    }
}

/// Symptom: a step of a whole period was not warned of.
#[test]
fn a_step_of_a_period_is_warned_of() {
    for integrator in Integrator::ALL {
        let mut scene = shaken(integrator, "1e-4");
        let warns = |scene: &Scene| {
            let all = StepMargin::all(scene);
            let standing = all
                .iter()
                .find(|it| it.limit.name == "driven period")
                .unwrap();
            assert!(!standing.limit.decisive);
            standing.consequence().is_some()
        };
        assert!(!warns(&scene));
        for (steps, expected) in [(13.0, false), (12.0, true), (2.0, true), (1.0, true)] {
            scene.time.dt = 0.01 / steps;
            assert_eq!(warns(&scene), expected, "{integrator:?}: {steps}");
        }
        // Of several, the fastest that moves decides.
        scene.dem.driven.push(scene.dem.driven[0].clone());
        scene.dem.driven[1].angular_frequency *= -2.0;
        scene.time.dt = 0.01 / 20.0;
        assert!(warns(&scene));
        scene.dem.driven[1].amplitude = [0.0; 3];
        assert!(!warns(&scene));
    }
}
