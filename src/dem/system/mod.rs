//! A simulation compiled for its contact laws.

mod adaptive;
mod candidates;
mod contact_block;
mod contact_geometry;
mod contact_laws;
mod contact_state;
mod contact_task;
mod division;
mod drive;
mod evaluate;
mod integrate;
mod lanes;
mod ledger;
mod lists;
mod measure;
mod moves;
mod order;
mod partners;
mod rolling;
mod seen;
mod state;
mod stream;
mod sums;
mod touching;
mod wall_contacts;

use self::adaptive::Workspace;
use self::contact_block::EarlierRows;
use self::contact_laws::Loading;
use self::contact_state::SphereProperties;
use self::contact_task::{Buffers, TooDeep};
use self::division::Division;
use self::integrate::MotionBefore;
use self::ledger::EnergyBooks;
pub(in crate::dem) use self::ledger::LedgerWork;
use self::rolling::RollingState;
pub(in crate::dem) use self::seen::{Partner, SeenContact, WallTouch};
pub(in crate::dem) use self::state::EngineState;
use self::wall_contacts::WallContacts;
use super::guard::Limits;
use super::neighbours::{Near, NearPair, Purpose, VerletList};
use super::profile::{self, Profile, StepPart};
use crate::forces::contact::NormalLaw;
use crate::forces::effects::PlacedEffect;
use crate::forces::friction::TangentialLaw;
use crate::forces::rolling::RollingLaw;
use crate::particles::bodies::Bodies;
use crate::particles::{Particles, Sphere, retain};
use crate::scene::{Driven, Integrator, Neighbours};
use crate::simulation::Instability;
use crate::simulation::StateError;
use crate::walls::Wall;
use fearless_simd::Level;

/// What the rest of the program asks of a system, whatever its laws.
pub(in crate::dem) trait Engine: Send {
    fn advance(&mut self, steps: u64) -> Result<(), Instability>;
    fn particles(&self) -> &Particles;
    fn step(&self) -> u64;
    /// How often a sphere was moved. Each sub-step counts.
    fn moves(&self) -> u64;
    fn list(&self) -> Option<&VerletList>;
    /// Energies and number of the contacts at the present positions.
    fn contacts(&mut self) -> Contacts;
    /// Shows all contacts of spheres that move, in a fixed order, with their forces if `forces`.
    /// This never changes the motion.
    fn see_contacts(&mut self, forces: bool, see: &mut dyn FnMut(SeenContact));
    /// Whether each wall and joint acts on spheres: a door that has opened does not.
    fn walls_that_act(&self) -> Vec<bool>;
    fn use_baseline_instructions(&mut self);
    /// Divides the work of a sorted scene among this number of threads. The engine must then run in
    /// a pool of them. Returns whether the work is divided.
    fn use_threads(&mut self, threads: usize) -> bool;
    /// Begins to keep the energy balance. This never changes the motion.
    fn keep_ledger(&mut self);
    /// Begins to measure the time of each part of a step. This never changes the motion.
    fn keep_profile(&mut self, profile: Profile);
    /// The measured profile, if one is kept.
    fn profile(&self) -> Option<&Profile>;
    /// Work since the start, if a ledger is kept.
    fn work(&self) -> Option<LedgerWork>;
    /// Adds a sphere; effects must not depend on how many there are.
    fn insert(&mut self, sphere: &Sphere);
    /// Removes the spheres that are not marked in `keep`.
    fn retain(&mut self, keep: &[bool]);
    /// Opens the floor, if it has a closed opening, and takes doors away.
    fn open_doors(&mut self);
    /// Frees the memory of contacts and lists. The motion must be over.
    fn forget_contacts(&mut self);
    /// The state from which the motion continues.
    fn state(&self) -> EngineState<'_>;
    /// Continues from a state of the same scene, in which doors are open or closed.
    fn restore(&mut self, state: EngineState<'_>, doors_are_open: bool) -> Result<(), StateError>;
}

/// Energies and number of contacts.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::dem) struct Contacts {
    /// Elastic energy (J).
    pub(in crate::dem) elastic_energy: f64,
    /// Energy of tangential and rolling springs (J), if a ledger is kept.
    pub(in crate::dem) spring_energy: f64,
    /// Contacts of all moving spheres. A contact between two of them counts twice.
    pub(in crate::dem) of_moving_spheres: i64,
}

