//! Studies: runs of one scene over axes and variants, from which one finding follows.

mod any_file;
mod rows;
pub mod stability;

pub use any_file::AnyFile;
