use super::*;
use crate::scene::Contact;
use crate::scene::{Scene, Shape};
use std::path::Path;

fn close(found: f64, expected: f64, tolerance: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error < tolerance, "{found:e} instead of {expected:e}");
}

fn impact_at_one_metre_per_second(young_modulus: f64, density: f64) -> Impact {
    let mass = Shape::Sphere.mass(density, 0.004);
    Impact::of_equal_spheres(0.004, mass, young_modulus, 0.3, 1.0)
}

#[test]
fn limits_of_a_soft_and_of_a_steel_pair() {
    // Pair limit, Rayleigh time and twelve contacts (s), to the four digits they are known to.
    let cases = [
        (2e5, 1e4, 3.370e-3, 4.895e-3, 1.376e-3),
        (2.1e11, 7850.0, 1.194e-5, 4.233e-6, 4.876e-6),
    ];
    for (young_modulus, density, pair, rayleigh, twelve) in cases {
        let impact = impact_at_one_metre_per_second(young_modulus, density);
        close(2.0 / impact.angular_frequency(), pair, 5e-4);
        close(impact.contact_time() / 2.015, pair, 5e-4);
        close(
            rayleigh_time(0.004, density, young_modulus, 0.3),
            rayleigh,
            5e-4,
        );
        close(
            2.0 / (6.0_f64.sqrt() * impact.angular_frequency()),
            twelve,
            5e-4,
        );
    }
}

#[test]
fn elastic_impacts_of_known_materials() {
    // Set-ups of Chung and Ooi (2011): overlap (um), force (N), contact time (us).
    let mass = Shape::Sphere.mass(2800.0, 0.01);
    let glass = Impact::of_equal_spheres(0.01, mass, 48e9, 0.2, 20.0);
    let aluminium_on_rigid_wall = Impact {
        effective_mass: Shape::Sphere.mass(2699.0, 0.1),
        stiffness: 4.0 / 3.0 * 70e9 / (1.0 - 0.3 * 0.3) * 0.1_f64.sqrt(),
        speed: 0.2,
    };
    let cases = [
        (glass, 274.1127, 10_696.889, 40.339_456),
        (aluminium_on_rigid_wall, 49.717_175, 11_369.858, 731.656_64),
    ];
    for (impact, overlap, force, time) in cases {
        close(1e6 * impact.deepest_overlap(), overlap, 1e-6);
        close(impact.largest_force(), force, 1e-6);
        close(1e6 * impact.contact_time(), time, 1e-6);
    }
}

/// Two spheres that meet at 1 m/s, with further `tables`.
fn pair(tables: &str) -> Scene {
    let text = format!(
        "{tables}
        [spheres]
        count = 2
        radius = 0.004
        density = 1e4
        [start]
        kind = 'list'
        spheres = [
            {{ position = [0, 0, 0], velocity = [0.5, 0, 0] }},
            {{ position = [1, 0, 0], velocity = [-0.5, 0, 0] }},
        ]
        [time]
        dt = 1e-7
        duration = 1
        frame_interval = 1e-3"
    );
    Scene::from_toml(&text, Path::new("pair.toml")).unwrap_or_else(|error| panic!("{error}"))
}

fn hertz(dissipation: &str) -> String {
    format!(
        "contact = {{ law = 'hertz', young_modulus = 2e5, poisson_ratio = 0.3, {dissipation} }}\n"
    )
}

#[test]
fn the_scene_decides_which_limits_there_are() {
    assert_eq!(limits(&pair("")), []);
    assert_eq!(largest_stable(&pair("")), None);
    let names =
        |scene: &Scene| -> Vec<&str> { limits(scene).iter().map(|limit| limit.name).collect() };
    let elastic = pair(&hertz("dissipation_time = 0"));
    assert_eq!(
        names(&elastic),
        [
            "contact",
            "twelve contacts",
            "displacement",
            "Rayleigh time"
        ]
    );
    close(largest_stable(&elastic).unwrap().seconds, 3.370e-3, 5e-4);
    let damped = pair(&hertz("dissipation_time = 1e-3"));
    // Six times as stiff and as damped as the pair.
    let [one, twelve] = ["contact", "twelve contacts"].map(|name| {
        let all = limits(&damped);
        let found = all.iter().find(|limit| limit.name == name);
        found.unwrap().seconds
    });
    let frequency = 2.0 / one;
    let sum = 6.0 * frequency * frequency * twelve * (twelve + 4.0 / 3.0 * 1e-3);
    close(sum, 4.0, 1e-12);
    assert_eq!(largest_stable(&damped).unwrap().name, "damped contact");
    let mindlin = "friction = { law = 'mindlin', coefficient = 0.3 }\n";
    let sticking = pair(&(hertz("dissipation_time = 0") + mindlin));
    assert_eq!(largest_stable(&sticking).unwrap().name, "sticking contact");
}

