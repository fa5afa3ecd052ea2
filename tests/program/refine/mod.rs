//! Which runs a phase diagram needs: the library, and refined sweeps.

mod blind;
mod borders;
mod given;
mod interface;
#[path = "../../../examples/oracle/maps.rs"]
mod maps;
mod margins;
#[path = "../../../examples/oracle/noise.rs"]
mod noise;
mod oracle;
mod properties;
#[path = "../../../examples/oracle/replay.rs"]
mod replay;
#[path = "../../../examples/oracle/score.rs"]
mod score;
mod sweeps;
