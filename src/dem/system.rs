//! A simulation compiled for its contact laws.

use super::contact::NormalLaw;
use super::effects::Effect;
use super::friction::{TangentialLaw, Touch};
use super::guard::Limits;
use super::neighbours::{Reach, VerletList};
use super::particles::Particles;
use super::vector::Vector;
use super::walls::{Cylinder, Floor, Wall};
use crate::record::Instability;
use crate::scene::Integrator;
use fearless_simd::Level;

/// What the rest of the program needs of a system, whatever its laws.
pub(super) trait Engine: Send {
    fn advance(&mut self, steps: u64) -> Result<(), Instability>;
    fn particles(&self) -> &Particles;
    fn step(&self) -> u64;
    fn list(&self) -> Option<&VerletList>;
    fn elastic_energy(&mut self) -> f64;
    fn use_baseline_instructions(&mut self);
}

/// What a system is made of besides its laws.
pub(super) struct Parts {
    pub(super) particles: Particles,
    pub(super) floor: Option<Floor>,
    pub(super) cylinder: Option<Cylinder>,
    pub(super) effects: Vec<Box<dyn Effect>>,
    /// Whether an effect needs the number of spheres below each sphere.
    pub(super) shielded: bool,
    pub(super) limits: Limits,
    pub(super) dt: f64,
    pub(super) integrator: Integrator,
    /// Skin of the neighbour list (m).
    pub(super) skin: f64,
}

/// A pair that touches, and its entry in the list.
#[derive(Clone, Copy, Default)]
struct TouchingPair {
    i: u32,
    j: u32,
    entry: u32,
}

/// What a contact needs to know of a sphere, side by side in memory.
#[derive(Clone, Copy, Default)]
struct Body {
    position: Vector,
    radius: f64,
    velocity: Vector,
    mass: f64,
    spin: Vector,
    inertia: f64,
}

/// What a contact adds to a sphere.
#[derive(Clone, Copy, Default)]
struct Load {
    force: Vector,
    torque: Vector,
}

/// A simulation compiled for its contact laws.
pub(super) struct System<N, T: TangentialLaw> {
    parts: Parts,
    normal: N,
    tangential: T,
    /// Absent where no pair interacts.
    list: Option<VerletList>,
    stale: bool,
    /// Steps since the list was built.
    age: u64,
    bodies: Vec<Body>,
    loads: Vec<Load>,
    touching: Vec<TouchingPair>,
    shielding: Vec<u32>,
    /// Histories of listed pairs, of the floor and of the cylinder. A law without history has one
    /// of no size, and these take no memory.
    pair_history: Vec<T::History>,
    floor_history: Vec<T::History>,
    cylinder_history: Vec<T::History>,
    step: u64,
    level: Level,
    /// The first sphere found beyond the overlap limit in this step, with its overlap.
    too_deep: Option<(usize, f64)>,
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    const REMEMBERS: bool = size_of::<T::History>() > 0;

    pub(super) fn new(normal: N, tangential: T, parts: Parts) -> Self {
        let count = parts.particles.len();
        let reach = if parts.shielded {
            Reach::Column
        } else {
            Reach::Contact
        };
        let histories =
            |present: bool| vec![T::History::default(); if present { count } else { 0 }];
        Self {
            list: (N::ACTS || parts.shielded).then(|| VerletList::new(reach, parts.skin)),
            stale: true,
            age: 0,
            bodies: Vec::new(),
            loads: Vec::new(),
            touching: Vec::new(),
            shielding: vec![0; if parts.shielded { count } else { 0 }],
            pair_history: Vec::new(),
            floor_history: histories(parts.floor.is_some()),
            cylinder_history: histories(parts.cylinder.is_some()),
            normal,
            tangential,
            parts,
            step: 0,
            level: Level::new(),
            too_deep: None,
        }
    }

    /// Evaluates all forces and torques at the present positions and velocities.
    #[inline(always)]
    fn evaluate(&mut self) -> Result<(), Instability> {
        if self.stale {
            self.rebuild()?;
        }
        if self.list.is_some() {
            self.gather();
            if self.parts.shielded {
                self.scan::<true>()
            } else {
                self.scan::<false>()
            }
            self.pair_forces();
            self.scatter();
        } else {
            self.parts.particles.force.fill(Vector::ZERO);
            self.parts.particles.torque.fill(Vector::ZERO);
        }
        if N::ACTS {
            if let Some(floor) = self.parts.floor {
                let mut history = std::mem::take(&mut self.floor_history);
                self.wall_forces(floor, &mut history);
                self.floor_history = history;
            }
            if let Some(cylinder) = self.parts.cylinder {
                let mut history = std::mem::take(&mut self.cylinder_history);
                self.wall_forces(cylinder, &mut history);
                self.cylinder_history = history;
            }
        }
        for effect in &mut self.parts.effects {
            effect.apply(&mut self.parts.particles, &self.shielding);
        }
        match self.too_deep.take() {
            Some((sphere, overlap)) => {
                Err(self
                    .parts
                    .limits
                    .overlap_broken(self.step, self.parts.dt, sphere, overlap))
            }
            None => Ok(()),
        }
    }

