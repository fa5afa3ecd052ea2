//! `phase` turns a TOML file into a phase diagram: discrete element simulations of spheres in a
//! vortex, run over a grid of parameters, labelled, and drawn.
//!
//! The program of that name is a thin layer over this library, which does without it. The way of
//! the data, with the module of each:
//!
//! | step | module |
//! |---|---|
//! | a [`Scene`](scene::Scene), from a file or built in code | [`scene`] |
//! | a [`DemSimulation`](dem::DemSimulation), advanced step by step | [`dem`], [`spot`] |
//! | what all models can do: the traits `Model` and `Simulation` | [`simulation`] |
//! | what is measured at every frame | [`observe`] |
//! | all of that in one call: a [`RunRecord`](record::RunRecord) | [`run`](mod@run), [`record`] |
//! | a run that is interrupted and continues from its checkpoint | [`resume`] |
//! | the label of a record | [`classify`](mod@classify) |
//! | many scenes at once, their labels, and figures | [`sweep`], [`plot`] |
//! | which runs a phase diagram needs | [`refine`] |
//! | records and tables as files | [`store`] |
//!
//! Other modules serve the program and its tests. They are hidden here, and may change with any
//! version.
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
//!         Start::Random { z_min: 0.01, z_max: 0.05, x: None, y: None, speed: 0.005, spin: 0.0 },
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

#[doc(hidden)]
pub mod beverloo;
pub mod classify;
mod color;
#[doc(hidden)]
pub mod compare;
#[doc(hidden)]
pub mod cost;
mod cpu_time;
pub mod dem;
#[doc(hidden)]
pub mod document;
#[doc(hidden)]
pub mod external;
mod fonts;
#[doc(hidden)]
pub mod forces;
pub mod grid;
mod markup;
#[doc(hidden)]
pub mod measure;
pub mod observe;
#[doc(hidden)]
pub mod particles;
pub mod plot;
pub mod record;
#[doc(hidden)]
pub mod reference;
pub mod refine;
pub mod refusal;
#[doc(hidden)]
pub mod render;
#[doc(hidden)]
pub mod replay;
pub mod report;
pub mod resume;
#[doc(hidden)]
pub mod rule;
pub mod run;
pub mod scene;
pub mod simulation;
pub mod spot;
#[doc(hidden)]
pub mod start;
#[doc(hidden)]
pub mod statistics;
pub mod store;
#[doc(hidden)]
pub mod study;
pub mod sweep;
#[doc(hidden)]
pub mod theory;
#[doc(hidden)]
pub mod verify;
pub mod walls;
