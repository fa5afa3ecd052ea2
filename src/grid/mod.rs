//! Grids: the axes over which a scene varies, of numbers or of named changes, the scenes of their
//! points, and what files say of them.

mod axis;
mod file;
mod points;
mod seeds;
pub(crate) mod spacing;
mod variant;

pub use axis::Axis;
pub(crate) use axis::AxisEntry;
pub(crate) use file::{
    MOST_JOBS, base_scene, check_axes, check_jobs, check_number_of_axes, check_points, check_steps,
    expand_axes, give_the_step_to_an_axis, or_path,
};
pub use points::{PointError, describe};
pub(crate) use points::{PointScenes, describe_point, number_of_points, points, variant_at};
pub(crate) use seeds::{SeedsEntry, expand_seeds};
pub(crate) use variant::{
    SceneTree, VariantEntry, check_change, check_variants, expand_variants, nothing_to_leave_out,
};
pub use variant::{VARIANT, Variant};
