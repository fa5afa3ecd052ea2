//! Published maps as oracles: replays of refining without any simulation.

mod maps;
mod noise;
mod replay;
mod score;

pub use maps::PublishedMap;
pub use noise::{NoisyMap, agreement};
pub use replay::{Oracle, replay};
pub use score::{Score, merged, score};
