//! Rolling resistance: a separate pass over the touching contacts after their forces, in the order
//! of the lists and on one thread. Only scenes that name it run this pass.
//!
//! Springs are kept by the numbers of their partners, which stay when spheres come, go or are
//! sorted in memory.

use super::System;
use super::adaptive::IslandContacts;
use super::contact_block::EarlierRows;
use super::contact_geometry::{ContactGeometry, inverse_or_zero};
use super::contact_laws::Laws;
use super::contact_state::ContactState;
use super::ledger::{Books, EnergyBooks};
use super::partners::Partners;
use crate::dem::neighbours::NearPair;
use crate::dem::profile::StepPart;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::forces::rolling::{RollingLaw, RollingTouch};
use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::walls::Wall;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// A partner of a contact, whatever its place in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(super) enum RollingPartner {
    /// A sphere that moves, by its number in the scene.
    Sphere(u32),
    /// A fixed sphere. Spheres of the door come last, so that the others keep their numbers when it
    /// opens.
    Fixed(u32),
    /// A wall, by its place among the walls.
    Wall(u32),
}

impl RollingPartner {
    fn of(particles: &Particles, i: u32) -> Self {
        let fixed = particles.fixed as u32;
        if i < fixed {
            return Self::Fixed(i);
        }
        let number = particles.number.get(i as usize).copied();
        Self::Sphere(number.unwrap_or(i - fixed))
    }
}

/// The moments (N m) of the springs of all contacts, on the first partner. Partners are in
/// ascending order.
pub(super) type RollingSprings = BTreeMap<[RollingPartner; 2], Vector>;

/// Rolling resistance and what its contacts remember.
pub(super) struct RollingState {
    law: RollingLaw,
    pub(super) springs: RollingSprings,
    /// Springs of an evaluation, kept for its memory.
    renewed: Vec<([RollingPartner; 2], Vector)>,
}

impl RollingState {
    pub(super) fn new(law: RollingLaw) -> Self {
        Self {
            law,
            springs: RollingSprings::new(),
            renewed: Vec::new(),
        }
    }

    /// Forgets the springs of spheres that are not kept.
    pub(super) fn retain(&mut self, keep: &[bool], particles: &Particles) {
        let gone = (0..).zip(keep).filter(|(_, keep)| !**keep);
        let gone: BTreeSet<RollingPartner> = gone
            .map(|(i, _)| RollingPartner::of(particles, i))
            .collect();
        self.springs
            .retain(|key, _| key.iter().all(|it| !gone.contains(it)));
    }
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Whether springs at contacts are loaded by velocities of an earlier moment, if the integrator
    /// has these.
    pub(super) fn loads_springs(&self) -> bool {
        Self::HAS_HISTORY || self.rolling.is_some()
    }

    /// Adds the torques of rolling resistance, if the scene has it.
    pub(super) fn add_rolling(&mut self) {
        let laws = self.laws();
        let Some(rolling) = &mut self.rolling else {
            return;
        };
        let mut pass = Pass::new(
            laws,
            rolling,
            &mut self.particles,
            &self.earlier,
            &mut self.ledger,
        );
        for &pair in self.neighbours.near.pairs() {
            pass.add_pair(pair);
        }
        for (wall, place) in self.walls.iter().zip(0..) {
            for sphere in &wall.near {
                pass.add_at_wall(&wall.wall, place, sphere.i);
            }
        }
        // Pairs that no longer touch have no spring, near or not.
        pass.springs.clear();
        pass.finish();
        self.mark(StepPart::Rolling);
    }

    /// The same for the contacts of an island. Springs of other contacts stay. Contacts outside all
    /// islands do not touch.
    pub(super) fn add_rolling_of_island(&mut self, contacts: &IslandContacts) {
        let laws = self.laws();
        let Some(rolling) = &mut self.rolling else {
            return;
        };
        let mut pass = Pass::new(
            laws,
            rolling,
            &mut self.particles,
            &self.earlier,
            &mut self.ledger,
        );
        for &pair in &contacts.pairs {
            pass.add_pair(pair);
        }
        for ((wall, place), near) in self.walls.iter().zip(0..).zip(&contacts.walls) {
            for sphere in near {
                pass.add_at_wall(&wall.wall, place, sphere.i);
            }
        }
        pass.finish();
        self.mark(StepPart::Rolling);
    }

    /// The torque (N m) on a sphere at a wall with its place, by these laws and the present spring.
    pub(super) fn rolling_at_wall(&self, laws: Laws<N, T>, wall: (&Wall, u32), i: u32) -> Vector {
        let Some(rolling) = &self.rolling else {
            return Vector::ZERO;
        };
        let (state, meeting) = meeting_at_wall(&laws, &self.particles, &[], wall, i);
        let known = rolling.springs.get(&meeting.key).copied();
        let touch = touch_of(&laws, &state, &meeting);
        let [torque, _] = rolling.law.torque(&touch, known.unwrap_or_default());
        torque * meeting.weight
    }

