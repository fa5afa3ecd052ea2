//! What the parts of a step take, on request.

use crate::cpu_time;
use crate::scene::{Scene, Start, Tank};

/// The parts of a run that cost time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// Building the neighbour list.
    List,
    /// Looking in the list for pairs, and at the walls for spheres, that may touch.
    Near,
    /// Forces of pairs: contact and friction.
    Pairs,
    /// Forces of the floor: contact and friction.
    Floor,
    /// Forces of the cylinder: contact and friction.
    Cylinder,
    /// Forces of the sides: contact and friction.
    Sides,
    /// Counting the spheres that shield one another from the updraught.
    Shield,
    /// Gravity.
    Gravity,
    /// The swirling air.
    Swirl,
    /// The rising air.
    Updraught,
    /// Damping of spins.
    SpinDamping,
    /// The books of energy.
    Ledger,
    /// Changing velocities and spins by forces and torques.
    Kick,
    /// Moving spheres by their velocities.
    Drift,
    /// What a step does besides: forces cleared, groups of touching spheres and their sub-steps, velocities foretold.
    Rest,
    /// Feed, door, outlet, and the watches over them.
    Process,
    /// Observers of a frame, the elastic energy of contacts among what they see.
    Observers,
    /// Taking the last snapshot, and writing the record.
    Record,
    /// Placing the spheres, and all that is made before the first step.
    Start,
}

impl Part {
    /// All parts, in the order of a step.
    pub const ALL: [Self; 19] = [
        Self::List,
        Self::Near,
        Self::Pairs,
        Self::Floor,
        Self::Cylinder,
        Self::Sides,
        Self::Shield,
        Self::Gravity,
        Self::Swirl,
        Self::Updraught,
        Self::SpinDamping,
        Self::Ledger,
        Self::Kick,
        Self::Drift,
        Self::Rest,
        Self::Process,
        Self::Observers,
        Self::Record,
        Self::Start,
    ];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::List => "neighbour list",
            Self::Near => "near pairs",
            Self::Pairs => "contacts of pairs",
            Self::Floor => "floor",
            Self::Cylinder => "cylinder",
            Self::Sides => "sides",
            Self::Shield => "counting shield",
            Self::Gravity => "gravity",
            Self::Swirl => "swirl",
            Self::Updraught => "updraught",
            Self::SpinDamping => "spin damping",
            Self::Ledger => "energy ledger",
            Self::Kick => "kick",
            Self::Drift => "drift",
            Self::Rest => "rest of the step",
            Self::Process => "feed, door, outlet",
            Self::Observers => "observers",
            Self::Record => "record",
            Self::Start => "start",
        }
    }

    /// Whether a scene has it at all; what it does not have costs nothing.
    pub fn is_in(self, scene: &Scene) -> bool {
        let touch = scene.contact.is_some();
        let wall = |is_there: bool| touch && is_there;
        let tank = scene.tank.as_ref();
        match self {
            Self::List | Self::Near => touch || scene.updraught.is_some(),
            Self::Pairs => touch,
            Self::Floor => wall(tank.is_some_and(|tank| tank.floor.is_some())),
            Self::Cylinder => wall(tank.is_some_and(|tank| tank.radius.is_some())),
            Self::Sides => wall(tank.is_some_and(Tank::has_sides)),
            Self::Shield | Self::Updraught => scene.updraught.is_some(),
            Self::Gravity => scene.gravity.is_some(),
            Self::Swirl => scene.swirl.is_some(),
            Self::SpinDamping => scene.spin_damping.is_some(),
            Self::Ledger => scene.output.ledger,
            Self::Process => {
                matches!(scene.start, Start::Feed { .. })
                    || scene.door.is_some()
                    || scene.rest.is_some()
                    || scene.outlet.is_some()
            }
            Self::Kick
            | Self::Drift
            | Self::Rest
            | Self::Observers
            | Self::Record
            | Self::Start => true,
        }
    }
}

/// Seconds of processor time of every part, in the order of [`Part::ALL`].
pub type Seconds = [f64; Part::ALL.len()];

