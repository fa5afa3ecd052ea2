//! What the tests share.

use crate::support::{Answer, TinySweep, Workplace};

/// A workplace whose `results/tiny` holds the default sweep.
pub(crate) fn swept(sweep: &TinySweep) -> (Workplace, Answer) {
    let place = Workplace::new();
    place.write("tiny.toml", &sweep.text());
    let answer = place.phase(&["sweep", "tiny.toml"]);
    (place, answer)
}
