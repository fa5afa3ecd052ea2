//! A simulation compiled for its contact laws.

mod contacts;
mod integrate;
mod state;

pub(in crate::dem) use self::state::EngineState;

use self::contacts::PairBlock;
use super::block::{Body, Load};
use super::contact::NormalLaw;
use super::effects::Effect;
use super::friction::TangentialLaw;
use super::guard::Limits;
use super::neighbours::{Near, Reach, VerletList};
use super::particles::{Particles, Sphere, retain};
use super::state::StateError;
use super::vector::Vector;
use super::walls::{Cylinder, Floor, Wall};
use crate::record::Instability;
use crate::scene::{Integrator, Neighbours};
use fearless_simd::{Level, Simd};

/// What the rest of the program needs of a system, whatever its laws.
pub(in crate::dem) trait Engine: Send {
    fn advance(&mut self, steps: u64) -> Result<(), Instability>;
    fn particles(&self) -> &Particles;
    fn step(&self) -> u64;
    fn list(&self) -> Option<&VerletList>;
    /// What the contacts hold at the present positions.
    fn contacts(&mut self) -> Contacts;
    fn use_baseline_instructions(&mut self);
    /// Adds a sphere; effects must not depend on how many there are.
    fn insert(&mut self, sphere: &Sphere);
    /// Removes the spheres that are not to be kept.
    fn retain(&mut self, keep: &[bool]);
    /// Everything that the motion goes on from.
    fn state(&self) -> EngineState;
    /// Takes up a state of the same scene.
    fn restore(&mut self, state: EngineState) -> Result<(), StateError>;
}

/// What contacts hold.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::dem) struct Contacts {
    /// Elastic energy (J).
    pub(in crate::dem) elastic_energy: f64,
    /// Contacts of all moving spheres, one between two of them counted for each.
    pub(in crate::dem) of_moving_spheres: usize,
}

/// What a system is made of besides its laws.
pub(in crate::dem) struct Parts {
    pub(in crate::dem) particles: Particles,
    pub(in crate::dem) floor: Option<Floor>,
    pub(in crate::dem) cylinder: Option<Cylinder>,
    pub(in crate::dem) effects: Vec<Box<dyn Effect>>,
    /// Whether an effect needs the number of spheres below each sphere.
    pub(in crate::dem) shielded: bool,
    pub(in crate::dem) limits: Limits,
    pub(in crate::dem) dt: f64,
    pub(in crate::dem) integrator: Integrator,
    /// Skin of the neighbour list (m).
    pub(in crate::dem) skin: f64,
    pub(in crate::dem) neighbours: Neighbours,
}

/// A simulation compiled for its contact laws.
pub(in crate::dem) struct System<N, T: TangentialLaw> {
    parts: Parts,
    normal: N,
    tangential: T,
    /// Absent where no pair interacts.
    list: Option<VerletList>,
    near: Near,
    /// Whether the near pairs must be looked for anew.
    stale: bool,
    /// Steps since the list was built.
    age: u64,
    /// Steps since the near pairs were looked for.
    near_age: u64,
    bodies: Vec<Body>,
    loads: Vec<Load>,
    block: Box<PairBlock<T::History>>,
    shielding: Vec<u32>,
    /// Spheres that may touch the floor and the cylinder.
    near_floor: Vec<u32>,
    near_cylinder: Vec<u32>,
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

