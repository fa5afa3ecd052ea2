//! A tank with plane sides.

use crate::support::Workplace;
use phase::dem::DemSimulation;
use phase::scene::Scene;
use std::path::Path;

fn scene(text: &str) -> Scene {
    Scene::from_toml(text, Path::new("box.toml")).unwrap_or_else(|error| panic!("{error}"))
}

/// A sphere of 10 mm without losses in a box of 100 mm by 60 mm, with that velocity (m/s).
fn bouncing(velocity: [f64; 3], tables: &str) -> Scene {
    scene(&format!(
        "spheres = {{ count = 1, radius = 0.01, density = 1000.0 }}
        contact.law = 'hertz'
        contact.young_modulus = 1e7
        contact.poisson_ratio = 0.3
        contact.dissipation_time = 0.0
        tank = {{ width = 0.1, depth = 0.06 }}
        start = {{ kind = 'list', spheres = [{{ position = [0, 0, 0], velocity = {velocity:?} }}] }}
        time.dt = 1e-6
        time.duration = 1.0
        time.frame_interval = 1e-3
        time.integrator = 'velocity-verlet'
        {tables}"
    ))
}

#[test]
fn a_sphere_bounces_between_the_sides() {
    // Free ways from wall to wall: 80 mm along x, 40 mm along y.
    for (axis, half, speed) in [(0, 0.04, 1.5), (1, 0.02, -1.5)] {
        let mut velocity = [0.0; 3];
        velocity[axis] = speed;
        let mut simulation = DemSimulation::new(&bouncing(velocity, "")).unwrap();
        let parts = |simulation: &DemSimulation| {
            let particles = simulation.particles();
            let (x, v) = (particles.position[0], particles.velocity[0]);
            ([x.x, x.y, x.z], [v.x, v.y, v.z])
        };
        let (mut turns, mut widest) = (0, 0.0_f64);
        let mut last = speed;
        for _ in 0..300_000 {
            simulation.advance(1).unwrap();
            let (place, velocity) = parts(&simulation);
            turns += u32::from(velocity[axis] * last < 0.0);
            last = velocity[axis];
            widest = widest.max(place[axis].abs());
            for other in (0..3).filter(|other| *other != axis) {
                assert_eq!((place[other], velocity[other]), (0.0, 0.0));
            }
        }
        // It turns round in the walls, which take their time and give way a little.
        let expected = 0.3 * 1.5 / (2.0 * half);
        assert!(f64::from(turns) > 0.85 * expected && f64::from(turns) <= expected + 1.0);
        assert!(widest > half && widest < half + 0.001, "{widest}");
        while parts(&simulation).0[axis].abs() > 0.5 * half {
            simulation.advance(1).unwrap();
        }
        let end = parts(&simulation).1[axis];
        assert!((end.abs() / speed.abs() - 1.0).abs() < 1e-6, "{end}");
    }
}

#[test]
fn the_sides_give_and_take_momentum_along_their_normals_alone() {
    let mut simulation = DemSimulation::new(&bouncing([1.0, 0.7, 0.3], "")).unwrap();
    for _ in 0..200 {
        simulation.advance(1000).unwrap();
        // Upward nothing acts.
        assert_eq!(simulation.particles().velocity[0].z, 0.3);
    }
    // A side is no floor: friction at it turns the sphere about the other axes alone.
    let rubbing = "friction = { law = 'mindlin', coefficient = 0.3 }";
    let mut simulation = DemSimulation::new(&bouncing([1.0, 0.0, 0.3], rubbing)).unwrap();
    simulation.advance(50_000).unwrap();
    let particles = simulation.particles();
    let (velocity, spin) = (particles.velocity[0], particles.spin[0]);
    assert!(velocity.x < 0.0 && velocity.z < 0.3);
    assert!(spin.y != 0.0 && spin.x == 0.0 && spin.z == 0.0);
    // What the wall takes along z, it gives as spin: m r dv = I dw.
    let (mass, inertia) = (particles.mass[0], particles.inertia[0]);
    let given = inertia * spin.y.abs();
    let taken = mass * 0.01 * (0.3 - velocity.z);
    assert!((given / taken - 1.0).abs() < 1e-9, "{given} {taken}");
}

