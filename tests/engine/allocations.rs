//! What a scene does not name takes no memory: every effect has arrays of its own, and without it
//! they are not there.

use phase::dem::DemSimulation;
use phase::scene::Scene;

/// Spheres: so many that their arrays outweigh everything else.
const COUNT: usize = 20_000;

/// A scene of spheres in space, on which nothing acts.
const BARE: &str = r#"
    spheres = { count = 20000, radius = 0.001, density = 1e3 }
    start = { kind = "random", z_min = 0.0, z_max = 3.0 }
    tank = { radius = 0.3 }
    time = { dt = 1e-4, duration = 1e-3, frame_interval = 1e-3 }
"#;

/// Bytes for each sphere that are held by a simulation, at its most while it is built and runs.
fn bytes_per_sphere(tables: &str) -> f64 {
    let scene: Scene = toml::from_str(&format!("{BARE}\n{tables}")).unwrap();
    assert_eq!(scene.problems(), [], "{tables}");
    let measured = allocation_counter::measure(|| {
        let mut simulation = DemSimulation::new(&scene).unwrap();
        simulation.advance(2).unwrap();
    });
    measured.bytes_max as f64 / COUNT as f64
}

#[test]
fn an_effect_has_its_arrays_and_a_scene_without_it_has_none() {
    let bare = bytes_per_sphere("");
    // An effect that keeps nothing for each sphere takes nothing but its own box.
    let more = bytes_per_sphere("gravity = { acceleration = 9.8 }") - bare;
    assert!(more.abs() < 0.1, "gravity: {more} bytes per sphere");
    // Two coefficients of eight bytes.
    let drag = "drag = { law = \"constant\", linear = 1e-6 }\nswirl = { omega = 1.0 }";
    let more = bytes_per_sphere(drag) - bare;
    assert!(
        (16.0..40.0).contains(&more),
        "drag: {more} bytes per sphere"
    );
    // Contacts need lists of neighbours; spins and torques come with friction alone.
    let contact = "contact = { law = \"hertz\", young_modulus = 1e6, poisson_ratio = 0.3, \
                   dissipation_time = 0.0 }";
    let touching = bytes_per_sphere(contact);
    assert!(touching > bare + 8.0, "{bare} {touching}");
    let friction = "friction = { law = \"coulomb\", coefficient = 0.3, regularisation = 1e-2 }";
    let turning = bytes_per_sphere(&format!("{contact}\n{friction}"));
    let spins_and_torques = 48.0;
    assert!(
        turning - touching > spins_and_torques,
        "{touching} {turning}"
    );
}
