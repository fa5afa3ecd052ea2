//! Which runs a phase diagram needs: the library, and refined sweeps.

mod blind;
mod borders;
mod interface;
mod oracle;
mod properties;
mod sweeps;
