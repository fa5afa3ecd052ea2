//! Figures of drainages: what is measured of snapshots, of one run or of several beside each other.
//!
//! Lengths are over the diameter of the spheres, so that runs of any size compare.

mod badness;
mod bond_angles;
mod cost_error;
mod cross_profile;
mod diffusion;
mod mixing;
mod outflow;
mod overlay;
mod packing_map;
mod radial_distribution;
mod residence;
mod retention;
mod surface_angle;
mod velocity_correlation;
mod velocity_profile;

use super::{Figure, PlotError, Source, choice};
use crate::compare::Drainage;
use overlay::{Curve, Lines, Overlay};

/// All of them.
pub(super) static FIGURES: [&dyn Figure; 14] = [
    &outflow::OUTFLOW,
    &velocity_profile::VelocityProfiles,
    &cross_profile::CROSS_PROFILE,
    &packing_map::PackingMap,
    &surface_angle::SURFACE_ANGLE,
    &radial_distribution::RADIAL_DISTRIBUTION,
    &bond_angles::BOND_ANGLES,
    &badness::BADNESS,
    &cost_error::CostError,
    &mixing::MIXING,
    &diffusion::DIFFUSION,
    &velocity_correlation::VELOCITY_CORRELATION,
    &retention::RETENTION,
    &residence::RESIDENCE,
];

/// What is common to the places of a figure's runs, and what it takes from each run: from the rest
/// of its place, and from its drainage.
fn each<T>(
    source: &Source<'_>,
    figure: &'static str,
    mut take: impl FnMut(Vec<String>, &Drainage<'_>) -> T,
) -> Result<(Vec<String>, Vec<T>), PlotError> {
    let runs = choice::runs(source, choice::states)?;
    let (common, places) = choice::places(&runs);
    let taken = runs.iter().zip(places).map(|(run, place)| {
        let record = run.record()?;
        let drainage = Drainage::new(&record, source.times);
        let drainage = drainage.map_err(|needs| PlotError::Scene { figure, needs })?;
        Ok(take(place, &drainage))
    });
    let taken: Result<Vec<T>, PlotError> = taken.collect();
    Ok((common, taken?))
}