#[test]
fn a_restitution_becomes_a_dissipation_time() {
    // b = 0.473881 gives e = 0.609834523 for this pair at 1 m/s with A = 1e-3 s and c = 1.
    let time = |text: &str| {
        let scene = pair(&hertz(text));
        let Some(Contact::Hertz(hertz)) = &scene.dem.contact else {
            unreachable!("the pair has a Hertz contact");
        };
        hertz.dissipation_time(scene.smallest_radius(), scene.smallest_mass())
    };
    close(time("restitution = 0.609834523"), 1e-3, 1e-6);
    close(
        time("restitution = 0.494664113, dissipation_factor = 1.5"),
        1e-3,
        1e-6,
    );
    assert_eq!(time("dissipation_time = 2e-4"), 2e-4);
}

/// Symptom: any step was accepted for spheres at rest that overlap, and gained energy. Cause: the
/// limit came from speeds alone.
#[test]
fn spheres_that_overlap_at_the_start_limit_the_step() {
    let law = hertz("dissipation_time = 0");
    let placed = |second: &str, tables: &str| {
        let text = format!(
            "{law}{tables}
            spheres = {{ count = 2, radius = 0.004, density = 1e4 }}
            start.kind = 'list'
            start.spheres = [{{ position = [0, 0, 1] }}, {{ position = {second} }}]
            time = {{ dt = 1e-7, duration = 1, frame_interval = 1e-3 }}"
        );
        Scene::from_toml(&text, Path::new("pair.toml")).unwrap_or_else(|error| panic!("{error}"))
    };
    let apart = placed("[0.1, 0, 1]", "");
    assert_eq!(largest_stable(&apart), None);
    // Released from the deepest overlap of an impact, the pair parts like after it.
    let impact = impact_at_one_metre_per_second(2e5, 1e4);
    let distance = 0.008 - impact.deepest_overlap();
    let pressed = placed(&format!("[0, {distance}, 1]"), "");
    let expected = largest_stable(&pair(&law)).unwrap().seconds;
    close(largest_stable(&pressed).unwrap().seconds, expected, 1e-9);
    let wall = placed(
        &format!("[0, {distance}, 3]"),
        &format!("tank = {{ floor = {} }}\n", 1.0 - distance + 0.004),
    );
    close(largest_stable(&wall).unwrap().seconds, expected, 1e-9);
}

#[test]
fn the_smallest_sphere_decides() {
    let scene = |radius: &str| {
        let text = format!(
            "contact = {{ law = 'hertz', young_modulus = 2e5, poisson_ratio = 0.3, \
             dissipation_time = 0 }}
            spheres = {{ count = 2, density = 1e4, radius = {radius} }}
            tank = {{ radius = 0.06, floor = 0.0 }}
            start = {{ kind = 'random', z_min = 0.1, z_max = 0.2 }}
            gravity = {{ acceleration = 9.8 }}
            time = {{ dt = 1e-6, duration = 1, frame_interval = 1e-3 }}"
        );
        Scene::from_toml(&text, Path::new("scene.toml")).unwrap_or_else(|error| panic!("{error}"))
    };
    let mixed = scene("[{ radius = 0.002, share = 1 }, { radius = 0.004, share = 1 }]");
    for alone in limits(&scene("0.002")) {
        let among = limits(&mixed);
        let among = among.iter().find(|limit| limit.name == alone.name);
        // For the displacement the largest sphere matters too, as it hits the smallest.
        let knocked_on = if alone.name == DISPLACEMENT {
            2.0 * 8.0 / (8.0 + 1.0)
        } else {
            1.0
        };
        close(among.unwrap().seconds, alone.seconds / knocked_on, 1e-12);
    }
    assert!(limits(&mixed)[0].seconds < limits(&scene("0.004"))[0].seconds);
    close(fastest_impact(&mixed), (2.0 * 9.8 * 0.2_f64).sqrt(), 1e-12);
}

/// How a spring finds its force.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SpringForce {
    /// From the position.
    Elastic,
    /// By adding its changes, as a spring of friction does.
    Loaded,
}

/// Whether x'' = -w^2 x - g x' stays bounded under a scheme.
fn bounded(scheme: Integrator, force: SpringForce, frequency: f64, rate: f64, dt: f64) -> bool {
    let loaded = force == SpringForce::Loaded;
    let (mut position, mut velocity, mut latest) = (1.0, 0.0, 0.0);
    let mut spring = -frequency * frequency * position;
    for step in 0..20_000 {
        let square = frequency * frequency;
        match scheme {
            // Velocity Verlet has the same values at its half steps.
            Integrator::SymplecticEuler
            | Integrator::VelocityVerlet
            | Integrator::AdaptiveVerlet => {
                let force = if loaded { spring } else { -square * position };
                velocity += dt * (force - rate * velocity);
                position += dt * velocity;
                spring -= square * velocity * dt;
            }
            Integrator::SynchronisedVerlet => {
                position += 0.5 * dt * velocity;
                let predicted = velocity + 0.5 * dt * latest;
                let time = if step == 0 { 0.5 * dt } else { dt };
                spring -= square * velocity * time;
                let force = if loaded { spring } else { -square * position };
                latest = force - rate * predicted;
                velocity += dt * latest;
                position += 0.5 * dt * velocity;
            }
        }
    }
    f64::abs(velocity) < 1e3 * frequency.max(1.0)
}

