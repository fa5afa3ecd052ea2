//! A run that was interrupted goes on from its checkpoint with the bits of one that was not.

mod bench;
mod bits;
mod runs;
mod sweeps;
