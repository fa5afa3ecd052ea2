//! Which runs a phase diagram needs.
//!
//! Most runs of a full grid are far from any border between labels. Here a coarse grid is run
//! first, and then rounds of runs where the label is least certain. The result is the probability
//! of each label at each place ([`ProbabilityMap`]), and the borders with bands ([`Borders`],
//! [`LatticePlane`]). Bands include the uncertainty from too few runs and the scatter of seeds.
//!
//! Everything is a function of the axes, the settings and the labels only. Mathematical functions
//! come from `libm`, all sums have a fixed order, and there are no threads: bits are the same on
//! all machines.
//!
//! ```
//! use phase::refine::{LatticeAxis, Borders, Lattice, Round, Rounds, AxisScale, Settings};
//!
//! // The label is 3 above a line, and 1 below it.
//! let label = |values: &[f64]| if values[1] > 2.0 + 0.3 * values[0] { 3 } else { 1 };
//! let values: Vec<f64> = (0..=20).map(|k| 0.5 * f64::from(k)).collect();
//! let lattice = Lattice::new(vec![
//!     LatticeAxis::new("radius", values.clone(), AxisScale::Linear)?,
//!     LatticeAxis::new("omega", values, AxisScale::Linear)?,
//! ])?;
//! let mut rounds = Rounds::new(lattice.clone(), Settings::with_budget(60))?;
//! while let Round::Runs(runs) = rounds.next_round()? {
//!     for run in runs {
//!         let label = label(&run.values);
//!         rounds.learn(run, label)?;
//!     }
//! }
//! assert_eq!(rounds.runs().len(), 60);
//! let borders = Borders::new(&lattice, rounds.map()?, 1)?;
//! for crossing in &borders.crossings {
//!     let border = 2.0 + 0.3 * crossing.values[0];
//!     assert!(crossing.band95[0] <= border && border <= crossing.band95[1]);
//! }
//! # Ok::<(), phase::refine::RefineError>(())
//! ```

mod between;
mod borders;
mod choice;
mod cholesky;
mod curves;
mod error;
mod gap;
mod lattice;
mod map;
pub mod model;
mod normal;
mod observations;
mod rounds;
mod settings;

pub use borders::{Borders, Crossing, Width, widths};
pub use curves::{BorderCurve, LatticePlane};
pub use error::RefineError;
pub use gap::Gap;
pub use lattice::{AxisScale, Lattice, LatticeAxis};
pub use map::ProbabilityMap;
pub use observations::{Finding, Observations, Training, Trial};
pub(crate) use rounds::start;
pub use rounds::{Finish, Round, Rounds, probabilities};
pub use settings::{ModelKind, Settings};

/// Code of a label; equal codes are equal labels. Runs that fail and runs that are unstable have
/// codes of their own.
pub type Code = i8;
