//! The same input gives the same bits, a broken guard names its place, and nothing panics.

use crate::scenes::{
    INTEGRATORS, State, cluster, frictions, integrators_at_walls, shaken, state, tank, walled,
    water,
};
use phase::dem::{DemSimulation, timestep};
use phase::record::{Guard, Instability};
use phase::scene::{Coulomb, Friction, Integrator, Mindlin, Scene, Spin, StartSphere};
use proptest::prelude::*;

const STEPS: u64 = 2000;

fn tanks() -> impl Iterator<Item = Scene> {
    let laws = frictions().into_iter();
    let air = laws.flat_map(|law| INTEGRATORS.map(|integrator| tank(law.clone(), integrator)));
    air.chain(INTEGRATORS.map(water))
        .chain(INTEGRATORS.map(shaken))
        .chain(integrators_at_walls().flat_map(walled))
}

fn run(scene: &Scene, steps: u64) -> State {
    let mut simulation = DemSimulation::new(scene).unwrap();
    simulation.advance(steps).unwrap();
    state(&simulation)
}

/// The tank without its updraught, whose shield needs a list of its own kind.
fn without_shield(mut scene: Scene) -> Scene {
    scene.dem.effects.updraught = None;
    scene
}

#[test]
#[ignore = "takes a quarter of a minute"]
fn bits_do_not_depend_on_the_neighbour_list() {
    for scene in tanks().flat_map(|scene| [without_shield(scene.clone()), scene]) {
        let expected = run(&scene, STEPS).bits();
        // Built at every step, when all near pairs touch and none is sorted out; often, when some
        // do not; seldom; never again, with all pairs in it.
        let (always, once) = (STEPS + 1, 1);
        for (skin, most_builds) in [(0.0, always), (0.05, STEPS), (2.0, STEPS / 2), (1e3, once)] {
            let mut simulation = DemSimulation::with_skin(&scene, skin).unwrap();
            simulation.advance(STEPS).unwrap();
            let list = simulation.list().unwrap();
            assert!(list.builds() <= most_builds, "{} builds", list.builds());
            if most_builds == once {
                let count = scene.spheres.count;
                assert_eq!(list.pairs(), count * (count - 1) / 2);
            }
            assert!(
                state(&simulation).bits() == expected,
                "{:?} with a skin of {skin} radii",
                scene.dem.friction
            );
        }
    }
}

#[test]
fn bits_do_not_depend_on_being_watched() {
    for scene in tanks() {
        let mut watched = DemSimulation::new(&scene).unwrap();
        for step in 0..STEPS {
            if step % 3 == 0 {
                watched.elastic_energy();
            }
            if step % 7 == 0 {
                watched.frame();
            }
            watched.advance(1).unwrap();
        }
        assert!(
            state(&watched).bits() == run(&scene, STEPS).bits(),
            "{:?}",
            scene.dem.friction
        );
    }
}

/// Steps forget forces as soon as they may; whoever looks between two advances still finds the
/// latest.
#[test]
fn latest_forces_do_not_depend_on_how_steps_are_asked_for() {
    let forces = |simulation: &DemSimulation| {
        let particles = simulation.particles();
        let all = particles.force.iter().chain(&particles.torque);
        all.map(|it| [it.x, it.y, it.z].map(f64::to_bits))
            .collect::<Vec<_>>()
    };
    for scene in tanks() {
        let mut at_once = DemSimulation::new(&scene).unwrap();
        at_once.advance(60).unwrap();
        let mut one_by_one = DemSimulation::new(&scene).unwrap();
        (0..60).for_each(|_| one_by_one.advance(1).unwrap());
        assert!(forces(&at_once).iter().flatten().any(|bits| *bits != 0));
        assert_eq!(forces(&at_once), forces(&one_by_one));
    }
}

#[test]
fn bits_do_not_depend_on_the_instruction_set() {
    for scene in tanks() {
        let mut plain = DemSimulation::new(&scene).unwrap();
        plain.use_baseline_instructions();
        plain.advance(STEPS).unwrap();
        assert!(
            state(&plain).bits() == run(&scene, STEPS).bits(),
            "{:?}",
            scene.dem.friction
        );
    }
}

