//! What the motion keeps, whatever the scene: momentum, angular momentum, energy, symmetries.

use crate::scenes::{
    INTEGRATORS, State, cluster, converging_spheres, damped, energy, frictions, momentum_is_kept,
    state, tank,
};
use phase::dem::DemSimulation;
use phase::particles::vector::Vector;
use phase::scene::{
    Contact, Coulomb, DragForm, Friction, Hertz, Integrator, Mindlin, Scene, StartSphere, Tank,
};
use proptest::prelude::*;

/// Laws in which every force on a sphere has a reaction on its partner, torques included.
fn reciprocal_frictions() -> impl Strategy<Value = Option<Friction>> {
    let [none, _, coulomb, mindlin, rescaled] = frictions();
    prop::sample::select(vec![none, coulomb, mindlin, rescaled])
}

fn integrators() -> impl Strategy<Value = Integrator> {
    prop::sample::select(INTEGRATORS.to_vec())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn momentum_and_angular_momentum_of_isolated_spheres(
        spheres in converging_spheres(),
        friction in reciprocal_frictions(),
        integrator in integrators(),
        dissipation in prop::sample::select(vec![0.0, 1e-3]),
    ) {
        let mut scene = damped(cluster(spheres, friction, 2e-5), dissipation);
        scene.time.integrator = integrator;
        momentum_is_kept(&scene)?;
    }

    #[test]
    fn elastic_spheres_keep_their_energy(spheres in converging_spheres()) {
        let mut simulation = DemSimulation::new(&cluster(spheres, None, 1e-6)).unwrap();
        let before = energy(&mut simulation, 0.0);
        for _ in 0..50 {
            simulation.advance(300).unwrap();
            let now = energy(&mut simulation, 0.0);
            prop_assert!((now / before - 1.0).abs() < 1e-6, "{now} of {before}");
        }
    }

    #[test]
    fn dissipation_gains_no_energy(
        spheres in converging_spheres(),
        friction in reciprocal_frictions(),
        dissipation in 0.0..3e-3,
    ) {
        let scene = damped(cluster(spheres, friction, 4e-6), dissipation);
        let mut simulation = DemSimulation::new(&scene).unwrap();
        let before = energy(&mut simulation, 0.0);
        for _ in 0..50 {
            simulation.advance(100).unwrap();
            let now = energy(&mut simulation, 0.0);
            prop_assert!(now <= before * (1.0 + 1e-5), "{now} of {before}");
        }
    }

    #[test]
    fn hits_on_walls_gain_no_energy(
        angle in 0.0..1.55_f64,
        spin in prop::array::uniform3(-500.0..500.0),
        coefficient in 0.0..1.0,
        coulomb in any::<bool>(),
        cylinder in any::<bool>(),
        poisson_ratio in 0.2..0.5,
        dissipation in prop::sample::select(vec![0.0, 1e-4]),
        integrator in integrators(),
    ) {
        let friction = if coulomb {
            Friction::Coulomb(Coulomb { coefficient, regularisation: 1e-2 })
        } else {
            Friction::Mindlin(Mindlin { coefficient, rescale: false })
        };
        let (into, along) = (libm::cos(angle), libm::sin(angle));
        let sphere = StartSphere {
            position: if cylinder { [0.056, 0.0, 0.0] } else { [0.0, 0.0, 0.004] },
            velocity: if cylinder { [into, along, 0.3 * along] } else { [along, 0.0, -into] },
            spin,
            radius: None,
        };
        let mut scene = damped(cluster(vec![sphere], Some(friction), 2e-6), dissipation);
        scene.time.integrator = integrator;
        scene.tank = Some(Tank {
            radius: cylinder.then_some(0.06),
            floor: (!cylinder).then_some(0.0),
            ..Tank::default()
        });
        if let Some(Contact::Hertz(Hertz { poisson_ratio: ratio, .. })) = &mut scene.dem.contact {
            *ratio = poisson_ratio;
        }
        let mut simulation = DemSimulation::new(&scene).unwrap();
        let before = energy(&mut simulation, 0.0);
        simulation.advance(12_000).unwrap();
        let after = energy(&mut simulation, 0.0);
        prop_assert!(after <= before * (1.0 + 1e-5), "{after} of {before}");
    }
}

