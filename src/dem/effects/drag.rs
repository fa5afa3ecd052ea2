//! The drag law that swirl and updraught share.

use crate::dem::block::BLOCK;
use crate::dem::bodies::Bodies;
use crate::dem::order::reorder;
use crate::dem::particles::Particles;
use crate::dem::vector::Vector;
use crate::scene::{Drag, DragForm};

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
pub(super) struct Linear;

impl DragKernel for Linear {
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

/// (c1 + c2 |u_x|) u_x and so on: each component by itself, as the thesis ran it.
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

/// Which kernel a drag law needs.
pub(super) enum Form {
    Linear,
    Vector,
    Components,
}

pub(super) fn form(drag: &Drag) -> Form {
    match drag.form {
        _ if drag.quadratic == 0.0 => Form::Linear,
        DragForm::Vector => Form::Vector,
        DragForm::Component => Form::Components,
    }
}

/// Coefficients c1 and c2 of every sphere, in whole blocks.
pub(super) struct Coefficients {
    linear: Vec<f64>,
    quadratic: Vec<f64>,
}

impl Coefficients {
    pub(super) fn new(drag: &Drag, particles: &Particles) -> Self {
        let (mut linear, mut quadratic): (Vec<f64>, Vec<f64>) = particles
            .radius
            .iter()
            .map(|&radius| drag.coefficients(radius))
            .unzip();
        let blocks = linear.len().div_ceil(BLOCK);
        linear.resize(blocks * BLOCK, 0.0);
        quadratic.resize(blocks * BLOCK, 0.0);
        Self { linear, quadratic }
    }

    /// Those of a block.
    #[inline(always)]
    pub(super) fn of_block(&self, bodies: &Bodies) -> [&[f64]; 2] {
        let block = bodies.first..bodies.first + BLOCK;
        [&self.linear[block.clone()], &self.quadratic[block]]
    }

    pub(super) fn reorder(&mut self, order: &[u32]) {
        for coefficients in [&mut self.linear, &mut self.quadratic] {
            coefficients.truncate(order.len());
            reorder(coefficients, order);
            coefficients.resize(order.len().next_multiple_of(BLOCK), 0.0);
        }
    }
}