/// A profile of a running engine.
///
/// The total is the processor time of the thread. How it divides into parts is found in some of the
/// steps, in which the clock is read between the parts; the others run as they always do. What reading the
/// clock takes is left out of all times.
#[derive(Clone, Debug)]
pub(crate) struct Profile {
    /// What one reading of the clock takes (s).
    pub(crate) reading: f64,
    /// Times of the parts in the steps that were looked at (s).
    looked_at: Seconds,
    /// The latest reading, while a step is looked at (s).
    latest: Option<f64>,
    readings: u64,
    /// When the engine was entered (s).
    entered: f64,
    /// Time in the engine so far (s), readings included.
    inside: f64,
    sphere_steps: u64,
}

/// Readings by which a profile finds what one takes.
const TRIALS: u32 = 2000;

impl Profile {
    /// An empty profile, which knows what a reading takes.
    pub(crate) fn new() -> Self {
        let started = cpu_time::of_this_thread();
        for _ in 1..TRIALS {
            std::hint::black_box(cpu_time::of_this_thread());
        }
        let trials = cpu_time::of_this_thread() - started;
        Self {
            reading: trials / f64::from(TRIALS),
            looked_at: Seconds::default(),
            latest: None,
            readings: 0,
            entered: 0.0,
            inside: 0.0,
            sphere_steps: 0,
        }
    }

    /// Time in the engine (s).
    pub(crate) fn seconds(&self) -> f64 {
        self.inside - self.readings as f64 * self.reading
    }

    /// What reading the clock took (s).
    pub(crate) fn readings(&self) -> f64 {
        self.readings as f64 * self.reading
    }

    /// Steps done, each times the spheres that moved in it.
    pub(crate) fn sphere_steps(&self) -> u64 {
        self.sphere_steps
    }

    /// The time in the engine, divided into its parts.
    pub(crate) fn parts(&self) -> Seconds {
        let all: f64 = self.looked_at.iter().sum();
        if all > 0.0 {
            return self.looked_at.map(|part| part * self.seconds() / all);
        }
        let mut parts = Seconds::default();
        parts[Part::Rest as usize] = self.seconds();
        parts
    }

    pub(super) fn enter(&mut self) {
        self.entered = cpu_time::of_this_thread();
        self.readings += 1;
    }

    pub(super) fn leave(&mut self) {
        self.latest = None;
        self.inside += cpu_time::of_this_thread() - self.entered;
    }

    /// Begins a step that moves so many spheres, and looks at it or not.
    #[inline(never)]
    fn begin(&mut self, step: u64, spheres: usize) {
        self.sphere_steps += spheres as u64;
        // The clock is read a dozen times for 128 spheres, half a microsecond each, in a step of some 50 ns per
        // sphere: with one step of 16 at most that adds some percent to it.
        let period = (8192 / spheres.max(1) as u64).clamp(16, 256);
        // Multiples of the golden ratio are spread evenly over any rhythm of steps, such as that of the
        // neighbour list.
        let spread = (step + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        self.latest = (spread < u64::MAX / period).then(|| {
            self.readings += 1;
            cpu_time::of_this_thread()
        });
    }

    /// Ends a part of a step.
    #[inline(never)]
    pub(super) fn mark(&mut self, part: Part) {
        if let Some(latest) = self.latest {
            let now = cpu_time::of_this_thread();
            self.readings += 1;
            self.looked_at[part as usize] += (now - latest - self.reading).max(0.0);
            self.latest = Some(now);
        }
    }
}

/// Begins a step, if there is a profile.
#[inline(always)]
pub(super) fn begin(profile: &mut Option<Box<Profile>>, step: u64, spheres: usize) {
    if let Some(profile) = profile {
        profile.begin(step, spheres);
    }
}

/// Ends a part of a step, if there is a profile.
#[inline(always)]
pub(super) fn mark(profile: &mut Option<Box<Profile>>, part: Part) {
    if let Some(profile) = profile {
        profile.mark(part);
    }
}