#[test]
fn a_damped_pile_under_gravity_loses_energy_from_frame_to_frame() {
    for friction in frictions().into_iter().skip(2) {
        let mut scene = tank(friction, Integrator::VelocityVerlet);
        (
            scene.dem.effects.drag,
            scene.dem.effects.swirl,
            scene.dem.effects.updraught,
        ) = (None, None, None);
        let mut simulation = DemSimulation::new(&scene).unwrap();
        let first = energy(&mut simulation, 9.8);
        let mut last = first;
        for _ in 0..200 {
            simulation.advance(10).unwrap();
            let now = energy(&mut simulation, 9.8);
            // The springs of Mindlin's law give back what they hold.
            assert!(now < last + 2e-3 * first.abs(), "{now} after {last}");
            last = now;
        }
        assert!(last < first - 0.1 * first.abs());
    }
}

/// A scene that goes on from a state, with the radii of another simulation.
fn going_on(scene: &Scene, from: &State, radius: &[f64]) -> Scene {
    Scene {
        start: from.start(radius),
        ..scene.clone()
    }
}

fn run(scene: &Scene, steps: u64) -> State {
    let mut simulation = DemSimulation::new(scene).unwrap();
    simulation.advance(steps).unwrap();
    state(&simulation)
}

/// Every scene of the tank with its start and radii.
fn tanks() -> impl Iterator<Item = (Scene, State, Vec<f64>)> {
    let laws = frictions().into_iter();
    let scenes = laws.flat_map(|law| INTEGRATORS.map(|integrator| tank(law.clone(), integrator)));
    scenes.map(|scene| {
        let simulation = DemSimulation::new(&scene).unwrap();
        let radius = simulation.particles().radius.clone();
        (scene, state(&simulation), radius)
    })
}

/// Rounding grows in collisions: over the steps of these runs to much less than this part of a
/// radius.
const CLOSE: f64 = 1e-6;
const STEPS: u64 = 400;

#[test]
fn mirrored_scenes_mirror() {
    let polar = |v: Vector| Vector::new(v.x, -v.y, v.z);
    let axial = |v: Vector| Vector::new(-v.x, v.y, -v.z);
    for (scene, start, radius) in tanks() {
        let mut mirrored = going_on(&scene, &start.map(polar, axial), &radius);
        mirrored.dem.effects.swirl.as_mut().unwrap().omega *= -1.0;
        let expected = run(&scene, STEPS).map(polar, axial);
        let distance = run(&mirrored, STEPS).distance(&expected, 0.004);
        assert!(distance < CLOSE, "{:?}: {distance}", scene.dem.friction);
    }
}

#[test]
fn a_quarter_turn_about_the_axis_changes_nothing() {
    let turn = |v: Vector| Vector::new(-v.y, v.x, v.z);
    for (scene, start, radius) in tanks() {
        let turned = going_on(&scene, &start.map(turn, turn), &radius);
        let expected = run(&scene, STEPS).map(turn, turn);
        let distance = run(&turned, STEPS).distance(&expected, 0.004);
        assert!(distance < CLOSE, "{:?}: {distance}", scene.dem.friction);
    }
}

/// What turns a vector about the axis by this angle.
fn turned(angle: f64) -> impl Fn(Vector) -> Vector + Copy {
    let (sine, cosine) = libm::sincos(angle);
    move |v| Vector::new(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y, v.z)
}

