//! The moves of a step on several threads.
//!
//! Each thread has its own copy of the positions. In each wave it makes its share of the moves and
//! logs which spheres they have moved where; after the wave it brings its copy up to date with the
//! logs of the others.

use super::guard::Fault;
use super::model::Scratch;
use super::steps::{Done, Step};
use crate::particles::vector::Vector;
use rayon::ThreadPool;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError, RwLock};

/// Least and most looks at a barrier before a thread sleeps: about 1 and 20 microseconds.
const LOOKS: [usize; 2] = [64, 1024];

/// Threads and what they work with.
#[derive(Debug)]
pub(crate) struct Crew {
    pool: ThreadPool,
    workers: Vec<Mutex<Worker>>,
    /// For each worker the logs of even and of odd waves: one is written while the other is read.
    logs: Vec<[RwLock<Log>; 2]>,
}

/// What one thread works with.
#[derive(Debug, Default)]
struct Worker {
    position: Vec<Vector>,
    scratch: Scratch,
    done: Vec<Done>,
    next: usize,
}

/// What one thread did in one wave.
#[derive(Debug, Default)]
struct Log {
    /// Slots of the spheres that were moved, and their new centres (m).
    moved: Vec<(u32, Vector)>,
    /// Whether the spheres must be sorted.
    stale: bool,
    /// The first broken guard, and the number of its move.
    fault: Option<(u32, Fault)>,
}

impl Crew {
    pub(crate) fn new(pool: ThreadPool) -> Self {
        let threads = pool.current_num_threads();
        Self {
            pool,
            workers: (0..threads).map(|_| Mutex::default()).collect(),
            logs: (0..threads)
                .map(|_| <[RwLock<Log>; 2]>::default())
                .collect(),
        }
    }

    /// The pool of threads.
    pub(crate) fn pool(&self) -> &ThreadPool {
        &self.pool
    }

    /// Makes the moves of waves until the spheres must be sorted. Returns the next wave, and what
    /// was done.
    pub(super) fn make_waves(
        &self,
        step: &Step<'_>,
        first: usize,
        position: &mut Vec<Vector>,
        scratch: &mut Scratch,
    ) -> Result<(usize, Vec<Done>), Fault> {
        for worker in &self.workers {
            let mut worker = lock(worker);
            worker.position.clone_from(position);
            worker.scratch.stale = false;
            worker.done.clear();
        }
        let barrier = Barrier::new(self.workers.len());
        self.pool
            .broadcast(|context| self.work(context.index(), step, first, &barrier));
        let mut done = Vec::new();
        let mut next = first;
        for worker in &self.workers {
            let worker = &mut *lock(worker);
            done.append(&mut worker.done);
            scratch.left.append(&mut worker.scratch.left);
            next = worker.next;
        }
        if let Some(last) = next.checked_sub(1) {
            let logs = self.logs.iter().map(|logs| read(&logs[last % 2]));
            let mut first_fault: Option<(u32, Fault)> = None;
            for log in logs {
                scratch.stale |= log.stale;
                if let Some((number, fault)) = &log.fault
                    && first_fault.as_ref().is_none_or(|(first, _)| number < first)
                {
                    first_fault = Some((*number, fault.clone()));
                }
            }
            if let Some((_, fault)) = first_fault {
                return Err(fault);
            }
        }
        if let Some(worker) = self.workers.first() {
            std::mem::swap(position, &mut lock(worker).position);
        }
        Ok((next, done))
    }

    /// The work of one thread.
    fn work(&self, own: usize, step: &Step<'_>, first: usize, barrier: &Barrier) {
        let worker = &mut *lock(&self.workers[own]);
        worker.next = first;
        let mut patience = LOOKS[1];
        for wave in step.waves_from(first) {
            let mut log = self.logs[own][wave % 2]
                .write()
                .unwrap_or_else(PoisonError::into_inner);
            let shares = step
                .waves
                .wave(wave)
                .iter()
                .skip(own)
                .step_by(self.workers.len());
            worker.make_moves(step, shares, &mut log);
            let mut ends = log.stale || log.fault.is_some();
            drop(log);
            barrier.wait(&mut patience);
            for (other, logs) in self.logs.iter().enumerate() {
                if other != own {
                    let log = read(&logs[wave % 2]);
                    for &(slot, centre) in &log.moved {
                        worker.position[slot as usize] = centre;
                    }
                    ends |= log.stale || log.fault.is_some();
                }
            }
            worker.next = wave + 1;
            if ends {
                return;
            }
        }
    }
}

impl Worker {
    fn make_moves<'a>(
        &mut self,
        step: &Step<'_>,
        numbers: impl Iterator<Item = &'a u32>,
        log: &mut Log,
    ) {
        log.moved.clear();
        log.fault = None;
        for &number in numbers {
            match step.make(number, &mut self.position, &mut self.scratch) {
                Ok(done) => self.done.push(done),
                Err(fault) => {
                    log.fault = Some((number, fault));
                    break;
                }
            }
            let slots = self.scratch.moved.iter().chain(&self.scratch.relaxed);
            log.moved
                .extend(slots.map(|&slot| (slot, self.position[slot as usize])));
        }
        log.stale = self.scratch.stale;
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn read(log: &RwLock<Log>) -> std::sync::RwLockReadGuard<'_, Log> {
    log.read().unwrap_or_else(PoisonError::into_inner)
}

/// A place where threads wait for each other. They look again and again at first, because most
/// waves are shorter than it takes to wake a thread; where other work keeps a thread waiting, it
/// sleeps.
struct Barrier {
    threads: usize,
    arrived: AtomicUsize,
    /// Number of threads that sleep.
    sleeping: Mutex<usize>,
    wake: Condvar,
}

impl Barrier {
    fn new(threads: usize) -> Self {
        Self {
            threads,
            arrived: AtomicUsize::new(0),
            sleeping: Mutex::new(0),
            wake: Condvar::new(),
        }
    }

    /// Waits for all. Where looking was in vain, the other threads may be waiting for this one's
    /// processor: `patience`, the number of looks, is halved, else doubled.
    fn wait(&self, patience: &mut usize) {
        let arrived = self.arrived.fetch_add(1, Ordering::AcqRel) + 1;
        let all = arrived.next_multiple_of(self.threads);
        let waits = || self.arrived.load(Ordering::Acquire) < all;
        if arrived == all {
            // The lock makes sure that a thread either sees the count or is woken.
            if *lock(&self.sleeping) > 0 {
                self.wake.notify_all();
            }
            return;
        }
        for _ in 0..*patience {
            if !waits() {
                *patience = (*patience * 2).min(LOOKS[1]);
                return;
            }
            std::hint::spin_loop();
        }
        *patience = (*patience / 2).max(LOOKS[0]);
        let mut sleeping = lock(&self.sleeping);
        *sleeping += 1;
        while waits() {
            sleeping = self
                .wake
                .wait(sleeping)
                .unwrap_or_else(PoisonError::into_inner);
        }
        *sleeping -= 1;
    }
}
