//! CSV tables for spreadsheets and pandas: all spheres, and all observables.

use super::{fixed, present};
use crate::observe::Snapshot;
use crate::record::RunRecord;
use crate::scene::FixedSphere;
use crate::store::StoreError;
use crate::store::atomic::write_atomic_with;
use std::io::Write;
use std::path::Path;

/// What a table of spheres begins with.
pub const SPHERES_SIGNATURE: &[u8] = b"time,sphere,x,y,z,";

/// Writes these states of a record as a table of one row per state and sphere: `time` (s), `sphere`
/// (from 0), centre `x`, `y`, `z` (m), velocity `vx`, `vy`, `vz` (m/s), spin `wx`, `wy`, `wz`
/// (rad/s; empty without rotation), `radius` (m), `mass` (kg). Where spheres come and go there is
/// no row for one that is not in.
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`].
pub fn write_spheres(
    record: &RunRecord,
    states: &[&Snapshot],
    path: &Path,
) -> Result<(), StoreError> {
    write_atomic_with(path, |file| {
        writeln!(file, "time,sphere,x,y,z,vx,vy,vz,wx,wy,wz,radius,mass")?;
        for state in states {
            for sphere in present(record, state) {
                let (radius, mass) = (record.radius[sphere], record.mass[sphere]);
                write!(file, "{:?},{sphere}", state.time)?;
                let centre = state.position.row(sphere);
                for number in centre.into_iter().chain(state.velocity.row(sphere)) {
                    write!(file, ",{number:?}")?;
                }
                if state.spin.nrows() > 0 {
                    for number in state.spin.row(sphere) {
                        write!(file, ",{number:?}")?;
                    }
                } else {
                    write!(file, ",,,")?;
                }
                writeln!(file, ",{radius:?},{mass:?}")?;
            }
        }
        Ok(())
    })
}

/// Writes the fixed spheres of a record's scene as a table of one row per sphere: `kind` (`wall` or
/// `door`), centre `x`, `y`, `z` (m), `radius` (m).
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`].
pub fn write_fixed(record: &RunRecord, path: &Path) -> Result<(), StoreError> {
    let fixed = fixed(record);
    write_atomic_with(path, |file| {
        writeln!(file, "kind,x,y,z,radius")?;
        for (kind, spheres) in [("wall", &fixed.walls), ("door", &fixed.door)] {
            for FixedSphere { position, radius } in spheres {
                let [x, y, z] = position;
                writeln!(file, "{kind},{x:?},{y:?},{z:?},{radius:?}")?;
            }
        }
        Ok(())
    })
}

/// Writes the scalar observables of a record as a table of one row per frame: `time` (s), then the
/// observables by their names, in the units that the record gives them.
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`].
pub fn write_observations(record: &RunRecord, path: &Path) -> Result<(), StoreError> {
    let scalars = record.observations.scalars();
    write_atomic_with(path, |file| {
        write!(file, "time")?;
        for series in &scalars {
            write!(file, ",{}", series.name)?;
        }
        writeln!(file)?;
        for (frame, time) in record.observations.time.iter().enumerate() {
            write!(file, "{time:?}")?;
            for series in &scalars {
                write!(file, ",{:?}", series.values[frame])?;
            }
            writeln!(file)?;
        }
        Ok(())
    })
}