#[test]
fn bits_do_not_depend_on_threads_beside() {
    let scene = tank(None, Integrator::SymplecticEuler);
    let alone = run(&scene, STEPS).bits();
    let together: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4)
            .map(|_| scope.spawn(|| run(&scene, STEPS).bits()))
            .collect();
        threads.into_iter().map(|it| it.join().unwrap()).collect()
    });
    assert!(together.iter().all(|bits| *bits == alone));
}

#[test]
fn the_seed_decides_the_start() {
    let scene = tank(frictions()[1].clone(), Integrator::SymplecticEuler);
    assert_eq!(run(&scene, 0).bits(), run(&scene, 0).bits());
    let mut other = scene.clone();
    other.seed += 1;
    let (first, second) = (run(&scene, 0), run(&other, 0));
    let same = first.position.iter().zip(&second.position);
    assert!(same.filter(|(a, b)| a == b).count() == 0);
}

fn sphere(position: [f64; 3], velocity: [f64; 3]) -> StartSphere {
    StartSphere {
        position,
        velocity,
        spin: [0.0; 3],
        radius: None,
    }
}

/// What ends a run, with every integrator.
fn broken_guards(scene: &Scene) -> [Instability; INTEGRATORS.len()] {
    INTEGRATORS.map(|integrator| {
        let mut scene = scene.clone();
        scene.time.integrator = integrator;
        let mut simulation = DemSimulation::new(&scene).unwrap();
        simulation.advance(10_000).unwrap_err()
    })
}

#[track_caller]
fn assert_broken(scene: &Scene, guard: Guard, sphere: usize, steps: std::ops::RangeInclusive<u64>) {
    for broken in broken_guards(scene) {
        assert_eq!((broken.guard, broken.sphere), (guard, sphere), "{broken}");
        assert!(steps.contains(&broken.step), "{broken}");
        assert!((broken.time - broken.step as f64 * scene.time.dt).abs() < 1e-12);
        let text = broken.to_string();
        assert!(text.contains(&format!("step {}", broken.step)), "{text}");
        assert!(text.contains(&format!("sphere {sphere}")), "{text}");
    }
}

#[test]
fn coincident_centres_break_the_overlap_guard() {
    let far = sphere([1.0, 0.0, 0.0], [0.0; 3]);
    let here = sphere([0.0; 3], [0.0; 3]);
    for friction in frictions() {
        let scene = cluster(
            vec![far.clone(), here.clone(), here.clone()],
            friction,
            1e-5,
        );
        assert_broken(&scene, Guard::Overlap, 1, 1..=1);
    }
}

#[test]
fn a_sphere_pressed_deep_breaks_the_overlap_guard() {
    let slow = sphere([0.0, 0.5, 0.004], [0.0; 3]);
    // Fast enough to cross the floor, slow enough for the displacement guard.
    let fast = sphere([0.0, 0.0, 0.01], [0.0, 0.0, -300.0]);
    let mut scene = cluster(vec![slow, fast], None, 1e-5);
    scene.tank = toml::from_str("floor = 0.0").unwrap();
    assert_broken(&scene, Guard::Overlap, 1, 2..=10);
}

#[test]
fn a_sphere_that_tunnels_breaks_the_displacement_guard() {
    let still = sphere([0.0; 3], [0.0; 3]);
    let fast = sphere([-1.0, 0.0, 0.0], [801.0, 0.0, 0.0]);
    let scene = cluster(vec![still, fast], None, 1e-5);
    assert_broken(&scene, Guard::Displacement, 1, 1..=1);
}

/// The halves of a step of velocity Verlet are done together where steps follow one another.
#[test]
fn who_grows_too_fast_is_named_with_the_same_step_however_a_run_is_cut() {
    let still = sphere([0.0; 3], [0.0; 3]);
    let mut steps = std::collections::BTreeSet::new();
    for excess in 0..8 {
        let fast = sphere(
            [-1.0, 0.1, 0.0],
            [0.0, 0.0, -390.0 - 0.27 * f64::from(excess)],
        );
        let mut scene = cluster(vec![still.clone(), fast], None, 1e-5);
        scene.dem.effects.gravity = Some(toml::from_str("acceleration = 2e4").unwrap());
        for integrator in INTEGRATORS {
            scene.time.integrator = integrator;
            let mut simulation = DemSimulation::new(&scene).unwrap();
            let whole = simulation.advance(1000).unwrap_err();
            // A state of an earlier moment would pass for a sound one.
            assert_eq!(simulation.step(), whole.step);
            assert_eq!(whole.guard, Guard::Displacement, "{whole}");
            for length in [1, 7] {
                let mut simulation = DemSimulation::new(&scene).unwrap();
                let broken = (0..1000).find_map(|_| simulation.advance(length).err());
                assert_eq!(broken.as_ref(), Some(&whole), "cut after {length} steps");
                assert_eq!(simulation.step(), whole.step);
            }
            steps.insert(whole.step % 7);
        }
    }
    assert!(steps.len() > 1, "all at the same place of a cut");
}

