//! The table of a friction law in a scene, and which contact laws it goes with.

use super::{
    Coulomb, CundallStrack, HookeFriction, Mindlin, MindlinDeresiewicz, SilbertFriction, Spin,
    TangentialLaw,
};
use crate::forces::contact::{
    Collision, Contact, ContactKeys, Hertz, Hooke, Linear, Silbert, Tsuji,
};
use crate::forces::limit::{Limit, Regime};
use crate::forces::simplification::Simplification;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

/// Tangential contact law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "kebab-case")]
#[expect(missing_docs, reason = "documented at the structs")]
pub enum Friction {
    Spin(Spin),
    Coulomb(Coulomb),
    CundallStrack(CundallStrack),
    Mindlin(Mindlin),
    MindlinDeresiewicz(MindlinDeresiewicz),
    #[serde(rename = "silbert")]
    SilbertFriction(SilbertFriction),
    #[serde(rename = "hooke")]
    HookeFriction(HookeFriction),
}

/// The keys of a friction law used with the contact law `C`.
pub(crate) trait FrictionKeys<C> {
    /// The law for the engine.
    type Law: TangentialLaw;

    /// The law for time steps of `dt` (s).
    fn law(&self, contact: &C, dt: f64) -> Self::Law;

    /// Its limit of the time step, if it has one. `collisions` come from the [contact
    /// law](ContactKeys::collisions).
    fn limit(
        &self,
        _contact: &C,
        _collisions: &[Collision],
        _regime: &Regime<'_>,
    ) -> Option<Limit> {
        None
    }

    /// A simpler friction law, if there is one.
    fn simpler(&self, _contact: &C) -> Option<Coulomb> {
        None
    }
}

/// Calls a macro with the pairs of contact and friction laws that go together, each as the variant
/// of its enum. The engine is compiled for these alone.
macro_rules! with_pairs_of_laws {
    ($call:ident) => {
        $call! {
            (Hertz, Spin),
            (Hertz, Coulomb),
            (Linear, Coulomb),
            (Linear, CundallStrack),
            (Hertz, Mindlin),
            (Hertz, MindlinDeresiewicz),
            (Silbert, SilbertFriction),
            (Tsuji, Spin),
            (Tsuji, Coulomb),
            (Tsuji, Mindlin),
            (Tsuji, MindlinDeresiewicz),
            (Hooke, HookeFriction),
        }
    };
}
pub(crate) use with_pairs_of_laws;

macro_rules! names_of {
    ($(($contact:ident, $friction:ident),)+) => {
        &[$(($contact::NAME, $friction::NAME)),+]
    };
}

/// Names of the pairs of contact and friction laws that go together.
const PAIRS: &[(&str, &str)] = with_pairs_of_laws!(names_of);

impl Friction {
    /// Name of the law, as in a scene file.
    pub fn law(&self) -> &'static str {
        match self {
            Self::Spin(_) => Spin::NAME,
            Self::Coulomb(_) => Coulomb::NAME,
            Self::CundallStrack(_) => CundallStrack::NAME,
            Self::Mindlin(_) => Mindlin::NAME,
            Self::MindlinDeresiewicz(_) => MindlinDeresiewicz::NAME,
            Self::SilbertFriction(_) => SilbertFriction::NAME,
            Self::HookeFriction(_) => HookeFriction::NAME,
        }
    }

    /// The form of a law whose formula has changed although its keys have not; `None` if it has not
    /// changed. Runs of different forms differ.
    pub(crate) fn form(&self) -> Option<&'static str> {
        match self {
            Self::SilbertFriction(_) => Some("keeps its displacement"),
            _ => None,
        }
    }

    /// Coefficient mu of a law that can hold spheres against a force; `None` if it only slows their
    /// spins.
    pub fn holding_coefficient(&self) -> Option<f64> {
        match self {
            Self::Spin(_) => None,
            Self::Coulomb(law) => Some(law.coefficient),
            Self::CundallStrack(law) => Some(law.coefficient),
            Self::Mindlin(law) => Some(law.coefficient),
            Self::MindlinDeresiewicz(law) => Some(law.coefficient),
            Self::SilbertFriction(law) => Some(law.coefficient),
            Self::HookeFriction(law) => Some(law.coefficient),
        }
    }

    /// The same law with another coefficient.
    pub fn with_coefficient(&self, coefficient: f64) -> Self {
        let mut law = self.clone();
        match &mut law {
            Self::Spin(law) => law.coefficient = coefficient,
            Self::Coulomb(law) => law.coefficient = coefficient,
            Self::CundallStrack(law) => law.coefficient = coefficient,
            Self::Mindlin(law) => law.coefficient = coefficient,
            Self::MindlinDeresiewicz(law) => law.coefficient = coefficient,
            Self::SilbertFriction(law) => law.coefficient = coefficient,
            Self::HookeFriction(law) => law.coefficient = coefficient,
        }
        law
    }

    /// The contact laws that it goes with, by name.
    pub fn contacts(&self) -> impl Iterator<Item = &'static str> + Clone {
        let law = self.law();
        let pairs = PAIRS.iter();
        pairs.filter_map(move |(contact, friction)| (*friction == law).then_some(*contact))
    }

    /// Whether it goes with a contact law.
    pub fn goes_with(&self, contact: &Contact) -> bool {
        PAIRS.contains(&(contact.law(), self.law()))
    }

    /// The friction laws that go with a contact law, by name.
    pub fn laws_with(contact: &Contact) -> impl Iterator<Item = &'static str> + Clone {
        let law = contact.law();
        let pairs = PAIRS.iter();
        pairs.filter_map(move |(contact, friction)| (*contact == law).then_some(*friction))
    }

    /// Simpler stand-ins for this law, each as a change of the scene's keys. `removed`: the table
    /// of friction, and the tables that need it.
    pub(crate) fn simplifications(
        &self,
        contact: &Contact,
        removed: Vec<&'static str>,
    ) -> Vec<Simplification> {
        macro_rules! of_pair {
            ($(($contact:ident, $friction:ident),)+) => {
                match (contact, self) {
                    $((Contact::$contact(contact), Self::$friction(friction)) => {
                        friction.simpler(contact)
                    })+
                    _ => None,
                }
            };
        }
        let law = self.law();
        let simpler = with_pairs_of_laws!(of_pair).map(|simpler| {
            let table = json!(Self::Coulomb(simpler));
            Simplification::setting(format!("{law} friction to coulomb"), [("friction", table)])
        });
        let none = Simplification {
            name: format!("{law} friction to none"),
            set: Vec::new(),
            remove: removed,
        };
        simpler.into_iter().chain([none]).collect()
    }

    /// As [`FrictionKeys::limit`].
    pub(crate) fn limit(
        &self,
        contact: &Contact,
        collisions: &[Collision],
        regime: &Regime<'_>,
    ) -> Option<Limit> {
        macro_rules! of_pair {
            ($(($contact:ident, $friction:ident),)+) => {
                match (contact, self) {
                    $((Contact::$contact(contact), Self::$friction(friction)) => {
                        friction.limit(contact, collisions, regime)
                    })+
                    _ => None,
                }
            };
        }
        with_pairs_of_laws!(of_pair)
    }
}
