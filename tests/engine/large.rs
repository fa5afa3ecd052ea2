//! Large scenes, whose spheres are sorted in memory: what leaves the engine is in the order of the
//! scene, and no bit depends on how a run is interrupted, on the numbers of spheres, or on the
//! threads that it runs on.

use crate::scenes::{INTEGRATORS, shake, tank};
use crate::support::Workplace;
use phase::dem::DemSimulation;
use phase::dem::order::MANY;
use phase::record::Guard;
use phase::scene::{Friction, Integrator, Mindlin, Radii, Scene, Start, StartSphere};
use phase::store::{content_digest, read_record};

const COUNT: usize = MANY + 404;

/// Steps after which the spheres have been sorted three times.
const STEPS: u64 = 520;

/// The small tank made larger, without its updraught, with spheres that mix.
pub(crate) fn large(friction: Option<Friction>, integrator: Integrator) -> Scene {
    let mut scene = tank(friction, integrator);
    scene.dem.effects.updraught = None;
    scene.dem.effects.swirl.as_mut().unwrap().omega = 30.0;
    let tank = scene.tank.as_mut().unwrap();
    let factor = libm::cbrt(COUNT as f64 / scene.spheres.count as f64);
    tank.radius = tank.radius.map(|radius| radius * factor);
    scene.spheres.count = COUNT;
    scene.start = Start::Random {
        x: None,
        y: None,
        z_min: -0.04,
        z_max: -0.04 + 0.1 * factor,
        speed: 1.0,
        spin: 50.0,
    };
    scene
}

fn mindlin() -> Option<Friction> {
    Some(Friction::Mindlin(Mindlin {
        coefficient: 0.3,
        rescale: false,
    }))
}

/// Places, velocities and spins in the order of the scene.
fn places(simulation: &mut DemSimulation) -> Vec<[f64; 9]> {
    let frame = simulation.frame();
    let none = vec![0.0; frame.count()];
    let spin = frame.spin.unwrap_or([&none; 3]);
    let of = |i: usize| {
        let all = [frame.position, frame.velocity, spin];
        std::array::from_fn(|k| all[k / 3][k % 3][i])
    };
    (0..frame.count()).map(of).collect()
}

fn bits(simulation: &mut DemSimulation) -> Vec<[u64; 9]> {
    let places = places(simulation).into_iter();
    places.map(|place| place.map(f64::to_bits)).collect()
}

/// The scene with its random start written out.
fn listed(mut scene: Scene) -> Scene {
    let mut simulation = DemSimulation::new(&scene).unwrap();
    let radius = simulation.radius().to_vec();
    let spheres = places(&mut simulation).into_iter().zip(radius);
    let triple = |place: &[f64], at: usize| [place[at], place[at + 1], place[at + 2]];
    let spheres = spheres.map(|(place, radius)| StartSphere {
        position: triple(&place, 0),
        velocity: triple(&place, 3),
        spin: triple(&place, 6),
        radius: Some(radius),
    });
    scene.start = Start::list(spheres.collect());
    scene
}

#[test]
fn frames_are_in_the_order_of_the_scene() {
    let mut simulation = DemSimulation::new(&large(mindlin(), Integrator::VelocityVerlet)).unwrap();
    let mut before = places(&mut simulation);
    let radius = simulation.radius().to_vec();
    for _ in 0..STEPS / 10 {
        simulation.advance(10).unwrap();
        let now = places(&mut simulation);
        // In a millisecond none gets farther than with 5 m/s.
        let way = |one: &[f64; 9], other: &[f64; 9]| {
            let squares = (0..3).map(|k| (one[k] - other[k]) * (one[k] - other[k]));
            squares.sum::<f64>().sqrt()
        };
        assert!(
            now.iter()
                .zip(&before)
                .all(|(now, before)| way(now, before) < 5e-3)
        );
        before = now;
        assert_eq!(simulation.frame().radius, radius);
    }
    // In memory they stand elsewhere.
    let particles = simulation.particles();
    assert!(
        particles
            .number
            .iter()
            .zip(0..)
            .any(|(&number, i)| number != i)
    );
    for (at, &number) in particles.number.iter().enumerate() {
        assert_eq!(particles.position[at].x, before[number as usize][0]);
        assert_eq!(particles.radius[at], radius[number as usize]);
    }
}

#[test]
fn few_spheres_stay_in_the_order_of_the_scene() {
    let mut scene = large(None, Integrator::SymplecticEuler);
    scene.spheres.count = MANY - 1;
    let mut simulation = DemSimulation::new(&scene).unwrap();
    simulation.advance(1).unwrap();
    assert!(simulation.particles().number.is_empty());
}

