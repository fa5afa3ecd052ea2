//! The program and the library around the engine: files, sweeps, records, figures, commands.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod ablate;
mod accuracy;
mod checkpoint;
mod clusters;
mod command_line;
mod compare;
mod cost;
mod drainage_figures;
mod drainages;
mod editors;
mod external;
mod figures;
mod fit;
mod folders;
/// How the program writes numbers; its unit tests run here.
#[path = "../../src/cli/format.rs"]
#[allow(dead_code, reason = "the program uses all of it")]
mod format;
mod formats;
mod limits;
mod loss;
mod made_up;
mod measures;
mod model;
mod names;
mod packing_fraction;
mod plot;
mod published;
mod recorder;
mod records;
mod refine;
mod report;
mod resume;
mod rooms;
mod rule;
mod scene_files;
#[path = "../scenes/mod.rs"]
mod scenes;
mod shards;
mod shared;
mod silo_figures;
mod silo_sweep;
mod spot;
mod stability_study;
mod studies;
mod suggestions;
#[path = "../support/mod.rs"]
mod support;
mod tables;
mod variants;
