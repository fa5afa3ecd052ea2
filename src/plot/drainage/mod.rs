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

use super::runs::Runs;
use super::{Figure, PlotError, Svg, choice};
use crate::classify::DRAINAGE;
use crate::compare::MeasuredDrainage;
use overlay::{Overlay, RunCurve, RunLines};

/// All of them.
pub(super) fn figures() -> [Figure; 14] {
    [
        outflow::OUTFLOW.figure(),
        velocity_profile::figure(),
        cross_profile::CROSS_PROFILE.figure(),
        packing_map::figure(),
        surface_angle::SURFACE_ANGLE.figure(),
        radial_distribution::RADIAL_DISTRIBUTION.figure(),
        bond_angles::BOND_ANGLES.figure(),
        badness::BADNESS.figure(),
        cost_error::figure(),
        mixing::MIXING.figure(),
        diffusion::DIFFUSION.figure(),
        velocity_correlation::VELOCITY_CORRELATION.figure(),
        retention::RETENTION.figure(),
        residence::RESIDENCE.figure(),
    ]
}

/// A figure of drainages, which takes times, and perhaps data of other sources.
fn of_drainages(
    name: &'static str,
    description: &str,
    takes_data: bool,
    draw: impl Fn(&Runs<'_>) -> Result<Svg, PlotError> + Send + Sync + 'static,
) -> Figure {
    Figure::of_runs(name, description, &choice::STATES, draw)
        .with_options(takes_data)
        .for_families([&DRAINAGE])
}

/// What a figure takes from each of its runs: from its name, and from its drainage.
fn each<T>(
    runs: &Runs<'_>,
    figure: &str,
    mut take: impl FnMut(Vec<String>, &MeasuredDrainage<'_>) -> T,
) -> Result<Vec<T>, PlotError> {
    let taken = runs.shown.iter().map(|run| {
        let record = run.record()?;
        let drainage = MeasuredDrainage::new(&record, runs.times);
        let drainage = drainage.map_err(|needs| PlotError::needs(figure, needs))?;
        Ok(take(run.name.clone(), &drainage))
    });
    taken.collect()
}
