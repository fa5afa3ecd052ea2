//! Studies: runs of one scene over axes and settings, from which one finding follows.

pub mod ablation;
pub mod accuracy;
mod any_file;
pub mod comparison;
mod name;
pub mod stability;

pub use any_file::{AnyFile, AnyStudy};
pub use name::StudyName;