/// What a scene specifies for a system besides its laws and spheres. It does not change.
pub(in crate::dem) struct SystemSetup {
    /// In the order in which they act.
    pub(in crate::dem) walls: Vec<Wall>,
    /// The floor with its opening open, if the opening is closed at the start.
    pub(in crate::dem) closed_floor: Option<Wall>,
    /// Effects with a potential come first.
    pub(in crate::dem) effects: Vec<PlacedEffect>,
    /// Whether an effect needs the number of spheres below each sphere.
    pub(in crate::dem) shielded: bool,
    /// Paths of driven spheres, in the order of the spheres' numbers in the scene.
    pub(in crate::dem) driven: Vec<Driven>,
    /// Absent where nothing resists rolling.
    pub(in crate::dem) rolling: Option<RollingLaw>,
    pub(in crate::dem) limits: Limits,
    /// Time step (s).
    pub(in crate::dem) dt: f64,
    pub(in crate::dem) integrator: Integrator,
    /// The largest h (w + g) of a sub-step of adaptive Verlet (rad).
    pub(in crate::dem) resolution: f64,
    /// Skin of the neighbour list (m).
    pub(in crate::dem) skin: f64,
    pub(in crate::dem) neighbours: Neighbours,
    /// Whether spheres are sorted in memory. [`Particles::number`] then holds their numbers in the
    /// scene.
    pub(in crate::dem) sorted: bool,
    /// Whether spheres come or go.
    pub(in crate::dem) flows: bool,
}

impl SystemSetup {
    /// Near pairs for a system with this normal law, not found yet.
    fn near<N: NormalLaw>(&self) -> Near {
        let purpose = Purpose {
            contacts: N::ACTS,
            shield: self.shielded,
        };
        Near::new(purpose, 0.3 * self.skin)
    }
}

/// A simulation compiled for its contact laws.
pub(in crate::dem) struct System<N, T: TangentialLaw> {
    particles: Particles,
    setup: SystemSetup,
    normal: N,
    tangential: T,
    step: StepState,
    neighbours: NeighbourState,
    /// Histories of near pairs. The history of a law without memory has size zero.
    pair_history: Vec<T::History>,
    /// The walls, the spheres near them, and the histories of these contacts.
    walls: Vec<WallContacts<T::History>>,
    /// Indices of the driven spheres that are in, and the places of their paths.
    driven: Vec<(usize, usize)>,
    /// How springs are loaded until the next evaluation.
    loading: Loading,
    /// Velocities and spins that load springs, if they differ from those at the evaluation.
    earlier: Vec<EarlierRows>,
    /// Velocities and spins before a prediction.
    before: MotionBefore,
    /// Buffers of adaptive Verlet.
    workspace: Workspace<T::History>,
    /// Absent where nothing resists rolling.
    rolling: Option<Box<RollingState>>,
    ledger: Option<EnergyBooks>,
    profile: Option<Box<Profile>>,
    /// The properties of all spheres, if they are alike.
    alike: Option<SphereProperties>,
    buffers: Box<Buffers<T::History>>,
    /// Blocks of spheres for the effects, one per thread.
    bodies: Vec<Bodies>,
    /// The division of spheres among threads, if there are several.
    division: Option<Division<T::History>>,
    level: Level,
}

/// Which steps are done, and which parts of the next step.
#[derive(Default)]
struct StepState {
    /// Steps done.
    number: u64,
    /// How often a sphere was moved. Each sub-step counts.
    moves: u64,
    /// Whether forces and torques are zero already.
    forces_are_zero: bool,
    /// Whether the first half of the next step is done already.
    first_half_done: bool,
    /// The first sphere found beyond the overlap limit in this step, with its overlap.
    too_deep: TooDeep,
}

/// The lists of neighbours, and how long they have held.
struct NeighbourState {
    /// Absent where no pair interacts.
    list: Option<VerletList>,
    /// The pairs of the list that may touch soon.
    near: Near,
    /// Whether the near pairs must be found again.
    stale: bool,
    /// Time since the list was built.
    age: Age,
    /// Time since the near pairs were found.
    near_age: Age,
    /// An unused list of pairs, kept for its memory.
    spare_pairs: Vec<NearPair>,
}

/// Time since an event.
#[derive(Clone, Copy, Debug, Default)]
struct Age {
    /// Steps begun since then.
    steps: u64,
    /// Time for which the spheres have moved since then (s).
    time: f64,
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    const HAS_HISTORY: bool = size_of::<T::History>() > 0;

