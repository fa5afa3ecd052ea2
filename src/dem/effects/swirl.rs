//! Drag toward air in rigid rotation about the axis.

use super::drag::{
    Coefficients, DragKernel, Form, Linear, QuadraticComponents, QuadraticVector, form,
};
use super::{Effect, OneBody};
use crate::dem::block::BLOCK;
use crate::dem::bodies::{Asked, Bodies};
use crate::dem::particles::Particles;
use crate::dem::profile::Part;
use crate::dem::vector::Vector;
use crate::scene::{self, Drag};
use std::marker::PhantomData;

/// Rice (2012), eqs. 21 to 27: drag toward the air's velocity Omega x r, on all three
/// components, the air's own vertical speed being zero in this term.
struct Swirl<K> {
    omega: f64,
    coefficients: Coefficients,
    kernel: PhantomData<K>,
}

pub(super) fn of_scene(
    swirl: &scene::Swirl,
    drag: &Drag,
    particles: &Particles,
) -> Box<dyn Effect> {
    fn boxed<K: DragKernel>(omega: f64, coefficients: Coefficients) -> Box<dyn Effect> {
        Box::new(Swirl::<K> {
            omega,
            coefficients,
            kernel: PhantomData,
        })
    }
    let coefficients = Coefficients::new(drag, particles);
    match form(drag) {
        Form::Linear => boxed::<Linear>(swirl.omega, coefficients),
        Form::Vector => boxed::<QuadraticVector>(swirl.omega, coefficients),
        Form::Components => boxed::<QuadraticComponents>(swirl.omega, coefficients),
    }
}

impl<K: DragKernel> OneBody for Swirl<K> {
    const PART: Part = Part::Swirl;
    const ASKS: Asked = Asked {
        motion: true,
        turn: false,
    };

    fn reorder(&mut self, order: &[u32]) {
        self.coefficients.reorder(order);
    }

    #[inline(always)]
    fn add(&self, bodies: &mut Bodies) {
        let [c1, c2] = self.coefficients.of_block(bodies);
        let [x, y, _] = &bodies.position.0;
        let [fx, fy, fz] = &mut bodies.force.0;
        for k in 0..BLOCK {
            let air = Vector::new(-self.omega * y[k], self.omega * x[k], 0.0);
            let force = K::vector(c1[k], c2[k], air - bodies.velocity.vector(k));
            fx[k] += force.x;
            fy[k] += force.y;
            fz[k] += force.z;
        }
    }
}
