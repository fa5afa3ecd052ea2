//! The state of a system, from which its motion continues.
//!
//! Lists, skins and margins are not part of it. No bit of the motion depends on them, and they are
//! built again. A contact that is not listed has an empty history.

use super::contact_state::SphereProperties;
use super::ledger::Books;
use super::rolling::RollingSprings;
use super::wall_contacts::WallContacts;
use super::{Age, NearPair, System, SystemSetup, VerletList};
use crate::dem::order;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::{History, TangentialLaw};
use crate::particles::Particles;
use crate::simulation::Instability;
use crate::simulation::StateError;
use serde::de::DeserializeOwned;
use serde::ser::SerializeSeq;
use serde::{Deserialize, Serialize, Serializer};
use std::borrow::Cow;

/// The state of a system, whatever its laws.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::dem) struct EngineState<'a> {
    step: u64,
    moves: u64,
    /// Velocity Verlet begins its step with the forces and torques of the latest evaluation.
    particles: Cow<'a, Particles>,
    /// [`Histories`] as bytes, because their type depends on the tangential law.
    histories: Vec<u8>,
    /// Springs of rolling resistance, if the scene has it.
    rolling: Option<Cow<'a, RollingSprings>>,
    /// The energy balance, if one is kept.
    books: Option<Cow<'a, Books>>,
}

impl EngineState<'_> {
    /// The same state, which borrows nothing.
    pub(in crate::dem) fn into_owned(self) -> EngineState<'static> {
        EngineState {
            particles: Cow::Owned(self.particles.into_owned()),
            rolling: self.rolling.map(|it| Cow::Owned(it.into_owned())),
            books: self.books.map(|books| Cow::Owned(books.into_owned())),
            ..self
        }
    }
}

/// Histories of contacts.
#[derive(Serialize, Deserialize)]
struct Histories<P, H> {
    /// Whether the law has a history. Empty lists do not show it.
    has_history: bool,
    /// [`RememberedPairs`] when written, a list of pairs when read.
    pairs: P,
    /// For each wall the spheres whose history with it is not empty, in the order of their indices.
    walls: Vec<Vec<(u32, H)>>,
}

/// Histories as they are read.
type SavedHistories<H> = Histories<Vec<(u32, u32, H)>, H>;

/// The near pairs whose history is not empty: both spheres and the history, in the order of the
/// list. They are written one by one, so that only their bytes are in memory a second time.
struct RememberedPairs<'a, H> {
    near: &'a [NearPair],
    histories: &'a [H],
}

impl<H: History> RememberedPairs<'_, H> {
    fn all(&self) -> impl Iterator<Item = (u32, u32, H)> {
        let known = self.near.iter().zip(self.histories);
        let known = known.filter(|(_, history)| size_of::<H>() > 0 && !history.is_new());
        known.map(|(pair, &history)| (pair.i(), pair.j(), history))
    }
}

