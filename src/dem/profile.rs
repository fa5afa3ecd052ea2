//! The parts of a step that cost time.

use crate::scene::{Scene, Start, Tank};
use crate::simulation::PartOfStep;
pub(super) use crate::simulation::Profile;

/// The parts of a step that cost time.
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
    /// What a step does besides: forces cleared, groups of touching spheres and their sub-steps,
    /// velocities foretold.
    Rest,
    /// Feed, door, outlet, and the watches over them.
    Process,
}

impl Part {
    /// All parts, in the order of a step.
    pub const ALL: [Self; 16] = [
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
        }
    }

    /// Whether a scene has it at all; what it does not have costs nothing.
    pub fn is_in(self, scene: &Scene) -> bool {
        let touch = scene.dem.contact.is_some();
        let wall = |is_there: bool| touch && is_there;
        let tank = scene.tank.as_ref();
        match self {
            Self::List | Self::Near => touch || scene.dem.effects.updraught.is_some(),
            Self::Pairs => touch,
            Self::Floor => wall(tank.is_some_and(|tank| tank.floor.is_some())),
            Self::Cylinder => wall(tank.is_some_and(|tank| tank.radius.is_some())),
            Self::Sides => wall(tank.is_some_and(Tank::has_sides)),
            Self::Shield | Self::Updraught => scene.dem.effects.updraught.is_some(),
            Self::Gravity => scene.dem.effects.gravity.is_some(),
            Self::Swirl => scene.dem.effects.swirl.is_some(),
            Self::SpinDamping => scene.dem.effects.spin_damping.is_some(),
            Self::Ledger => scene.output.ledger,
            Self::Process => {
                matches!(scene.start, Start::Feed { .. })
                    || scene.dem.door.is_some()
                    || scene.dem.rest.is_some()
                    || scene.dem.outlet.is_some()
            }
            Self::Kick | Self::Drift | Self::Rest => true,
        }
    }
}

/// The parts of a scene's step, in the order of [`Part::ALL`].
pub(super) fn parts_of(scene: &Scene) -> Vec<PartOfStep> {
    let part = |part: Part| PartOfStep {
        name: part.name(),
        is_present: part.is_in(scene),
        // Feed, door and outlet work between the steps.
        is_between_steps: part == Part::Process,
    };
    Part::ALL.map(part).into()
}

/// An empty profile of the parts of a step.
pub(super) fn new_profile() -> Profile {
    Profile::new(Part::ALL.len(), Part::Rest as usize)
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
        profile.mark(part as usize);
    }
}
