//! Volumes of the Voronoi cells of the spheres in a box, from the first state of a record, as a
//! table on standard output.
//!
//!     cargo run --release --example voronoi_cells -- results/quick/spot.h5 > cells.csv

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "an example speaks for itself"
)]

use phase::measure::{CellBounds, Centres, voronoi_cells};
use phase::store::read_record;
use std::error::Error;
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args_os().nth(1).map(PathBuf::from);
    let record = read_record(&file.unwrap_or("results/quick/spot.h5".into()))?;
    let state = record.snapshots.first().ok_or("no snapshots")?;
    let tank = record.scene.tank.as_ref();
    let reach = tank.map(|tank| (tank.reach(), tank.floor));
    let Some(([Some(x), Some(y)], Some(floor))) = reach else {
        return Err("the tank is no box".into());
    };

    // The box ends at the highest centre: no cell is open.
    let centres = Centres::of(state);
    let heights = centres.place.iter().map(|place| place.z);
    let top = heights.fold(f64::NEG_INFINITY, f64::max) + record.scene.spheres.radius.mean();
    let walls = CellBounds {
        low: [-x, -y, floor],
        high: [x, y, top],
        farthest: f64::MAX,
    };
    let start = Instant::now();
    let cells = voronoi_cells(&centres, &walls);
    eprintln!("{} cells in {:.2?}", cells.len(), start.elapsed());

    let mut table = String::from("x,y,z,top,volume,faces\n");
    for (place, cell) in centres.place.iter().zip(&cells) {
        let [x, y, z] = [place.x, place.y, place.z];
        writeln!(table, "{x},{y},{z},{top},{},{}", cell.volume, cell.faces)?;
    }
    print!("{table}");
    Ok(())
}
