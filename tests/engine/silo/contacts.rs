//! The linear contact and its friction.

use super::hopper;
use phase::dem::DemSimulation;
use phase::particles::vector::Vector;
use phase::scene::Scene;

/// Grains in empty space.
fn free(spheres: &str, contact: &str, friction: &str) -> Scene {
    let count = spheres.matches("position").count();
    let text = format!(
        r#"
        spheres = {{ count = {count}, radius = 0.04, density = 1.0, shape = "disc" }}
        contact = {{ law = "linear", stiffness = 100.0, {contact} }}
        {friction}
        start = {{ kind = "list", spheres = [{spheres}] }}
        time = {{ dt = 1e-3, duration = 1.0, frame_interval = 0.1, integrator = "velocity-verlet" }}
        "#
    );
    phase::scene::Scene::from_toml(&text, std::path::Path::new("free.toml"))
        .unwrap_or_else(|error| panic!("{error}"))
}

/// The five steps of the document, written down as they are printed, for two grains of mass m.
fn five_steps(mut x: [Vector; 2], mut v: [Vector; 2], steps: usize) -> ([Vector; 2], [Vector; 2]) {
    let (dt, mass, radius, k, b) = (1e-3, 1.0 * 0.04 * 0.04, 0.04, 100.0, 0.05);
    let force = |x: [Vector; 2], v: [Vector; 2]| {
        let offset = x[0] - x[1];
        let distance = offset.norm();
        let overlap = 2.0 * radius - distance;
        if overlap <= 0.0 {
            return Vector::ZERO;
        }
        offset * (k * overlap / distance) - (v[0] - v[1]) * b
    };
    let mut a = [Vector::ZERO; 2];
    for _ in 0..steps {
        let half = [0, 1].map(|i| v[i] + a[i] * (0.5 * dt));
        x = [0, 1].map(|i| x[i] + v[i] * dt + a[i] * (0.5 * dt * dt));
        let on_first = force(x, half);
        a = [on_first * (1.0 / mass), on_first * (-1.0 / mass)];
        v = [0, 1].map(|i| half[i] + a[i] * (0.5 * dt));
    }
    (x, v)
}

#[test]
fn steps_are_the_five_of_the_document() {
    // An oblique impact, with the drag on the whole relative velocity.
    let scene = free(
        "{ position = [0.0, 0.0, 0.0], velocity = [1.0, 0.0, 0.3] }, { position = [0.1, 0.0, 0.03] }",
        r#"damping = 0.05, drag = "whole""#,
        "",
    );
    let mut simulation = DemSimulation::new(&scene).unwrap();
    let start = [Vector::ZERO, Vector::new(0.1, 0.0, 0.03)];
    let mut touched = false;
    for steps in [10, 30, 60] {
        let before = simulation.step();
        simulation.advance(steps - before).unwrap();
        let (x, v) = five_steps(
            start,
            [Vector::new(1.0, 0.0, 0.3), Vector::ZERO],
            steps as usize,
        );
        let particles = simulation.particles();
        for i in 0..2 {
            assert!(
                (particles.position[i] - x[i]).norm() < 1e-14,
                "step {steps}"
            );
            assert!(
                (particles.velocity[i] - v[i]).norm() < 1e-13,
                "step {steps}"
            );
        }
        touched |= v[1].x > 0.1;
    }
    assert!(touched);
}

#[test]
fn momentum_is_kept_and_angular_momentum_but_for_the_drag_between_centres() {
    let spheres = "{ position = [0.0, 0.0, 0.0], velocity = [1.0, 0.0, 0.4] }, \
                   { position = [0.1, 0.0, 0.05] }, { position = [0.16, 0.0, 0.0], velocity = [-1.0, 0.0, 0.2] }";
    let frictions = [
        "",
        r#"friction = { law = "cundall-strack", coefficient = 0.5, stiffness = 70.0, damping = 0.01 }"#,
        r#"friction = { law = "coulomb", coefficient = 0.5, regularisation = 0.05 }"#,
    ];
    for friction in frictions {
        let scene = free(spheres, "damping = 0.05", friction);
        let mut simulation = DemSimulation::new(&scene).unwrap();
        let momenta = |simulation: &DemSimulation| {
            let particles = simulation.particles();
            let (mut linear, mut angular) = (Vector::ZERO, 0.0);
            for i in 0..particles.len() {
                let (x, v) = (
                    particles.position[i],
                    particles.velocity[i] * particles.mass[i],
                );
                linear += v;
                angular += x.z * v.x - x.x * v.z;
                if let (Some(spin), Some(inertia)) =
                    (particles.spin.get(i), particles.inertia.get(i))
                {
                    angular += inertia * spin.y;
                }
            }
            (linear, angular)
        };
        let (linear, angular) = momenta(&simulation);
        simulation.advance(400).unwrap();
        let (after, turned) = momenta(&simulation);
        assert!((after - linear).norm() < 1e-16, "{friction}");
        // Velocities and positions are half a step apart in a force: of the step's own order.
        assert!(
            (turned - angular).abs() < 2e-3 * angular.abs(),
            "{friction}: {turned} {angular}"
        );
        assert!(simulation.particles().position.iter().all(|x| x.y == 0.0));
    }
}

