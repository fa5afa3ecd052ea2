//! Which workers do the jobs of a sweep.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of workers to use by default: all cores this process may use.
pub fn default_workers() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Calls `work` for every item, in order, on that many workers of a pool of their own. Workers
/// take the next item when they are done with one.
///
/// # Errors
/// If the system gives no threads.
pub fn each<T: Sync>(
    workers: usize,
    items: &[T],
    work: impl Fn(&T) + Sync,
) -> Result<(), rayon::ThreadPoolBuildError> {
    let workers = workers.clamp(1, items.len().max(1));
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(workers)
        .build()?;
    let next = AtomicUsize::new(0);
    pool.broadcast(|_| {
        while let Some(item) = items.get(next.fetch_add(1, Ordering::Relaxed)) {
            work(item);
        }
    });
    Ok(())
}

/// Like [`each`], and collects what `work` returns, in the order of the items.
///
/// # Errors
/// If the system gives no threads.
pub fn map<T: Sync, U: Send + Sync>(
    workers: usize,
    items: &[T],
    work: impl Fn(&T) -> U + Sync,
) -> Result<Vec<U>, rayon::ThreadPoolBuildError> {
    let slots: Vec<_> = items.iter().map(|_| std::sync::OnceLock::new()).collect();
    let indices: Vec<usize> = (0..items.len()).collect();
    each(workers, &indices, |&index| {
        // Each index is visited once, so the slot is always empty here.
        let _ = slots[index].set(work(&items[index]));
    })?;
    Ok(slots
        .into_iter()
        .filter_map(std::sync::OnceLock::into_inner)
        .collect())
}