    /// Builds the list anew, after making sure that every sphere is somewhere.
    fn rebuild(&mut self) -> Result<(), Instability> {
        let Parts {
            particles,
            limits,
            dt,
            ..
        } = &self.parts;
        limits.check_positions(particles, self.step, *dt)?;
        self.stale = false;
        self.age = 0;
        let Some(list) = &mut self.list else {
            return Ok(());
        };
        if !Self::REMEMBERS {
            list.build(particles);
            self.pair_history
                .resize(list.pairs(), T::History::default());
            return Ok(());
        }
        let (start, neighbour) = (list.start().to_vec(), list.neighbour().to_vec());
        list.build(particles);
        let old = std::mem::take(&mut self.pair_history);
        self.pair_history = carry_over(&start, &neighbour, &old, list.start(), list.neighbour());
        Ok(())
    }

    /// Copies the state of the spheres into the order of memory that contacts read best.
    #[inline(always)]
    fn gather(&mut self) {
        let Particles {
            position,
            velocity,
            radius,
            mass,
            spin,
            inertia,
            ..
        } = &self.parts.particles;
        self.bodies.clear();
        self.bodies.extend(
            position
                .iter()
                .zip(velocity)
                .zip(radius.iter().zip(mass))
                .map(|((&position, &velocity), (&radius, &mass))| Body {
                    position,
                    radius,
                    velocity,
                    mass,
                    ..Body::default()
                }),
        );
        for ((body, &spin), &inertia) in self.bodies.iter_mut().zip(spin).zip(inertia) {
            body.spin = spin;
            body.inertia = inertia;
        }
        self.loads.clear();
        self.loads.resize(self.bodies.len(), Load::default());
    }

    /// Copies forces and torques of the contacts back to the spheres.
    #[inline(always)]
    fn scatter(&mut self) {
        let Particles { force, torque, .. } = &mut self.parts.particles;
        for (force, load) in force.iter_mut().zip(&self.loads) {
            *force = load.force;
        }
        for (torque, load) in torque.iter_mut().zip(&self.loads) {
            *torque = load.torque;
        }
    }

    /// Goes through the list once: notes the pairs that touch and counts the shielding spheres.
    #[inline(always)]
    fn scan<const SHIELD: bool>(&mut self) {
        let Some(list) = &self.list else { return };
        if SHIELD {
            self.shielding.fill(0);
        }
        // One spare slot: a pair is always written, and kept only if it touches.
        self.touching
            .resize(list.pairs() + 1, TouchingPair::default());
        let mut kept = 0;
        let bodies = &self.bodies[..];
        for (i, bounds) in list.start().windows(2).enumerate() {
            let Body {
                position: centre,
                radius: ri,
                ..
            } = bodies[i];
            let mut below = 0;
            let first = bounds[0];
            let neighbours = &list.neighbour()[first as usize..bounds[1] as usize];
            for (entry, &j) in (first..).zip(neighbours) {
                let Body {
                    position,
                    radius: rj,
                    ..
                } = bodies[j as usize];
                let offset = centre - position;
                if N::ACTS {
                    self.touching[kept] = TouchingPair {
                        i: i as u32,
                        j,
                        entry,
                    };
                    let touches = offset.norm_squared() < (ri + rj) * (ri + rj);
                    kept += usize::from(touches);
                    if Self::REMEMBERS && !touches {
                        self.pair_history[entry as usize] = T::History::default();
                    }
                }
                if SHIELD {
                    let (dx, dy) = (offset.x.abs(), offset.y.abs());
                    let within = |diameter: f64| (dx < diameter) & (dy < diameter);
                    below += u32::from(within(2.0 * ri) & (offset.z > 0.0));
                    self.shielding[j as usize] += u32::from(within(2.0 * rj) & (offset.z < 0.0));
                }
            }
            if SHIELD {
                self.shielding[i] += below;
            }
        }
        self.touching.truncate(kept);
    }

