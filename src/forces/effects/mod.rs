//! Effects on single spheres, one file each: keys, formula, loop, limit of the time step.

mod added_mass;
mod buoyancy;
mod drag;
mod gravity;
mod magnus;
mod schiller_naumann;
mod spin_damping;
mod swirl;
mod updraught;

pub use added_mass::AddedMass;
pub use buoyancy::Buoyancy;
pub use drag::{Drag, DragForm, DragLaw};
pub use gravity::Gravity;
pub use magnus::Magnus;
pub use spin_damping::SpinDamping;
pub use swirl::Swirl;
pub use updraught::Updraught;

use super::limit::{Limit, Regime};
use super::simplification::{MeanSphere, Simplification};
use crate::document::Problem;
use crate::particles::Particles;
use crate::particles::bodies::{Asked, Bodies};
use crate::particles::vector::Vector;
use fearless_simd::Level;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Declares all effects, in the order in which they are applied, those with a potential energy
/// first: the table of a scene file, the type of its keys, and its name in profiles (empty if it
/// has no loop: if only other effects use it, as they use the drag law, or it changes the spheres).
macro_rules! effects {
    ($($(#[doc = $description:literal])+ $table:ident: $keys:ident = $name:literal,)+) => {
        /// The effects on single spheres. One that is absent does not exist in the simulation.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
        pub struct Effects {
            $(
                $(#[doc = $description])+
                #[serde(default, skip_serializing_if = "Option::is_none")]
                pub $table: Option<$keys>,
            )+
        }

        impl Effects {
            /// Their names in profiles; empty for tables that only other effects use.
            const NAMES: &[&str] = &[$($name),+];

            /// The tables of all, in the same order.
            const TABLES: &[&str] = &[$(stringify!($table)),+];

            /// Takes a table away.
            fn remove(&mut self, table: &str) {
                $(if table == stringify!($table) {
                    self.$table = None;
                })+
            }

            /// Their keys in the same order.
            fn keys(&self) -> impl Iterator<Item = Option<&dyn EffectKeys>> {
                [$(self.$table.as_ref().map(|keys| keys as &dyn EffectKeys)),+].into_iter()
            }
        }
    };
}

effects! {
    /// Gravity. Absent: none.
    gravity: Gravity = "gravity",
    /// Buoyancy: the weight of the displaced fluid, against gravity. Absent: none.
    buoyancy: Buoyancy = "buoyancy",
    /// Mass C rho V of fluid that moves with each sphere, in impacts too; weights and moments of
    /// inertia stay. Absent: none.
    added_mass: AddedMass = "",
    /// The drag law that `swirl` and `updraught` share. Needed by either.
    drag: Drag = "",
    /// Drag toward air in rigid rotation about the axis. Absent: none.
    swirl: Swirl = "swirl",
    /// Rising air that lower spheres shield. Absent: none.
    updraught: Updraught = "updraught",
    /// Lift of spheres with spin w and velocity u in a fluid at rest, or in that of `swirl`:
    /// C pi r^3 rho w x u (Rubinow and Keller, 1961). Absent: none.
    magnus: Magnus = "Magnus lift",
    /// Viscous damping of spins. Absent: none.
    spin_damping: SpinDamping = "spin damping",
}

/// An effect, and its place among [all names](Effects::all_names).
pub(crate) type PlacedEffect = (usize, Box<dyn Effect>);

/// What effects act on.
pub(crate) struct Targets<'a> {
    /// Radii of the spheres (m).
    pub(crate) radii: &'a [f64],
    /// Their density (kg/m3).
    pub(crate) density: f64,
}

/// The table of an effect in a scene.
pub(crate) trait EffectKeys {
    /// The effect on these spheres; none if only others of `all` effects use the table, or if it
    /// has no loop.
    fn effect(&self, all: &Effects, targets: &Targets<'_>) -> Option<Box<dyn Effect>>;

    /// Its limit of the time step, if it has one. Limits are not summed: an effect that relaxes what
    /// another relaxes too must count the other's rate in.
    fn limit(&self, _all: &Effects, _regime: &Regime<'_>) -> Option<Limit> {
        None
    }

    /// The fastest speed (m/s) that it gives a sphere up to that distance (m) from the axis.
    fn fastest(&self, _reach: f64) -> f64 {
        0.0
    }

    /// Simpler stand-ins for this part, each as a change of the scene's keys: off, as `off` has it,
    /// or a simpler law.
    fn simplifications(
        &self,
        off: Simplification,
        _all: &Effects,
        _mean: &MeanSphere,
    ) -> Vec<Simplification> {
        vec![off]
    }

    /// What is wrong with it beside `all` others; `rotates` says whether spheres have spins.
    fn problems(&self, _all: &Effects, _rotates: bool) -> Vec<Problem> {
        Vec::new()
    }
}

impl Effects {
    /// How many act themselves.
    pub(crate) const COUNT: usize = {
        let (mut at, mut count) = (0, 0);
        while at < Self::NAMES.len() {
            count += !Self::NAMES[at].is_empty() as usize;
            at += 1;
        }
        count
    };

    /// Names of those that act themselves, in the order in which they are applied.
    pub fn all_names() -> impl Iterator<Item = &'static str> {
        let names = Self::NAMES.iter().copied();
        names.filter(|name| !name.is_empty())
    }

    /// The keys of those that act themselves, in the same order.
    fn acting(&self) -> impl Iterator<Item = Option<&dyn EffectKeys>> {
        let named = Self::NAMES.iter().zip(self.keys());
        named.filter_map(|(name, keys)| (!name.is_empty()).then_some(keys))
    }

    /// The effects with their places among [all names](Self::all_names), for these spheres.
    pub(crate) fn build(&self, targets: &Targets<'_>) -> Vec<PlacedEffect> {
        let effect = |(place, keys): (usize, Option<&dyn EffectKeys>)| {
            let effect = keys?.effect(self, targets)?;
            Some((place, effect))
        };
        self.acting().enumerate().filter_map(effect).collect()
    }

    /// Gravity, less the buoyancy of spheres of a density (kg/m3).
    pub(crate) fn gravity_in_fluid(&self, density: f64) -> Option<Gravity> {
        let gravity = self.gravity.as_ref()?;
        let ratio = self.buoyancy.as_ref().map_or(0.0, |it| it.ratio(density));
        Some(Gravity {
            acceleration: gravity.acceleration * (1.0 - ratio),
            ..gravity.clone()
        })
    }

    /// Added mass over mass of spheres of a density (kg/m3).
    pub(crate) fn added_mass_ratio(&self, density: f64) -> f64 {
        self.added_mass.as_ref().map_or(0.0, |it| it.ratio(density))
    }

    /// Names of those that the scene has.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        let all = Self::all_names().zip(self.acting());
        all.filter_map(|(name, keys)| keys.is_some().then_some(name))
    }

    /// Their limits of the time step.
    pub(crate) fn limits(&self, regime: &Regime<'_>) -> impl Iterator<Item = Limit> {
        self.keys()
            .flatten()
            .filter_map(|keys| keys.limit(self, regime))
    }

    /// The fastest speed (m/s) that one of them gives a sphere up to that distance (m) from the
    /// axis.
    pub(crate) fn fastest(&self, reach: f64) -> f64 {
        let speeds = self.keys().flatten().map(|keys| keys.fastest(reach));
        speeds.fold(0.0, f64::max)
    }

    /// Simpler stand-ins for each of them, in a scene of that mean sphere; `rotates` says whether
    /// spheres have spins.
    pub(crate) fn simplifications(&self, rotates: bool, mean: &MeanSphere) -> Vec<Simplification> {
        let tables = Self::TABLES.iter().zip(self.keys());
        let of_table = |(&table, keys): (&&'static str, Option<&dyn EffectKeys>)| {
            let off = Simplification {
                name: format!("{} off", table.replace('_', " ")),
                set: Vec::new(),
                remove: self.removed_with(Some(table), rotates),
            };
            keys.map(|keys| keys.simplifications(off, self, mean))
        };
        tables.filter_map(of_table).flatten().collect()
    }

    /// A table and those that do not go without it, by name: what must be removed together. With
    /// none, those that do not go with the others, or without spins.
    pub(crate) fn removed_with(
        &self,
        table: Option<&'static str>,
        rotates: bool,
    ) -> Vec<&'static str> {
        let (mut left, mut removed) = (self.clone(), Vec::new());
        let mut next = table;
        loop {
            if let Some(table) = next {
                left.remove(table);
                removed.push(table);
            }
            let mut tables = Self::TABLES.iter().zip(left.keys());
            let dangles = |keys: Option<&dyn EffectKeys>| {
                keys.is_some_and(|keys| !keys.problems(&left, rotates).is_empty())
            };
            let found = tables.find(|(_, keys)| dangles(*keys));
            next = found.map(|(table, _)| *table);
            if next.is_none() {
                break;
            }
        }
        removed.sort_unstable();
        removed
    }

    /// Keys that do not go together; `rotates` says whether spheres have spins.
    pub(crate) fn problems(&self, rotates: bool) -> Vec<Problem> {
        let problems = self
            .keys()
            .flatten()
            .map(|keys| keys.problems(self, rotates));
        problems.flatten().collect()
    }
}