#[test]
fn a_turn_by_any_angle_about_the_axis_changes_nothing() {
    let turn = turned(1.0);
    for (mut scene, start, radius) in tanks() {
        // Quadratic drag by components knows the axes, and so does the shield.
        scene.dem.effects.drag.as_mut().unwrap().form = DragForm::Vector;
        scene.dem.effects.updraught = None;
        let end = run(&going_on(&scene, &start.map(turn, turn), &radius), STEPS);
        let expected = run(&going_on(&scene, &start, &radius), STEPS).map(turn, turn);
        let distance = end.distance(&expected, 0.004);
        assert!(distance < CLOSE, "{:?}: {distance}", scene.dem.friction);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Turned, mirrored, renumbered or a hundred times as heavy and stiff: the same motion.
    #[test]
    fn isolated_spheres_move_alike_however_they_are_looked_at(
        spheres in converging_spheres(),
        friction in prop::sample::select(frictions().to_vec()),
        integrator in integrators(),
        dissipation in prop::sample::select(vec![0.0, 1e-4]),
        angle in 0.0..6.3_f64,
        shift in 0_usize..10,
    ) {
        let mut scene = damped(cluster(spheres, friction, 2e-5), dissipation);
        scene.time.integrator = integrator;
        let simulation = DemSimulation::new(&scene).unwrap();
        let (start, radius) = (state(&simulation), simulation.particles().radius.clone());
        let end = run(&scene, 1500);
        let check = |other: &Scene, expected: &State, what: &str| {
            let distance = run(other, 1500).distance(expected, 0.004);
            prop_assert!(distance < CLOSE, "{what}: {distance}");
            Ok(())
        };
        let turn = turned(angle);
        let other = going_on(&scene, &start.map(turn, turn), &radius);
        check(&other, &end.map(turn, turn), "turned")?;
        let polar = |v: Vector| Vector::new(v.x, v.y, -v.z);
        let axial = |v: Vector| Vector::new(-v.x, -v.y, v.z);
        let other = going_on(&scene, &start.map(polar, axial), &radius);
        check(&other, &end.map(polar, axial), "mirrored")?;
        let mut order: Vec<usize> = (0..radius.len()).rev().collect();
        order.rotate_left(shift % radius.len());
        let radii: Vec<f64> = order.iter().map(|&i| radius[i]).collect();
        let other = going_on(&scene, &start.reordered(&order), &radii);
        check(&other, &end.reordered(&order), "renumbered")?;
        let mut other = scene.clone();
        other.spheres.density *= 100.0;
        if let Some(Contact::Hertz(Hertz { young_modulus, .. })) = &mut other.dem.contact {
            *young_modulus *= 100.0;
        }
        check(&other, &end, "scaled")?;
    }
}

#[test]
fn numbers_of_the_spheres_do_not_matter() {
    for (scene, start, radius) in tanks() {
        let count = radius.len();
        let order: Vec<usize> = (0..count).map(|i| (7 * i + 3) % count).collect();
        let radius: Vec<f64> = order.iter().map(|&i| radius[i]).collect();
        let renumbered = going_on(&scene, &start.reordered(&order), &radius);
        let expected = run(&scene, STEPS).reordered(&order);
        let distance = run(&renumbered, STEPS).distance(&expected, 0.004);
        assert!(distance < CLOSE, "{:?}: {distance}", scene.dem.friction);
    }
}

#[test]
fn scaling_all_forces_and_masses_changes_nothing() {
    for (scene, start, radius) in tanks() {
        let mut scaled = going_on(&scene, &start, &radius);
        scaled.spheres.density *= 100.0;
        if let Some(Contact::Hertz(Hertz { young_modulus, .. })) = &mut scaled.dem.contact {
            *young_modulus *= 100.0;
        }
        let drag = scaled.dem.effects.drag.as_mut().unwrap();
        drag.linear *= 100.0;
        drag.quadratic *= 100.0;
        let distance = run(&scaled, STEPS).distance(&run(&scene, STEPS), 0.004);
        assert!(distance < CLOSE, "{:?}: {distance}", scene.dem.friction);
    }
}

#[test]
fn isolated_spheres_do_not_mind_a_common_velocity() {
    let spheres = |drift: f64| {
        [-1.0, 1.0].map(|side| StartSphere {
            position: [0.006 * side, 0.001 * side, 0.0],
            velocity: [drift - side, 0.0, 0.5 * drift],
            spin: [0.0, 100.0, 30.0 * side],
            radius: None,
        })
    };
    for friction in frictions() {
        let ends = [0.0, 3.0].map(|drift| {
            let scene = cluster(spheres(drift).to_vec(), friction.clone(), 1e-5);
            let end = run(&scene, 2000);
            end.position[0] - end.position[1]
        });
        assert!((ends[0] - ends[1]).norm() < 1e-12, "{friction:?}");
    }
}