    pub(in crate::dem) fn new(
        normal: N,
        tangential: T,
        setup: SystemSetup,
        mut particles: Particles,
    ) -> Self {
        Self {
            driven: drive::find(&setup.driven, &mut particles),
            step: StepState::default(),
            neighbours: NeighbourState::new::<N>(&setup),
            pair_history: Vec::new(),
            walls: setup.walls.iter().map(WallContacts::new).collect(),
            loading: Loading::present(setup.dt),
            earlier: Vec::new(),
            before: MotionBefore::default(),
            workspace: Workspace::default(),
            rolling: setup.rolling.map(|law| Box::new(RollingState::new(law))),
            ledger: None,
            profile: None,
            alike: SphereProperties::of_all::<N, T>(&particles),
            buffers: Buffers::new(),
            bodies: Vec::new(),
            division: None,
            level: Level::new(),
            particles,
            setup,
            normal,
            tangential,
        }
    }

    /// Ends a part of a step that is measured.
    #[inline(always)]
    fn mark(&mut self, part: StepPart) {
        profile::mark(&mut self.profile, part);
    }

    fn take_doors_away(&mut self) {
        // The floor is the first wall.
        if let (Some(open), Some(floor)) = (self.setup.closed_floor.take(), self.walls.first_mut())
        {
            floor.wall = open;
        }
        self.walls.iter_mut().for_each(WallContacts::open_door);
        self.neighbours.stale = true;
    }

    /// Ends the part of the ledger, if there is one.
    #[inline(always)]
    fn mark_ledger(&mut self) {
        if self.ledger.is_some() {
            self.mark(StepPart::Ledger);
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
        let divides = self.setup.sorted && threads > 1;
        self.division = divides.then(|| Division::new(threads));
        self.neighbours.stale = true;
        divides
    }

    fn particles(&self) -> &Particles {
        &self.particles
    }

    fn step(&self) -> u64 {
        self.step.number
    }

    fn moves(&self) -> u64 {
        self.step.moves
    }

    fn list(&self) -> Option<&VerletList> {
        self.neighbours.list.as_ref()
    }

    fn keep_ledger(&mut self) {
        self.ledger = Some(EnergyBooks::default());
    }

    fn keep_profile(&mut self, profile: Profile) {
        self.profile = Some(Box::new(profile));
    }

    fn profile(&self) -> Option<&Profile> {
        self.profile.as_deref()
    }

    fn work(&self) -> Option<LedgerWork> {
        self.ledger.as_ref().map(|ledger| ledger.books.work)
    }

    fn insert(&mut self, sphere: &Sphere) {
        let before = self.energy_in_books();
        self.particles.push(sphere);
        if let Some(ledger) = &mut self.ledger {
            ledger.books.add_sphere();
        }
        self.setup.limits.add_sphere(sphere.radius, self.setup.dt);
        self.neighbours
            .list
            .iter_mut()
            .for_each(VerletList::add_sphere);
        self.neighbours.near.add_sphere(sphere.position);
        self.renumber();
        self.note_exchange(before);
    }

    fn retain(&mut self, keep: &[bool]) {
        let before = self.energy_in_books();
        if let Some(rolling) = &mut self.rolling {
            rolling.retain(keep, &self.particles);
        }
        self.particles.retain(keep);
        if let Some(ledger) = &mut self.ledger {
            ledger.books.retain(keep);
        }
        self.walls.iter_mut().for_each(|wall| wall.retain(keep));
        let lists = self.neighbours.list.iter_mut();
        lists.for_each(|list| list.remove_spheres(keep));
        retain(
            &mut self.pair_history,
            &self.neighbours.near.remove_spheres(keep),
        );
        self.renumber();
        self.note_exchange(before);
    }

    fn open_doors(&mut self) {
        let before = self.energy_in_books();
        self.take_doors_away();
        self.note_exchange(before);
    }

    fn forget_contacts(&mut self) {
        self.neighbours.list = None;
        self.neighbours.near = Near::new(Purpose::NONE, 0.0);
        self.pair_history = Vec::new();
        self.neighbours.spare_pairs = Vec::new();
        self.walls.clear();
        self.division = None;
        self.rolling = None;
        self.earlier = Vec::new();
        self.before = MotionBefore::default();
        self.workspace = Workspace::default();
    }

    fn state(&self) -> EngineState<'_> {
        self.save()
    }

    fn restore(&mut self, state: EngineState<'_>, doors_are_open: bool) -> Result<(), StateError> {
        self.take_up(state, doors_are_open)
    }

    fn contacts(&mut self) -> Contacts {
        self.measure_contacts()
    }

    fn see_contacts(&mut self, forces: bool, see: &mut dyn FnMut(SeenContact)) {
        self.see_contacts(forces, see);
    }

    fn walls_that_act(&self) -> Vec<bool> {
        let walls = self.walls.iter();
        walls.map(|it| it.wall.weight != 0.0).collect()
    }
}
