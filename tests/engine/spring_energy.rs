//! Tangential springs that rescale make no energy.
//!
//! Symptom: a sphere that breathes at rest on the floor gained 13 times the energy of its breathing
//! in 5 s, and its spin grew by a factor of 434. Cause: the stiffness of the spring follows the
//! overlap, and a spring that keeps its force gives back more when it is released than it took.
//! One that keeps its displacement, as the source of `silbert` has it, gains when it is pressed.

use crate::ledger::{largest, last, with_ledger};
use crate::scenes::INTEGRATORS;
use phase::observe::Observations;
use phase::scene::{Integrator, Scene};

/// The sphere breathes at twice the frequency of the tangential swing: 3.5 k_t = 1.5 k_n / 4.
fn breathing(friction: &str, integrator: Integrator) -> Observations {
    let contact = match friction.contains("silbert") {
        true => r#"{ law = "silbert", stiffness = 1e6, damping = 0.0 }"#,
        false => {
            r#"{ law = "hertz", young_modulus = 1.365e6, poisson_ratio = 0.3, dissipation_time = 0.0 }"#
        }
    };
    let text = format!(
        r#"
        spheres = {{ count = 1, radius = 0.01, density = 2500.0 }}
        contact = {contact}
        friction = {friction}
        tank = {{ floor = 0.0 }}
        start.kind = "list"
        start.spheres = [
            {{ position = [0.0, 0.0, 0.009847282194083701], spin = [0.0, 0.02, 0.0] }},
        ]
        gravity = {{ acceleration = 9.81 }}
        guards = {{ horizontal = 100.0 }}
        [time]
        dt = 4.1317967743885845e-05
        duration = 4.9581561292663014
        frame_interval = 0.0033054374195108675
        "#
    );
    let mut scene: Scene = toml::from_str(&text).unwrap();
    scene.time.integrator = integrator;
    with_ledger(&scene)
}

/// How often the energy of rotation grew.
fn growth(books: &Observations) -> f64 {
    largest(&books.rotational) / f64::from(books.rotational[0])
}

#[test]
fn a_sphere_that_breathes_at_rest_gains_no_spin() {
    let laws = [
        r#"{ law = "silbert", coefficient = 1.0, stiffness = 107000.0, rescale = true }"#,
        r#"{ law = "mindlin", coefficient = 1.0, rescale = true }"#,
    ];
    for integrator in INTEGRATORS {
        for law in laws {
            let books = breathing(law, integrator);
            assert!(
                growth(&books) < 1.001,
                "{integrator:?} {law} {}",
                growth(&books)
            );
            // The spring never gives more than it got.
            let start = f64::from(books.rotational[0]);
            let dissipated = books.dissipated_by_friction.iter();
            let mut before = 0.0;
            for &now in dissipated {
                let now = f64::from(now);
                assert!(
                    now > before - 1e-3 * start,
                    "{integrator:?} {law} {before} {now}"
                );
                before = before.max(now);
            }
            assert!(last(&books.dissipated_by_friction) > 0.1 * start);
        }
    }
}

/// What the key is for: the law of the source makes energy.
#[test]
fn the_law_of_silbert_makes_energy_of_breathing() {
    let law = r#"{ law = "silbert", coefficient = 1.0, stiffness = 107000.0 }"#;
    for integrator in INTEGRATORS {
        let books = breathing(law, integrator);
        assert!(growth(&books) > 1e3, "{integrator:?} {}", growth(&books));
        assert!(last(&books.dissipated_by_friction) < 0.0);
    }
}
