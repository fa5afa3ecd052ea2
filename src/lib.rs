//! `phase` turns a TOML file into a phase diagram.

pub mod classify;
mod color;
mod cpu_time;
pub mod dem;
pub mod document;
pub mod notation;
pub mod observe;
pub mod plot;
pub mod record;
pub mod render;
pub mod replay;
pub mod run;
pub mod scene;
pub mod store;
pub mod sweep;
pub mod theory;
pub mod verify;
