//! Work divided among threads: what is done for each share, and shares of arrays.

/// Does the work of each item, on the threads of the pool that runs this, if one does.
pub(in crate::dem) fn in_parallel<I: Send>(items: &mut [I], work: &(impl Fn(&mut I) + Sync)) {
    match items {
        [] => {}
        [item] => work(item),
        _ if rayon::current_thread_index().is_none() => items.iter_mut().for_each(work),
        _ => {
            let (one, other) = items.split_at_mut(items.len() / 2);
            rayon::join(|| in_parallel(one, work), || in_parallel(other, work));
        }
    }
}

/// Takes so many entries from the front, or all that there are.
pub(in crate::dem) fn split<'a, E>(rest: &mut &'a mut [E], count: usize) -> &'a mut [E] {
    let all = std::mem::take(rest);
    let count = count.min(all.len());
    let (front, back) = all.split_at_mut(count);
    *rest = back;
    front
}

/// The same of entries that are only read.
pub(in crate::dem) fn split_shared<'a, E>(rest: &mut &'a [E], count: usize) -> &'a [E] {
    let (front, back) = rest.split_at(count.min(rest.len()));
    *rest = back;
    front
}
