//! The state of a system: what its motion goes on from.
//!
//! Lists, skins and margins are not part of it: no bit of the motion depends on them, and they are
//! made anew. A contact without a history stands for one whose history is empty.

use super::ledger::Books;
use super::wall_contacts::WallContacts;
use super::{Age, Near, Parts, System};
use crate::dem::contact::NormalLaw;
use crate::dem::friction::TangentialLaw;
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
        // By its bits: to whom zero and minus zero are equal may not be for the motion.
        let empty = encode(&T::History::default());
        let holds = |history: &T::History| Self::REMEMBERS && encode(history) != empty;
        let mut pairs = Vec::new();
        if let Some(list) = self.list.as_ref().filter(|_| Self::REMEMBERS) {
            let entries = list.owner().iter().zip(list.neighbour());
            for ((&i, &j), &history) in entries.zip(&self.pair_history) {
                if holds(&history) {
                    pairs.push((i, j, history));
                }
            }
        }
        let of_wall = |wall: &WallContacts<T::History>| {
            let known = wall.near.iter().zip(&wall.histories);
            let known = known.filter(|(_, history)| holds(history));
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
        let limits = &mut self.parts.limits;
        limits.speed_squared.clear();
        for radius in &particles.radius {
            limits.add_sphere(*radius, self.parts.dt);
        }
        self.parts.particles = particles;
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
        let known = |index: u32| (index as usize) < count;
        let in_order = |wall: &Vec<(u32, T::History)>| {
            wall.windows(2).all(|pair| pair[0].0 < pair[1].0)
                && wall.last().is_none_or(|&(i, _)| known(i))
        };
        let Histories { pairs, walls, .. } = histories;
        let fits = particles.fits_together()
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
        let Some(list) = &mut self.list else {
            return Ok(());
        };
        let particles = &self.parts.particles;
        self.alike = Self::alike(particles);
        self.near = Near::new(N::ACTS, self.parts.shielded, 0.3 * self.parts.skin);
        self.block.forget();
        self.age = Age::default();
        self.near_age = Age::default();
        list.build(particles);
        let mut known = histories.iter().peekable();
        let entries = list.owner().iter().zip(list.neighbour());
        self.pair_history = entries
            .map(|(&i, &j)| {
                while known.next_if(|&&(a, b, _)| (a, b) < (i, j)).is_some() {}
                let known = known.next_if(|&&(a, b, _)| (a, b) == (i, j));
                known.map_or_else(T::History::default, |&(_, _, history)| history)
            })
            .collect();
        // A step may begin with a drift, which already goes by the near list.
        self.refresh()
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
