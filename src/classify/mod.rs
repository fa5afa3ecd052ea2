//! The sieves: from the observables of a run to its label.
//!
//! Each [family](Family) of scenes has a folder with its sieves and measures, and a place in the
//! list [`FAMILIES`]. A sieve is one file and a line in the list of [`Sieves`]; its windows are
//! durations; it reads records, never simulations.

mod agreement;
mod drainage;
mod error;
mod family;
mod label;
mod lengths;
mod measure;
mod none;
mod numerics;
mod rules;
mod sieve;
mod sieves;
mod silo;
mod table;
mod tank;
mod verdict;
mod window;

pub use agreement::{Agreement, MeasureDifference};
pub use drainage::{BlockedSieve, DRAINAGE};
pub use error::ClassifyError;
pub use family::{FAMILIES, Family};
pub use label::Label;
pub use measure::{Measure, MeasureRange};
pub use none::NONE;
pub use numerics::{ENERGY_GAIN, NUMERICS, judge_numerics, judge_numerics_again};
pub use rules::{Rules, StoredRule};
pub use sieve::SieveOfFamily;
pub use sieves::Sieves;
pub use silo::{ArchingSieve, FlowingSieve, SILO};
pub use table::{LabelRow, LabelTable, Point};
pub use tank::{FluidSieve, PinnedSieve, SettleSieve, SpoutSieve, TANK, pinned_shares};
pub use verdict::{Verdict, classify};
