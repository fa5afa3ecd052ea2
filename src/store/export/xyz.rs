//! Extended XYZ, as OVITO and ASE read it: one block of text per state.
//!
//! ```text
//! 256
//! Lattice="…" Origin="…" pbc="F F F" Properties=species:S:1:pos:R:3:radius:R:1:… Time=0.5
//! X x y z radius mass vx vy vz wx wy wz
//! ```
//!
//! OVITO makes Radius, Mass, Velocity and Angular Velocity of `radius`, `mass`, `velo` and
//! `omega`. The lattice is the box that holds all spheres at all times; nothing is periodic. All
//! numbers are in SI units, with as many digits as it takes to read back the same bits.

use super::{bounds, rotate};
use crate::observe::Snapshot;
use crate::record::RunRecord;
use crate::store::StoreError;
use crate::store::atomic::write_atomic_with;
use std::io::{self, Write};
use std::path::Path;

/// Writes these states of a record as one extended XYZ file.
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`].
pub fn write_xyz(record: &RunRecord, states: &[&Snapshot], path: &Path) -> Result<(), StoreError> {
    let [low, high] = bounds(states, &record.radius);
    let size = [0, 1, 2].map(|axis| high[axis] - low[axis]);
    let spins = rotate(states);
    let header = format!(
        "Lattice=\"{:?} 0 0 0 {:?} 0 0 0 {:?}\" Origin=\"{:?} {:?} {:?}\" pbc=\"F F F\" \
         Properties=species:S:1:pos:R:3:radius:R:1:mass:R:1:velo:R:3{}",
        size[0],
        size[1],
        size[2],
        low[0],
        low[1],
        low[2],
        if spins { ":omega:R:3" } else { "" }
    );
    write_atomic_with(path, |file| {
        for state in states {
            writeln!(
                file,
                "{}\n{header} Time={:?}",
                record.radius.len(),
                state.time
            )?;
            write_spheres(file, record, state, spins)?;
        }
        Ok(())
    })
}

fn write_spheres(
    file: &mut impl Write,
    record: &RunRecord,
    state: &Snapshot,
    spins: bool,
) -> io::Result<()> {
    for (sphere, (radius, mass)) in record.radius.iter().zip(&record.mass).enumerate() {
        // A chemical symbol is asked for; X stands for no element.
        write!(file, "X")?;
        let numbers = state.position.row(sphere).into_iter().chain([radius, mass]);
        for number in numbers.chain(state.velocity.row(sphere)) {
            write!(file, " {number:?}")?;
        }
        if spins {
            for number in state.spin.row(sphere) {
                write!(file, " {number:?}")?;
            }
        }
        writeln!(file)?;
    }
    Ok(())
}