impl<H: History> Serialize for RememberedPairs<'_, H> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(Some(self.all().count()))?;
        for pair in self.all() {
            list.serialize_element(&pair)?;
        }
        list.end()
    }
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    pub(super) fn save(&self) -> EngineState<'_> {
        let pairs = RememberedPairs {
            near: self.neighbours.near.pairs(),
            histories: &self.pair_history,
        };
        let of_wall = |wall: &WallContacts<T::History>| {
            let known = wall.near.iter().zip(&wall.histories);
            let known = known.filter(|(_, history)| Self::HAS_HISTORY && !history.is_new());
            known
                .map(|(sphere, &history)| (sphere.i, history))
                .collect()
        };
        EngineState {
            step: self.step.number,
            moves: self.step.moves,
            particles: Cow::Borrowed(&self.particles),
            histories: encode(&Histories {
                has_history: Self::HAS_HISTORY,
                pairs,
                walls: self.walls.iter().map(of_wall).collect(),
            }),
            rolling: (self.rolling.as_ref()).map(|rolling| Cow::Borrowed(&rolling.springs)),
            books: (self.ledger.as_ref()).map(|ledger| Cow::Borrowed(&ledger.books)),
        }
    }

    pub(super) fn take_up(
        &mut self,
        state: EngineState<'_>,
        doors_are_open: bool,
    ) -> Result<(), StateError> {
        let EngineState {
            step,
            moves,
            particles,
            histories,
            rolling,
            books,
        } = state;
        let histories: SavedHistories<T::History> =
            decode(&histories).ok_or(StateError("its contacts follow another law"))?;
        if histories.has_history != Self::HAS_HISTORY {
            return Err(StateError("its contacts follow another law"));
        }
        self.accept(&particles, &histories)?;
        match (&mut self.rolling, rolling) {
            (Some(present), Some(springs)) => present.springs = springs.into_owned(),
            (None, None) => {}
            _ => return Err(StateError("its rolling resistance differs")),
        }
        match (&mut self.ledger, books) {
            (Some(ledger), Some(books)) if books.fit(&particles) => {
                ledger.books = books.into_owned();
            }
            (None, None) => {}
            _ => return Err(StateError("its energy balance differs")),
        }
        self.step.number = step;
        self.step.moves = moves;
        (self.step.forces_are_zero, self.step.first_half_done) = (false, false);
        let SystemSetup {
            limits,
            dt,
            effects,
            sorted,
            flows,
            ..
        } = &mut self.setup;
        let present = &mut self.particles;
        limits.fit(&particles.radius, *dt);
        // No effect keeps an array where spheres come or go.
        if *sorted && !*flows {
            let order = order::between(&present.number, &particles.number, particles.fixed);
            for (_, effect) in effects {
                effect.reorder(&order);
            }
        }
        let domain = present.domain;
        *present = particles.into_owned();
        present.domain = domain;
        self.find_driven();
        if doors_are_open {
            self.take_doors_away();
        }
        for (wall, known) in self.walls.iter_mut().zip(histories.walls) {
            wall.set(known);
        }
        self.make_lists(&histories.pairs)
            .map_err(|_| StateError("a sphere is out of bounds"))
    }

    /// Checks that spheres and histories may belong to this scene.
    fn accept(
        &self,
        particles: &Particles,
        histories: &SavedHistories<T::History>,
    ) -> Result<(), StateError> {
        let SystemSetup { limits, dt, .. } = &self.setup;
        let count = particles.len();
        let present = &self.particles;
        let SystemSetup { sorted, flows, .. } = self.setup;
        let ordered = match (sorted, flows) {
            (_, true) => order::are_distinct(&particles.number, particles.fixed),
            (true, false) => {
                count == present.len()
                    && particles.fixed == present.fixed
                    && order::is_one(&particles.number, particles.fixed)
            }
            (false, false) => particles.number.is_empty() == present.number.is_empty(),
        };
        let known = |index: u32| (index as usize) < count;
        let in_order = |wall: &Vec<(u32, T::History)>| {
            wall.windows(2).all(|pair| pair[0].0 < pair[1].0)
                && wall.last().is_none_or(|&(i, _)| known(i))
        };
        let Histories { pairs, walls, .. } = histories;
        let fits = particles.fits_together()
            && ordered
            && (particles.rotate() == T::ROTATES || particles.is_empty())
            && walls.len() == self.walls.len()
            && walls.iter().all(in_order)
            && pairs.iter().all(|&(i, j, _)| known(i) && known(j));
        if !fits {
            return Err(StateError("it has other spheres or contacts"));
        }
        limits
            .check_positions(particles, self.step.number, *dt)
            .map_err(|_| StateError("a sphere is out of bounds"))
    }

    /// Builds lists of neighbours for the present spheres, with these histories.
    fn make_lists(&mut self, histories: &[(u32, u32, T::History)]) -> Result<(), Instability> {
        self.neighbours.stale = true;
        if self.neighbours.list.is_none() {
            return Ok(());
        }
        self.alike = SphereProperties::of_all::<N, T>(&self.particles);
        self.neighbours.near = self.setup.near::<N>();
        self.forget_lists();
        let pairs = histories.iter().map(|&(i, j, _)| (i, j));
        self.neighbours.near.set_pairs(pairs);
        self.pair_history.clear();
        let histories = histories.iter().map(|&(_, _, history)| history);
        self.pair_history.extend(histories);
        // A step may begin with a drift, which checks the near pairs.
        self.refresh()
    }

    /// Makes all lists invalid, after the spheres were replaced or sorted.
    pub(super) fn forget_lists(&mut self) {
        self.neighbours
            .list
            .iter_mut()
            .for_each(VerletList::outdate);
        self.neighbours.age = Age::default();
        self.neighbours.near_age = Age::default();
        self.neighbours.stale = true;
    }
}

fn encode<V: Serialize>(value: &V) -> Vec<u8> {
    postcard::to_allocvec(value).expect("histories hold numbers in lists of known length")
}

fn decode<V: DeserializeOwned>(bytes: &[u8]) -> Option<V> {
    match postcard::take_from_bytes(bytes) {
        Ok((value, [])) => Some(value),
        _ => None,
    }
}
