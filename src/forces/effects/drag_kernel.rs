//! The force of the air on a sphere by its coefficients, for laws without and with direction.

use crate::particles::vector::Vector;

/// Force of the air on a sphere from the velocity of the air relative to it, for the
/// coefficients c1 (kg/s) and c2 (kg/m) of the sphere.
pub(super) trait DragKernel: Copy + Send + Sync + 'static {
    /// Force (N) for the relative velocity of the air (m/s).
    fn vector(c1: f64, c2: f64, air: Vector) -> Vector;

    /// The same along one axis alone.
    fn along(c1: f64, c2: f64, air: f64) -> f64;
}

/// c1 u.
#[derive(Clone, Copy)]
pub(super) struct LinearDrag;

impl DragKernel for LinearDrag {
    #[inline(always)]
    fn vector(c1: f64, _: f64, air: Vector) -> Vector {
        air * c1
    }

    #[inline(always)]
    fn along(c1: f64, _: f64, air: f64) -> f64 {
        c1 * air
    }
}

/// (c1 + c2 |u|) u, isotropic.
#[derive(Clone, Copy)]
pub(super) struct QuadraticVector;

impl DragKernel for QuadraticVector {
    #[inline(always)]
    fn vector(c1: f64, c2: f64, air: Vector) -> Vector {
        air * (c1 + c2 * air.norm())
    }

    #[inline(always)]
    fn along(c1: f64, c2: f64, air: f64) -> f64 {
        (c1 + c2 * air.abs()) * air
    }
}

/// (c1 + c2 |u_x|) u_x and so on: each component separately, as in the thesis.
#[derive(Clone, Copy)]
pub(super) struct QuadraticComponents;

impl DragKernel for QuadraticComponents {
    #[inline(always)]
    fn vector(c1: f64, c2: f64, air: Vector) -> Vector {
        Vector::new(
            Self::along(c1, c2, air.x),
            Self::along(c1, c2, air.y),
            Self::along(c1, c2, air.z),
        )
    }

    #[inline(always)]
    fn along(c1: f64, c2: f64, air: f64) -> f64 {
        (c1 + c2 * air.abs()) * air
    }
}
