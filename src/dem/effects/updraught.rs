//! Rising air with the rectangular counting shield.

use super::drag::{Coefficients, DragKernel, Form, Linear, QuadraticComponents, form};
use super::{Effect, OneBody};
use crate::dem::block::BLOCK;
use crate::dem::bodies::{Asked, Bodies};
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
    /// alpha^n of every sphere, in whole blocks.
    shield: Vec<f64>,
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
        Box::new(Updraught::<K> {
            parameters,
            coefficients,
            powers: vec![1.0],
            shield: Vec::new(),
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
    const ASKS: Asked = Asked {
        motion: true,
        turn: false,
    };

    fn reorder(&mut self, order: &[u32]) {
        self.coefficients.reorder(order);
    }

    fn prepare(&mut self, shielding: &[u32]) {
        let most = shielding.iter().copied().max().unwrap_or(0) as usize;
        while self.powers.len() <= most {
            self.powers
                .push(self.powers[self.powers.len() - 1] * self.parameters.alpha);
        }
        self.shield.clear();
        let powers = shielding
            .iter()
            .map(|&spheres| self.powers[spheres as usize]);
        self.shield.extend(powers);
        let blocks = shielding.len().div_ceil(BLOCK);
        self.shield.resize(blocks * BLOCK, 1.0);
    }

    #[inline(always)]
    fn add(&self, bodies: &mut Bodies) {
        let scene::Updraught {
            speed,
            strength,
            decay,
            origin,
            ..
        } = self.parameters;
        let shield = &self.shield[bodies.first..bodies.first + BLOCK];
        let [c1, c2] = self.coefficients.of_block(bodies);
        let (height, velocity) = (&bodies.position.0[2], &bodies.velocity.0[2]);
        let force = &mut bodies.force.0[2];
        for k in 0..BLOCK {
            let factor = strength * exp(-decay * (height[k] - origin));
            force[k] += factor * shield[k] * K::along(c1[k], c2[k], speed - velocity[k]);
        }
    }
}
