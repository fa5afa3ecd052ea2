//! Refines a sweep without the program, and prints where the label changes:
//!
//! ```text
//! cargo run --release --example refined_sweep -- sweeps/theoretical-refined.toml /tmp/refined
//! ```
#![allow(clippy::print_stdout, reason = "the example prints borders")]

use phase::sweep::{Folder, LocalThreads, Pool, load, work};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, out] = &arguments[..] else {
        return Err("give a sweep file with a table [refine], and a folder for the results".into());
    };
    let (sweep, folder) = (load(Path::new(file))?, Folder::new(out));
    folder.create()?;
    let threads = LocalThreads::new(work::default_workers());
    let refined = Pool::new(&folder, &sweep, &threads).refine(&mut ())?;
    println!("{} runs: {:?}", refined.refinement.runs(), refined.end);
    println!("{}", std::fs::read_to_string(folder.borders())?);
    Ok(())
}
