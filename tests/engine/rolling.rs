//! Rolling resistance in scenes of many spheres: what it keeps, what it costs, and its bits.

use crate::large::large;
use crate::ledger::{check_residual, largest, with_ledger};
use crate::scenes::{
    INTEGRATORS, cluster, converging_spheres, damped, energy, momentum_is_kept, state, tank,
};
use phase::dem::DemSimulation;
use phase::scene::{
    Coulomb, Friction, Integrator, Mindlin, Neighbours, Rolling, Scene, Start, StartSphere,
};
use proptest::prelude::*;

/// Steps after which the spheres of a large scene have been sorted.
const STEPS: u64 = 260;

fn frictions() -> [Friction; 2] {
    [
        Friction::Coulomb(Coulomb {
            coefficient: 0.3,
            regularisation: 1e-2,
        }),
        Friction::Mindlin(Mindlin {
            coefficient: 0.3,
            rescale: false,
        }),
    ]
}

fn resisting(mut scene: Scene) -> Scene {
    scene.dem.rolling = Some(Rolling {
        coefficient: 0.2,
        damping: 0.3,
    });
    scene
}

/// Laws and integrators with which rolling resistance goes.
fn all() -> impl Iterator<Item = (Friction, Integrator)> {
    frictions()
        .into_iter()
        .flat_map(|friction| INTEGRATORS.map(|integrator| (friction.clone(), integrator)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn opposite_torques_keep_momentum_and_angular_momentum(
        spheres in converging_spheres(),
        friction in prop::sample::select(frictions().to_vec()),
        integrator in prop::sample::select(INTEGRATORS.to_vec()),
    ) {
        let mut scene = resisting(cluster(spheres, Some(friction), 2e-5));
        scene.time.integrator = integrator;
        momentum_is_kept(&scene)?;
    }

    #[test]
    fn resistance_gains_no_energy(
        spheres in converging_spheres(),
        friction in prop::sample::select(frictions().to_vec()),
        integrator in prop::sample::select(INTEGRATORS.to_vec()),
    ) {
        let mut scene = resisting(damped(cluster(spheres, Some(friction), 4e-6), 1e-3));
        scene.time.integrator = integrator;
        let mut simulation = DemSimulation::new(&scene).unwrap();
        let before = energy(&mut simulation, 0.0);
        for _ in 0..50 {
            simulation.advance(100).unwrap();
            let now = energy(&mut simulation, 0.0);
            prop_assert!(now <= before * (1.0 + 1e-5), "{now} of {before}");
        }
    }
}

/// Two spheres that touch and turn against each other without touching anything else: rolling
/// resistance stops their difference of spins, and nothing else of their motion.
#[test]
fn two_spheres_exchange_spin_alone() {
    for (friction, integrator) in all() {
        let sphere = |x: f64, spin: f64| StartSphere {
            spin: [0.0, spin, 0.0],
            ..StartSphere::at([x, 0.0, 0.0])
        };
        // Surfaces move alike where the spins are opposite: nothing slides.
        let spheres = vec![sphere(-0.00398, 5.0), sphere(0.00398, -5.0)];
        let mut scene = resisting(damped(cluster(spheres, Some(friction), 1e-6), 1e-3));
        scene.time.integrator = integrator;
        let mut simulation = DemSimulation::new(&scene).unwrap();
        simulation.advance(50).unwrap();
        let particles = simulation.particles();
        let [one, other] = [particles.spin[0], particles.spin[1]];
        assert!(one.y < 4.99 && one.y > 0.0, "{integrator:?}: {one:?}");
        assert!((one + other).norm() < 1e-12, "{one:?} {other:?}");
        let sideways = particles.velocity.iter().map(|it| it.y.abs() + it.z.abs());
        assert!(sideways.sum::<f64>() < 1e-9);
    }
}

fn bits(scene: &Scene, steps: u64) -> Vec<[u64; 3]> {
    let mut simulation = DemSimulation::new(scene).unwrap();
    simulation.advance(steps).unwrap();
    state(&simulation).bits()
}

#[test]
fn it_changes_the_motion_and_asking_for_the_books_does_not() {
    for (friction, integrator) in all() {
        let without = tank(Some(friction), integrator);
        let scene = resisting(without.clone());
        let expected = bits(&scene, 1000);
        assert!(expected != bits(&without, 1000), "{integrator:?}");
        let mut kept = scene.clone();
        kept.output.ledger = true;
        assert!(expected == bits(&kept, 1000), "{integrator:?}");
        let length = 0.01;
        for neighbours in [Neighbours::AllPairs, Neighbours::Cells { length }] {
            let mut searched = scene.clone();
            searched.dem.effects.updraught = None;
            let expected = bits(&searched, 500);
            searched.dem.neighbours = neighbours;
            assert!(expected == bits(&searched, 500), "{neighbours:?}");
        }
    }
}

/// The work of rolling resistance counts as friction, and what its springs hold as springs: the
/// balance closes as it does without it.
#[test]
fn the_books_of_a_tank_close() {
    for (friction, integrator) in all() {
        let mut scene = resisting(tank(Some(friction), integrator));
        scene.time.dt = 2e-5;
        let books = with_ledger(&scene);
        check_residual(&books, integrator);
        assert!(largest(&books.springs) > 0.0);
    }
}

/// Many spheres, which are sorted in memory on the way: springs follow them, on any number of
/// threads, and through a checkpoint.
#[test]
#[ignore = "takes a quarter of a minute"]
fn springs_follow_spheres_that_are_sorted() {
    for (friction, integrator) in all() {
        let mut scene = resisting(large(Some(friction), integrator));
        scene.output.ledger = integrator == Integrator::VelocityVerlet;
        let mut one = DemSimulation::new(&scene).unwrap();
        one.advance(STEPS).unwrap();
        let expected = state(&one).bits();
        let mut first = DemSimulation::new(&scene).unwrap();
        first.use_threads(2).unwrap();
        first.advance(249).unwrap();
        let mut second = DemSimulation::new(&scene).unwrap();
        second.restore(first.state()).unwrap();
        second.use_threads(3).unwrap();
        second.advance(STEPS - 249).unwrap();
        assert!(state(&second).bits() == expected, "{integrator:?}");
        assert_eq!(second.frame().ledger, one.frame().ledger);
    }
}

#[test]
fn a_state_without_rolling_springs_is_refused() {
    let without = tank(Some(frictions()[1].clone()), Integrator::VelocityVerlet);
    let scene = resisting(without.clone());
    let bare = DemSimulation::new(&without).unwrap();
    let mut simulation = DemSimulation::new(&scene).unwrap();
    let error = simulation.restore(bare.state()).unwrap_err();
    assert!(error.to_string().contains("rolling"), "{error}");
}

/// What the smallest sphere's spring may become is below the limit: a sphere that spins on its
/// place keeps to its energy just below the limit, and does not above it.
#[test]
fn the_limit_of_the_step_is_that_of_the_spring() {
    use phase::dem::timestep;
    let sphere = StartSphere {
        spin: [0.0, 1e-3, 0.0],
        ..StartSphere::at([0.0, 0.0, 0.00399])
    };
    let mut scene = cluster(vec![sphere], Some(frictions()[0].clone()), 1e-6);
    scene.tank = Some(phase::scene::Tank {
        floor: Some(0.0),
        ..phase::scene::Tank::default()
    });
    // So stiff that no other limit is near, and no friction besides.
    scene.dem.friction = Some(Friction::Coulomb(Coulomb {
        coefficient: 0.0,
        regularisation: 1.0,
    }));
    scene.dem.contact = Some(phase::scene::Contact::Linear(phase::scene::Linear {
        stiffness: 100.0,
        damping: 0.0,
        drag: phase::scene::ContactDrag::Normal,
    }));
    scene.dem.effects.gravity = Some(phase::scene::Gravity {
        acceleration: 100.0 * 1e-5 / (1e4 * 4.0 / 3.0 * std::f64::consts::PI * 6.4e-8),
        tilt: 0.0,
    });
    scene.dem.rolling = Some(Rolling {
        coefficient: 10.0,
        damping: 0.0,
    });
    assert!(matches!(scene.start, Start::List { .. }));
    for integrator in [
        Integrator::SymplecticEuler,
        Integrator::VelocityVerlet,
        Integrator::SynchronisedVerlet,
    ] {
        scene.time.integrator = integrator;
        let limits = timestep::limits(&scene);
        let named = |name: &str| limits.iter().find(|it| it.name == name).unwrap();
        let limit = named("rolling resistance").seconds;
        assert!(limit < 0.1 * named("contact").seconds);
        let largest = |factor: f64| {
            scene.time.dt = factor * limit;
            let mut simulation = DemSimulation::new(&scene).unwrap();
            let mut most = 0.0_f64;
            for _ in 0..400 {
                simulation.advance(1).unwrap();
                most = most.max(simulation.particles().spin[0].norm());
            }
            most
        };
        let (mut below, mut above) = (0.0, 0.0);
        let mut largest = largest;
        below += largest(0.95);
        above += largest(1.05);
        assert!(below < 1e-2, "{integrator:?}: {below}");
        assert!(above > 1e-1, "{integrator:?}: {above}");
    }
}
