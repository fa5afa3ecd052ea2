//! The parts of a step that cost time.

use crate::forces::effects::Effects;
use crate::scene::{Scene, Start, Tank};
use crate::simulation::PartOfStep;
pub(super) use crate::simulation::Profile;
use crate::walls::WallName;

/// The parts of a step that cost time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum StepPart {
    /// Building the neighbour list.
    List,
    /// Selecting the pairs, and the spheres at walls, that may touch.
    Near,
    /// Forces of pairs: contact and friction.
    Pairs,
    /// Forces of the floor: contact and friction.
    Floor,
    /// Forces of the cylinder: contact and friction.
    Cylinder,
    /// Forces of the sides: contact and friction.
    Sides,
    /// Forces of the walls that a scene lists: contact and friction.
    Walls,
    /// Rolling resistance of all contacts.
    Rolling,
    /// Counting the spheres that shield one another from the updraught.
    Shield,
    /// An effect on single spheres, by its place among [`Effects::all_names`].
    Effect(usize),
    /// The energy balance.
    Ledger,
    /// Changing velocities and spins by forces and torques.
    Kick,
    /// Moving spheres by their velocities.
    Drift,
    /// The rest of a step: clearing forces, groups of touching spheres and their sub-steps,
    /// predicted velocities.
    Rest,
    /// Feed, door, outlet, and the watches over them.
    Process,
}

impl StepPart {
    /// All parts, in the order of a step.
    pub fn all() -> impl Iterator<Item = Self> {
        let first = [
            Self::List,
            Self::Near,
            Self::Pairs,
            Self::Floor,
            Self::Cylinder,
            Self::Sides,
            Self::Walls,
            Self::Rolling,
            Self::Shield,
        ];
        let last = [
            Self::Ledger,
            Self::Kick,
            Self::Drift,
            Self::Rest,
            Self::Process,
        ];
        let effects = (0..Effects::COUNT).map(Self::Effect);
        first.into_iter().chain(effects).chain(last)
    }

    /// Its place among [all](Self::all).
    const fn place(self) -> usize {
        match self {
            Self::List => 0,
            Self::Near => 1,
            Self::Pairs => 2,
            Self::Floor => 3,
            Self::Cylinder => 4,
            Self::Sides => 5,
            Self::Walls => 6,
            Self::Rolling => 7,
            Self::Shield => 8,
            Self::Effect(place) => 9 + place,
            Self::Ledger => 9 + Effects::COUNT,
            Self::Kick => 10 + Effects::COUNT,
            Self::Drift => 11 + Effects::COUNT,
            Self::Rest => 12 + Effects::COUNT,
            Self::Process => 13 + Effects::COUNT,
        }
    }

    /// The part to which the forces of a wall belong.
    pub(super) fn of_wall(name: WallName) -> Self {
        match name {
            WallName::Floor | WallName::FloorAroundOpening => Self::Floor,
            WallName::Cylinder => Self::Cylinder,
            WallName::Side => Self::Sides,
            WallName::Listed(_) => Self::Walls,
        }
    }

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::List => "neighbour list",
            Self::Near => "near pairs",
            Self::Pairs => "contacts of pairs",
            Self::Floor => "floor",
            Self::Cylinder => "cylinder",
            Self::Sides => "sides",
            Self::Walls => "walls",
            Self::Rolling => "rolling resistance",
            Self::Shield => "counting shield",
            Self::Effect(place) => Effects::all_names().nth(place).unwrap_or(""),
            Self::Ledger => "energy ledger",
            Self::Kick => "kick",
            Self::Drift => "drift",
            Self::Rest => "rest of the step",
            Self::Process => "feed, door, outlet",
        }
    }

    /// Whether a scene has this part. A part that it does not have costs nothing.
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
            Self::Walls => wall(!scene.dem.walls.is_empty()),
            Self::Rolling => scene.dem.rolling.is_some(),
            Self::Shield => scene.dem.effects.updraught.is_some(),
            Self::Effect(_) => scene.dem.effects.names().any(|name| name == self.name()),
            Self::Ledger => scene.output.ledger,
            Self::Process => {
                matches!(scene.start, Start::Feed { .. })
                    || scene.dem.door.is_some()
                    || scene.dem.rest.is_some()
                    || scene.outlet_height().is_some()
            }
            Self::Kick | Self::Drift | Self::Rest => true,
        }
    }
}

/// The parts of a scene's step, in the order of [`StepPart::all`].
pub(super) fn parts_of(scene: &Scene) -> Vec<PartOfStep> {
    let part = |part: StepPart| PartOfStep {
        name: part.name(),
        is_present: part.is_in(scene),
        // Feed, door and outlet work between the steps.
        is_between_steps: part == StepPart::Process,
    };
    StepPart::all().map(part).collect()
}

/// An empty profile of the parts of a step.
pub(super) fn new_profile() -> Profile {
    Profile::new(StepPart::all().count(), StepPart::Rest.place())
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
pub(super) fn mark(profile: &mut Option<Box<Profile>>, part: StepPart) {
    if let Some(profile) = profile {
        profile.mark(part.place());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_has_its_place() {
        for (place, part) in StepPart::all().enumerate() {
            assert_eq!(part.place(), place, "{part:?}");
            assert!(!part.name().is_empty());
        }
    }
}
