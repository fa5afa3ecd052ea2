//! Profiles of the downward velocity of a drainage.

use super::MeasuredDrainage;
use crate::measure::{FlowSpread, SpaceAxis, VelocityProfile, flow_spread};

/// Heights of the layers that figures show, as shares of the height at the start: 20, 30 and 60
/// diameters in the box of Rycroft, Wong and Bazant (2010).
pub const DRAWN_HEIGHTS: [f64; 3] = [0.18, 0.27, 0.54];
/// Those to whose widths the diffusion length is fitted.
const FITTED_HEIGHTS: [f64; 6] = [0.14, 0.22, 0.30, 0.38, 0.46, 0.54];
/// Thickness of a layer, in diameters.
const THICKNESS: f64 = 4.0;
/// Where the profile through the depth is measured: |x| < 10 d and 50 d < z < 70 d in the box of
/// the paper.
const CROSS: (f64, [f64; 2]) = (0.4, [0.45, 0.64]);
/// Bins through the depth in a diameter.
const CROSS_BINS: f64 = 4.0;

/// The profile over x of a layer at a share of the height at the start, in bins of a diameter.
pub fn profile_at(drainage: &MeasuredDrainage<'_>, share: f64) -> VelocityProfile {
    let filled_box = &drainage.filled_box;
    let half = 0.5 * THICKNESS * filled_box.diameter / filled_box.filled;
    let region = filled_box.part(1.0, [share - half, share + half]);
    let bins = (2.0 * filled_box.half_width / filled_box.diameter).round();
    let profile = VelocityProfile::new(SpaceAxis::X, region, bins.max(2.0) as usize);
    filled(profile, drainage)
}

/// The profile through the depth, of the middle 40 % of the width (figure 8 of the paper).
pub fn cross_profile(drainage: &MeasuredDrainage<'_>) -> VelocityProfile {
    let filled_box = &drainage.filled_box;
    let bins = (CROSS_BINS * 2.0 * filled_box.half_depth / filled_box.diameter).round();
    let region = filled_box.part(CROSS.0, CROSS.1);
    // An odd number: of an even one sides of bins lie where spheres touch the walls, half a
    // diameter from them, and those at one wall alone would share a bin with what is inside.
    let profile = VelocityProfile::new(SpaceAxis::Y, region, bins.max(1.0) as usize | 1);
    filled(profile, drainage)
}

/// How fast the flow widens upwards: fitted to six layers, with images in the side walls.
pub fn flow_spread_of(drainage: &MeasuredDrainage<'_>) -> Option<FlowSpread> {
    let layers = FITTED_HEIGHTS.map(|share| profile_at(drainage, share));
    flow_spread(&layers, Some(drainage.filled_box.half_width))
}

fn filled(mut profile: VelocityProfile, drainage: &MeasuredDrainage<'_>) -> VelocityProfile {
    for pair in drainage.flow().windows(2) {
        profile.add(&pair[0], &pair[1]);
    }
    profile
}
