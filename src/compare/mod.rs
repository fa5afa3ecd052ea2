//! Comparison of drainages: what is measured of their records, and how it differs.
//!
//! Records of the discrete element model and of the spot model go through the same measures.

mod drainage;
mod fit;
mod profiles;
mod quantities;
mod simpler;
mod spreading;
mod table;

pub use drainage::{MeasuredDrainage, opened};
pub use fit::SpotFit;
pub use profiles::{DRAWN_HEIGHTS, cross_profile, flow_spread_of, profile_at};
pub use quantities::{DrainageQuantity, QUANTITIES, badness_of, mixing, outflow, packing_fraction};
pub use simpler::{MixingOverTime, mixing_of_kinematic_flow, mixing_of_voids};
pub use spreading::{Spreading, correlation_radius, spreading, velocity_correlation};
pub use table::{ComparisonRow, DrainageComparison, are_of_one_run};
