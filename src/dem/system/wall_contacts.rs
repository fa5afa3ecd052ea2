//! A wall, the spheres near it, and the histories of their contacts with it.

use crate::particles::Particles;
use crate::walls::Wall;

/// A sphere that may touch a wall, and its entry in the wall's list.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NearSphere {
    /// Its index.
    pub(super) i: u32,
    /// Where the wall keeps the history of their contact.
    pub(super) entry: u32,
}

/// A wall, the spheres near it, and the histories of their contacts with it. Only these spheres
/// have an entry, because few spheres of a heap are near a wall.
pub(super) struct WallContacts<H> {
    pub(super) wall: Wall,
    /// In the order of their indices.
    pub(super) near: Vec<NearSphere>,
    /// In the same order. The history of a law without memory has size zero.
    pub(super) histories: Vec<H>,
    /// Unused lists, kept for their memory.
    spare: (Vec<NearSphere>, Vec<H>),
}

impl<H: Copy + Default> WallContacts<H> {
    const HAS_HISTORY: bool = size_of::<H>() > 0;

    pub(super) fn new(wall: &Wall) -> Self {
        Self {
            wall: *wall,
            near: Vec::new(),
            histories: Vec::new(),
            spare: (Vec::new(), Vec::new()),
        }
    }

    /// Finds the moving spheres that touch the wall, or may after a displacement of `margin` (m),
    /// and clears the histories of the others. Both lists are sorted, so one pass over each
    /// suffices.
    pub(super) fn find(&mut self, particles: &Particles, margin: f64) {
        let moving = match self.is_gone() {
            true => 0..0,
            false => particles.fixed..particles.len(),
        };
        let (near, histories) = &mut self.spare;
        near.clear();
        histories.clear();
        let mut known = self.near.iter().zip(&self.histories).peekable();
        for i in moving {
            if !(self.wall).is_near(particles.position[i], particles.radius[i], margin) {
                continue;
            }
            let i = i as u32;
            let mut history = H::default();
            if Self::HAS_HISTORY {
                while known.next_if(|(known, _)| known.i < i).is_some() {}
                if let Some((_, &known)) = known.next_if(|(known, _)| known.i == i) {
                    history = known;
                }
            }
            let entry = near.len() as u32;
            near.push(NearSphere { i, entry });
            histories.push(history);
        }
        std::mem::swap(&mut self.near, near);
        std::mem::swap(&mut self.histories, histories);
    }

    /// Takes the wall away, if it is a door; where a door joined it, it counts more often.
    pub(super) fn open_door(&mut self) {
        self.wall.weight = self.wall.weight_when_open;
        if self.is_gone() {
            self.set([]);
        }
    }

    /// Whether its forces do not count.
    fn is_gone(&self) -> bool {
        self.wall.weight == 0.0
    }

    /// Gives the spheres that stay their new indices, when others are removed.
    pub(super) fn retain(&mut self, keep: &[bool]) {
        let (near, histories) = (&self.near, &self.histories);
        let known = near
            .iter()
            .zip(histories)
            .map(|(it, history)| (it.i, *history));
        let mut place = 0;
        let mut next = 0;
        let staying: Vec<(u32, H)> = known
            .filter_map(|(i, history)| {
                place += keep[next..i as usize].iter().filter(|it| **it).count() as u32;
                next = i as usize;
                keep[next].then_some((place, history))
            })
            .collect();
        self.set(staying);
    }

    /// Gives the spheres their new indices.
    pub(super) fn reorder(&mut self, places: &[u32]) {
        let known = self.near.iter().zip(&self.histories);
        let mut moved: Vec<(u32, H)> = known
            .map(|(it, history)| (places[it.i as usize], *history))
            .collect();
        moved.sort_unstable_by_key(|&(i, _)| i);
        self.set(moved);
    }

    /// Replaces all entries by these spheres and histories, in the order of the indices.
    pub(super) fn set(&mut self, known: impl IntoIterator<Item = (u32, H)>) {
        self.near.clear();
        self.histories.clear();
        for (entry, (i, history)) in (0..).zip(known) {
            self.near.push(NearSphere { i, entry });
            self.histories.push(history);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::particles::vector::Vector;
    use crate::walls::{Plane, WallName, WallSurface};

    fn heights(heights: &[f64]) -> Particles {
        Particles {
            position: heights.iter().map(|&z| Vector::new(0.0, 0.0, z)).collect(),
            radius: vec![1.0; heights.len()],
            ..Particles::default()
        }
    }

    fn known(contacts: &WallContacts<u8>) -> Vec<(u32, u8)> {
        let near = contacts.near.iter().enumerate();
        near.map(|(entry, it)| {
            assert_eq!(it.entry as usize, entry);
            (it.i, contacts.histories[entry])
        })
        .collect()
    }

    #[test]
    fn histories_stay_with_their_spheres() {
        let mut contacts = WallContacts::new(&Wall::new(
            WallSurface::Plane(Plane::floor(0.0)),
            WallName::Floor,
        ));
        contacts.find(&heights(&[0.9, 5.0, 0.9, 0.9, 5.0]), 0.1);
        assert_eq!(known(&contacts), [(0, 0), (2, 0), (3, 0)]);
        contacts.histories.copy_from_slice(&[7, 8, 9]);
        // One comes near, one leaves.
        contacts.find(&heights(&[0.9, 1.05, 5.0, 0.9, 5.0]), 0.1);
        assert_eq!(known(&contacts), [(0, 7), (1, 0), (3, 9)]);
        contacts.find(&heights(&[0.9, 1.05, 0.9, 0.9, 5.0]), 0.1);
        assert_eq!(known(&contacts), [(0, 7), (1, 0), (2, 0), (3, 9)]);
        contacts.retain(&[true, false, false, true, true]);
        assert_eq!(known(&contacts), [(0, 7), (1, 9)]);
        contacts.retain(&[false, true, true]);
        assert_eq!(known(&contacts), [(0, 9)]);
    }
}
