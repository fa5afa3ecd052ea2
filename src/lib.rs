//! `phase` turns a TOML file into a phase diagram: discrete element simulations of spheres in a
//! vortex, run over a grid of parameters, labelled, and drawn.
//!
//! The program of that name is a thin layer over this library, which does without it. The way of
//! the data, with the module of each:
//!
//! | step | module |
//! |---|---|
//! | a [`Scene`](scene::Scene), from a file or built in code | [`scene`] |
//! | a [`DemSimulation`](dem::DemSimulation), advanced step by step | [`dem`] |
//! | what is measured at every frame | [`observe`] |
//! | all of that in one call: a [`RunRecord`](record::RunRecord) | [`run`](mod@run) |
//! | a run that is interrupted and goes on from its checkpoint | [`resume`] |
//! | the label of a record | [`classify`](mod@classify) |
//! | many scenes at once, their labels, and figures of them | [`sweep`], [`plot`] |
//! | where an integrator is stable: a phase diagram of the numerics | [`study`] |
//! | what a run costs, and each of its parts | [`cost`] |
//! | records and tables as files | [`store`] |
//! | which runs a phase diagram needs | [`refine`] |
//! | laws that results are compared with | [`theory`], [`beverloo`] |
//!
//! SI units throughout, angles in radians, z up. The same scene gives the same bits on every
//! machine.
//!
//! # A scene, its run, its label
//!
//! Eight spheres fall to the floor of a tank.
//!
//! ```
//! use phase::classify::{Label, Sieves, classify};
//! use phase::scene::{Hertz,
//!     Contact, DemScene, Effects, Gravity, Integrator, Radii, Scene, Shape, Spheres, Start, Tank,
//!     Time,
//! };
//! use std::ops::ControlFlow;
//!
//! let scene = Scene {
//!     tank: Some(Tank { radius: Some(0.03), floor: Some(0.0), ..Tank::default() }),
//!     dem: DemScene {
//!         contact: Some(Contact::Hertz(Hertz {
//!             young_modulus: 5e5,
//!             poisson_ratio: 0.3,
//!             dissipation_time: Some(1e-3),
//!             restitution: None,
//!             restitution_speed: 1.0,
//!             dissipation_factor: 1.0,
//!         })),
//!         effects: Effects {
//!             gravity: Some(Gravity { acceleration: 9.8, tilt: 0.0 }),
//!             ..Effects::default()
//!         },
//!         ..DemScene::default()
//!     },
//!     ..Scene::new(
//!         Spheres { count: 8, radius: Radii::One(0.004), density: 3750.0, shape: Shape::Sphere },
//!         Start::Random { z_min: 0.01, z_max: 0.05, speed: 0.005, spin: 0.0 },
//!         Time {
//!             dt: 1e-4,
//!             safety_factor: None,
//!             resolution: None,
//!             duration: 4.0,
//!             frame_interval: 1e-2,
//!             integrator: Integrator::SymplecticEuler,
//!         },
//!     )
//! };
//! // Files are checked when they are loaded; a scene built in code is checked like this.
//! assert!(scene.problems().is_empty());
//!
//! let record = phase::run::run(&scene, &mut |_| ControlFlow::Continue(()))?;
//!
//! // One value per frame for each observable.
//! let top = &record.observations.height_max;
//! assert_eq!(top.len(), 401);
//! // At the end they lie on the floor, one radius above it.
//! assert!(top[0] > 0.01 && (top[400] - 0.004).abs() < 1e-4);
//!
//! let verdict = classify(&record, &Sieves::default())?;
//! assert_eq!(verdict.label, Label::SETTLED);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The folder `examples/` has more: a scene built in code, and a simulation watched step by step.

pub mod beverloo;
pub mod classify;
mod color;
pub mod compare;
pub mod cost;
mod cpu_time;
pub mod dem;
pub mod document;
mod fonts;
pub mod forces;
mod markup;
pub mod measure;
pub mod observe;
pub mod particles;
pub mod plot;
pub mod record;
pub mod reference;
pub mod refine;
pub mod refusal;
pub mod render;
pub mod replay;
pub mod resume;
pub mod run;
pub mod scene;
pub mod simulation;
pub mod spot;
pub mod start;
pub mod statistics;
pub mod store;
pub mod study;
pub mod sweep;
pub mod theory;
pub mod verify;