/// The linear contact attracts at the end of a contact. Friction capped by a negative normal force
/// would drive the sliding.
#[test]
fn friction_never_drives() {
    for friction in [
        r#"friction = { law = "coulomb", coefficient = 0.03, regularisation = 1e-3 }"#,
        r#"friction = { law = "cundall-strack", coefficient = 0.03, stiffness = 70.0 }"#,
    ] {
        let mut scene = free(
            "{ position = [0.0, 0.0, 0.0], velocity = [2.0, 0.0, 0.0] }, { position = [0.0801, 0.0, 0.0], spin = [0.0, 20.0, 0.0] }",
            "damping = 0.2",
            friction,
        );
        scene.time.dt = 5e-6;
        let mut simulation = DemSimulation::new(&scene).unwrap();
        // Speed of one surface along the other; the line of centres turns by less than a hundredth.
        let sliding = |simulation: &DemSimulation| {
            let particles = simulation.particles();
            let [one, other] = [0, 1].map(|i| (particles.velocity[i].z, particles.spin[i].y));
            (one.0 - other.0 - 0.04 * (one.1 + other.1)).abs()
        };
        // A spring along the contact may swing; a slider only slows down.
        let swings = friction.contains("stiffness");
        let start = sliding(&simulation);
        let mut least = start;
        for _ in 0..20_000 {
            simulation.advance(1).unwrap();
            let now = sliding(&simulation);
            let rises = now > least + 5e-3 * start;
            assert!(swings || !rises, "step {}: {now} m/s", simulation.step());
            least = least.min(now);
        }
        let end = sliding(&simulation);
        assert!(end < 0.9 * start, "{end} of {start} m/s are left");
    }
}

#[test]
fn a_heavier_grain_with_a_stiffer_spring_moves_in_the_same_way() {
    // By a power of two, with which every product is exact: the same bits.
    let one = (
        "[{ radius = 0.04, share = 1 }, { radius = 0.03, share = 1 }]",
        "0.04",
    );
    let still = ("spread = 0.1", "spread = 0.0");
    // Off the middle, where grains would stand upon each other.
    let aside = ("position = [0.0, 0.0, 1.4]", "position = [0.013, 0.0, 1.4]");
    let light = hopper(&[one, still, aside]);
    let heavy = hopper(&[
        one,
        still,
        aside,
        ("density = 1.0", "density = 64.0"),
        (
            "stiffness = 100.0, damping = 0.05",
            "stiffness = 6400.0, damping = 3.2",
        ),
        (
            "stiffness = 70.0, damping = 0.02",
            "stiffness = 4480.0, damping = 1.28",
        ),
        ("kinetic_energy = 1e-4", "kinetic_energy = 64e-4"),
    ]);
    let [mut light, mut heavy] = [light, heavy].map(|scene| DemSimulation::new(&scene).unwrap());
    // Filled at 3 s, at rest, open, and half empty.
    for _ in 0..16 {
        light.advance(1000).unwrap();
        heavy.advance(1000).unwrap();
        let bits = |simulation: &DemSimulation| {
            let position = simulation.particles().position.clone();
            let numbers = position.into_iter().flat_map(|it| [it.x, it.z]);
            numbers.map(f64::to_bits).collect::<Vec<_>>()
        };
        assert!(bits(&light) == bits(&heavy), "at {} s", light.time());
    }
    assert!(light.counts().unwrap().discharged > 0);
}

#[test]
fn a_heap_with_friction_stays_where_it_is() {
    // Without regularisation there is no creep: after the grains are at rest, none moves any more.
    let scene = hopper(&[("door = {}", "door = { opens = 29.0 }")]);
    let mut simulation = DemSimulation::new(&scene).unwrap();
    simulation.advance(20_000).unwrap();
    let place = |simulation: &DemSimulation| simulation.particles().position.clone();
    let before = place(&simulation);
    simulation.advance(20_000).unwrap();
    for (now, before) in place(&simulation).iter().zip(&before) {
        assert!((*now - *before).norm() < 1e-4, "{now:?} {before:?}");
    }
}
