//! What acts on spheres, one file each: effects on single spheres, laws of contact and friction.

pub mod contact;
pub mod effects;
pub mod friction;
pub(crate) mod limit;
pub mod simplification;

/// For serde: the default of a factor.
pub(crate) fn one() -> f64 {
    1.0
}