    /// Energy (J) of the rolling spring of two spheres, at an overlap and effective radius (m).
    pub(super) fn rolling_energy(
        &self,
        [i, j]: [usize; 2],
        overlap: f64,
        effective_radius: f64,
    ) -> f64 {
        let partner = |i: usize| RollingPartner::of(&self.particles, i as u32);
        self.energy_of_spring([partner(i), partner(j)], overlap, effective_radius)
    }

    /// The same for a sphere and a wall, by its place among the walls.
    pub(super) fn rolling_energy_at_wall(
        &self,
        (i, wall): (usize, usize),
        overlap: f64,
        radius: f64,
    ) -> f64 {
        let sphere = RollingPartner::of(&self.particles, i as u32);
        self.energy_of_spring([sphere, RollingPartner::Wall(wall as u32)], overlap, radius)
    }

    fn energy_of_spring(
        &self,
        mut key: [RollingPartner; 2],
        overlap: f64,
        effective_radius: f64,
    ) -> f64 {
        let Some(rolling) = &self.rolling else {
            return 0.0;
        };
        key.sort_unstable();
        let moment = rolling.springs.get(&key);
        moment.map_or(0.0, |&moment| {
            let stiffness = self.normal.stiffness(overlap, effective_radius);
            let stiffness = rolling.law.stiffness(stiffness, effective_radius);
            RollingLaw::energy(moment, stiffness)
        })
    }

    /// Squared frequency (1/s2) and damping rate (1/s) of rolling at an impact of some spheres at
    /// its deepest overlap (m).
    pub(super) fn rolling_rates(
        &self,
        spheres: &[usize],
        overlap: f64,
        effective_radius: f64,
    ) -> [f64; 2] {
        let Some(rolling) = &self.rolling else {
            return [0.0; 2];
        };
        let particles = &self.particles;
        let inverse = spheres.iter().map(|&i| {
            let (inertia, radius) = (particles.inertia[i], particles.radius[i]);
            inverse_rolling_inertia(inertia, particles.inverse_mass[i], radius)
        });
        let turning = spheres.iter().map(|&i| particles.inverse_inertia[i]);
        rolling.law.rates(
            self.normal.stiffness(overlap, effective_radius),
            effective_radius,
            inverse_or_zero(inverse.sum()),
            turning.sum(),
        )
    }
}

/// 1 / (I + m r^2) (1/(kg m2)), zero for what does not move.
fn inverse_rolling_inertia(inertia: f64, inverse_mass: f64, radius: f64) -> f64 {
    match inverse_mass > 0.0 {
        true => 1.0 / (inertia + radius * radius / inverse_mass),
        false => 0.0,
    }
}

/// An evaluation of the torques of some contacts.
struct Pass<'a, N, T> {
    laws: Laws<N, T>,
    law: RollingLaw,
    /// Springs of the previous evaluation. Each is taken out when its contact is computed again.
    springs: &'a mut RollingSprings,
    renewed: &'a mut Vec<([RollingPartner; 2], Vector)>,
    particles: &'a mut Particles,
    earlier: &'a [EarlierRows],
    books: Option<&'a mut Books>,
}

/// A contact whose geometry is known.
struct Meeting {
    /// Both partners, in the order of the springs' keys.
    key: [RollingPartner; 2],
    /// The spheres among them.
    spheres: (u32, Option<u32>),
    /// How often the contact counts.
    weight: f64,
    effective_radius: f64,
    now: ContactGeometry,
    /// The earlier moment whose velocities load springs, if any.
    earlier: Option<ContactGeometry>,
}

impl<'a, N: NormalLaw, T: TangentialLaw> Pass<'a, N, T> {
    fn new(
        laws: Laws<N, T>,
        rolling: &'a mut RollingState,
        particles: &'a mut Particles,
        earlier: &'a [EarlierRows],
        ledger: &'a mut Option<EnergyBooks>,
    ) -> Self {
        Self {
            earlier: match laws.loading.age > 0.0 {
                true => earlier,
                false => &[],
            },
            laws,
            law: rolling.law,
            springs: &mut rolling.springs,
            renewed: &mut rolling.renewed,
            particles,
            books: ledger.as_mut().map(|ledger| &mut ledger.books),
        }
    }

    /// Keeps the springs of the contacts that touch.
    fn finish(self) {
        self.springs.extend(self.renewed.drain(..));
    }

