//! The table of a contact law in a scene.

use super::{Hertz, Hooke, Impact, Linear, LinearImpact, NormalLaw, Silbert, Tsuji};
use crate::document::Problem;
use crate::forces::limit::{Limit, Regime};
use crate::forces::simplification::Simplification;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

/// Normal contact law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "kebab-case")]
#[expect(missing_docs, reason = "documented at the structs")]
pub enum Contact {
    Hertz(Hertz),
    Linear(Linear),
    Silbert(Silbert),
    Tsuji(Tsuji),
    Hooke(Hooke),
}

/// Evaluates an expression with the keys of a contact law, whichever law it is.
macro_rules! with_keys {
    ($contact:expr, $keys:ident => $do:expr) => {
        match $contact {
            $crate::forces::contact::Contact::Hertz($keys) => $do,
            $crate::forces::contact::Contact::Linear($keys) => $do,
            $crate::forces::contact::Contact::Silbert($keys) => $do,
            $crate::forces::contact::Contact::Tsuji($keys) => $do,
            $crate::forces::contact::Contact::Hooke($keys) => $do,
        }
    };
}

pub(crate) use with_keys;

/// The keys of a contact law.
pub(crate) trait ContactKeys {
    /// The law for the engine.
    type Law: NormalLaw;

    /// Name of the law, as in a scene file.
    const NAME: &'static str;

    /// What the limit `contact` means.
    const CONTACT_LIMIT: &'static str;

    /// What the limit `damped contact` means.
    const DAMPED_LIMIT: &'static str;

    /// The law, in a scene whose spheres have this mean radius (m). `mean_mass`: mass (kg) of a
    /// sphere of this radius.
    fn law(&self, mean_radius: f64, mean_mass: f64) -> Self::Law;

    /// The impacts that may limit the time step, the stiffest first; empty if nothing moves.
    fn collisions(&self, regime: &Regime<'_>) -> Vec<Collision>;

    /// Limits that do not follow from the collisions.
    fn other_limits(&self, _regime: &Regime<'_>) -> Vec<Limit> {
        Vec::new()
    }

    /// Simpler stand-ins for this law, each as a change of the scene's keys.
    fn simplifications(&self) -> Vec<Simplification> {
        Vec::new()
    }

    /// Keys that do not go together.
    fn problems(&self) -> Vec<Problem> {
        Vec::new()
    }
}

/// The simplification to contacts without losses, `key` = `value`, if there are losses.
pub(super) fn elastic(
    dissipates: bool,
    key: &'static str,
    value: f64,
) -> impl Iterator<Item = Simplification> {
    let elastic = Simplification::setting("restitution to elastic", [(key, json!(value))]);
    dissipates.then_some(elastic).into_iter()
}

/// An impact of two partners: the numbers that limit the time step.
pub(crate) struct Collision {
    /// Effective mass m1 m2 / (m1 + m2) (kg).
    pub(crate) effective_mass: f64,
    /// Relative speed (m/s).
    pub(crate) speed: f64,
    /// Angular frequency w (1/s) of the contact where it is stiffest.
    pub(crate) frequency: f64,
    /// Damping rate g (1/s) there.
    pub(crate) rate: f64,
    /// Largest force (N).
    pub(crate) largest_force: f64,
    /// Duration (s).
    pub(crate) contact_time: f64,
    /// Radius sqrt(R_eff xi) of the contact (m) where it is deepest; 0 if the law does not use it.
    pub(crate) contact_radius: f64,
}

impl Collision {
    /// The collision of an impact of partners with this effective radius (m) and damping rate
    /// (1/s).
    pub(super) fn of_impact(impact: &Impact, effective_radius: f64, rate: f64) -> Self {
        Self {
            effective_mass: impact.effective_mass,
            speed: impact.speed,
            frequency: impact.angular_frequency(),
            rate,
            largest_force: impact.largest_force(),
            contact_time: impact.contact_time(),
            contact_radius: (effective_radius * impact.deepest_overlap()).sqrt(),
        }
    }

