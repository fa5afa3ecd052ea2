//! Spheres that come in one after the other.

use crate::dem::system::Engine;
use crate::particles::Sphere;
use std::collections::VecDeque;

/// Overlaps with fixed spheres below this share of the radii come from rounded positions and do not
/// block the feed.
pub(in crate::dem) const ROUNDING: f64 = 1e-9;

/// Spheres that come in one after the other, at one place.
#[derive(Default)]
pub(in crate::dem) struct Feed {
    waiting: VecDeque<Sphere>,
    /// Steps between two spheres.
    interval: u64,
    /// Spheres that came in.
    released: usize,
}

impl Feed {
    /// These spheres, one every `interval` steps.
    pub(in crate::dem) fn new(spheres: Vec<Sphere>, interval: u64) -> Self {
        Self {
            waiting: spheres.into(),
            interval,
            released: 0,
        }
    }

    /// Whether all spheres are in.
    pub(super) fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    pub(super) fn released(&self) -> usize {
        self.released
    }

    /// How many spheres are not in yet.
    pub(super) fn waiting(&self) -> usize {
        self.waiting.len()
    }

    /// Skips this number of spheres, which came in before.
    pub(super) fn skip(&mut self, spheres: usize) {
        self.waiting.drain(..spheres.min(self.waiting.len()));
        self.released += spheres;
    }

    /// The next step after `step` at which a sphere may come in.
    pub(super) fn due_after(&self, step: u64) -> Option<u64> {
        // Without spheres there may be no interval.
        (!self.waiting.is_empty()).then(|| (step / self.interval + 1) * self.interval)
    }

    /// Lets the next sphere in, if it is time and its place is free.
    pub(super) fn act(&mut self, engine: &mut dyn Engine) {
        if self.waiting.is_empty() || !engine.step().is_multiple_of(self.interval) {
            return;
        }
        let particles = engine.particles();
        let is_free = |sphere: &Sphere| {
            (0..particles.len()).all(|i| {
                let share = match i < particles.fixed {
                    true => 1.0 - ROUNDING,
                    false => 1.0,
                };
                let reach = (sphere.radius + particles.radius[i]) * share;
                (particles
                    .domain
                    .offset(particles.position[i], sphere.position))
                .norm_squared()
                    >= reach * reach
            })
        };
        if let Some(sphere) = self.waiting.pop_front_if(|sphere| is_free(sphere)) {
            engine.insert(&sphere);
            self.released += 1;
        }
    }
}
