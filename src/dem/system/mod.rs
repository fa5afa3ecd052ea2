//! A simulation compiled for its contact laws.

mod adaptive;
mod contacts;
mod couple;
mod division;
mod evaluate;
mod integrate;
mod lanes;
mod ledger;
mod lists;
mod measure;
mod meeting;
mod moves;
mod order;
mod pair_block;
mod partners;
mod share;
mod state;
mod stream;
mod sums;
mod touching;
mod wall_contacts;

use self::adaptive::Workspace;
use self::couple::Solid;
use self::division::Division;
use self::integrate::Before;
use self::ledger::Ledger;
pub(in crate::dem) use self::ledger::Work;
use self::meeting::Loading;
use self::pair_block::EarlierRows;
use self::share::Buffers;
pub(in crate::dem) use self::state::EngineState;
use self::wall_contacts::WallContacts;
use super::bodies::Bodies;
use super::contact::NormalLaw;
use super::effects::Effect;
use super::friction::TangentialLaw;
use super::guard::Limits;
use super::neighbours::{Near, NearPair, Reach, VerletList};
use super::particles::{Particles, Sphere, retain};
use super::profile::{self, Part, Profile};
use super::state::StateError;
use super::walls::TankWall;
use crate::scene::{Integrator, Neighbours};
use crate::simulation::Instability;
use fearless_simd::Level;

/// What the rest of the program needs of a system, whatever its laws.
pub(in crate::dem) trait Engine: Send {
    fn advance(&mut self, steps: u64) -> Result<(), Instability>;
    fn particles(&self) -> &Particles;
    fn step(&self) -> u64;
    /// How often a sphere was moved, parts of steps counted.
    fn moves(&self) -> u64;
    fn list(&self) -> Option<&VerletList>;
    /// What the contacts hold at the present positions.
    fn contacts(&mut self) -> Contacts;
    fn use_baseline_instructions(&mut self);
    /// Divides the work of a sorted scene among so many threads, of the pool that the engine then
    /// runs in. Whether it does.
    fn use_threads(&mut self, threads: usize) -> bool;
    /// Begins to keep the books of energy; never changes the motion.
    fn keep_ledger(&mut self);
    /// Begins to measure what the parts of a step take; never changes the motion.
    fn keep_profile(&mut self, profile: Profile);
    /// What was measured, if anything is.
    fn profile(&self) -> Option<&Profile>;
    /// Work since the start, if books are kept.
    fn work(&self) -> Option<Work>;
    /// Adds a sphere; effects must not depend on how many there are.
    fn insert(&mut self, sphere: &Sphere);
    /// Removes the spheres that are not to be kept.
    fn retain(&mut self, keep: &[bool]);
    /// Forgets all that is known of contacts, for its memory: the motion is over.
    fn forget_contacts(&mut self);
    /// Everything that the motion goes on from.
    fn state(&self) -> EngineState<'_>;
    /// Takes up a state of the same scene.
    fn restore(&mut self, state: EngineState<'_>) -> Result<(), StateError>;
}

/// What contacts hold.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::dem) struct Contacts {
    /// Elastic energy (J).
    pub(in crate::dem) elastic_energy: f64,
    /// Energy of tangential springs (J), if books are kept.
    pub(in crate::dem) spring_energy: f64,
    /// Contacts of all moving spheres, one between two of them counted for each.
    pub(in crate::dem) of_moving_spheres: usize,
}

/// What a system is made of besides its laws.
pub(in crate::dem) struct Parts {
    pub(in crate::dem) particles: Particles,
    /// In the order in which they act.
    pub(in crate::dem) walls: Vec<TankWall>,
    /// Those of a potential first.
    pub(in crate::dem) effects: Vec<Box<dyn Effect>>,
    /// Whether an effect needs the number of spheres below each sphere.
    pub(in crate::dem) shielded: bool,
    pub(in crate::dem) limits: Limits,
    pub(in crate::dem) dt: f64,
    pub(in crate::dem) integrator: Integrator,
    /// Skin of the neighbour list (m).
    pub(in crate::dem) skin: f64,
    pub(in crate::dem) neighbours: Neighbours,
    /// Whether spheres are sorted in memory; their numbers then follow them.
    pub(in crate::dem) sorted: bool,
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
    /// Since the list was built.
    age: Age,
    /// Since the near pairs were looked for.
    near_age: Age,
    /// How springs are loaded until the next evaluation.
    loading: Loading,
    /// The velocities and spins that load them, if these are not those of the evaluation.
    earlier: Vec<EarlierRows>,
    before: Before,
    workspace: Workspace<T::History>,
    ledger: Option<Ledger>,
    profile: Option<Box<Profile>>,
    /// What all spheres are like, if they are alike.
    alike: Option<Solid>,
    buffers: Box<Buffers<T::History>>,
    /// Of every thread.
    bodies: Vec<Bodies>,
    /// The walls, and what may touch them.
    walls: Vec<WallContacts<T::History>>,
    /// Histories of near pairs. A law without history has one of no size, and these take no memory.
    pair_history: Vec<T::History>,
    /// Who answers for which spheres, if it is not one thread for all.
    division: Option<Division<T::History>>,
    /// Whether forces and torques are zero already.
    cleared: bool,
    /// Whether spheres have done the first half of the next step already.
    begun: bool,
    /// The near pairs of before, for their memory.
    spare_pairs: Vec<NearPair>,
    step: u64,
    moves: u64,
    level: Level,
    /// The first sphere found beyond the overlap limit in this step, with its overlap.
    too_deep: Option<(usize, f64)>,
}

