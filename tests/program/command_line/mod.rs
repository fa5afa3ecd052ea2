//! What each command prints, writes and returns.

mod arguments;
mod bench;
mod results;
mod scenes;
mod sweeps;