    pub(in crate::dem) fn new(normal: N, tangential: T, parts: Parts) -> Self {
        let count = parts.particles.len();
        let reach = if parts.shielded {
            Reach::Column
        } else {
            Reach::Contact
        };
        let histories =
            |present: bool| vec![T::History::default(); if present { count } else { 0 }];
        let interact = N::ACTS || parts.shielded;
        Self {
            list: interact.then(|| VerletList::new(reach, parts.skin, parts.neighbours)),
            stale: true,
            near: Near::new(N::ACTS, parts.shielded, 0.3 * parts.skin),
            age: 0,
            near_age: 0,
            bodies: if interact {
                bodies_of(&parts.particles)
            } else {
                Vec::new()
            },
            loads: vec![Load::default(); if interact { count } else { 0 }],
            block: Box::new(PairBlock::new()),
            shielding: vec![0; if parts.shielded { count } else { 0 }],
            near_floor: Vec::new(),
            near_cylinder: Vec::new(),
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
    ///
    /// The hot loops are compiled once per instruction set, and no more than once: this is most of
    /// what a build has to do. Wider vectors change no bit: every lane computes what the scalar code
    /// would.
    fn evaluate(&mut self) -> Result<(), Instability> {
        if self.list.is_some() {
            self.gather();
            if self.stale {
                self.refresh()?;
            }
            let level = self.level;
            fearless_simd::dispatch!(level, simd => self.contact_forces(simd));
        } else {
            if self.stale {
                self.rebuild()?;
            }
            self.parts.particles.force.fill(Vector::ZERO);
            self.parts.particles.torque.fill(Vector::ZERO);
        }
        for effect in &mut self.parts.effects {
            effect.apply(self.level, &mut self.parts.particles, &self.shielding);
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

    /// Forces and torques of pairs and walls, and the counts of shielding spheres.
    #[inline(always)]
    fn contact_forces<S: Simd>(&mut self, simd: S) {
        self.pair_forces(simd);
        if let (true, Some(floor)) = (N::ACTS, self.parts.floor) {
            let near = std::mem::take(&mut self.near_floor);
            let mut history = std::mem::take(&mut self.floor_history);
            self.wall_forces(simd, floor, &near, &mut history);
            (self.near_floor, self.floor_history) = (near, history);
        }
        if let (true, Some(cylinder)) = (N::ACTS, self.parts.cylinder) {
            let near = std::mem::take(&mut self.near_cylinder);
            let mut history = std::mem::take(&mut self.cylinder_history);
            self.wall_forces(simd, cylinder, &near, &mut history);
            (self.near_cylinder, self.cylinder_history) = (near, history);
        }
        self.scatter();
        if self.parts.shielded {
            self.near
                .count_shielding(simd, &self.bodies, &mut self.shielding);
        }
    }

    /// Looks for near pairs anew, in a list that holds until they must be looked for again.
    fn refresh(&mut self) -> Result<(), Instability> {
        let Some(list) = &self.list else {
            return self.rebuild();
        };
        self.near.adapt(self.near_age, list.skin());
        self.near_age = 0;
        let time = self.age as f64 * self.parts.dt;
        if !list.holds(&self.parts.particles, time, self.near.margin()) {
            self.rebuild()?;
        }
        self.stale = false;
        if let Some(list) = &self.list {
            let (near, particles) = (&mut self.near, &self.parts.particles);
            let history = &mut self.pair_history;
            let mut forget = |entry: u32| history[entry as usize] = T::History::default();
            let forget: Option<&mut dyn FnMut(u32)> = match Self::REMEMBERS {
                true => Some(&mut forget),
                false => None,
            };
            near.refresh(self.level, list, particles, &self.bodies, forget);
            let margin = near.margin();
            if let Some(wall) = self.parts.floor {
                let (near, history) = (&mut self.near_floor, &mut self.floor_history);
                find_near_wall(wall, particles, margin, near, history);
            }
            if let Some(wall) = self.parts.cylinder {
                let (near, history) = (&mut self.near_cylinder, &mut self.cylinder_history);
                find_near_wall(wall, particles, margin, near, history);
            }
        }
        Ok(())
    }

    /// Fits everything that has an entry per sphere to the spheres that there are now.
    fn renumber(&mut self) {
        if self.list.is_some() {
            self.bodies = bodies_of(&self.parts.particles);
            self.loads.clear();
            self.loads.resize(self.bodies.len(), Load::default());
        }
        self.stale = true;
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
        let age = std::mem::take(&mut self.age);
        let Some(list) = &mut self.list else {
            return Ok(());
        };
        list.adapt(age);
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
}

impl<N: NormalLaw, T: TangentialLaw> Engine for System<N, T> {
    fn advance(&mut self, steps: u64) -> Result<(), Instability> {
        self.steps(steps)?;
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

    fn insert(&mut self, sphere: &Sphere) {
        let Parts {
            particles,
            limits,
            dt,
            floor,
            cylinder,
            ..
        } = &mut self.parts;
        particles.push(sphere);
        limits.add_sphere(sphere.radius, *dt);
        if floor.is_some() {
            self.floor_history.push(T::History::default());
        }
        if cylinder.is_some() {
            self.cylinder_history.push(T::History::default());
        }
        self.list.iter_mut().for_each(VerletList::add_sphere);
        self.near.add_sphere(sphere.position);
        self.renumber();
    }

    fn retain(&mut self, keep: &[bool]) {
        self.parts.particles.retain(keep);
        retain(&mut self.parts.limits.speed_squared, keep);
        retain(&mut self.floor_history, keep);
        retain(&mut self.cylinder_history, keep);
        if let Some(list) = &mut self.list {
            retain(&mut self.pair_history, &list.remove_spheres(keep));
        }
        self.near.remove_spheres(keep);
        self.block.forget();
        self.renumber();
    }

    fn state(&self) -> EngineState {
        self.save()
    }

    fn restore(&mut self, state: EngineState) -> Result<(), StateError> {
        self.take_up(state)
    }

    /// Reads positions alone, and builds the list at most earlier than a step would: bits of
    /// the motion do not depend on when the list is built.
    fn contacts(&mut self) -> Contacts {
        let mut contacts = Contacts::default();
        if !N::ACTS {
            return contacts;
        }
        if self.stale {
            self.gather();
            if self.refresh().is_err() {
                return contacts;
            }
        }
        let Particles {
            position,
            radius,
            fixed,
            ..
        } = &self.parts.particles;
        let mut energy = 0.0;
        let count = &mut contacts.of_moving_spheres;
        let mut pairs = self.near.pairs().iter().peekable();
        for i in 0..radius.len() {
            let (centre, ri) = (position[i], radius[i]);
            while let Some(pair) = pairs.next_if(|pair| pair.i as usize == i) {
                let j = pair.j as usize;
                let rj = radius[j];
                let distance_squared = (centre - position[j]).norm_squared();
                if distance_squared < (ri + rj) * (ri + rj) {
                    let overlap = ri + rj - distance_squared.sqrt();
                    energy += self.normal.elastic_energy(overlap, ri * rj / (ri + rj));
                    *count += usize::from(i >= *fixed) + usize::from(j >= *fixed);
                }
            }
            let walls = [
                self.parts.floor.map(|floor| floor.contact(centre, ri)),
                self.parts
                    .cylinder
                    .map(|cylinder| cylinder.contact(centre, ri)),
            ];
            for contact in walls.into_iter().flatten() {
                if contact.touches {
                    energy += self.normal.elastic_energy(contact.overlap, ri);
                    *count += 1;
                }
            }
        }
        contacts.elastic_energy = energy;
        contacts
    }
}

/// Spheres in rows.
fn bodies_of(particles: &Particles) -> Vec<Body> {
    let inertia = |i: usize| particles.inertia.get(i).copied().unwrap_or(0.0);
    let body = |i: usize| Body {
        place: [0.0, 0.0, 0.0, particles.radius[i]],
        motion: [0.0, 0.0, 0.0, particles.mass[i]],
        turning: [0.0, 0.0, 0.0, inertia(i)],
    };
    (0..particles.len()).map(body).collect()
}

/// Finds the spheres near a wall, and forgets the histories of the others.
fn find_near_wall<W: Wall, H: Default>(
    wall: W,
    particles: &Particles,
    margin: f64,
    near: &mut Vec<u32>,
    histories: &mut [H],
) {
    near.clear();
    for (i, (&centre, &radius)) in particles.position.iter().zip(&particles.radius).enumerate() {
        if wall.is_near(centre, radius, margin) {
            near.push(i as u32);
        } else {
            histories[i] = H::default();
        }
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