#[test]
#[ignore = "takes ten seconds"]
fn an_interrupted_run_goes_on_with_the_same_bits() {
    // With the ledger and without it in turn.
    for (integrator, ledger) in INTEGRATORS
        .into_iter()
        .zip([true, false].into_iter().cycle())
    {
        let mut scene = large(mindlin(), integrator);
        scene.output.ledger = ledger;
        let mut whole = DemSimulation::new(&scene).unwrap();
        whole.advance(STEPS).unwrap();
        let mut latest = DemSimulation::new(&scene).unwrap();
        // At the moment of a sort, before one and after one.
        for step in [100, 250, 251, STEPS] {
            latest.advance(step - latest.step()).unwrap();
            let mut next = DemSimulation::new(&scene).unwrap();
            next.restore(latest.state()).unwrap();
            assert_eq!(bits(&mut next), bits(&mut latest));
            latest = next;
        }
        assert!(bits(&mut latest) == bits(&mut whole), "{integrator:?}");
        let work = |simulation: &mut DemSimulation| simulation.frame().ledger;
        assert_eq!(work(&mut latest), work(&mut whole), "{integrator:?}");
    }
}

#[test]
fn bits_do_not_depend_on_the_threads() {
    for integrator in INTEGRATORS {
        let mut shaken = large(mindlin(), integrator);
        shake(&mut shaken);
        let in_air = [None, mindlin()].map(|friction| large(friction, integrator));
        for scene in in_air.into_iter().chain([shaken]) {
            let mut one = DemSimulation::new(&scene).unwrap();
            one.advance(STEPS).unwrap();
            let expected = bits(&mut one);
            // Their number may change on the way.
            let mut several = DemSimulation::new(&scene).unwrap();
            for (threads, end) in [(2, STEPS / 3), (3, STEPS / 2), (7, STEPS)] {
                several.use_threads(threads).unwrap();
                several.advance(end - several.step()).unwrap();
                several.frame();
            }
            assert!(
                bits(&mut several) == expected,
                "{integrator:?}, {:?}",
                scene.dem.friction
            );
        }
    }
}

#[test]
#[ignore = "takes seven seconds"]
fn bits_do_not_depend_on_lists_or_on_being_watched() {
    let mut scene = large(mindlin(), Integrator::SymplecticEuler);
    for updraught in [
        None,
        tank(None, Integrator::VelocityVerlet).dem.effects.updraught,
    ] {
        scene.dem.effects.updraught = updraught;
        let mut expected = DemSimulation::new(&scene).unwrap();
        expected.advance(STEPS).unwrap();
        let mut other = DemSimulation::with_skin(&scene, 0.05).unwrap();
        other.use_baseline_instructions();
        other.use_threads(2).unwrap();
        for _ in 0..STEPS {
            other.advance(1).unwrap();
            other.frame();
        }
        assert!(bits(&mut other) == bits(&mut expected));
    }
}

#[test]
fn the_numbers_of_spheres_change_no_bit() {
    let mut scene = listed(large(mindlin(), Integrator::SynchronisedVerlet));
    let mut one = DemSimulation::new(&scene).unwrap();
    one.advance(STEPS).unwrap();
    let spheres = scene.start.list_mut().unwrap();
    spheres.reverse();
    let mut other = DemSimulation::new(&scene).unwrap();
    other.use_threads(2).unwrap();
    other.advance(STEPS).unwrap();
    let mut found = bits(&mut other);
    found.reverse();
    assert!(found == bits(&mut one));
}

#[test]
fn a_broken_guard_names_the_sphere_of_the_scene() {
    let mut scene = listed(large(mindlin(), Integrator::SymplecticEuler));
    let spheres = scene.start.list_mut().unwrap();
    spheres[1234].velocity = [1e3, 0.0, 0.0];
    for threads in [1, 2] {
        let mut simulation = DemSimulation::new(&scene).unwrap();
        simulation.use_threads(threads).unwrap();
        let instability = simulation.advance(5).unwrap_err();
        assert_eq!(
            (instability.guard, instability.sphere),
            (Guard::Displacement, 1234)
        );
    }
    let spheres = scene.start.list_mut().unwrap();
    spheres[1234] = spheres[321].clone();
    // What is left of the spheres does not depend on how they were moved either.
    let broken = [1, 2].map(|threads| {
        let mut simulation = DemSimulation::new(&scene).unwrap();
        simulation.use_threads(threads).unwrap();
        let instability = simulation.advance(5).unwrap_err();
        assert_eq!(instability.guard, Guard::Overlap);
        assert!([321, 1234].contains(&instability.sphere), "{instability}");
        bits(&mut simulation)
    });
    assert!(broken[0] == broken[1]);
}

/// Spheres on a cubic lattice, each with a velocity of its own.
#[derive(Clone, Copy, Debug)]
struct Lattice {
    /// Radius of the tank (m): in a wide one most spheres are near those of another thread; in a
    /// narrow one few, and each thread then moves its own while those of others are still to come.
    tank: f64,
    count: usize,
    /// Whether all are pressed together; or they meet and part.
    pressed: bool,
    /// Whether all have one radius, or one of three.
    alike: bool,
    friction: bool,
}

const WIDE: Lattice = Lattice {
    tank: 0.08,
    count: COUNT,
    pressed: true,
    alike: true,
    friction: true,
};