    /// The collision of a linear impact at a relative speed (m/s), under a law without contact
    /// radius.
    pub(super) fn of_linear_impact(impact: &LinearImpact, speed: f64) -> Self {
        let frequency = impact.angular_frequency();
        Self {
            effective_mass: impact.effective_mass,
            speed,
            frequency,
            rate: impact.damping_rate(),
            largest_force: impact.stiffness * speed / frequency,
            contact_time: impact.contact_time(),
            contact_radius: 0.0,
        }
    }
}

impl Contact {
    /// Name of the law, as in a scene file.
    pub fn law(&self) -> &'static str {
        fn name<K: ContactKeys>(_: &K) -> &'static str {
            K::NAME
        }
        with_keys!(self, keys => name(keys))
    }

    /// [`NormalLaw::elastic_energy`] for many contacts: the law is built only once, because it
    /// takes an integration if the keys give a restitution.
    pub(crate) fn elastic_energy(&self) -> Box<dyn Fn(f64, f64) -> f64> {
        // The mean sphere is for the dissipation, on which the elastic energy does not depend.
        with_keys!(self, keys => {
            let law = keys.law(1.0, 1.0);
            Box::new(move |overlap, effective_radius| law.elastic_energy(overlap, effective_radius))
        })
    }

    /// As [`ContactKeys::collisions`].
    pub(crate) fn collisions(&self, regime: &Regime<'_>) -> Vec<Collision> {
        with_keys!(self, keys => keys.collisions(regime))
    }

    /// The stiffness (N/m) of a contact at its deepest, at the start or in the fastest impact with
    /// this effective radius (m) and effective mass (kg).
    pub(crate) fn stiffest(
        &self,
        regime: &Regime<'_>,
        effective_radius: f64,
        effective_mass: f64,
    ) -> f64 {
        with_keys!(self, keys => {
            let law = keys.law(regime.mean_radius, regime.mean_mass);
            let speed = regime.fastest_impact;
            let overlap = law.deepest_overlap(0.0, speed, effective_radius, effective_mass);
            law.stiffness(overlap.max(*regime.deepest_at_start), effective_radius)
        })
    }

    /// As [`ContactKeys::simplifications`].
    pub(crate) fn simplifications(&self) -> Vec<Simplification> {
        with_keys!(self, keys => keys.simplifications())
    }

    /// As [`ContactKeys::problems`].
    pub(crate) fn problems(&self) -> Vec<Problem> {
        with_keys!(self, keys => keys.problems())
    }

    /// The limits of the time step that follow from its collisions, without friction.
    pub(crate) fn limits(&self, collisions: &[Collision], regime: &Regime<'_>) -> Vec<Limit> {
        with_keys!(self, keys => limits(keys, collisions, regime))
    }
}

fn limits<K: ContactKeys>(keys: &K, collisions: &[Collision], regime: &Regime<'_>) -> Vec<Limit> {
    let Some(stiffest) = collisions.first() else {
        return Vec::new();
    };
    let least = |frequency: f64, rate: f64| {
        let seconds = collisions.iter().map(|collision| {
            let (frequency, rate) = (frequency * collision.frequency, rate * collision.rate);
            regime.scheme.oscillator(frequency, rate)
        });
        seconds.fold(f64::INFINITY, f64::min)
    };
    let mut limits = vec![
        Limit {
            name: "contact",
            seconds: 2.0 / stiffest.frequency,
            decisive: true,
            explanation: K::CONTACT_LIMIT,
            consequence: Limit::COARSE,
        },
        Limit {
            name: "twelve contacts",
            seconds: least(6.0_f64.sqrt(), 6.0),
            decisive: false,
            explanation: "(w dt)^2 + 2 g dt < 4 of a sphere with twelve such contacts, all assumed \
                          to act along one line: w^2 and the damping rate g are 6 times a pair's",
            consequence: Some("a sphere squeezed by many others may gain energy"),
        },
        regime.displacement(stiffest.speed),
    ];
    if stiffest.rate > 0.0 {
        limits.push(Limit {
            name: "damped contact",
            seconds: least(1.0, 1.0),
            decisive: true,
            explanation: K::DAMPED_LIMIT,
            consequence: Limit::COARSE,
        });
    }
    limits.extend(keys.other_limits(regime));
    limits
}