    #[inline(always)]
    fn pair_forces(&mut self) {
        let (bodies, loads) = (&self.bodies[..], &mut self.loads[..]);
        let overlap_limit = self.parts.limits.overlap;
        for &TouchingPair { i, j, entry } in &self.touching {
            let (i, j) = (i as usize, j as usize);
            let (one, other) = (&bodies[i], &bodies[j]);
            let offset = one.position - other.position;
            let distance = offset.norm();
            let normal = offset * (1.0 / distance);
            let sum = one.radius + other.radius;
            let overlap = sum - distance;
            let effective_radius = one.radius * other.radius / sum;
            let velocity = one.velocity - other.velocity;
            let normal_force = self
                .normal
                .force(overlap, -velocity.dot(normal), effective_radius);
            if overlap > overlap_limit * one.radius.min(other.radius) || distance == 0.0 {
                self.too_deep.get_or_insert((i, overlap));
            }
            let mut force = normal * normal_force;
            if T::ROTATES {
                // Both centres turn about the point where the surfaces meet, so that the pair
                // keeps its angular momentum.
                let lever = distance / sum;
                let touch = Touch {
                    normal,
                    velocity,
                    spin: [one.spin, other.spin],
                    lever: [one.radius * lever, other.radius * lever],
                    inertia: [one.inertia, other.inertia],
                    lesser_mass: one.mass.min(other.mass),
                    overlap,
                    effective_radius,
                    normal_force,
                };
                let history = &mut self.pair_history[entry as usize];
                let traction = self.tangential.traction(&touch, history);
                force += traction.force;
                loads[i].torque += traction.torque[0];
                loads[j].torque += traction.torque[1];
            }
            loads[i].force += force;
            loads[j].force -= force;
        }
    }

    #[inline(always)]
    fn wall_forces<W: Wall>(&mut self, wall: W, histories: &mut [T::History]) {
        let Parts {
            particles, limits, ..
        } = &mut self.parts;
        for i in 0..particles.len() {
            let radius = particles.radius[i];
            let Some((overlap, normal)) = wall.touch(particles.position[i], radius) else {
                if Self::REMEMBERS {
                    histories[i] = T::History::default();
                }
                continue;
            };
            let velocity = particles.velocity[i];
            let normal_force = self.normal.force(overlap, -velocity.dot(normal), radius);
            if overlap > limits.overlap * radius {
                self.too_deep.get_or_insert((i, overlap));
            }
            let mut force = normal * normal_force;
            if T::ROTATES {
                let touch = Touch {
                    normal,
                    velocity,
                    spin: [particles.spin[i], Vector::ZERO],
                    lever: [radius, 0.0],
                    inertia: [particles.inertia[i], 0.0],
                    lesser_mass: particles.mass[i],
                    overlap,
                    effective_radius: radius,
                    normal_force,
                };
                let traction = self.tangential.traction(&touch, &mut histories[i]);
                force += traction.force;
                particles.torque[i] += traction.torque[0];
            }
            particles.force[i] += force;
        }
    }

    /// v += a dt for a time `dt`, and the same for spins. True if a sphere is too fast.
    #[inline(always)]
    fn kick(&mut self, dt: f64) -> bool {
        let Particles {
            velocity,
            force,
            spin,
            torque,
            inverse_mass,
            inverse_inertia,
            ..
        } = &mut self.parts.particles;
        let mut too_fast = false;
        let limits = &self.parts.limits.speed_squared;
        for (((velocity, &force), inverse), &limit) in velocity
            .iter_mut()
            .zip(force.iter())
            .zip(inverse_mass.iter())
            .zip(limits)
        {
            *velocity += force * (inverse * dt);
            // Written so that a speed which is not a number counts.
            too_fast |= !(velocity.norm_squared() <= limit);
        }
        for ((spin, &torque), inverse) in spin
            .iter_mut()
            .zip(torque.iter())
            .zip(inverse_inertia.iter())
        {
            *spin += torque * (inverse * dt);
        }
        too_fast
    }

    /// x += v dt. Notes whether a sphere left the skin of the list.
    #[inline(always)]
    fn drift(&mut self) {
        let dt = self.parts.dt;
        let Particles {
            position, velocity, ..
        } = &mut self.parts.particles;
        self.age += 1;
        let Some(list) = &self.list else {
            for (position, &velocity) in position.iter_mut().zip(velocity.iter()) {
                *position += velocity * dt;
            }
            return;
        };
        let allowance = list.allowance(self.age as f64 * dt);
        let mut moved = false;
        for ((position, &velocity), &reference) in position
            .iter_mut()
            .zip(velocity.iter())
            .zip(list.reference())
        {
            *position += velocity * dt;
            moved |= !allowance.holds(*position, reference);
        }
        self.stale = moved;
    }

