//! Extended XYZ, as OVITO and ASE read it: one block of text per state.
//!
//! ```text
//! 256
//! Lattice="…" Origin="…" pbc="F F F" Properties=species:S:1:pos:R:3:radius:R:1:… Time=0.5
//! X x y z radius mass vx vy vz wx wy wz
//! ```
//!
//! OVITO makes Radius, Mass, Velocity and Angular Velocity of `radius`, `mass`, `velo` and `omega`.
//! The lattice is the box that holds all spheres at all times, and the period along an axis that is
//! periodic. All numbers are in SI units, with as many digits as it takes to read back the same
//! bits. Where spheres come and go, a block holds those that are in, and `id` is the index of each,
//! from 0.

use super::{bounds, fixed, present, rotate};
use crate::observe::Snapshot;
use crate::record::RunRecord;
use crate::scene::{FixedSphere, Scene};
use crate::store::StoreError;
use crate::store::atomic::write_atomic_with;
use std::io::{self, Write};
use std::path::Path;

/// Writes these states of a record as one extended XYZ file.
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`].
pub fn write_xyz(record: &RunRecord, states: &[&Snapshot], path: &Path) -> Result<(), StoreError> {
    let [mut low, high] = bounds(states, &record.radius);
    let mut size = [0, 1, 2].map(|axis| high[axis] - low[axis]);
    let periods = record.scene.domain().periods();
    for (axis, period) in periods.into_iter().enumerate() {
        if let Some(period) = period {
            (low[axis], size[axis]) = (-0.5 * period, period);
        }
    }
    let spins = rotate(states);
    let flows = record.scene.has_flow();
    let header = format!(
        "Lattice=\"{:?} 0 0 0 {:?} 0 0 0 {:?}\" Origin=\"{:?} {:?} {:?}\" pbc=\"{}\" \
         Properties=species:S:1:pos:R:3:radius:R:1:mass:R:1:velo:R:3{}{}",
        size[0],
        size[1],
        size[2],
        low[0],
        low[1],
        low[2],
        periodic_axes(&record.scene),
        if spins { ":omega:R:3" } else { "" },
        if flows { ":id:I:1" } else { "" }
    );
    write_atomic_with(path, |file| {
        for state in states {
            let spheres = present(record, state);
            writeln!(file, "{}\n{header} Time={:?}", spheres.len(), state.time)?;
            for sphere in spheres {
                write_sphere(file, record, state, sphere)?;
                if flows {
                    write!(file, " {sphere}")?;
                }
                writeln!(file)?;
            }
        }
        Ok(())
    })
}

/// Which axes are periodic, as the format says it.
fn periodic_axes(scene: &Scene) -> String {
    let axes = scene.domain().periods();
    axes.map(|period| if period.is_some() { "T" } else { "F" })
        .join(" ")
}

fn write_sphere(
    file: &mut impl Write,
    record: &RunRecord,
    state: &Snapshot,
    sphere: usize,
) -> io::Result<()> {
    // The format needs a chemical symbol; X stands for no element.
    write!(file, "X")?;
    let numbers = state.position.row(sphere).into_iter();
    let numbers = numbers.chain([&record.radius[sphere], &record.mass[sphere]]);
    for number in numbers.chain(state.velocity.row(sphere)) {
        write!(file, " {number:?}")?;
    }
    if state.spin.nrows() > 0 {
        for number in state.spin.row(sphere) {
            write!(file, " {number:?}")?;
        }
    }
    Ok(())
}

/// Writes the fixed spheres of a record's scene as one block; `door` is 1 for
/// spheres of the door, 0 for the walls.
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`].
pub fn write_fixed_xyz(record: &RunRecord, path: &Path) -> Result<(), StoreError> {
    let fixed = fixed(record);
    write_atomic_with(path, |file| {
        let count = fixed.walls.len() + fixed.door.len();
        writeln!(
            file,
            "{count}\nProperties=species:S:1:pos:R:3:radius:R:1:door:I:1 pbc=\"{}\"",
            periodic_axes(&record.scene)
        )?;
        for (door, spheres) in [(0, &fixed.walls), (1, &fixed.door)] {
            for FixedSphere { position, radius } in spheres {
                let [x, y, z] = position;
                writeln!(file, "X {x:?} {y:?} {z:?} {radius:?} {door}")?;
            }
        }
        Ok(())
    })
}
