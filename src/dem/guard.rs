//! Numerical guards: a run that breaks one is ended and reported, never corrected.

use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::scene::{Scene, Start, Tank};
use crate::simulation::{Guard, Instability};

/// Limits beyond which a run is ended.
#[derive(Clone, Debug)]
pub(super) struct Limits {
    /// Largest overlap, in radii of the smaller partner.
    pub(super) overlap: f64,
    /// If all velocity components are below this (m/s), no sphere exceeds its speed limit.
    pub(super) slow: f64,
    displacement: f64,
    horizontal: f64,
    vertical: f64,
}

/// A sphere that exceeds its speed limit.
#[derive(Clone, Copy, Debug)]
pub(super) struct TooFast {
    sphere: usize,
    /// (m)
    radius: f64,
    /// (m/s)
    speed: f64,
}

impl Limits {
    /// The scene's limits, or their defaults.
    pub(super) fn new(scene: &Scene, particles: &Particles) -> Self {
        let guards = &scene.dem.guards;
        let reach = scene.tank.as_ref().map(Tank::reach).unwrap_or_default();
        let widest = reach.into_iter().flatten().reduce(f64::max);
        let all_around = reach.iter().all(Option::is_some);
        let floor = scene.tank.as_ref().and_then(|tank| tank.floor);
        let fed = match &scene.start {
            Start::Feed { position, .. } => position[2].abs(),
            _ => 0.0,
        };
        let highest = particles
            .position
            .iter()
            .fold(fed, |most: f64, centre| most.max(centre.z.abs()));
        let mut limits = Self {
            overlap: guards.overlap,
            slow: f64::MAX,
            displacement: guards.displacement,
            horizontal: guards
                .horizontal
                .or(widest.filter(|_| all_around).map(|reach| 2.0 * reach))
                .unwrap_or(f64::MAX),
            vertical: guards
                .vertical
                .or(floor.map(|floor| 10.0 * floor.abs().max(highest).max(widest.unwrap_or(1.0))))
                .unwrap_or(f64::MAX),
        };
        limits.fit(&particles.radius, scene.time.dt);
        limits
    }

    /// Sets `slow` for these spheres.
    pub(super) fn fit(&mut self, radius: &[f64], dt: f64) {
        self.slow = f64::MAX;
        for &radius in radius {
            self.add_sphere(radius, dt);
        }
    }

    /// Includes one more sphere in `slow`.
    pub(super) fn add_sphere(&mut self, radius: f64, dt: f64) {
        // Slightly less than 1 / sqrt(3), to allow for rounding.
        self.slow = self.slow.min(0.577 * self.largest_speed(radius, dt));
    }

    /// The speed (m/s) at which a sphere of this radius (m) reaches the largest displacement per
    /// step.
    fn largest_speed(&self, radius: f64, dt: f64) -> f64 {
        self.displacement * radius / dt
    }

    /// Reports the first sphere whose spin has no finite square, or whose position is not a number
    /// or out of bounds. Spheres that stay or keep to their paths may be anywhere.
    pub(super) fn check_positions(
        &self,
        particles: &Particles,
        step: u64,
        dt: f64,
    ) -> Result<(), Instability> {
        let endless = |spin: &Vector| !(spin.norm_squared() <= f64::MAX);
        if let Some(sphere) = particles.spin.iter().position(endless) {
            return Err(Instability {
                guard: Guard::NotANumber,
                step,
                time: step as f64 * dt,
                sphere,
                detail: format!("spin of {:.4e} rad/s", particles.spin[sphere].norm()),
            });
        }
        // Along a period there is no bound.
        let [x, y, z] = particles.domain.periods();
        let within = |place: f64, bound: f64, period: Option<f64>| match period {
            Some(_) => place.is_finite(),
            None => place.abs() <= bound,
        };
        let outside = |centre: &Vector| {
            !(within(centre.x, self.horizontal, x)
                && within(centre.y, self.horizontal, y)
                && within(centre.z, self.vertical, z))
        };
        let mut all = particles.position.iter().enumerate();
        let found = all.find(|(i, centre)| outside(centre) && !particles.is_prescribed(*i));
        let Some((sphere, _)) = found else {
            return Ok(());
        };
        let Vector { x, y, z, .. } = particles.position[sphere];
        let place = format!("centre at ({x:.4e}, {y:.4e}, {z:.4e}) m");
        let number = !(x.is_nan() || y.is_nan() || z.is_nan());
        Err(Instability {
            guard: if number {
                Guard::OutOfBounds
            } else {
                Guard::NotANumber
            },
            step,
            time: step as f64 * dt,
            sphere,
            detail: if number {
                format!(
                    "{place}; bounds |x|, |y| <= {:.4e} m, |z| <= {:.4e} m",
                    self.horizontal, self.vertical
                )
            } else {
                place
            },
        })
    }

    /// The first of these spheres that exceeds its speed limit. Indices begin at `first`.
    pub(super) fn first_too_fast(
        &self,
        first: usize,
        velocity: &[Vector],
        radius: &[f64],
        dt: f64,
    ) -> Option<TooFast> {
        let mut all = (first..).zip(velocity).zip(radius);
        all.find_map(|((sphere, velocity), &radius)| {
            let largest = self.largest_speed(radius, dt);
            let is_fine = velocity.norm_squared() <= largest * largest;
            (!is_fine).then(|| TooFast {
                sphere,
                radius,
                speed: velocity.norm(),
            })
        })
    }

    /// The report of a sphere that exceeds its speed limit.
    pub(super) fn speed_broken(&self, step: u64, dt: f64, found: TooFast) -> Instability {
        let TooFast {
            sphere,
            radius,
            speed,
        } = found;
        let (guard, detail) = if speed.is_nan() {
            (Guard::NotANumber, "velocity is not a number".to_owned())
        } else {
            let radii = speed * dt / radius;
            let detail = format!(
                "{radii:.3} radii in one step ({speed:.4e} m/s); limit {}",
                self.displacement
            );
            (Guard::Displacement, detail)
        };
        Instability {
            guard,
            step,
            time: step as f64 * dt,
            sphere,
            detail,
        }
    }

    /// The report of an overlap (m) beyond the limit.
    pub(super) fn overlap_broken(
        &self,
        step: u64,
        dt: f64,
        sphere: usize,
        overlap: f64,
    ) -> Instability {
        Instability {
            guard: Guard::Overlap,
            step,
            time: step as f64 * dt,
            sphere,
            detail: format!("overlap {overlap:.4e} m; limit {} radii", self.overlap),
        }
    }
}
