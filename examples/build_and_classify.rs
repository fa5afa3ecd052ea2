//! Builds a scene in code, runs it, stores its record and says which state it is in.
//!
//!     cargo run --release --example build_and_classify

#![allow(clippy::print_stdout, reason = "an example speaks for itself")]

use phase::classify::{Sieves, classify};
use phase::scene::{
    Contact, DemScene, Drag, DragForm, DragLaw, Effects, Gravity, Hertz, Integrator, Radii, Scene,
    Shape, Spheres, Start, Swirl, Tank, Time,
};
use phase::{run, store};
use std::error::Error;
use std::ops::ControlFlow;

/// Spheres in a tank whose air turns with the angular velocity `omega` (rad/s).
fn tank(omega: f64) -> Scene {
    let spheres = Spheres {
        count: 64,
        radius: Radii::One(0.004),
        density: 3750.0,
        shape: Shape::Sphere,
    };
    let start = Start::Random {
        x: None,
        y: None,
        z_min: 0.01,
        z_max: 0.15,
        speed: 0.005,
        spin: 0.0,
    };
    let time = Time {
        dt: 1e-4,
        safety_factor: None,
        resolution: None,
        duration: 5.0,
        frame_interval: 1e-3,
        integrator: Integrator::SymplecticEuler,
    };
    Scene {
        tank: Some(Tank {
            radius: Some(0.04),
            floor: Some(0.0),
            ..Tank::default()
        }),
        dem: DemScene {
            contact: Some(Contact::Hertz(Hertz {
                young_modulus: 5.657e5,
                poisson_ratio: 0.3,
                dissipation_time: Some(1e-3),
                restitution: None,
                restitution_speed: 1.0,
                dissipation_factor: 1.0,
            })),
            effects: Effects {
                gravity: Some(Gravity {
                    acceleration: 9.8,
                    tilt: 0.0,
                }),
                drag: Some(Drag {
                    linear: 100.0,
                    quadratic: 0.0,
                    viscosity: None,
                    density: None,
                    law: DragLaw::CrossSection,
                    form: DragForm::Vector,
                }),
                swirl: Some(Swirl { omega }),
                ..Effects::default()
            },
            ..DemScene::default()
        },
        ..Scene::new(spheres, start, time)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    for omega in [0.0, 20.0, 60.0] {
        let scene = tank(omega);
        // A scene from a file has been checked; this one has not.
        if let Some(problem) = scene.problems().first() {
            return Err(problem.to_string().into());
        }
        let record = run::run(&scene, &mut |_| ControlFlow::Continue(()))?;
        let verdict = classify(&record, &Sieves::default())?;
        let hole = verdict.value("hole_radius").unwrap_or(f64::NAN);
        println!(
            "omega = {omega} rad/s: {}, hole of {hole:.2} R",
            verdict.label.name
        );

        let path = std::env::temp_dir().join(format!("phase-example-{omega}.h5"));
        store::write_record(&record, &path)?;
        println!("  {}", path.display());
    }
    Ok(())
}
