//! Names from files, where the program else has names of its own.

use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};

/// The same text for as long as the program runs. Equal texts are kept once: names of columns and
/// parameters, of which files have few.
pub(crate) fn lasting(text: &str) -> &'static str {
    static KNOWN: Mutex<Option<HashSet<&'static str>>> = Mutex::new(None);
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let known = known.get_or_insert_default();
    if let Some(kept) = known.get(text) {
        return kept;
    }
    let kept: &'static str = text.to_owned().leak();
    known.insert(kept);
    kept
}