#[test]
fn the_damped_limit_is_where_an_oscillator_diverges() {
    let without_sub_steps = |it: &Integrator| *it != Integrator::AdaptiveVerlet;
    for integrator in Integrator::ALL.into_iter().filter(without_sub_steps) {
        let mut scene = pair("");
        scene.time.integrator = integrator;
        let scheme = scheme_of(&scene);
        for (frequency, dissipation) in [(5.0, 0.0), (1.0, 0.1), (3.0, 1.0), (10.0, 3.0)] {
            let rate = 2.0 / 3.0 * dissipation * frequency * frequency;
            let limit = scheme.oscillator(frequency, rate);
            for force in [SpringForce::Elastic, SpringForce::Loaded] {
                let name = format!("{} {force:?} {frequency}", integrator.name());
                let bounded = |dt| bounded(integrator, force, frequency, rate, dt);
                assert!(bounded(0.99 * limit), "{name}");
                assert!(!bounded(1.01 * limit), "{name}");
            }
        }
    }
}

#[test]
fn a_fluid_makes_spheres_slower_and_their_contacts_softer() {
    // Half of the fluid's mass moves with the spheres: half as heavy again.
    let added = "added_mass = { coefficient = 0.5, density = 1e4 }\n";
    let law = hertz("dissipation_time = 0");
    let [plain, water] = [pair(&law), pair(&format!("{law}{added}"))];
    let seconds = |scene: &Scene| largest_stable(scene).unwrap().seconds;
    // w^2 = (3/2) K sqrt(xi) / m_eff with xi as m_eff^(2/5).
    let ratio = libm::pow(1.5, 0.4);
    close(seconds(&water) / seconds(&plain), ratio, 1e-12);
    let friction = "friction = { law = 'spin', coefficient = 0.01 }
        spin_damping = { coefficient = 1e-3 }\n";
    let damped = pair(&format!("{law}{added}{friction}"));
    let mass = Shape::Sphere.mass(1e4, 0.004);
    // The moment of inertia stays.
    let expected = 2.0 * 0.4 * mass * 0.004 * 0.004 / 1e-3;
    close(seconds(&damped), expected, 1e-12);
    let falling = pair(
        "tank = { floor = -1.2 }
        gravity = { acceleration = 10.0 }
        buoyancy = { density = 6e3 }
        added_mass = { density = 4e3 }\n",
    );
    close(
        fastest_impact(&falling),
        (2.0_f64 * 10.0 * 0.4 / 1.2 * 1.2).sqrt(),
        1e-12,
    );
}

#[test]
fn drag_of_schiller_and_naumann_limits_the_step() {
    let water = "drag = { law = 'schiller-naumann', viscosity = 1e-3, density = 1e3 }
        swirl = { omega = 0.0 }\n";
    let mass = Shape::Sphere.mass(1e4, 0.004);
    let limit = largest_stable(&pair(water)).unwrap();
    assert_eq!(limit.name, "drag");
    // At 1 m/s, Re = 8000: dF/du of 0.44 (pi/8) rho D^2 u^2.
    let slope = 0.44 * std::f64::consts::PI / 4.0 * 1e3 * 0.008 * 0.008;
    close(limit.seconds, 2.0 * mass / slope, 1e-12);
}

#[test]
fn lift_advises_a_step() {
    let spinning = hertz("dissipation_time = 0")
        + "friction = { law = 'spin', coefficient = 0.01 }
           magnus = { coefficient = 0.5, density = 1e3 }\n";
    let limits = limits(&pair(&spinning));
    let lift = limits.iter().find(|it| it.name == "Magnus lift").unwrap();
    assert!(!lift.decisive);
    // Spheres of 4 mm that roll at 1 m/s: W = 3/4 0.5 (1e3 / 1e4) 250 / s.
    close(lift.seconds, 0.02 / (0.75 * 0.5 * 0.1 * 250.0), 1e-12);
}

#[test]
fn air_and_spins_limit_the_step() {
    let still_air = "drag = { law = 'constant', linear = 0.1, quadratic = 0.2 }
        swirl = { omega = 0.0 }\n";
    let mass = Shape::Sphere.mass(1e4, 0.004);
    let limit = largest_stable(&pair(still_air)).unwrap();
    assert_eq!(limit.name, "drag");
    close(limit.seconds, 2.0 * mass / (0.1 + 2.0 * 0.2 * 1.0), 1e-12);
    let damped = hertz("dissipation_time = 0")
        + "friction = { law = 'spin', coefficient = 0.01 }
           spin_damping = { coefficient = 1e-3 }\n";
    let limit = largest_stable(&pair(&damped)).unwrap();
    assert_eq!(limit.name, "spin damping");
    close(
        limit.seconds,
        2.0 * 0.4 * mass * 0.004 * 0.004 / 1e-3,
        1e-12,
    );
}
