//! Rising air with the rectangular counting shield.

use super::drag::{Coefficients, DragKernel, Form, Linear, QuadraticComponents, form};
use super::{Effect, OneBody};
use crate::dem::math::exp;
use crate::dem::particles::Particles;
use crate::dem::profile::Part;
use crate::scene::{self, Drag};
use std::marker::PhantomData;

/// Rice (2012), eq. 24: F_z = s exp(-beta (z - z0)) alpha^n drag(v_air - v_z), with n the number
/// of lower spheres whose centre lies within 2r in |dx| and in |dy|. With a reference rotation
/// Omega_0, s (Omega / Omega_0)^2 takes the place of s (eq. 44).
struct Updraught<K> {
    parameters: scene::Updraught,
    coefficients: Coefficients,
    /// alpha^n for every n met so far.
    powers: Vec<f64>,
    /// s exp(-beta (z - z0)) of every sphere.
    decay: Vec<f64>,
    kernel: PhantomData<K>,
}

pub(super) fn of_scene(
    updraught: &scene::Updraught,
    swirl: Option<&scene::Swirl>,
    drag: &Drag,
    particles: &Particles,
) -> Box<dyn Effect> {
    fn boxed<K: DragKernel>(
        parameters: scene::Updraught,
        coefficients: Coefficients,
    ) -> Box<dyn Effect> {
        let decay = vec![0.0; coefficients.linear.len()];
        Box::new(Updraught::<K> {
            parameters,
            coefficients,
            powers: vec![1.0],
            decay,
            kernel: PhantomData,
        })
    }
    let coefficients = Coefficients::new(drag, particles);
    let parameters = scene::Updraught {
        strength: updraught.strength_in(swirl),
        ..updraught.clone()
    };
    match form(drag) {
        Form::Linear => boxed::<Linear>(parameters, coefficients),
        // Along one axis the two quadratic forms are the same.
        Form::Vector | Form::Components => boxed::<QuadraticComponents>(parameters, coefficients),
    }
}

impl<K: DragKernel> OneBody for Updraught<K> {
    const PART: Part = Part::Updraught;

    fn reorder(&mut self, order: &[u32]) {
        self.coefficients.reorder(order);
    }

    #[inline(always)]
    fn add(&mut self, particles: &mut Particles, shielding: &[u32]) {
        let count = particles.len();
        let most = shielding.iter().copied().max().unwrap_or(0) as usize;
        while self.powers.len() <= most {
            self.powers
                .push(self.powers[self.powers.len() - 1] * self.parameters.alpha);
        }
        let scene::Updraught {
            speed,
            strength,
            decay,
            origin,
            ..
        } = self.parameters;
        for (factor, centre) in self.decay.iter_mut().zip(&particles.position) {
            *factor = strength * exp(-decay * (centre.z - origin));
        }
        let (velocity, force) = (&particles.velocity[..count], &mut particles.force[..count]);
        let (c1, c2) = (
            &self.coefficients.linear[..count],
            &self.coefficients.quadratic[..count],
        );
        let (factor, shielding) = (&self.decay[..count], &shielding[..count]);
        for i in 0..count {
            let shield = self.powers[shielding[i] as usize];
            force[i].z += factor[i] * shield * K::along(c1[i], c2[i], speed - velocity[i].z);
        }
    }
}
