//! The state of a system: what its motion goes on from.
//!
//! Lists, skins and margins are not part of it: no bit of the motion depends on them, and they are
//! made anew. A contact without a history stands for one whose history is empty.

use super::ledger::Books;
use super::wall_contacts::WallContacts;
use super::{Age, Near, Parts, System, VerletList};
use crate::dem::contact::NormalLaw;
use crate::dem::friction::{History, TangentialLaw};
use crate::dem::order;
use crate::dem::particles::Particles;
use crate::dem::state::StateError;
use crate::record::Instability;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// The state of a system, whatever its laws.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::dem) struct EngineState {
    step: u64,
    moves: u64,
    /// Velocity Verlet begins its step with the forces and torques of the latest evaluation.
    particles: Particles,
    /// [`Histories`] of the tangential law, in bytes, as their type is that of the law.
    histories: Vec<u8>,
    /// The books of energy, if any are kept.
    books: Option<Books>,
}

/// What contacts remember.
#[derive(Serialize, Deserialize)]
struct Histories<H> {
    /// Whether the law remembers anything: where nothing is held, nothing else tells.
    remembers: bool,
    /// Of the pairs whose history is not empty: both spheres, in the order of the list.
    pairs: Vec<(u32, u32, H)>,
    /// Of each wall: the spheres whose history with it is not empty, in the order of their indices.
    walls: Vec<Vec<(u32, H)>>,
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    pub(super) fn save(&self) -> EngineState {
        let pairs = self.remembered();
        let of_wall = |wall: &WallContacts<T::History>| {
            let known = wall.near.iter().zip(&wall.histories);
            let known = known.filter(|(_, history)| Self::REMEMBERS && !history.is_new());
            known
                .map(|(sphere, &history)| (sphere.i, history))
                .collect()
        };
        EngineState {
            step: self.step,
            moves: self.moves,
            particles: self.parts.particles.clone(),
            histories: encode(&Histories {
                remembers: Self::REMEMBERS,
                pairs,
                walls: self.walls.iter().map(of_wall).collect(),
            }),
            books: self.ledger.as_ref().map(|ledger| ledger.books.clone()),
        }
    }

    /// The pairs whose history is not empty: both spheres, in the order of the list.
    pub(super) fn remembered(&self) -> Vec<(u32, u32, T::History)> {
        let known = self.near.pairs().iter().zip(&self.pair_history);
        let known = known.filter(|(_, history)| Self::REMEMBERS && !history.is_new());
        known
            .map(|(pair, &history)| (pair.i(), pair.j(), history))
            .collect()
    }

    pub(super) fn take_up(&mut self, state: EngineState) -> Result<(), StateError> {
        let EngineState {
            step,
            moves,
            particles,
            histories,
            books,
        } = state;
        let histories: Histories<T::History> =
            decode(&histories).ok_or(StateError("its contacts follow another law"))?;
        if histories.remembers != Self::REMEMBERS {
            return Err(StateError("its contacts follow another law"));
        }
        self.accept(&particles, &histories)?;
        match (&mut self.ledger, books) {
            (Some(ledger), Some(books)) if books.fit(&particles) => ledger.books = books,
            (None, None) => {}
            _ => return Err(StateError("its books of energy are others")),
        }

        self.step = step;
        self.moves = moves;
        let Parts {
            limits,
            dt,
            effects,
            particles: present,
            sorted,
            ..
        } = &mut self.parts;
        limits.fit(&particles.radius, *dt);
        if *sorted {
            let order = order::between(&present.number, &particles.number, particles.fixed);
            for effect in effects {
                effect.reorder(&order);
            }
        }
        *present = particles;
        for (wall, known) in self.walls.iter_mut().zip(histories.walls) {
            wall.take_up(known);
        }
        self.make_lists(&histories.pairs)
            .map_err(|_| StateError("a sphere is out of bounds"))
    }

    /// Makes sure that spheres and histories may be those of this scene.
    fn accept(
        &self,
        particles: &Particles,
        histories: &Histories<T::History>,
    ) -> Result<(), StateError> {
        let Parts { limits, dt, .. } = &self.parts;
        let count = particles.len();
        let present = &self.parts.particles;
        let ordered = match self.parts.sorted {
            true => {
                count == present.len()
                    && particles.fixed == present.fixed
                    && order::is_one(&particles.number, particles.fixed)
            }
            false => particles.number.is_empty() == present.number.is_empty(),
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
            .check_positions(particles, self.step, *dt)
            .map_err(|_| StateError("a sphere is out of bounds"))
    }

    /// Makes lists of neighbours for the present spheres, with these histories.
    fn make_lists(&mut self, histories: &[(u32, u32, T::History)]) -> Result<(), Instability> {
        self.stale = true;
        if self.list.is_none() {
            return Ok(());
        }
        self.alike = Self::alike(&self.parts.particles);
        self.near = Near::new(N::ACTS, self.parts.shielded, 0.3 * self.parts.skin);
        self.forget_lists();
        let pairs = histories.iter().map(|&(i, j, _)| (i, j));
        self.near.set_pairs(pairs);
        self.pair_history.clear();
        let histories = histories.iter().map(|&(_, _, history)| history);
        self.pair_history.extend(histories);
        // A step may begin with a drift, which already goes by the near list.
        self.refresh()
    }

    /// Sees to it that lists are made anew, for spheres that are others or elsewhere.
    pub(super) fn forget_lists(&mut self) {
        self.list.iter_mut().for_each(VerletList::outdate);
        self.age = Age::default();
        self.near_age = Age::default();
        self.stale = true;
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
