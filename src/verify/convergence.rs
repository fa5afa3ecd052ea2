//! Convergence of the motion as the time step shrinks.

use super::bench::Bench;
use super::{CaseFamily, MeasuredValues, VerifyError, named};
use crate::dem::DemSimulation;
use crate::scene::{DemScene, Guards, Scene, Time};
use serde::Deserialize;

/// A scene, run with its time step, half of it and a quarter. For smooth motion, the difference of
/// two consecutive runs shrinks by the factor two to the power of the scheme's order.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Convergence {
    /// The scene; the bench sets its integrator.
    scene: Box<Scene>,
}

impl CaseFamily for Convergence {
    fn name(&self) -> &'static str {
        "convergence"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let dt = self.scene.time.dt;
        let states = [dt, 0.5 * dt, 0.25 * dt].map(|dt| self.end(dt, bench));
        let [coarse, middle, fine] = states;
        let (coarse, middle, fine) = (coarse?, middle?, fine?);
        let order = libm::log2(distance(&coarse, &middle) / distance(&middle, &fine));
        Ok(named([("order", order)]))
    }
}

impl Convergence {
    /// Places at the end, and the distances (m) that velocities and spinning surfaces would cover
    /// in the duration.
    fn end(&self, dt: f64, bench: &mut Bench<'_>) -> Result<Vec<f64>, VerifyError> {
        let duration = self.scene.time.duration;
        let scene = Scene {
            time: Time {
                dt,
                integrator: bench.integrator(),
                ..self.scene.time.clone()
            },
            dem: DemScene {
                guards: Guards {
                    displacement: f64::MAX,
                    ..Guards::default()
                },
                ..self.scene.dem.clone()
            },
            ..(*self.scene).clone()
        };
        let mut simulation = DemSimulation::new(&scene)?;
        bench.advance_for(&mut simulation, duration, dt)?;
        let particles = simulation.particles();
        let spins = particles.spin.iter().zip(&particles.radius);
        let places = particles.position.iter().copied();
        let velocities = particles.velocity.iter().map(|&it| it * duration);
        let surfaces = spins.map(|(&spin, radius)| spin * (radius * duration));
        let vectors = places.chain(velocities).chain(surfaces);
        Ok(vectors.flat_map(|it| [it.x, it.y, it.z]).collect())
    }
}

fn distance(one: &[f64], other: &[f64]) -> f64 {
    let squares = one.iter().zip(other).map(|(a, b)| (a - b) * (a - b));
    squares.sum::<f64>().sqrt()
}