    fn add_pair(&mut self, pair: NearPair) {
        let (mut i, mut j) = (pair.i(), pair.j());
        let mut key = [i, j].map(|it| RollingPartner::of(self.particles, it));
        // The moments of both partners are opposite to the last bit, so either may be kept.
        if key[1] < key[0] {
            key.swap(0, 1);
            (i, j) = (j, i);
        }
        let spheres = Partners::all(self.particles, self.earlier);
        let state = ContactState::of_pair(&spheres, i, j);
        let earlier = state.earlier.map(|motion| {
            let offset = self.laws.earlier_position(state.offset, motion.velocity);
            let state = ContactState {
                offset,
                earlier: None,
                ..state
            };
            self.laws.pair_geometry(&state)
        });
        let meeting = Meeting {
            key,
            spheres: (i, Some(j)),
            weight: 1.0,
            effective_radius: state.effective_radius(),
            now: self.laws.pair_geometry(&state),
            earlier,
        };
        self.add(&state, &meeting);
    }

    fn add_at_wall(&mut self, wall: &Wall, place: u32, i: u32) {
        let (laws, particles) = (&self.laws, &*self.particles);
        let (state, meeting) = meeting_at_wall(laws, particles, self.earlier, (wall, place), i);
        self.add(&state, &meeting);
    }

    fn add(&mut self, state: &ContactState, meeting: &Meeting) {
        let known = self.springs.remove(&meeting.key);
        if !meeting.now.touches {
            return;
        }
        let touch = touch_of(&self.laws, state, meeting);
        let [torque, moment] = self.law.torque(&touch, known.unwrap_or_default());
        self.renewed.push((meeting.key, moment));
        let torque = torque * meeting.weight;
        let (one, other) = meeting.spheres;
        self.turn(one, torque);
        match (other, &mut self.books) {
            (Some(other), _) => self.turn(other, -torque),
            // A wall that turns does the work of its reaction.
            (None, Some(books)) => {
                books.add_power_of_wall(one, [0.0, torque.dot(state.spin[1])]);
            }
            (None, None) => {}
        }
    }

    /// Adds a torque (N m) to a sphere and to the books.
    fn turn(&mut self, i: u32, torque: Vector) {
        self.particles.torque[i as usize] += torque;
        if let Some(books) = &mut self.books {
            books.add(i, Vector::ZERO, Vector::ZERO, torque);
        }
    }
}

/// A sphere and a wall with its place: their motion relative to each other, and their geometry.
fn meeting_at_wall<N: NormalLaw, T: TangentialLaw>(
    laws: &Laws<N, T>,
    particles: &Particles,
    earlier: &[EarlierRows],
    (wall, place): (&Wall, u32),
    i: u32,
) -> (ContactState, Meeting) {
    let spheres = Partners::all(particles, earlier);
    let at_rest = ContactState::at_wall(&spheres, i);
    let radius = at_rest.properties[0].radius;
    let geometry = |position: Vector| {
        let contact = wall.contact(position, radius);
        laws.geometry_at_wall(&at_rest, contact, None)
    };
    let (state, _) = laws.meeting_at_wall(wall, &at_rest);
    let meeting = Meeting {
        key: [
            RollingPartner::of(particles, i),
            RollingPartner::Wall(place),
        ],
        spheres: (i, None),
        weight: wall.weight,
        effective_radius: radius,
        now: geometry(state.offset),
        earlier: (at_rest.earlier)
            .map(|motion| geometry(laws.earlier_position(state.offset, motion.velocity))),
    };
    (state, meeting)
}

/// The contact in the form that rolling laws take.
///
/// Its rate is the difference of the spins, without the part along the normal. A common
/// rotation of both partners cancels, whatever their radii. R_eff times this rate is the speed
/// at which the contact moves along both surfaces if they do not slide. With opposite torques,
/// which conserve angular momentum, the power is the torque times this rate.
fn touch_of<N: NormalLaw, T: TangentialLaw>(
    laws: &Laws<N, T>,
    state: &ContactState,
    meeting: &Meeting,
) -> RollingTouch {
    let Meeting {
        effective_radius,
        now,
        earlier,
        ..
    } = meeting;
    let rate = |spin: [Vector; 2], geometry: &ContactGeometry| {
        (spin[0] - spin[1]).perpendicular_to(geometry.normal)
    };
    let stiffness = |overlap: f64| {
        let normal = &laws.normal;
        normal.stiffness(overlap, *effective_radius)
    };
    let present = (rate(state.spin, now), stiffness(now.overlap));
    let (loading_rate, loading_stiffness) = match (earlier, &state.earlier) {
        (Some(geometry), Some(motion)) => {
            (rate(motion.spin, geometry), stiffness(geometry.overlap))
        }
        _ => present,
    };
    let approach = -state.velocity.dot(now.normal);
    let force = laws.normal.force(
        now.overlap,
        approach,
        now.contact_radius,
        now.effective_mass,
    );
    let inverse = state
        .properties
        .map(|it| inverse_rolling_inertia(it.inertia, it.inverse_mass, it.radius));
    RollingTouch {
        normal: now.normal,
        normal_force: force.max(0.0),
        effective_radius: *effective_radius,
        stiffness: present.1,
        inertia: inverse_or_zero(inverse[0] + inverse[1]),
        rate: present.0,
        loading_rate,
        loading_stiffness,
        loading_time: laws.loading.duration,
    }
}