/// How long ago something was.
#[derive(Clone, Copy, Debug, Default)]
struct Age {
    /// Steps begun since.
    steps: u64,
    /// Time that the spheres moved since (s).
    time: f64,
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    const REMEMBERS: bool = size_of::<T::History>() > 0;

    pub(in crate::dem) fn new(normal: N, tangential: T, parts: Parts) -> Self {
        let reach = if parts.shielded {
            Reach::Column
        } else {
            Reach::Contact
        };
        let interact = N::ACTS || parts.shielded;
        Self {
            list: interact.then(|| {
                let list = VerletList::new(reach, parts.skin, parts.neighbours);
                if parts.sorted { list.of_sorted() } else { list }
            }),
            stale: true,
            near: Near::new(N::ACTS, parts.shielded, 0.3 * parts.skin),
            age: Age::default(),
            near_age: Age::default(),
            loading: Loading::present(parts.dt),
            earlier: Vec::new(),
            before: Before::default(),
            workspace: Workspace::default(),
            ledger: None,
            profile: None,
            alike: Self::alike(&parts.particles),
            buffers: Buffers::new(),
            bodies: Vec::new(),
            walls: parts.walls.iter().copied().map(WallContacts::new).collect(),
            pair_history: Vec::new(),
            division: None,
            cleared: false,
            begun: false,
            spare_pairs: Vec::new(),
            normal,
            tangential,
            parts,
            step: 0,
            moves: 0,
            level: Level::new(),
            too_deep: None,
        }
    }

    /// Ends a part of a step that is looked at.
    #[inline(always)]
    fn mark(&mut self, part: Part) {
        profile::mark(&mut self.profile, part);
    }

    /// The same of the ledger, if there is one.
    #[inline(always)]
    fn mark_ledger(&mut self) {
        if self.ledger.is_some() {
            self.mark(Part::Ledger);
        }
    }
}

impl<N: NormalLaw, T: TangentialLaw> Engine for System<N, T> {
    fn advance(&mut self, steps: u64) -> Result<(), Instability> {
        self.profile.iter_mut().for_each(|it| it.enter());
        let result = self.steps(steps);
        self.profile.iter_mut().for_each(|it| it.leave());
        result?;
        self.check_positions()
    }

    fn use_baseline_instructions(&mut self) {
        self.level = Level::baseline();
    }

    fn use_threads(&mut self, threads: usize) -> bool {
        let divides = self.parts.sorted && threads > 1;
        self.division = divides.then(|| Division::new(threads));
        self.stale = true;
        divides
    }

    fn particles(&self) -> &Particles {
        &self.parts.particles
    }

    fn step(&self) -> u64 {
        self.step
    }

    fn moves(&self) -> u64 {
        self.moves
    }

    fn list(&self) -> Option<&VerletList> {
        self.list.as_ref()
    }

    fn keep_ledger(&mut self) {
        self.ledger = Some(Ledger::default());
    }

    fn keep_profile(&mut self, profile: Profile) {
        self.profile = Some(Box::new(profile));
    }

    fn profile(&self) -> Option<&Profile> {
        self.profile.as_deref()
    }

    fn work(&self) -> Option<Work> {
        self.ledger.as_ref().map(|ledger| ledger.books.work)
    }

    fn insert(&mut self, sphere: &Sphere) {
        let before = self.energy_in_books();
        let Parts {
            particles,
            limits,
            dt,
            ..
        } = &mut self.parts;
        particles.push(sphere);
        if let Some(ledger) = &mut self.ledger {
            ledger.books.add_sphere();
        }
        limits.add_sphere(sphere.radius, *dt);
        self.list.iter_mut().for_each(VerletList::add_sphere);
        self.near.add_sphere(sphere.position);
        self.renumber();
        self.note_exchange(before);
    }

    fn retain(&mut self, keep: &[bool]) {
        let before = self.energy_in_books();
        self.parts.particles.retain(keep);
        if let Some(ledger) = &mut self.ledger {
            ledger.books.retain(keep);
        }
        self.walls.iter_mut().for_each(|wall| wall.retain(keep));
        let lists = self.list.iter_mut();
        lists.for_each(|list| list.remove_spheres(keep));
        retain(&mut self.pair_history, &self.near.remove_spheres(keep));
        self.renumber();
        self.note_exchange(before);
    }

    fn forget_contacts(&mut self) {
        self.list = None;
        self.near = Near::new(false, false, 0.0);
        self.pair_history = Vec::new();
        self.spare_pairs = Vec::new();
        self.walls.clear();
        self.division = None;
        self.earlier = Vec::new();
        self.before = Before::default();
        self.workspace = Workspace::default();
    }

    fn state(&self) -> EngineState<'_> {
        self.save()
    }

    fn restore(&mut self, state: EngineState<'_>) -> Result<(), StateError> {
        self.take_up(state)
    }

    fn contacts(&mut self) -> Contacts {
        self.measure_contacts()
    }
}
