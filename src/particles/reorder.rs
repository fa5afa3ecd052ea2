//! Arrays in another order.

/// Puts entries into a new order; leaves an empty array alone.
pub(crate) fn reorder<T: Copy>(entries: &mut Vec<T>, order: &[u32]) {
    if !entries.is_empty() {
        *entries = order.iter().map(|&i| entries[i as usize]).collect();
    }
}