const HEAP: &str = "
    spheres = { count = 60, radius = 0.01, density = 1000.0 }
    contact = { law = 'hertz', young_modulus = 1e6, poisson_ratio = 0.3, restitution = 0.5 }
    friction = { law = 'mindlin', coefficient = 0.5 }
    tank = { width = 0.1, depth = 0.05, floor = 0.0 }
    start = { kind = 'random', z_min = 0.01, z_max = 0.3, speed = 0.5 }
    gravity = { acceleration = 9.8 }
    time = { dt = 2e-5, duration = 0.5, frame_interval = 0.01 }
    output = { ledger = true }";

#[test]
fn spheres_start_in_the_box_and_stay_there() {
    let scene = scene(HEAP);
    let mut simulation = DemSimulation::new(&scene).unwrap();
    let inside = |simulation: &DemSimulation, give: f64| {
        let places = &simulation.particles().position;
        places
            .iter()
            .all(|p| p.x.abs() <= 0.04 + give && p.y.abs() <= 0.015 + give && p.z >= 0.01 - give)
    };
    assert!(inside(&simulation, 0.0));
    // They fill it, up to all sides.
    let places = &simulation.particles().position;
    assert!(places.iter().any(|p| p.x > 0.03) && places.iter().any(|p| p.x < -0.03));
    assert!(places.iter().any(|p| p.y > 0.01) && places.iter().any(|p| p.y < -0.01));
    simulation.advance(25_000).unwrap();
    assert!(inside(&simulation, 0.001));
    let highest = simulation
        .particles()
        .position
        .iter()
        .fold(0.0_f64, |most, p| most.max(p.z));
    assert!(highest < 0.15, "{highest}");
    let frame = simulation.frame();
    let kinetic: f64 = (0..60)
        .map(|i| {
            0.5 * frame.mass[i]
                * (0..3)
                    .map(|axis| frame.velocity[axis][i] * frame.velocity[axis][i])
                    .sum::<f64>()
        })
        .sum();
    // They fell with 0.3 J.
    assert!(kinetic < 1e-3, "{kinetic}");
}

#[test]
fn sweeps_of_commands_take_the_box() {
    let place = Workplace::new();
    place.write("heap.toml", HEAP);
    place
        .phase(&["check", "heap.toml"])
        .code(0)
        .says("sides, floor");
    place
        .phase(&["run", "heap.toml", "--trajectory", "--out", "heap.h5"])
        .code(0);
    place
        .phase(&["view", "heap.h5", "--out", "heap.png"])
        .code(0);
    let answer = place.phase(&["cost", "heap.toml"]).code(0);
    answer.says("sides");
}

/// A heap under the laws of Silbert et al., of two sizes.
fn heap_of_silbert(integrator: &str) -> Scene {
    scene(&format!(
        "spheres = {{ count = 60, radius = [{{ radius = 0.4, share = 1 }}, {{ radius = 0.5, share \
         = 1 }}], density = 1.909859317102744 }}
        contact = {{ law = 'silbert', stiffness = 2e5, damping = 50.0 }}
        friction = {{ law = 'silbert', coefficient = 0.5, stiffness = 57142.857, damping = 25.0 }}
        tank = {{ width = 4.0, depth = 3.0, floor = 0.0 }}
        start = {{ kind = 'random', z_min = 0.5, z_max = 14.0, speed = 1.0, spin = 1.0 }}
        gravity = {{ acceleration = 1.0 }}
        time = {{ dt = 5e-4, duration = 1.0, frame_interval = 0.1, integrator = '{integrator}' }}"
    ))
}

