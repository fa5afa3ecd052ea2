//! Periodic sides: pairs meet by their nearest images, whatever the search, the threads and the
//! interruptions, and the motion is the same wherever the box begins.

use crate::ledger::{largest, with_ledger};
use crate::scenes::state;
use phase::dem::DemSimulation;
use phase::dem::order::MANY;
use phase::particles::vector::Vector;
use phase::scene::{Integrator, Neighbours, Scene, Start, StartSphere};

/// Spheres of 4 mm and 1 kg/l between periodic sides. `text` has the other tables.
fn scene(count: usize, text: &str) -> Scene {
    let text = format!(
        "spheres = {{ count = {count}, radius = 0.004, density = 1000 }}
        time = {{ dt = 2e-5, duration = 0.1, frame_interval = 1e-3 }}
        {text}"
    );
    let scene: Scene = toml::from_str(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(scene.problems(), [], "{text}");
    scene
}

const LINEAR: &str = "contact = { law = 'linear', stiffness = 2000.0, damping = 0.1 }";
const ELASTIC: &str = "contact = { law = 'linear', stiffness = 2000.0, damping = 0.0 }";
const HERTZ: &str = "contact = { law = 'hertz', young_modulus = 1e6, poisson_ratio = 0.3, \
                     restitution = 0.8 }
friction = { law = 'mindlin', coefficient = 0.4 }";

/// A gas of spheres in a box that is periodic along all axes, or along those that are given.
fn gas(count: usize, laws: &str, periodic: &str) -> Scene {
    let half = 0.5 * libm::cbrt(count as f64 / 256.0) * 0.08;
    let side = 2.0 * half;
    let periodic = periodic.replace('L', &side.to_string());
    let text = format!(
        "{laws}
        periodic = {{ {periodic} }}
        start = {{ kind = 'random', x = [-{half}, {half}], y = [-{half}, {half}], z_min = -{half}, \
                   z_max = {half}, speed = 1.0, spin = 50.0 }}"
    );
    scene(count, &text)
}

const ALL_AXES: &str = "x = L, y = L, z = L";

fn run(scene: &Scene, steps: u64) -> Vec<[u64; 3]> {
    let mut simulation = DemSimulation::new(scene).unwrap();
    simulation.advance(steps).unwrap();
    state(&simulation).bits()
}

/// Frames are in the order of the scene, also where spheres are sorted in memory.
fn frame_bits(simulation: &mut DemSimulation) -> Vec<u64> {
    let frame = simulation.frame();
    let columns = [frame.position, frame.velocity];
    let numbers = columns.iter().flatten().flat_map(|column| column.iter());
    numbers.map(|number| number.to_bits()).collect()
}

#[test]
fn every_search_finds_the_pairs_across_the_sides() {
    for (laws, periodic) in [
        (LINEAR, ALL_AXES),
        (HERTZ, "x = L, y = L"),
        (HERTZ, "z = L"),
    ] {
        let scene = gas(256, laws, periodic);
        let expected = run(&scene, 1500);
        for (name, neighbours) in [
            ("cells", Neighbours::Cells { length: 0.009 }),
            ("narrow cells", Neighbours::Cells { length: 0.013 }),
            ("wide cells", Neighbours::Cells { length: 0.05 }),
            ("hashed cells", Neighbours::HashedCells { length: 0.009 }),
            (
                "wide hashed cells",
                Neighbours::HashedCells { length: 0.035 },
            ),
            ("all pairs", Neighbours::AllPairs),
        ] {
            let mut other = scene.clone();
            other.dem.neighbours = neighbours;
            assert!(run(&other, 1500) == expected, "{name}, {periodic}");
        }
        for skin in [0.0, 0.1, 3.0, 1e3] {
            let mut simulation = DemSimulation::with_skin(&scene, skin).unwrap();
            simulation.advance(1500).unwrap();
            let bits = state(&simulation).bits();
            assert!(bits == expected, "a skin of {skin} radii, {periodic}");
        }
        let mut plain = DemSimulation::new(&scene).unwrap();
        plain.use_baseline_instructions();
        plain.advance(1500).unwrap();
        assert!(state(&plain).bits() == expected, "baseline, {periodic}");
    }
}

/// The forces of a step are those of all images within reach, found by brute force.
#[test]
fn forces_are_those_of_all_images() {
    let scene = gas(256, ELASTIC, ALL_AXES);
    let periods = scene.domain().periods().map(Option::unwrap);
    let mut simulation = DemSimulation::new(&scene).unwrap();
    let mut touched = 0;
    for _ in 0..20 {
        simulation.advance(100).unwrap();
        let before = simulation.particles().clone();
        simulation.advance(1).unwrap();
        let after = simulation.particles();
        for i in 0..before.len() {
            let mut force = Vector::ZERO;
            for j in (0..before.len()).filter(|&j| j != i) {
                for images in 0..27 {
                    let image =
                        [images % 3, images / 3 % 3, images / 9].map(|it| f64::from(it) - 1.0);
                    let offset = before.position[i] - before.position[j];
                    let along = |axis: usize, part: f64| {
                        let period = periods[axis];
                        part - period * (part / period).round() + period * image[axis]
                    };
                    let offset =
                        Vector::new(along(0, offset.x), along(1, offset.y), along(2, offset.z));
                    let overlap = 0.008 - offset.norm();
                    if overlap > 0.0 {
                        force += offset.unit() * (2000.0 * overlap);
                        touched += 1;
                    }
                }
            }
            let kick = (after.velocity[i] - before.velocity[i]) * (before.mass[i] / 2e-5);
            assert!(
                (kick - force).norm() <= 1e-6 * force.norm().max(1e-3),
                "sphere {i}"
            );
        }
    }
    assert!(touched > 300, "{touched} contacts");
}

/// A scene whose spheres are listed at other images is the same scene, up to rounding.
#[test]
fn the_motion_does_not_depend_on_where_the_box_begins() {
    let one = gas(64, ELASTIC, ALL_AXES);
    let periods = one.domain().periods().map(Option::unwrap);
    let places = phase::start::place(&one).unwrap();
    let listed = |shift: [f64; 3], images: bool| {
        let spheres = places.position.iter().zip(&places.velocity).enumerate();
        let sphere = |(i, (place, velocity)): (usize, (&Vector, &Vector))| {
            let image = if images { (i % 5) as f64 - 2.0 } else { 0.0 };
            let along = |axis: usize, place: f64| place + shift[axis] + image * periods[axis];
            StartSphere {
                position: [along(0, place.x), along(1, place.y), along(2, place.z)],
                velocity: [velocity.x, velocity.y, velocity.z],
                ..StartSphere::at([0.0; 3])
            }
        };
        let mut scene = one.clone();
        scene.start = Start::list(spheres.map(sphere).collect());
        let mut simulation = DemSimulation::new(&scene).unwrap();
        simulation.advance(2000).unwrap();
        simulation.particles().velocity.clone()
    };
    let expected = listed([0.0; 3], false);
    for (shift, images) in [([0.0; 3], true), ([0.013, -0.02, 0.03], false)] {
        for (found, expected) in listed(shift, images).iter().zip(&expected) {
            // A collision multiplies a difference; these runs have some ten a sphere.
            assert!((*found - *expected).norm() < 1e-6, "{shift:?}");
        }
    }
}

/// A sphere that goes round meets another one across the side, as in open space with that image.
#[test]
fn a_sphere_meets_another_across_the_side() {
    for (along, periodic) in [(0, "x = 0.1"), (1, "y = 0.1"), (2, "z = 0.1")] {
        let at = |place: f64| {
            let mut position = [0.001, 0.002, -0.001];
            position[along] = place;
            position
        };
        let velocity = |speed: f64| {
            let mut velocity = [0.0; 3];
            velocity[along] = speed;
            velocity
        };
        let of = |other: f64, periodic: &str| {
            let text = format!(
                "{LINEAR}
                {periodic}
                start = {{ kind = 'list', spheres = [
                    {{ position = {:?}, velocity = {:?} }}, {{ position = {:?} }} ] }}",
                at(0.03),
                velocity(1.0),
                at(other)
            );
            let mut simulation = DemSimulation::new(&scene(2, &text)).unwrap();
            simulation.advance(3000).unwrap();
            let particles = simulation.particles();
            let part = |it: Vector| [it.x, it.y, it.z][along];
            [
                part(particles.velocity[0]),
                part(particles.velocity[1]),
                part(particles.position[0]),
            ]
        };
        let round = of(-0.04, &format!("periodic = {{ {periodic} }}"));
        let open = of(0.06, "");
        for (round, open) in round.into_iter().zip(open) {
            assert!(
                (round - open).abs() < 1e-9,
                "{round} {open} along {periodic}"
            );
        }
        assert!(round[1] > 0.5, "{round:?}");
        // Positions go on beyond the box.
        assert!(round[2] > 0.05, "{round:?}");
    }
}

/// Twice the box with every sphere twice moves as the box does.
#[test]
fn a_box_and_two_copies_of_it_move_alike() {
    let one = gas(64, LINEAR, ALL_AXES);
    let side = one.domain().periods()[0].unwrap();
    let places = phase::start::place(&one).unwrap();
    let spheres = |copies: usize| {
        let of = |copy: usize| {
            let all = places.position.iter().zip(&places.velocity);
            all.map(move |(place, velocity)| StartSphere {
                position: [place.x + side * copy as f64, place.y, place.z],
                velocity: [velocity.x, velocity.y, velocity.z],
                ..StartSphere::at([0.0; 3])
            })
        };
        (0..copies).flat_map(of).collect::<Vec<_>>()
    };
    let run = |copies: usize| {
        let mut scene = one.clone();
        scene.spheres.count = 64 * copies;
        scene.dem.periodic.as_mut().unwrap().x = Some(side * copies as f64);
        scene.start = Start::list(spheres(copies));
        let mut simulation = DemSimulation::new(&scene).unwrap();
        simulation.advance(2000).unwrap();
        simulation.particles().velocity.clone()
    };
    let (single, double) = (run(1), run(2));
    for (i, velocity) in double.iter().enumerate() {
        assert!((*velocity - single[i % 64]).norm() < 1e-6, "sphere {i}");
    }
}

/// Momentum stays, and the books of the energy close, with every integrator that knows the sides.
#[test]
fn momentum_and_energy_are_kept() {
    for integrator in [
        Integrator::SymplecticEuler,
        Integrator::VelocityVerlet,
        Integrator::SynchronisedVerlet,
    ] {
        let mut scene = gas(256, HERTZ, ALL_AXES);
        scene.time.dt = 4e-6;
        scene.time.integrator = integrator;
        let momentum = |simulation: &DemSimulation| {
            let particles = simulation.particles();
            let all = particles.velocity.iter().zip(&particles.mass);
            all.fold(Vector::ZERO, |sum, (velocity, mass)| {
                sum + *velocity * *mass
            })
        };
        let mut simulation = DemSimulation::new(&scene).unwrap();
        let first = momentum(&simulation);
        simulation.advance(4000).unwrap();
        let total = simulation.mass().iter().sum::<f64>();
        let change = (momentum(&simulation) - first).norm() / total;
        assert!(change < 1e-12, "{change} m/s, {integrator:?}");
        let observed = with_ledger(&scene);
        let energy = f64::from(observed.kinetic[0]);
        let residual = largest(&observed.residual);
        assert!(
            residual < 2e-3 * energy,
            "{residual} of {energy} J, {integrator:?}"
        );
    }
}

/// Along a slope that is periodic, gravity does work without end, and the books still close.
#[test]
fn the_potential_of_gravity_goes_on_beyond_the_box() {
    let text = format!(
        "{HERTZ}
        gravity = {{ acceleration = 9.8, tilt = 0.5 }}
        tank = {{ floor = 0 }}
        periodic = {{ x = 0.05, y = 0.05 }}
        start = {{ kind = 'random', z_min = 0.004, z_max = 0.06 }}"
    );
    let mut scene = scene(40, &text);
    scene.time.dt = 1e-5;
    scene.time.duration = 0.6;
    let observed = with_ledger(&scene);
    let gained = largest(&observed.kinetic);
    assert!(gained > 0.01, "{gained} J");
    let residual = largest(&observed.residual);
    assert!(residual < 2e-3 * gained, "{residual} of {gained} J");
    let mut simulation = DemSimulation::new(&scene).unwrap();
    simulation.advance(60_000).unwrap();
    let position = &simulation.particles().position;
    let farthest = position
        .iter()
        .fold(0.0_f64, |most, it| most.max(it.x.abs()));
    assert!(farthest > 0.1, "{farthest} m");
}

#[test]
fn many_spheres_have_the_same_bits_on_threads_and_after_an_interruption() {
    let slope = format!(
        "{HERTZ}
        gravity = {{ acceleration = 9.8, tilt = 0.4 }}
        tank = {{ floor = 0 }}
        periodic = {{ x = 0.2, y = 0.12 }}
        start = {{ kind = 'random', z_min = 0.004, z_max = 0.4, speed = 1.0 }}"
    );
    for scene in [scene(MANY + 100, &slope), gas(MANY + 100, HERTZ, ALL_AXES)] {
        let mut whole = DemSimulation::new(&scene).unwrap();
        whole.advance(520).unwrap();
        let expected = frame_bits(&mut whole);
        for threads in [2, 3, 7] {
            let mut divided = DemSimulation::new(&scene).unwrap();
            divided.use_threads(threads).unwrap();
            divided.advance(520).unwrap();
            assert!(frame_bits(&mut divided) == expected, "{threads} threads");
        }
        let mut part = DemSimulation::new(&scene).unwrap();
        part.advance(260).unwrap();
        let mut next = DemSimulation::new(&scene).unwrap();
        next.restore(part.state()).unwrap();
        next.advance(260).unwrap();
        assert!(frame_bits(&mut next) == expected, "interrupted");
    }
}

/// A random start keeps clear across the sides too.
#[test]
fn random_starts_do_not_overlap_across_the_sides() {
    let scene = gas(400, LINEAR, ALL_AXES);
    let places = phase::start::place(&scene).unwrap().position;
    let domain = scene.domain();
    let mut across = 0;
    for (i, one) in places.iter().enumerate() {
        for other in &places[..i] {
            let distance = domain.offset(*one, *other).norm();
            assert!(distance > 0.008, "{distance} m");
            across += u32::from(distance < 0.01 && (*one - *other).norm() > 0.01);
        }
    }
    assert!(across > 10, "{across} pairs are close across the sides");
}

/// Between plates and in a tube that span the period, a sphere moves as between endless ones, time
/// and again across the side.
#[test]
fn walls_that_span_the_period_are_endless() {
    let friction = "friction = { law = 'mindlin', coefficient = 0.3 }
        gravity = { acceleration = 9.8 }
        contact = { law = 'hertz', young_modulus = 1e6, poisson_ratio = 0.3, restitution = 0.6 }";
    let valley = |from: f64, length: f64| {
        let plate = |edge: &str| {
            format!(
                "{{ plate = {{ corner = [0.0, {from}, 0.0], first_edge = {edge}, \
                 second_edge = [0.0, {length}, 0.0] }} }}"
            )
        };
        format!(
            "wall = [{}, {}]",
            plate("[0.1, 0.0, 0.1]"),
            plate("[-0.1, 0.0, 0.05]")
        )
    };
    let tube = |from: f64, length: f64| {
        format!(
            "wall = [{{ cylinder = {{ base = [0.0, {from}, 0.05], axis = [0.0, 1.0, 0.0], \
             radius = 0.05, length = {length} }}, angular_velocity = 3.0 }}]"
        )
    };
    let run = |walls: &str, periodic: &str| {
        let text = format!(
            "{friction}
            {walls}
            {periodic}
            start = {{ kind = 'list', spheres = [{{ position = [0.01, 0.01, 0.03], \
                       velocity = [0.0, 0.4, 0.0] }}] }}"
        );
        let mut simulation = DemSimulation::new(&scene(1, &text)).unwrap();
        simulation.advance(20_000).unwrap();
        simulation.particles().position[0]
    };
    for walls in [&valley as &dyn Fn(f64, f64) -> String, &tube] {
        let found = run(&walls(-0.02, 0.05), "periodic = { y = 0.05 }");
        let expected = run(&walls(-1.0, 2.0), "");
        assert!((found - expected).norm() < 1e-9, "{found:?} {expected:?}");
        assert!(found.y > 0.075, "{found:?}");
    }
}
