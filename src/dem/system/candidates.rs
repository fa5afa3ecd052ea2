//! Candidates for contacts: near pairs, and spheres near walls.

use super::contact_task::ContactSlice;
use super::wall_contacts::{NearSphere, WallContacts};
use crate::dem::neighbours::NearPair;
use crate::walls::Wall;
use smallvec::SmallVec;

/// Walls of most scenes: a floor and four sides. Lists of more are on the heap.
const USUAL_WALLS: usize = 5;

/// The spheres near a wall, each with its history.
pub(super) struct AtWall<'a, H> {
    pub(super) wall: &'a Wall,
    pub(super) near: ContactSlice<'a, NearSphere, H>,
}

/// The spheres near each wall.
pub(super) type AtWalls<'a, H> = SmallVec<[AtWall<'a, H>; USUAL_WALLS]>;

/// Candidates for contacts, in the order of the lists, each with its history.
pub(super) struct Candidates<'a, H> {
    pub(super) pairs: ContactSlice<'a, NearPair, H>,
    pub(super) walls: AtWalls<'a, H>,
}

impl<'a, H> Candidates<'a, H> {
    /// All near pairs, and all spheres near walls.
    pub(super) fn all(
        pairs: &'a [NearPair],
        histories: &'a mut [H],
        walls: &'a mut [WallContacts<H>],
    ) -> Self {
        let at_wall = |contacts: &'a mut WallContacts<H>| AtWall {
            wall: &contacts.wall,
            near: ContactSlice {
                contacts: &contacts.near,
                histories: &mut contacts.histories,
            },
        };
        Self {
            pairs: ContactSlice {
                contacts: pairs,
                histories,
            },
            walls: walls.iter_mut().map(at_wall).collect(),
        }
    }
}
