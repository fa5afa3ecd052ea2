//! One run out of a sweep, and its spheres in the formats of other programs.

mod browser;
mod dumps;
mod export;
mod flat;
mod names;
mod run_again;
mod view;
