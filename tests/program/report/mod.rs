//! Pages of `phase report`: what they hold, and that their thresholds label as the program does.

mod contents;
mod files;
mod thresholds;

use crate::support::{TinySweep, Workplace};
use serde_json::Value;

/// Sieves for runs of two seconds.
const SIEVES: &str = "
[sieves.settle]
window = 0.1
drift_window = 0.2
tolerance = 0.1
[sieves.fluid]
window = 0.3
[sieves.pinned]
window = 0.3
[sieves.spout]
window = 0.05
least = 1
";

/// A sweep whose tank sieves find something.
fn sieved() -> TinySweep {
    TinySweep {
        omegas: vec![0.0, 2.0, 4.0, 8.0, 16.0],
        more: SIEVES.to_owned(),
        ..TinySweep::default()
    }
}

/// The document in a page.
fn document(page: &str) -> Value {
    let (_, data) = page
        .split_once("<script type=\"application/json\" id=\"data\">")
        .unwrap();
    let (data, _) = data.split_once("</script>").unwrap();
    serde_json::from_str(data).unwrap()
}

/// The document of a page of a workplace.
fn read(place: &Workplace, page: &str) -> Value {
    document(&place.read(page))
}
