//! Effects on single spheres, one file each: keys, formula, loop, limit of the time step.

mod added_mass;
mod buoyancy;
mod drag;
mod drag_kernel;
mod gravity;
mod magnus;
mod one_body;
mod schiller_naumann;
mod shaking;
mod spin_damping;
mod swirl;
mod updraught;

pub use added_mass::AddedMass;
pub use buoyancy::Buoyancy;
pub use drag::{Drag, DragForm, DragLaw};
pub use gravity::Gravity;
pub use magnus::Magnus;
pub(crate) use one_body::Effect;
pub use shaking::Shaking;
pub use spin_damping::SpinDamping;
pub use swirl::Swirl;
pub use updraught::Updraught;

use super::limit::{Limit, Regime};
use super::simplification::{MeanSphere, Simplification};
use crate::document::Problem;
use drag::Form;
use one_body::OneBody;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// List of all effects, in order of application. Effects with a potential energy come first, then
/// the shaking, which also accelerates all spheres equally. The ledger books its work as
/// `work_of_shaking` and the work of all after it as `work_of_air`. Each line: table name, struct,
/// name in profiles ("" for a table that is not itself a force, like the drag law or the added
/// mass). The doc comment appears in the reference of keys, so it gives the formula.
macro_rules! effects {
    ($($(#[doc = $description:literal])+ $table:ident: $keys:ident = $name:literal,)+) => {
        /// The effects on single spheres. Absent effects do not exist in the simulation.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
        pub struct Effects {
            $(
                $(#[doc = $description])+
                #[serde(default, skip_serializing_if = "Option::is_none")]
                pub $table: Option<$keys>,
            )+
        }

        impl Effects {
            /// Names in profiles; empty for tables that are not forces themselves.
            const NAMES: &[&str] = &[$($name),+];

            /// Names of all tables, in the same order.
            const TABLES: &[&str] = &[$(stringify!($table)),+];

            /// Removes a table.
            fn remove(&mut self, table: &str) {
                $(if table == stringify!($table) {
                    self.$table = None;
                })+
            }

            /// The tables that the scene has, in the same order.
            fn keys(&self) -> impl Iterator<Item = Option<&dyn EffectKeys>> {
                [$(self.$table.as_ref().map(|keys| keys as &dyn EffectKeys)),+].into_iter()
            }
        }
    };
}

effects! {
    /// Gravity: F = m g, straight down or tilted. Absent: none.
    gravity: Gravity = "gravity",
    /// Buoyancy: the weight of the displaced fluid, against gravity, F = -rho_fluid V g. Absent:
    /// none.
    buoyancy: Buoyancy = "buoyancy",
    /// A shaken box: F = m A w^2 sin(w t + p) along a direction, in the frame of the box, less the
    /// buoyancy of the shaken fluid. Absent: none.
    shaking: Shaking = "shaking",
    /// Mass C rho V of fluid that moves with each sphere, in impacts too; weights and moments of
    /// inertia do not change. Absent: none.
    added_mass: AddedMass = "",
    /// The drag law that `swirl` and `updraught` share and need: F = c1 u + c2 |u| u, with the
    /// velocity u of the air relative to the sphere. `law` defines c1 and c2, or chooses another
    /// formula.
    drag: Drag = "",
    /// Drag toward air in rigid rotation about the axis, of velocity Omega x r (Rice, 2012, eqs. 21
    /// to 27): F = drag(Omega x r - v). With `buoyancy` or `added_mass` also the pressure of the
    /// rotating fluid, -(rho_b + C rho_a) V Omega^2 (x, y), with their densities. Absent: none.
    swirl: Swirl = "swirl",
    /// Rising air that lower spheres shield (Rice, 2012, eq. 24): F_z = s exp(-beta (z - z0))
    /// alpha^n drag(v_air - v_z), with n the number of lower spheres whose centre lies within 2r in
    /// |dx| and in |dy|, and `speed` v_air. Absent: none.
    updraught: Updraught = "updraught",
    /// Magnus lift of spinning spheres (Rubinow and Keller, 1961): F = C pi r^3 rho w x u, with
    /// spin w and velocity u relative to the fluid, which is at rest except in `swirl`. Absent:
    /// none.
    magnus: Magnus = "Magnus lift",
    /// Viscous damping of spins: torque -c w, with spin w. Absent: none.
    spin_damping: SpinDamping = "spin damping",
}

/// An effect, and its place among [all names](Effects::all_names).
pub(crate) type PlacedEffect = (usize, Box<dyn Effect>);

/// What effects may need to know of a scene, besides one another.
#[derive(Clone, Copy)]
pub(crate) struct SceneFacts {
    /// Density of the spheres (kg/m3).
    pub(crate) density: f64,
    /// Whether spheres have spins.
    pub(crate) rotates: bool,
}

/// What an effect is built for.
pub(crate) struct Targets<'a> {
    /// Radii of the spheres (m).
    pub(crate) radii: &'a [f64],
    /// The scene that the spheres are in.
    pub(crate) scene: SceneFacts,
    /// How far the velocities that effects read lag behind their forces (s).
    pub(crate) lag: f64,
}

/// The table of an effect in a scene.
pub(crate) trait EffectKeys {
    /// The effect on these spheres. `None` if the table is not itself a force (drag, added mass).
    /// `all` are the effects of the scene, whose tables it may use.
    fn effect(&self, all: &Effects, targets: &Targets<'_>) -> Option<Box<dyn Effect>>;

    /// Its limit of the time step, if it has one. The program takes the smallest limit, not their
    /// combination. If two effects damp the same velocity, one of them must use the sum of both
    /// rates.
    fn limit(&self, _all: &Effects, _regime: &Regime<'_>) -> Option<Limit> {
        None
    }

    /// The fastest speed (m/s) that the effect gives a sphere within this distance (m) of the axis.
    fn fastest(&self, _reach: f64) -> f64 {
        0.0
    }

    /// Simpler stand-ins for this effect, each as a change of the scene's keys: `off`, which
    /// removes the table, or a simpler law.
    fn simplifications(
        &self,
        off: Simplification,
        _all: &Effects,
        _mean: &MeanSphere,
    ) -> Vec<Simplification> {
        vec![off]
    }

    /// Conflicts of this table with `all` effects of the scene.
    fn problems(&self, _all: &Effects, _scene: &SceneFacts) -> Vec<Problem> {
        Vec::new()
    }

    /// Whether the effect keeps an array with a number per sphere. It then excludes spheres that
    /// come or go, and its loop implements `reorder`.
    fn keeps_numbers_per_sphere(&self) -> bool {
        false
    }
}

impl Effects {
    /// Number of effects that are forces themselves.
    pub(crate) const COUNT: usize = {
        let (mut at, mut count) = (0, 0);
        while at < Self::NAMES.len() {
            count += !Self::NAMES[at].is_empty() as usize;
            at += 1;
        }
        count
    };

    /// Names of the effects that are forces themselves, in order of application.
    pub fn all_names() -> impl Iterator<Item = &'static str> {
        let names = Self::NAMES.iter().copied();
        names.filter(|name| !name.is_empty())
    }

    /// Tables of the effects that are forces themselves, in the same order.
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

    /// Gravity minus the buoyancy of spheres of a density (kg/m3).
    pub(crate) fn gravity_in_fluid(&self, density: f64) -> Option<Gravity> {
        let gravity = self.gravity.as_ref()?;
        let ratio = self.buoyancy.as_ref().map_or(0.0, |it| it.ratio(density));
        Some(Gravity {
            acceleration: gravity.acceleration * (1.0 - ratio),
            ..gravity.clone()
        })
    }

    /// The most that the shaking changes the velocity of a free sphere (m/s).
    pub(crate) fn fastest_change_by_shaking(&self) -> f64 {
        let (shaking, gravity) = (self.shaking.as_ref(), self.gravity.as_ref());
        shaking.map_or(0.0, |it| it.fastest_change(gravity))
    }

    /// Added mass over mass of spheres of a density (kg/m3).
    pub(crate) fn added_mass_ratio(&self, density: f64) -> f64 {
        self.added_mass.as_ref().map_or(0.0, |it| it.ratio(density))
    }

    /// Mass of the fluid that a sphere displaces and of its added mass, over the mass of spheres of
    /// a density (kg/m3): the mass that an accelerated fluid carries along.
    pub(crate) fn pressed_mass_ratio(&self, density: f64) -> f64 {
        let displaced = self.buoyancy.as_ref().map_or(0.0, |it| it.ratio(density));
        displaced + self.added_mass_ratio(density)
    }

    /// Names of the effects that the scene has and that are forces themselves.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        let all = Self::all_names().zip(self.acting());
        all.filter_map(|(name, keys)| keys.is_some().then_some(name))
    }

    /// Names of the tables that the scene has.
    pub fn tables(&self) -> impl Iterator<Item = &'static str> {
        let all = Self::TABLES.iter().zip(self.keys());
        all.filter_map(|(&table, keys)| keys.is_some().then_some(table))
    }

    /// Limits of the time step, of all effects that have one.
    pub(crate) fn limits(&self, regime: &Regime<'_>) -> impl Iterator<Item = Limit> {
        self.keys()
            .flatten()
            .filter_map(|keys| keys.limit(self, regime))
    }

    /// The fastest speed (m/s) that any effect gives a sphere within this distance (m) of the axis.
    pub(crate) fn fastest(&self, reach: f64) -> f64 {
        let speeds = self.keys().flatten().map(|keys| keys.fastest(reach));
        speeds.fold(0.0, f64::max)
    }

    /// The terminal speed (m/s) through the air of a sphere of this radius (m), mass (kg) and
    /// density (kg/m3), at any place. `None` if there is no such drag: an updraught acts only along
    /// z, changes with height, and is weaker above other spheres unless the sphere is `alone`.
    pub(crate) fn terminal_speed(
        &self,
        radius: f64,
        mass: f64,
        density: f64,
        alone: bool,
    ) -> Option<f64> {
        let drag = self.drag.as_ref()?;
        let [along_x, along_z] = self.gravity_in_fluid(density)?.components();
        let swirl = if self.swirl.is_some() { 1.0 } else { 0.0 };
        let strength = |air: &Updraught| air.strength_in(self.swirl.as_ref());
        let updraught = match self.updraught.as_ref() {
            Some(air) if strength(air) == 0.0 => 0.0,
            // Below, it grows without limit.
            Some(air) if air.decay != 0.0 && along_z < 0.0 => return None,
            Some(air) if air.decay == 0.0 && (air.alpha == 1.0 || alone) => strength(air),
            _ => 0.0,
        };
        let factor = if along_x == 0.0 {
            swirl + updraught
        } else {
            swirl
        };
        let speed = |acceleration: f64| drag.speed_at(radius, mass * acceleration.abs() / factor);
        let speed = match drag.kernel() {
            Form::Components => libm::hypot(speed(along_x), speed(along_z)),
            _ => speed(libm::hypot(along_x, along_z)),
        };
        speed.is_finite().then_some(speed)
    }

    /// Simpler stand-ins for each effect, in that scene, whose mean sphere is `mean`.
    pub(crate) fn simplifications(
        &self,
        scene: &SceneFacts,
        mean: &MeanSphere,
    ) -> Vec<Simplification> {
        let tables = Self::TABLES.iter().zip(self.keys());
        let of_table = |(&table, keys): (&&'static str, Option<&dyn EffectKeys>)| {
            let off = Simplification {
                name: format!("{} off", table.replace('_', " ")),
                set: Vec::new(),
                remove: self.removed_with(Some(table), scene),
            };
            keys.map(|keys| keys.simplifications(off, self, mean))
        };
        tables.filter_map(of_table).flatten().collect()
    }

    /// Names of tables that must be removed together: `table` and the tables that need it. Without
    /// a `table`, those that conflict with other tables or with the scene.
    pub(crate) fn removed_with(
        &self,
        table: Option<&'static str>,
        scene: &SceneFacts,
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
                keys.is_some_and(|keys| !keys.problems(&left, scene).is_empty())
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

    /// Conflicts between tables, or with the scene.
    pub(crate) fn problems(&self, scene: &SceneFacts) -> Vec<Problem> {
        let tables = self.keys().flatten();
        tables.flat_map(|keys| keys.problems(self, scene)).collect()
    }

    /// Names of the tables whose effects [keep numbers per
    /// sphere](EffectKeys::keeps_numbers_per_sphere).
    pub(crate) fn with_numbers_per_sphere(&self) -> impl Iterator<Item = &'static str> {
        let keeps = |keys: &dyn EffectKeys| keys.keeps_numbers_per_sphere();
        let tables = Self::TABLES.iter().zip(self.keys());
        tables.filter_map(move |(table, keys)| keys.is_some_and(keeps).then_some(*table))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::particles::Particles;

    /// The ledger tells them apart by their places.
    #[test]
    fn effects_with_a_potential_energy_come_first_and_then_the_shaking() {
        let text = std::fs::read_to_string("tests/good/everything.toml").unwrap();
        let all: Effects = toml::from_str(&text).unwrap();
        assert!(all.keys().all(|keys| keys.is_some()), "a table is missing");
        let built = all.build(&Targets {
            radii: &[],
            scene: SceneFacts {
                density: 1.0,
                rotates: true,
            },
            lag: 0.0,
        });
        let particles = Particles::default();
        let energies = built.iter().map(|(_, effect)| effect.energy(&particles));
        let without: Vec<bool> = energies.map(|energy| energy.is_none()).collect();
        assert_eq!(without.len(), Effects::COUNT);
        assert!(without.contains(&false) && without.contains(&true));
        assert!(without.is_sorted(), "{without:?}");
        let uneven = built.iter().map(|(_, it)| it.acceleration().is_none());
        assert!(uneven.is_sorted());
    }
}