/// 44 spheres in a layer, and so many of them that two threads move theirs in several goes.
const NARROW: Lattice = Lattice {
    tank: 0.033,
    count: 10_000,
    ..WIDE
};

impl Lattice {
    fn scene(self, integrator: Integrator) -> Scene {
        let mut scene = large(self.friction.then(mindlin).flatten(), integrator);
        let radius = 0.004;
        let (spacing, slowest) = match self.pressed {
            true => (1.98 * radius, 1e-4),
            false => (2.02 * radius, 3e-3),
        };
        let cell = |k: usize| spacing * k as f64;
        let columns = (0..20).flat_map(|i| (0..20).map(move |j| [i, j]));
        let columns = columns
            .map(|[i, j]| [cell(i), cell(j)].map(|x| x - 9.5 * spacing))
            .filter(|[x, y]| libm::hypot(*x, *y) < self.tank - radius);
        let columns: Vec<_> = columns.collect();
        let spheres = (0..self.count).map(|at| {
            let ([x, y], layer) = (columns[at % columns.len()], at / columns.len());
            let speed = |salt: usize| slowest * ((at * salt) % 101) as f64;
            StartSphere {
                position: [x, y, -0.05 + 0.99 * radius + cell(layer)],
                velocity: [speed(37), speed(53), speed(71)],
                spin: [0.0; 3],
                radius: (!self.alike).then_some(radius * (1.0 - 1e-3 * (at % 3) as f64)),
            }
        });
        scene.spheres.radius = Radii::One(radius);
        scene.spheres.count = self.count;
        scene.tank.as_mut().unwrap().radius = Some(self.tank);
        scene.start = Start::list(spheres.collect());
        scene
    }
}

/// Of many contacts spheres are moved while others are still to come; step by step they are moved
/// after all of them.
#[test]
#[ignore = "takes seven seconds"]
fn bits_do_not_depend_on_when_spheres_are_moved() {
    let unlike = Lattice {
        alike: false,
        ..NARROW
    };
    let loose = Lattice {
        pressed: false,
        ..NARROW
    };
    let smooth = Lattice {
        friction: false,
        ..loose
    };
    for integrator in [Integrator::SymplecticEuler, Integrator::VelocityVerlet] {
        for lattice in [WIDE, NARROW, unlike, loose, smooth] {
            let scene = lattice.scene(integrator);
            let advanced = |threads: usize, at_once: u64| {
                let mut simulation = DemSimulation::new(&scene).unwrap();
                simulation.use_threads(threads).unwrap();
                while simulation.step() < 60 {
                    simulation.advance(at_once).unwrap();
                }
                bits(&mut simulation)
            };
            let expected = advanced(1, 60);
            for (threads, at_once) in [(1, 1), (2, 60), (3, 20), (8, 60)] {
                assert!(
                    advanced(threads, at_once) == expected,
                    "{integrator:?}, {threads} threads, {at_once} steps at once, {lattice:?}"
                );
            }
        }
    }
}

/// Wherever it is, at the boundary of two threads too.
#[test]
fn a_contact_too_deep_is_the_same_on_threads_that_move_their_own_spheres() {
    let middle = NARROW.count / 2;
    for at in [
        0,
        NARROW.count / 3,
        middle - 40,
        middle,
        middle + 40,
        NARROW.count - 1,
    ] {
        let mut scene = NARROW.scene(Integrator::SymplecticEuler);
        let spheres = scene.start.list_mut().unwrap();
        // Up from the floor, or down into the others.
        spheres[at].velocity = [0.0, 0.0, if at == 0 { 30.0 } else { -30.0 }];
        let broken = [1, 2, 3].map(|threads| {
            let mut simulation = DemSimulation::new(&scene).unwrap();
            simulation.use_threads(threads).unwrap();
            let instability = simulation.advance(200).unwrap_err();
            assert_eq!(instability.guard, Guard::Overlap);
            (instability.to_string(), bits(&mut simulation))
        });
        assert!(
            broken[0] == broken[1] && broken[0] == broken[2],
            "{at}: {}",
            broken[0].0
        );
    }
}

#[test]
fn the_program_runs_on_threads_and_writes_the_same_record() {
    let place = Workplace::new();
    let mut scene = large(mindlin(), Integrator::SymplecticEuler);
    scene.time.duration = 0.03;
    scene.time.frame_interval = 0.01;
    place.write("large.toml", &toml::to_string(&scene).unwrap());
    let digest = |name: &str| content_digest(&read_record(&place.path(name)).unwrap()).unwrap();
    for (record, threads) in [("one.h5", "1"), ("two.h5", "2")] {
        place
            .phase(&["run", "large.toml", "--out", record, "--threads", threads])
            .code(0);
    }
    assert_eq!(digest("one.h5"), digest("two.h5"));
    for wrong in ["0", "many"] {
        place
            .phase(&["run", "large.toml", "--threads", wrong])
            .code(2)
            .complains("--threads");
    }
}