    fn check_speeds(&self, too_fast: bool) -> Result<(), Instability> {
        if too_fast {
            let Parts {
                particles,
                limits,
                dt,
                ..
            } = &self.parts;
            limits.check_speeds(particles, self.step, *dt)?;
        }
        Ok(())
    }

    #[inline(always)]
    fn steps(&mut self, steps: u64) -> Result<(), Instability> {
        for _ in 0..steps {
            match self.parts.integrator {
                Integrator::SymplecticEuler => self.symplectic_euler()?,
                Integrator::VelocityVerlet => self.velocity_verlet()?,
            }
        }
        Ok(())
    }

    /// One step of symplectic Euler: v += a(x, v) dt, then x += v dt.
    #[inline(always)]
    fn symplectic_euler(&mut self) -> Result<(), Instability> {
        self.step += 1;
        self.evaluate()?;
        let too_fast = self.kick(self.parts.dt);
        self.check_speeds(too_fast)?;
        self.drift();
        Ok(())
    }

    /// One step of velocity Verlet, with forces from the new positions and the half-step
    /// velocities. The forces of the step before serve its first half.
    #[inline(always)]
    fn velocity_verlet(&mut self) -> Result<(), Instability> {
        self.step += 1;
        if self.step == 1 {
            self.evaluate()?;
        }
        let half = 0.5 * self.parts.dt;
        let too_fast = self.kick(half);
        self.check_speeds(too_fast)?;
        self.drift();
        self.evaluate()?;
        let too_fast = self.kick(half);
        self.check_speeds(too_fast)
    }
}

impl<N: NormalLaw, T: TangentialLaw> Engine for System<N, T> {
    fn advance(&mut self, steps: u64) -> Result<(), Instability> {
        // The hot loops are compiled once per instruction set. Wider vectors change no bit:
        // every lane computes what the scalar code would.
        let level = self.level;
        fearless_simd::dispatch!(level, simd => {
            let _ = simd;
            self.steps(steps)
        })?;
        let Parts {
            particles,
            limits,
            dt,
            ..
        } = &self.parts;
        limits.check_positions(particles, self.step, *dt)
    }

    fn use_baseline_instructions(&mut self) {
        self.level = Level::baseline();
    }

    fn particles(&self) -> &Particles {
        &self.parts.particles
    }

    fn step(&self) -> u64 {
        self.step
    }

    fn list(&self) -> Option<&VerletList> {
        self.list.as_ref()
    }

    /// Reads positions alone, and builds the list at most earlier than a step would: bits of
    /// the motion do not depend on when the list is built.
    fn elastic_energy(&mut self) -> f64 {
        if !N::ACTS || (self.stale && self.rebuild().is_err()) {
            return 0.0;
        }
        let Some(list) = &self.list else { return 0.0 };
        let Particles {
            position, radius, ..
        } = &self.parts.particles;
        let mut energy = 0.0;
        for i in 0..radius.len() {
            let (centre, ri) = (position[i], radius[i]);
            let entries = list.start()[i] as usize..list.start()[i + 1] as usize;
            for &j in &list.neighbour()[entries] {
                let rj = radius[j as usize];
                let distance_squared = (centre - position[j as usize]).norm_squared();
                if distance_squared < (ri + rj) * (ri + rj) {
                    let overlap = ri + rj - distance_squared.sqrt();
                    energy += self.normal.elastic_energy(overlap, ri * rj / (ri + rj));
                }
            }
            let walls = [
                self.parts.floor.and_then(|floor| floor.touch(centre, ri)),
                self.parts
                    .cylinder
                    .and_then(|cylinder| cylinder.touch(centre, ri)),
            ];
            for (overlap, _) in walls.into_iter().flatten() {
                energy += self.normal.elastic_energy(overlap, ri);
            }
        }
        energy
    }
}

/// Histories in the order of a new list; both lists are sorted, so one pass over each suffices.
fn carry_over<H: Copy + Default>(
    old_start: &[u32],
    old_neighbour: &[u32],
    old: &[H],
    start: &[u32],
    neighbour: &[u32],
) -> Vec<H> {
    let mut histories = vec![H::default(); neighbour.len()];
    if old.is_empty() {
        return histories;
    }
    for i in 0..start.len() - 1 {
        let mut from = old_start[i] as usize;
        let end = old_start[i + 1] as usize;
        for entry in start[i] as usize..start[i + 1] as usize {
            while from < end && old_neighbour[from] < neighbour[entry] {
                from += 1;
            }
            if from < end && old_neighbour[from] == neighbour[entry] {
                histories[entry] = old[from];
            }
        }
    }
    histories
}
