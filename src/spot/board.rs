//! What the threads of a batch report to their neighbours: progress, and moved spheres.

use crate::particles::vector::Vector;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Slot of a sphere, and its new centre (m).
type MovedSphere = (u32, [f64; 3]);

/// Reports of one thread to the strips below and above.
#[derive(Debug, Default)]
#[repr(align(128))]
pub(super) struct Board {
    /// How many of the moves that it shares have been made.
    shared: AtomicU32,
    moved: [Mutex<Vec<MovedSphere>>; 2],
}

impl Board {
    /// Forgets the last batch.
    pub(super) fn clear(&self) {
        self.shared.store(0, Ordering::Relaxed);
        self.moved.iter().for_each(|moved| lock(moved).clear());
    }

    /// Notes the present places of spheres whose slots the strip on one side watches.
    pub(super) fn note<'a>(
        &self,
        side: usize,
        watched: &Range<usize>,
        slots: impl Iterator<Item = &'a u32>,
        position: &[Vector],
    ) {
        let watched = slots.filter(|slot| watched.contains(&(**slot as usize)));
        let places = watched.map(|&slot| {
            let Vector { x, y, z, .. } = position[slot as usize];
            (slot, [x, y, z])
        });
        lock(&self.moved[side]).extend(places);
    }

    /// Shows how many moves have been shared.
    pub(super) fn show(&self, shared: u32) {
        self.shared.store(shared, Ordering::Release);
    }

    /// Whether this many moves have been shared.
    pub(super) fn has_shown(&self, shared: u32) -> bool {
        self.shared.load(Ordering::Acquire) >= shared
    }

    /// Moves spheres as was noted for the strip on one side. `inbox` is empty before and after.
    pub(super) fn take_over(&self, side: usize, inbox: &mut Inbox, position: &mut [Vector]) {
        // The other thread is not kept waiting while the spheres are moved.
        std::mem::swap(&mut *lock(&self.moved[side]), &mut inbox.0);
        for (slot, centre) in inbox.0.drain(..) {
            position[slot as usize] = Vector::from(centre);
        }
    }
}

/// What was taken from a board.
#[derive(Debug, Default)]
pub(super) struct Inbox(Vec<MovedSphere>);

/// Locks, even if another thread panicked while it held the lock.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
