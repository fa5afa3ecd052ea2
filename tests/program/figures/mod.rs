//! Figures of single runs and of theory: what they show, which runs they choose, what they refuse.
//!
//! Every figure drawn here is left in `target/tmp` to look at.

mod bench;
mod runs;
mod states;
mod theory;
