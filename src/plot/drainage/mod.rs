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

use super::{Figure, PlotError, Source};
use crate::compare::Drainage;
use crate::record::RunRecord;
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

/// A record as a figure reads it.
fn drainage<'a>(
    record: &'a RunRecord,
    source: &Source<'_>,
    figure: &'static str,
) -> Result<Drainage<'a>, PlotError> {
    let drainage = Drainage::new(record, source.times);
    drainage.map_err(|needs| PlotError::Scene { figure, needs })
}
