//! Work divided among threads, and shares of arrays.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// How long an idle thread spins before it sleeps: about the time to wake it. A step of a few
/// thousand spheres would otherwise wake threads several times.
const PATIENCE: Duration = Duration::from_micros(200);

/// Does the work of each item, on the threads of the present pool if there is one.
pub(in crate::dem) fn in_parallel<I: Send>(items: &mut [I], work: &(impl Fn(&mut I) + Sync)) {
    if items.len() < 2 || rayon::current_thread_index().is_none() {
        items.iter_mut().for_each(work);
        return;
    }
    let all = items.len();
    let (begun, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    fork(items, &|item| {
        begun.fetch_add(1, Ordering::Relaxed);
        work(item);
        done.fetch_add(1, Ordering::Relaxed);
        // Only the time depends on these counters. As long as an item has not begun, this thread
        // may still get work, and does not wait here.
        let since = Instant::now();
        while begun.load(Ordering::Relaxed) == all
            && done.load(Ordering::Relaxed) < all
            && since.elapsed() < PATIENCE
        {
            std::thread::yield_now();
        }
    });
}

fn fork<I: Send>(items: &mut [I], work: &(impl Fn(&mut I) + Sync)) {
    match items {
        [] => {}
        [item] => work(item),
        _ => {
            let (one, other) = items.split_at_mut(items.len() / 2);
            rayon::join(|| fork(one, work), || fork(other, work));
        }
    }
}

/// Does both, at the same time if the present pool has several threads.
pub(in crate::dem) fn both(threads: usize, one: impl FnOnce() + Send, other: impl FnOnce() + Send) {
    // With one thread, the pool may belong to a sweep, where `join` could start another run
    // meanwhile.
    if threads > 1 && rayon::current_thread_index().is_some() {
        rayon::join(one, other);
    } else {
        one();
        other();
    }
}

/// Takes this number of entries from the front, or all if there are fewer.
pub(in crate::dem) fn split<'a, E>(rest: &mut &'a mut [E], count: usize) -> &'a mut [E] {
    let all = std::mem::take(rest);
    let count = count.min(all.len());
    let (front, back) = all.split_at_mut(count);
    *rest = back;
    front
}

/// The same for entries that are only read.
pub(in crate::dem) fn split_shared<'a, E>(rest: &mut &'a [E], count: usize) -> &'a [E] {
    let (front, back) = rest.split_at(count.min(rest.len()));
    *rest = back;
    front
}
