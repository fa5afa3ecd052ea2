//! What acts on spheres, one file each: effects on single spheres, laws of contact, friction and
//! rolling.

pub mod contact;
pub mod effects;
pub mod friction;
pub(crate) mod limit;
pub mod rolling;
pub mod simplification;

/// For serde: the default of a factor.
pub(crate) fn one() -> f64 {
    1.0
}
