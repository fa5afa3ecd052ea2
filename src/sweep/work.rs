//! How much work a run is, and which workers do it.

use crate::observe::Observations;
use crate::record::{Outcome, RunRecord};
use crate::run;
use crate::scene::{Scene, Start};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Sphere-steps of a whole run: steps times spheres. Where spheres come and go, the most that it may
/// take: none is known to leave, and the run to last its whole duration.
pub fn sphere_steps(scene: &Scene) -> u64 {
    let (steps, frames) = run::frames(scene);
    sphere_steps_until(scene, steps * frames)
}

/// Sphere-steps of a run until that step, if no sphere leaves.
pub fn sphere_steps_until(scene: &Scene, step: u64) -> u64 {
    let count = scene.spheres.count as u64;
    let Start::Feed { interval, .. } = scene.start else {
        return step.saturating_mul(count);
    };
    // One more sphere from every interval on, until all are in.
    let interval = ((interval / scene.time.dt).round() as u64).max(1);
    let coming = count.min(step.div_ceil(interval));
    let missed = interval.saturating_mul(coming.saturating_mul(coming.saturating_sub(1)) / 2);
    step.saturating_mul(coming).saturating_sub(missed)
}

/// Sphere-steps that a run of that outcome took, if no sphere left: fewer if a guard ended it.
pub fn sphere_steps_run(scene: &Scene, outcome: &Outcome) -> u64 {
    match outcome {
        Outcome::Completed => sphere_steps(scene),
        Outcome::Unstable(instability) => sphere_steps_until(scene, instability.step),
    }
}

/// Sphere-steps that the run of a record took.
pub fn sphere_steps_of(record: &RunRecord) -> u64 {
    let Observations {
        released,
        discharged,
        spilled,
        ..
    } = &record.observations;
    if released.is_empty() {
        return sphere_steps_run(&record.scene, &record.outcome);
    }
    let (steps, _) = run::frames(&record.scene);
    // The first frame is the start.
    (1..released.len())
        .map(|frame| released[frame] - discharged[frame] - spilled[frame])
        .map(|inside| inside as u64 * steps)
        .sum()
}

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
