//! Which spheres may touch one another within a step.

use crate::dem::neighbours::NearPair;
use crate::dem::system::wall_contacts::NearSphere;

/// Spheres that may touch one another within a step, directly or through others, and their possible
/// contacts.
#[derive(Default)]
pub(super) struct Island {
    /// Their indices, in rising order.
    pub(super) spheres: Vec<u32>,
    /// Their contacts, possible ones included.
    pub(super) contacts: IslandContacts,
}

/// Contacts of an island, possible ones included.
#[derive(Default)]
pub(in crate::dem::system) struct IslandContacts {
    /// Pairs, in the order of the list.
    pub(in crate::dem::system) pairs: Vec<NearPair>,
    /// Entries of these pairs in the histories of all near pairs.
    pub(in crate::dem::system) entries: Vec<u32>,
    /// Spheres near each wall.
    pub(in crate::dem::system) walls: Vec<Vec<NearSphere>>,
}

impl Island {
    fn clear(&mut self) {
        self.spheres.clear();
        self.contacts.pairs.clear();
        self.contacts.entries.clear();
        self.contacts.walls.iter_mut().for_each(Vec::clear);
    }
}

/// The parts into which contacts divide the spheres.
#[derive(Default)]
pub(super) struct Islands {
    /// Another sphere of the same island, on the path to the first sphere of it.
    parent: Vec<u32>,
    /// Whether a sphere touches anything or may touch it.
    active: Vec<bool>,
    /// The island of each sphere that is the first of an island.
    island_of: Vec<u32>,
    islands: Vec<Island>,
    used: usize,
}

impl Islands {
    /// Makes every sphere an island of its own without contacts.
    pub(super) fn reset(&mut self, spheres: usize) {
        self.parent.clear();
        self.parent.extend(0..spheres as u32);
        self.active.clear();
        self.active.resize(spheres, false);
    }

    /// Notes that a sphere may touch something that does not move.
    pub(super) fn touch(&mut self, sphere: u32) {
        self.active[sphere as usize] = true;
    }

    /// Notes that two spheres may touch. The first `fixed` spheres do not move, and join no
    /// islands.
    pub(super) fn join(&mut self, i: u32, j: u32, fixed: usize) {
        self.touch(j);
        if (i as usize) < fixed {
            return;
        }
        self.touch(i);
        let (i, j) = (self.first(i), self.first(j));
        self.parent[i.max(j) as usize] = i.min(j);
    }

    /// The first sphere of the island of a sphere.
    fn first(&mut self, sphere: u32) -> u32 {
        let mut i = sphere;
        while self.parent[i as usize] != i {
            let next = self.parent[self.parent[i as usize] as usize];
            self.parent[i as usize] = next;
            i = next;
        }
        i
    }

    /// Whether a sphere touches nothing, now or within the step.
    pub(super) fn is_free(&self, sphere: usize) -> bool {
        !self.active[sphere]
    }

    /// Whether the contact of two spheres belongs to an island. The second sphere of a pair always
    /// moves.
    pub(super) fn holds_pair(&mut self, i: u32, j: u32, fixed: usize) -> bool {
        if (i as usize) < fixed {
            return self.active[j as usize];
        }
        self.active[i as usize] && self.active[j as usize] && self.first(i) == self.first(j)
    }

    /// Puts spheres that may touch and their contacts into islands, in the order of the indices.
    pub(super) fn collect<'a>(
        &mut self,
        pairs: &[NearPair],
        walls: impl Iterator<Item = &'a [NearSphere]>,
        fixed: usize,
    ) {
        self.islands[..self.used].iter_mut().for_each(Island::clear);
        self.used = 0;
        self.island_of.resize(self.parent.len(), 0);
        for sphere in 0..self.parent.len() as u32 {
            if self.is_free(sphere as usize) {
                continue;
            }
            let first = self.first(sphere);
            if first == sphere {
                self.island_of[sphere as usize] = self.used as u32;
                self.used += 1;
                if self.islands.len() < self.used {
                    self.islands.push(Island::default());
                }
            }
            self.island(first).spheres.push(sphere);
        }
        for (pair, entry) in pairs.iter().zip(0..) {
            if self.holds_pair(pair.i(), pair.j(), fixed) {
                let first = self.first(pair.j());
                let contacts = &mut self.island(first).contacts;
                contacts.pairs.push(*pair);
                contacts.entries.push(entry);
            }
        }
        for (wall, near) in walls.enumerate() {
            for &sphere in near {
                if !self.is_free(sphere.i as usize) && sphere.i as usize >= fixed {
                    let first = self.first(sphere.i);
                    let walls = &mut self.island(first).contacts.walls;
                    if walls.len() <= wall {
                        walls.resize_with(wall + 1, Vec::new);
                    }
                    walls[wall].push(sphere);
                }
            }
        }
    }

    fn island(&mut self, first: u32) -> &mut Island {
        &mut self.islands[self.island_of[first as usize] as usize]
    }

    /// The islands, in the order of their first spheres.
    pub(super) fn all(&self) -> &[Island] {
        &self.islands[..self.used]
    }
}