#[test]
fn a_sphere_that_leaves_breaks_the_bounds() {
    let still = sphere([0.0; 3], [0.0; 3]);
    let leaving = sphere([0.0, 0.0, 0.1], [0.0, 10.0, 0.0]);
    for contact in [true, false] {
        let mut scene = cluster(vec![still.clone(), leaving.clone()], None, 1e-5);
        scene.dem.guards.horizontal = Some(0.05);
        if !contact {
            scene.dem.contact = None;
        }
        // Found when the list is built, or when the run stops to look.
        assert_broken(&scene, Guard::OutOfBounds, 1, 500..=10_000);
    }
}

#[test]
fn what_is_not_a_number_is_named_at_once() {
    let still = sphere([0.0; 3], [0.0; 3]);
    let low = sphere([0.0, 0.1, -1.0], [0.0; 3]);
    let mut scene = cluster(vec![still, low], None, 1e-5);
    scene.dem.effects.drag = toml::from_str("law = \"constant\"\nlinear = 1e-3").unwrap();
    // Without strength, but the exponential so far below its origin is infinite.
    scene.dem.effects.updraught =
        toml::from_str("speed = 1.0\nstrength = 0.0\ndecay = 1e6\norigin = 0.0\nalpha = 0.5")
            .unwrap();
    assert_eq!(scene.problems().len(), 0);
    assert_broken(&scene, Guard::NotANumber, 1, 1..=1);
}

/// Symptom: the energy of a run was not a number, and the run went on. Cause: spins were only
/// looked at where spheres touch.
#[test]
fn a_spin_that_grows_without_end_is_reported() {
    let still = sphere([0.0; 3], [0.0; 3]);
    let mut spinning = sphere([0.0, 0.1, 0.0], [0.0; 3]);
    spinning.spin = [0.0, 0.0, 1.0];
    let mut scene = cluster(vec![still, spinning], frictions()[3].clone(), 1e-5);
    scene.dem.effects.spin_damping = Some(phase::scene::SpinDamping { coefficient: 0.01 });
    scene.time.dt = 3.0 * timestep::largest_stable(&scene).unwrap().seconds;
    assert_broken(&scene, Guard::NotANumber, 1, 500..=10_000);
}

/// Symptom: a panic. Cause: the damping of spins asked for those of spheres that have none, as
/// nothing turns them.
#[test]
fn spin_damping_without_friction_does_nothing() {
    let spheres = vec![
        sphere([0.0; 3], [0.1, 0.0, 0.0]),
        sphere([0.0085, 0.0, 0.0], [0.0; 3]),
    ];
    let mut scene = cluster(spheres, None, 1e-5);
    let expected = run(&scene, STEPS).bits();
    scene.dem.effects.spin_damping = Some(phase::scene::SpinDamping { coefficient: 1e-6 });
    assert!(run(&scene, STEPS).bits() == expected);
}

#[test]
fn sound_scenes_break_no_guard() {
    for scene in tanks() {
        DemSimulation::new(&scene).unwrap().advance(STEPS).unwrap();
    }
}

/// Magnitudes from the ordinary to the absurd, zero and both signs.
fn odd_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1.0..1.0_f64,
        2 => Just(0.0),
        1 => Just(-0.0),
        1 => prop::sample::select(vec![1e-300, 5e-324, 1e300, f64::MAX, 1e20, -1e20, -1e300]),
    ]
}

fn odd_size() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => 1e-3..1e-1_f64,
        1 => prop::sample::select(vec![1e-300, 5e-324, 1e-12, 1e3, 1e20, 1e150, f64::MAX]),
    ]
}

