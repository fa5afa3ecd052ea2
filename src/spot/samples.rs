//! A small silo for tests.

use super::packing::random_packing;
use super::parameters::{Parameters, SpotOpening};
use super::simulation::SpotSimulation;
use crate::particles::vector::Vector;
use std::sync::OnceLock;

/// A box of 14 d times 8 d.
pub(super) fn parameters() -> Parameters {
    Parameters {
        half_width: 7.0,
        orifice: SpotOpening::Circle { radius: 3.0 },
        ..Parameters::figure_2(1.0)
    }
}

/// A packing of some 16 d in this box.
pub(super) fn packing() -> &'static [Vector] {
    static PACKING: OnceLock<Vec<Vector>> = OnceLock::new();
    PACKING.get_or_init(|| random_packing(&parameters(), 2000, 1, 1).expect("a packing"))
}

/// A simulation that starts from this packing.
pub(super) fn simulation(change: impl FnOnce(&mut Parameters)) -> SpotSimulation {
    let mut parameters = parameters();
    change(&mut parameters);
    SpotSimulation::new(parameters, packing(), 1).expect("a start")
}

/// Sum of the overlaps over all pairs, each counted once, per sphere and diameter.
pub(super) fn badness(simulation: &SpotSimulation) -> f64 {
    let centres: Vec<Vector> = simulation.positions().into_iter().flatten().collect();
    let mut sum = 0.0;
    for (second, centre) in centres.iter().enumerate() {
        for other in &centres[..second] {
            let overlap = 1.0 - (*centre - *other).norm();
            sum += overlap.max(0.0);
        }
    }
    sum / centres.len() as f64
}
