//! What settings of a scene cost in time, and how wrong they are: time steps, integrators,
//! stiffness, laws, frames, and any other key.
//!
//! An error is what the scene allows one to say. Of a [case](Errors::Case) of `phase verify` it is
//! that of its known numbers. Of a motion that is not chaotic it is the distance from a reference
//! at [given times](Errors::Motion). Of a chaotic scene it is how many [labels](Errors::States)
//! change beyond what seeds change by themselves, and how far order parameters shift in units of
//! their spread over seeds.

mod cases;
mod choices;
mod evaluate;
mod file;
mod finding;
mod load;
mod motion;
mod order;
mod table;

pub use cases::{CaseRow, CaseSetting};
pub use evaluate::{Errors, Evaluation, MethodOrder, Outcome};
pub(crate) use file::ACCURACY;
pub use file::Tolerance;
pub use finding::Finding;
pub(crate) use load::of_document;
pub use load::{from_str, load};
pub use motion::MotionError;
pub use order::{Order, fitted_order};
pub use table::write_accuracy;

use crate::study::comparison::Comparison;

/// A study of accuracy, fully resolved.
#[derive(Clone, Debug)]
pub struct AccuracyStudy {
    /// Free text, the title of figures.
    pub title: Option<String>,
    /// How large an error is allowed.
    pub tolerance: Tolerance,
    /// What is run.
    pub subject: Subject,
    /// Axes, or last parts of the keys of ladders, against which the time of a step is drawn.
    pub step_time: Vec<String>,
}

/// What a study runs.
#[derive(Clone, Debug)]
pub enum Subject {
    /// Settings of a scene or sweep, compared with a reference.
    Scene(Box<Comparison>),
    /// Settings of a verification case, compared with its known numbers.
    Case(Vec<CaseSetting>),
}
