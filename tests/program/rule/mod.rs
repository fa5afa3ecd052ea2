//! Rules: their text, their errors, their units and their values.

mod closed_forms;
mod columns;
mod evidence;
mod families;
mod identity;
mod limits;
mod reductions;
mod refused;
mod run;
pub(crate) mod sweeps;
mod trees;
mod units;
