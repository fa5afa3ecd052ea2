//! Refines a sweep without the program, and prints where the label changes:
//!
//! ```text
//! cargo run --release --example refined_sweep -- sweeps/theoretical-refined.toml /tmp/refined
//! ```
#![allow(clippy::print_stdout, reason = "the example prints borders")]

use phase::resume::DEFAULT_INTERVAL;
use phase::sweep::{Folder, LocalThreads, Pool, Wishes, load, work};
use std::error::Error;
use std::path::Path;
use std::sync::atomic::AtomicBool;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, out] = &arguments[..] else {
        return Err("give a sweep file with a table [refine], and a folder for the results".into());
    };
    let (sweep, folder) = (load(Path::new(file))?, Folder::new(out));
    folder.create()?;
    let workers = work::default_workers();
    let pool = Pool {
        folder: &folder,
        sweep: &sweep,
        backend: &LocalThreads::new(workers),
        workers,
        checkpoint_interval: DEFAULT_INTERVAL,
        wishes: Wishes {
            stop: &AtomicBool::new(false),
            resume: true,
            watch: &|_| {},
        },
    };
    let refined = pool.refine(&mut ())?;
    println!("{} runs: {:?}", refined.refinement.runs(), refined.end);
    println!("{}", std::fs::read_to_string(folder.borders())?);
    Ok(())
}