/// No bit depends on the list, the instruction set, or a break: near the sides, too, and with
/// masses in the laws.
#[test]
fn bits_of_a_box_depend_on_nothing_but_the_scene() {
    let places = |simulation: &DemSimulation| -> Vec<[u64; 3]> {
        let places = simulation.particles().position.iter();
        places.map(|p| [p.x, p.y, p.z].map(f64::to_bits)).collect()
    };
    for integrator in [
        "symplectic-euler",
        "velocity-verlet",
        "synchronised-verlet",
        "adaptive-verlet",
    ] {
        let scene = heap_of_silbert(integrator);
        let mut whole = DemSimulation::new(&scene).unwrap();
        whole.advance(8000).unwrap();
        let mut touchy = DemSimulation::with_skin(&scene, 0.0).unwrap();
        touchy.use_baseline_instructions();
        touchy.advance(5000).unwrap();
        let mut resumed = DemSimulation::with_skin(&scene, 3.0).unwrap();
        resumed.restore(touchy.state()).unwrap();
        for simulation in [&mut touchy, &mut resumed] {
            simulation.advance(3000).unwrap();
            assert!(places(simulation) == places(&whole), "{integrator}");
        }
        // They are a heap.
        let slow = |i: usize| whole.particles().velocity[i].norm() < 8.0;
        assert!((0..60).all(slow), "{integrator}");
    }
}

/// It loses energy all the way, and never gains any.
#[test]
fn a_heap_of_silbert_comes_to_rest() {
    let mut scene = heap_of_silbert("velocity-verlet");
    scene.time.dt = 1e-3;
    let mut simulation = DemSimulation::new(&scene).unwrap();
    let energy = |simulation: &mut DemSimulation| {
        let elastic = simulation.elastic_energy();
        let particles = simulation.particles();
        (0..particles.len())
            .map(|i| {
                let (mass, inertia) = (particles.mass[i], particles.inertia[i]);
                0.5 * mass * particles.velocity[i].norm_squared()
                    + 0.5 * inertia * particles.spin[i].norm_squared()
                    + mass * particles.position[i].z
            })
            .sum::<f64>()
            + elastic
    };
    let mut before = energy(&mut simulation);
    for _ in 0..60 {
        simulation.advance(1000).unwrap();
        let after = energy(&mut simulation);
        // What springs hold is not counted, and comes back.
        assert!(after < before * (1.0 + 1e-4), "{before} {after}");
        before = after;
    }
    let particles = simulation.particles();
    let fastest = particles
        .velocity
        .iter()
        .fold(0.0_f64, |most, v| most.max(v.norm()));
    assert!(fastest < 0.05, "{fastest}");
}

#[test]
fn laws_that_do_not_go_together_are_refused() {
    let text = |contact: &str, friction: &str| {
        format!(
            "spheres = {{ count = 1, radius = 0.01, density = 1000.0 }}
            contact = {{ {contact} }}
            friction = {{ {friction} }}
            start = {{ kind = 'list', spheres = [{{ position = [0, 0, 0] }}] }}
            time = {{ dt = 1e-6, duration = 1.0, frame_interval = 1e-3 }}"
        )
    };
    let silbert = "law = 'silbert', stiffness = 1e5, damping = 1e3";
    let linear = "law = 'linear', stiffness = 100.0, damping = 0.1";
    for (contact, friction, says) in [
        (
            silbert,
            "law = 'mindlin', coefficient = 0.3",
            "goes with the hertz or tsuji contact only",
        ),
        (
            linear,
            "law = 'silbert', coefficient = 0.3, stiffness = 1e5",
            "silbert contact only",
        ),
    ] {
        let refused =
            Scene::from_toml(&text(contact, friction), Path::new("box.toml")).unwrap_err();
        assert!(refused.to_string().contains(says), "{refused}");
    }
}

/// All of them find a place in the large box, off its walls and off each other.
#[test]
fn the_shipped_boxes_can_be_started() {
    for (name, count, [x, y]) in [("box", 200, [2.5, 1.5]), ("box-55000", 55_000, [24.5, 3.5])] {
        let path = format!("sweeps/scenes/{name}.toml");
        let scene = phase::scene::Scene::load(Path::new(&path)).unwrap();
        let mut simulation = DemSimulation::new(&scene).unwrap();
        assert_eq!(simulation.particles().len(), count);
        let places = &simulation.particles().position;
        assert!(
            places
                .iter()
                .all(|p| p.x.abs() <= x && p.y.abs() <= y && p.z >= 0.5)
        );
        assert_eq!(simulation.elastic_energy(), 0.0);
        simulation.advance(20).unwrap();
    }
}