fn odd_sphere() -> impl Strategy<Value = StartSphere> {
    let triple = || prop::array::uniform3(odd_number());
    let position = prop_oneof![
        3 => prop::array::uniform3(-0.05..0.05_f64),
        1 => (-0.05..0.05_f64).prop_map(|z| [0.0, 0.0, z]),
        1 => triple(),
    ];
    (position, triple(), triple(), prop::option::of(odd_size())).prop_map(
        |(position, velocity, spin, radius)| StartSphere {
            position,
            velocity,
            spin,
            radius,
        },
    )
}

fn odd_friction() -> impl Strategy<Value = Option<Friction>> {
    prop_oneof![
        Just(None),
        odd_size().prop_map(|coefficient| Some(Friction::Spin(Spin { coefficient }))),
        (odd_size(), odd_size()).prop_map(|(coefficient, regularisation)| Some(Friction::Coulomb(
            Coulomb {
                coefficient,
                regularisation
            }
        ))),
        (prop::sample::select(vec![0.0, 0.3, 1e300]), any::<bool>()).prop_map(
            |(coefficient, rescale)| Some(Friction::Mindlin(Mindlin {
                coefficient,
                rescale
            }))
        ),
    ]
}

fn odd_scene() -> impl Strategy<Value = Scene> {
    let spheres = prop::collection::vec(odd_sphere(), 1..6);
    let tables = prop::array::uniform8(any::<bool>());
    let sizes = prop::array::uniform8(odd_size());
    (spheres, odd_friction(), tables, sizes, odd_number()).prop_map(
        |(
            spheres,
            friction,
            [floor, cylinder, gravity, air, lift, damping, verlet, loose],
            size,
            number,
        )| {
            let mut scene = cluster(spheres, friction, 1e-4);
            scene.spheres.density = size[0];
            scene.tank = Some(phase::scene::Tank {
                radius: cylinder.then_some(size[1]),
                floor: floor.then_some(number),
                ..phase::scene::Tank::default()
            });
            scene.dem.effects.gravity =
                gravity.then(|| toml::from_str("acceleration = 0.0").unwrap());
            if let Some(gravity) = &mut scene.dem.effects.gravity {
                gravity.acceleration = if loose { 0.0 } else { size[2] };
            }
            if air || lift {
                scene.dem.effects.drag =
                    toml::from_str("law = \"diameter\"\nlinear = 1e-3").unwrap();
                if let Some(drag) = &mut scene.dem.effects.drag {
                    drag.quadratic = size[3];
                }
            }
            scene.dem.effects.swirl = air.then_some(phase::scene::Swirl { omega: number });
            scene.dem.effects.updraught = lift.then_some(phase::scene::Updraught {
                reference_omega: None,
                speed: number,
                strength: size[4],
                decay: size[5],
                origin: number,
                alpha: 0.5,
            });
            scene.dem.effects.spin_damping = damping.then_some(phase::scene::SpinDamping {
                coefficient: size[6],
            });
            scene.time.integrator = INTEGRATORS[usize::from(verlet)];
            if loose {
                scene.dem.guards.displacement = f64::MAX;
                scene.dem.guards.overlap = f64::MAX;
            }
            scene
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn odd_scenes_run_or_name_what_broke(scene in odd_scene()) {
        let mut simulation = DemSimulation::new(&scene).unwrap();
        for _ in 0..20 {
            if let Err(broken) = simulation.advance(1) {
                prop_assert!(broken.sphere < scene.spheres.count);
                prop_assert!(broken.step == simulation.step());
                return Ok(());
            }
            simulation.elastic_energy();
            simulation.frame();
        }
        for position in &simulation.particles().position {
            prop_assert!(!position.norm_squared().is_nan(), "{position:?}");
        }
    }

    #[test]
    fn random_starts_of_odd_size_run_or_are_refused(
        count in 1_usize..5,
        radius in odd_size(),
        tank in odd_size(),
        heights in prop::array::uniform2(odd_number()),
        speed in odd_size(),
    ) {
        let mut scene = cluster(Vec::new(), None, 1e-4);
        scene.spheres.count = count;
        scene.spheres.radius = phase::scene::Radii::One(radius);
        scene.tank = Some(phase::scene::Tank {
                radius: Some(tank),
                ..phase::scene::Tank::default()
            });
        scene.start = phase::scene::Start::Random { x: None, y: None,
            z_min: heights[0].min(heights[1]),
            z_max: heights[0].max(heights[1]),
            speed,
            spin: 0.0,
        };
        if let Ok(mut simulation) = DemSimulation::new(&scene) {
            let _ = simulation.advance(10);
        }
    }
}
