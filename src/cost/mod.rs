//! Measured costs of steps and runs.
//!
//! Times are processor times of the calling thread, and things to compare are measured in turn, so
//! that what else the machine does hits all of them alike. Ratios mean something on any machine,
//! times only on this one.

mod forecast;
mod representatives;
mod run;
mod sweep;

pub use forecast::{Forecast, ForecastError, forecast};
pub use run::{CostError, OBSERVERS, PartCost, RECORD, RunCost, START};
pub use sweep::{SweepCost, TriedJob};