/// An effect adds to the forces and torques of the spheres.
pub(crate) trait Effect: Send + Sync {
    /// Makes ready for a step. `shielding` holds, where the scene has an updraught, the number of
    /// spheres that shield each one, of all of them, from below.
    fn prepare(&mut self, shielding: &[u32]);

    /// Adds its forces and torques to those of a block of spheres.
    fn apply(&self, level: Level, bodies: &mut Bodies);

    /// What it asks for.
    fn asks(&self) -> Asked;

    /// The acceleration (m/s2) that it gives to all spheres, if it does nothing else: they then
    /// need no blocks.
    fn acceleration(&self) -> Option<Vector>;

    /// Follows spheres into a new order.
    fn reorder(&mut self, order: &[u32]);

    /// The potential energy (J) of a force that has one; none of the others.
    fn energy(&self, particles: &Particles) -> Option<f64>;
}

/// The loop of an effect, to be compiled once per instruction set.
trait OneBody: Send + Sync {
    /// As [`Effect::asks`].
    const ASKS: Asked;

    /// As [`Effect::prepare`].
    fn prepare(&mut self, _shielding: &[u32]) {}

    /// As [`Effect::apply`]; implementations must be inlined always.
    fn add(&self, bodies: &mut Bodies);

    /// As [`Effect::acceleration`].
    fn acceleration(&self) -> Option<Vector> {
        None
    }

    /// As [`Effect::reorder`], of an effect that keeps something per sphere.
    fn reorder(&mut self, _order: &[u32]) {}

    /// As [`Effect::energy`].
    fn energy(&self, _particles: &Particles) -> Option<f64> {
        None
    }
}

impl<E: OneBody> Effect for E {
    fn prepare(&mut self, shielding: &[u32]) {
        OneBody::prepare(self, shielding);
    }

    fn apply(&self, level: Level, bodies: &mut Bodies) {
        fearless_simd::dispatch!(level, simd => {
            let _ = simd;
            self.add(bodies);
        });
    }

    fn asks(&self) -> Asked {
        E::ASKS
    }

    fn acceleration(&self) -> Option<Vector> {
        OneBody::acceleration(self)
    }

    fn reorder(&mut self, order: &[u32]) {
        OneBody::reorder(self, order);
    }

    fn energy(&self, particles: &Particles) -> Option<f64> {
        OneBody::energy(self, particles)
    }
}
