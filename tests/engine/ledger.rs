//! The energy balance: it closes, it names what is dissipated, and it changes nothing.

use crate::scenes::{INTEGRATORS, frictions, tank, water};
use crate::support::Workplace;
use phase::observe::Observations;
use phase::record::{Outcome, RunRecord};
use phase::run;
use phase::scene::{CundallStrack, Friction, Integrator, Scene};
use std::ops::ControlFlow;

fn observe(scene: &Scene) -> RunRecord {
    let record = run::run(scene, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(record.outcome, Outcome::Completed);
    record
}

pub(crate) fn with_ledger(scene: &Scene) -> Observations {
    let mut scene = scene.clone();
    scene.output.ledger = true;
    observe(&scene).observations
}

pub(crate) fn last(values: &[f32]) -> f64 {
    f64::from(*values.last().unwrap())
}

pub(crate) fn largest(values: &[f32]) -> f64 {
    values
        .iter()
        .fold(0.0, |most, value| f64::from(value.abs()).max(most))
}

fn scene(text: &str, integrator: Integrator) -> Scene {
    let mut scene: Scene = toml::from_str(text).unwrap();
    scene.time.integrator = integrator;
    scene
}

/// A sphere that hits the floor once at 1 m/s, and sticks or slides.
fn impact(integrator: Integrator, friction: &str) -> Scene {
    let text = format!(
        r#"
        spheres = {{ count = 1, radius = 0.004, density = 1e4 }}
        contact.law = "hertz"
        contact.young_modulus = 2e5
        contact.poisson_ratio = 0.3
        contact.dissipation_time = 2e-4
        {friction}
        tank = {{ floor = 0.0 }}
        start.kind = "list"
        start.spheres = [
            {{ position = [0, 0, 0.0041], velocity = [0.5, 0, -1], spin = [0, 20, 5] }},
        ]
        time = {{ dt = 1e-5, duration = 0.02, frame_interval = 1e-3 }}
        "#
    );
    scene(&text, integrator)
}

#[test]
fn asking_for_the_books_changes_no_bit() {
    for friction in frictions() {
        for integrator in INTEGRATORS {
            let mut scene = tank(friction.clone(), integrator);
            scene.time.duration = 0.05;
            let plain = observe(&scene);
            scene.output.ledger = true;
            let kept = observe(&scene);
            assert_eq!(
                plain.snapshots, kept.snapshots,
                "{friction:?} {integrator:?}"
            );
            assert_eq!(plain.observations.elastic, kept.observations.elastic);
            assert!(plain.observations.residual.is_empty());
            assert_eq!(scene.identity(), plain.scene.identity());
        }
    }
}

/// What an impact loses is in the balance: kinetic energy before less that after.
#[test]
fn damping_and_friction_are_told_apart() {
    let laws = [
        "",
        "friction = { law = 'coulomb', coefficient = 0.3, regularisation = 1e-4 }",
        "friction = { law = 'mindlin', coefficient = 0.3 }",
        "friction = { law = 'mindlin', coefficient = 5.0 }",
    ];
    for integrator in INTEGRATORS {
        for law in laws {
            let books = with_ledger(&impact(integrator, law));
            let kinetic =
                |frame: usize| f64::from(books.kinetic[frame]) + f64::from(books.rotational[frame]);
            let (start, end) = (kinetic(0), kinetic(books.frames() - 1));
            let (damping, friction) = (
                last(&books.dissipated_by_damping),
                last(&books.dissipated_by_friction),
            );
            assert!(
                (start - end - damping - friction).abs() < 1e-4 * start,
                "{law}"
            );
            // The normal motion loses what it does without friction: 1 - e^2 of m v^2 / 2.
            let frictionless = with_ledger(&impact(integrator, ""));
            let expected = last(&frictionless.dissipated_by_damping);
            assert!(
                (damping / expected - 1.0).abs() < 1e-6,
                "{law} {damping} {expected}"
            );
            assert!(
                (law.is_empty() && friction == 0.0)
                    || friction > 0.01 * start
                    || law.contains("5.0")
            );
        }
    }
}

/// The same under the laws whose damping grows with the masses and attracts at the end.
#[test]
fn the_books_know_contacts_that_attract() {
    let laws = [
        "contact = { law = 'silbert', stiffness = 1e6, damping = 2e5 }
        friction = { law = 'silbert', coefficient = 0.3, stiffness = 3e5, damping = 1e5 }",
        "contact = { law = 'hooke', stiffness = 1e3, damping_rate = 400.0 }
        friction = { law = 'hooke', coefficient = 0.3, stiffness = 3e2, damping_rate = 2e2 }",
        "contact = { law = 'tsuji', young_modulus = 1e6, poisson_ratio = 0.3, restitution = 0.6 }
        friction = { law = 'mindlin', coefficient = 0.3 }",
    ];
    let frictionless = laws.iter().filter_map(|laws| laws.lines().next());
    let laws: Vec<_> = laws.into_iter().chain(frictionless).collect();
    for integrator in INTEGRATORS {
        for laws in &laws {
            let text = format!(
                r#"
                spheres = {{ count = 2, radius = 0.004, density = 2500.0 }}
                {laws}
                start.kind = "list"
                start.spheres = [
                    {{ position = [0, 0, 0], velocity = [0.5, 0, 0.3] }},
                    {{ position = [0.0081, 0, 0] }},
                ]
                time = {{ dt = 1e-6, duration = 0.01, frame_interval = 1e-3 }}
                "#
            );
            let books = with_ledger(&scene(&text, integrator));
            let kinetic =
                |frame: usize| f64::from(books.kinetic[frame]) + f64::from(books.rotational[frame]);
            let lost = kinetic(0) - kinetic(books.frames() - 1);
            let (damping, rubbed) = (
                last(&books.dissipated_by_damping),
                last(&books.dissipated_by_friction),
            );
            assert!(
                (lost - damping - rubbed).abs() < 1e-3 * lost,
                "{laws} {integrator:?} {lost} {damping} {rubbed}"
            );
            assert!(damping > 0.1 * lost);
            assert!(laws.contains("friction") == (rubbed != 0.0));
        }
    }
}

/// A sphere that slides until it rolls gives 2/7 of its energy to friction.
#[test]
fn sliding_into_rolling_costs_two_sevenths() {
    for integrator in INTEGRATORS {
        for law in [
            "{ law = 'coulomb', coefficient = 0.3, regularisation = 1e-4 }",
            "{ law = 'mindlin', coefficient = 0.3 }",
        ] {
            let text = format!(
                r#"
                spheres = {{ count = 1, radius = 0.004, density = 1e4 }}
                contact.law = "hertz"
                contact.young_modulus = 2e6
                contact.poisson_ratio = 0.3
                contact.dissipation_time = 1e-4
                friction = {law}
                tank = {{ floor = 0.0 }}
                gravity = {{ acceleration = 9.81 }}
                start.kind = "list"
                start.spheres = [
                    {{ position = [0.0, 0.0, 0.0039568424], velocity = [1.0, 0.0, 0.0] }},
                ]
                time = {{ dt = 1e-5, duration = 0.2, frame_interval = 1e-2 }}
                "#
            );
            let books = with_ledger(&scene(&text, integrator));
            let share = last(&books.dissipated_by_friction) / f64::from(books.kinetic[0]);
            assert!(
                (share - 2.0 / 7.0).abs() < 2e-3,
                "{law} {integrator:?} {share}"
            );
        }
    }
}

/// The air's work is what a free sphere gains, gravity's apart.
#[test]
fn the_work_of_the_air_is_what_a_sphere_gains() {
    for integrator in INTEGRATORS {
        let text = r#"
            spheres = { count = 2, radius = 0.004, density = 1e3 }
            gravity = { acceleration = 9.8 }
            drag = { law = "constant", linear = 2e-4, quadratic = 5e-3 }
            swirl = { omega = 20.0 }
            start.kind = "list"
            start.spheres = [
                { position = [0.1, 0.0, 0.0], velocity = [1.0, 0.0, 2.0] },
                { position = [-0.2, 0.0, 0.5] },
            ]
            time = { dt = 1e-4, duration = 0.5, frame_interval = 0.1 }
        "#;
        let books = with_ledger(&scene(text, integrator));
        let energy =
            |frame: usize| f64::from(books.kinetic[frame]) + f64::from(books.gravitational[frame]);
        let gained = energy(books.frames() - 1) - energy(0);
        let air = last(&books.work_of_air);
        let tolerance = if integrator == Integrator::SymplecticEuler {
            2e-3
        } else {
            1e-5
        };
        assert!(
            (gained / air - 1.0).abs() < tolerance,
            "{integrator:?} {gained} {air}"
        );
    }
}

/// In water the balance closes too: buoyancy has a potential, and the water that moves with spheres
/// has kinetic energy.
#[test]
fn the_books_close_in_water() {
    for integrator in INTEGRATORS {
        let mut water = water(integrator);
        water.time.duration = 0.2;
        let books = with_ledger(&water);
        let turnover = last(&books.dissipated_by_damping) + last(&books.work_of_air).abs();
        let residual = largest(&books.residual);
        assert!(
            residual < 5e-3 * turnover && residual > 0.0,
            "{integrator:?}: {residual} of {turnover}"
        );
    }
}

/// Without drag nothing is lost: what a light sphere gains in speed, its water's included, it gains
/// from the water that sinks as it rises.
#[test]
fn a_light_sphere_rises_on_the_energy_of_its_fluid() {
    for integrator in INTEGRATORS {
        let text = r#"
            spheres = { count = 1, radius = 0.01, density = 50.0 }
            gravity = { acceleration = 9.81, tilt = 0.2 }
            buoyancy = { density = 1000.0 }
            added_mass = { density = 1000.0 }
            start.kind = "list"
            start.spheres = [{ position = [0.0, 0.0, 0.0], velocity = [0.3, 0.0, -0.5] }]
            time = { dt = 1e-5, duration = 0.5, frame_interval = 0.1 }
        "#;
        let books = with_ledger(&scene(text, integrator));
        let mass = 4.0 / 3.0 * std::f64::consts::PI * 1e-6 * 50.0;
        let expected = 0.5 * (mass * 11.0) * (0.3 * 0.3 + 0.5 * 0.5);
        assert!((f64::from(books.kinetic[0]) / expected - 1.0).abs() < 1e-6);
        let change = last(&books.kinetic) - f64::from(books.kinetic[0]);
        let drop = last(&books.gravitational) - f64::from(books.gravitational[0]);
        assert!(change > 1.0 * mass && (change / -drop - 1.0).abs() < 1e-3);
        assert!(largest(&books.residual) < 1e-4 * change, "{integrator:?}");
        assert_eq!(last(&books.work_of_air), 0.0);
    }
}

/// The residual shrinks with the order of the integrator: halving the step divides it by two for
/// symplectic Euler and by four for the others. A contact that lasts, on which a sphere bounces,
/// sticks and turns in moving air.
#[test]
fn the_residual_has_the_order_of_the_integrator() {
    for integrator in INTEGRATORS {
        let residual = |dt: f64| {
            let text = format!(
                r#"
                spheres = {{ count = 1, radius = 0.004, density = 1e4 }}
                contact.law = "hertz"
                contact.young_modulus = 2e5
                contact.poisson_ratio = 0.3
                contact.dissipation_time = 2e-4
                friction = {{ law = "mindlin", coefficient = 0.9 }}
                tank = {{ floor = 0.0 }}
                gravity = {{ acceleration = 200.0 }}
                drag = {{ law = "constant", linear = 2e-3, quadratic = 5e-2 }}
                swirl = {{ omega = 30.0 }}
                start.kind = "list"
                start.spheres = [
                  {{ position = [0.1, 0, 0.0036], velocity = [0.03, -0.02, 0], spin = [2, 1, 3] }},
                ]
                time = {{ dt = {dt}, duration = 0.01, frame_interval = 1e-4 }}
                "#
            );
            largest(&with_ledger(&scene(&text, integrator)).residual)
        };
        let order = libm::log2(residual(2e-5) / residual(1e-5));
        let expected = match integrator {
            Integrator::SymplecticEuler => 1.0,
            _ => 2.0,
        };
        assert!((order - expected).abs() < 0.15, "{integrator:?}: {order}");
    }
}

/// The largest residual of the books of a tank, which is a small part of what was dissipated.
pub(crate) fn check_residual(books: &Observations, integrator: Integrator) -> f64 {
    let turnover = last(&books.dissipated_by_damping) + last(&books.work_of_air).abs();
    let residual = largest(&books.residual);
    let share = match integrator {
        Integrator::SymplecticEuler => 2e-2,
        _ => 2e-3,
    };
    assert!(
        residual < share * turnover,
        "{integrator:?}: {residual} of {turnover}"
    );
    residual
}

/// In a tank with every effect the balance closes: the residual is a small part of what was
/// dissipated.
#[test]
fn the_books_of_a_tank_close() {
    for friction in frictions() {
        for integrator in INTEGRATORS {
            let mut scene = tank(friction.clone(), integrator);
            scene.time.dt = 2e-5;
            let books = with_ledger(&scene);
            let residual = check_residual(&books, integrator);
            assert!(residual > 0.0);
            assert!(
                books
                    .dissipated_by_damping
                    .windows(2)
                    .all(|pair| pair[1] >= pair[0])
            );
        }
    }
}

/// Where spheres come and go, what they bring and take is in the balance.
#[test]
fn the_books_of_a_silo_close() {
    for integrator in INTEGRATORS {
        let mut silo = scene(&crate::support::silo_file(), integrator);
        silo.dem.friction = Some(Friction::CundallStrack(CundallStrack {
            coefficient: 0.5,
            stiffness: 50.0,
            damping: 0.01,
        }));
        silo.time.dt = 2.5e-4;
        let books = with_ledger(&silo);
        assert!(last(&books.discharged) > 0.0);
        let turnover = last(&books.dissipated_by_damping) + last(&books.dissipated_by_friction);
        let residual = largest(&books.residual);
        assert!(largest(&books.energy_brought) > turnover);
        let share = match integrator {
            Integrator::SymplecticEuler => 2e-2,
            _ => 5e-3,
        };
        assert!(
            residual < share * turnover,
            "{integrator:?}: {residual} of {turnover}"
        );
    }
}

/// Through the program: asked for by a flag, drawn from the record, named where it is missing.
#[test]
fn the_program_keeps_and_draws_the_books() {
    let place = Workplace::new();
    place.write("scene.toml", &crate::support::scene_file());
    let run = |more: &[&str]| {
        let arguments = [&["run", "scene.toml", "--out", "run.h5"], more].concat();
        place.phase(&arguments).code(0)
    };
    assert!(run(&["--ledger"]).stdout.contains("residual"));
    place
        .phase(&["plot", "run.h5"])
        .code(0)
        .says("run-ledger.svg");
    let picture = place.read("run-ledger.svg");
    for word in ["dissipated by damping", "residual", "symplectic-euler"] {
        assert!(picture.contains(word), "{word}");
    }
    assert!(!run(&[]).stdout.contains("residual"));
    place
        .phase(&["plot", "run.h5", "--figure", "ledger"])
        .complains("ledger = true");
}
