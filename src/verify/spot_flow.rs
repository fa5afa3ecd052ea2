//! Spots rise through spheres on a lattice.

use super::bench::Bench;
use super::{CaseFamily, MeasuredValues, VerifyError, named};
use crate::particles::vector::Vector;
use crate::spot::{Parameters, Relaxation, Schedule, SpotOpening, SpotSimulation};
use serde::Deserialize;
use std::f64::consts::PI;

/// Spots enter a box at a constant rate and rise; the run ends before the first reaches the top.
/// Spheres start on a cubic lattice and follow them. Overlaps are removed for all spheres at once,
/// but not when the flow is measured, because its closed form includes only spots.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpotFlow {
    /// Number of spheres with a diameter of 1 m.
    spheres: usize,
    /// Width and depth of the box (m).
    sides: [f64; 2],
    /// Steps of a spot along x and y, and along z (m).
    step: [f64; 2],
    /// Spots that enter per second, and steps of each (1/s).
    rates: [f64; 2],
    /// Whether each spot moves at its own times, or all at once in steps.
    #[serde(default)]
    all_at_once: bool,
    /// When spots are observed (s).
    time: f64,
    /// Start of the measurement of the flow of spheres, which ends at the same time (s).
    flow_from: Option<f64>,
    seed: u64,
}

/// Heights between which spots are counted (m): above the first step, and below the front.
const LOWEST: f64 = 0.5;
const BELOW_FRONT: f64 = 0.85;
/// The layer in which the flow is measured (m), and the half width of its middle, where walls do
/// not affect the density.
const LAYER: [f64; 2] = [3.0, 5.0];
const MIDDLE: f64 = 6.0;

impl CaseFamily for SpotFlow {
    fn name(&self) -> &'static str {
        "spot-flow"
    }

    fn measure(&self, _: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let spots = |error: &dyn std::fmt::Display| VerifyError::Spots(error.to_string());
        let parameters = self.parameters();
        let mut simulation = SpotSimulation::new(parameters, &self.lattice(), self.seed)
            .map_err(|error| spots(&error))?;
        let before = match self.flow_from {
            None => None,
            Some(time) => {
                simulation.advance_to(time).map_err(|error| spots(&error))?;
                Some(simulation.positions())
            }
        };
        simulation
            .advance_to(self.time)
            .map_err(|error| spots(&error))?;
        let [across, up] = self.step;
        let highest = BELOW_FRONT * self.rates[1] * up * self.time;
        let places = simulation.spots().iter().map(|spot| spot.position);
        let counted: Vec<_> = places
            .filter(|place| (LOWEST..highest).contains(&place.z))
            .collect();
        let count = counted.len() as f64;
        let per_height = count / (highest - LOWEST);
        // x^2 over the variance after the number of steps to this height.
        let variances = counted
            .iter()
            .map(|place| place.x * place.x / (across * across * place.z / up));
        let mut measured = named([
            ("spots_per_height", per_height),
            (
                "front_speed",
                simulation.spots().len() as f64 / (per_height * self.time),
            ),
            ("spread_over_walk", variances.sum::<f64>() / count),
            (
                "spheres",
                (simulation.spheres_inside() + simulation.spheres_left()) as f64,
            ),
        ]);
        if let (Some(before), Some(from)) = (before, self.flow_from) {
            let [flux, spread] = self.flow(&simulation, &before, self.time - from);
            measured.extend(named([
                ("flux_over_balance", flux),
                ("flow_spread", spread),
            ]));
        }
        Ok(measured)
    }
}

impl SpotFlow {
    /// Centres one diameter apart, layer by layer from the floor.
    fn lattice(&self) -> Vec<Vector> {
        let [rows, columns] = self.sides.map(|it| it as usize);
        let place = |sphere: usize| {
            let [x, y] = [sphere % rows, sphere / rows % columns].map(|it| it as f64 + 0.5);
            let z = (sphere / (rows * columns)) as f64 + 0.5;
            Vector::new(x - 0.5 * rows as f64, y - 0.5 * columns as f64, z)
        };
        (0..self.spheres).map(place).collect()
    }

    /// Spheres that sink through a layer per second, over the flux of spots, lambda n V_s / w with
    /// the number density n of the spheres and the volume V_s of a spot; and the second moment of
    /// their displacements along x over the value from the walk and the ball of a spot, (z / dz)
    /// dx^2 + r_s^2 / 5.
    fn flow(&self, simulation: &SpotSimulation, before: &[Option<Vector>], time: f64) -> [f64; 2] {
        let parameters = simulation.parameters();
        let [low, high] = LAYER;
        let (mut sum, mut moment, mut middle) = (0.0, 0.0, 0.0);
        for (before, after) in before.iter().zip(simulation.positions()) {
            let (Some(before), Some(after)) = (before, after) else {
                continue;
            };
            if (low..high).contains(&before.z) {
                let sunk = before.z - after.z;
                sum += sunk;
                moment += sunk * before.x * before.x;
                middle += f64::from(u8::from(before.x.abs().max(before.y.abs()) < MIDDLE));
            }
        }
        let density = middle / (4.0 * MIDDLE * MIDDLE * (high - low));
        let radius = parameters.spot_radius;
        let volume = 4.0 / 3.0 * PI * radius * radius * radius;
        let carried = parameters.insertion_rate * density * volume / parameters.displacement_ratio;
        let [across, up] = self.step;
        let walked = across * across * 0.5 * (low + high) / up;
        let flux = sum / ((high - low) * time);
        [
            flux / carried,
            moment / sum / (walked + radius * radius / 5.0),
        ]
    }

    fn parameters(&self) -> Parameters {
        let [across, up] = self.step;
        Parameters {
            half_width: 0.5 * self.sides[0],
            half_depth: 0.5 * self.sides[1],
            orifice: SpotOpening::Circle { radius: 4.0 },
            step: [across, across, up],
            insertion_rate: self.rates[0],
            move_rate: self.rates[1],
            schedule: match self.all_at_once {
                false => Schedule::Events,
                true => Schedule::StepsInRandomOrder,
            },
            relaxation: match self.flow_from {
                None => Relaxation::Global { ratio: 1 },
                Some(_) => Relaxation::Off,
            },
            ..Parameters::figure_2(1.0)
        }
    }
}
