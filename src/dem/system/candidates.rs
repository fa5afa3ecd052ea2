//! Candidates for contacts: near pairs, and spheres near walls.

use super::contact_task::ContactSlice;
use super::wall_contacts::{NearSphere, WallContacts};
use crate::dem::neighbours::NearPair;
use crate::dem::walls::TankWall;

/// Spheres near each wall, each with its history.
pub(super) type AtWalls<'a, H> =
    [Option<(TankWall, ContactSlice<'a, NearSphere, H>)>; TankWall::MOST];

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
        let mut at_walls = [const { None }; TankWall::MOST];
        for (place, wall) in at_walls.iter_mut().zip(walls) {
            let near = ContactSlice {
                contacts: &wall.near,
                histories: &mut wall.histories,
            };
            *place = Some((wall.wall, near));
        }
        Self {
            pairs: ContactSlice {
                contacts: pairs,
                histories,
            },
            walls: at_walls,
        }
    }
}
