//! Times of the engine's parts and of whole scenes. `benches/README.md` says how to run them.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

mod parts;
mod scenes;
mod states;

fn main() {
    divan::main();
}
