//! CSV tables for spreadsheets and pandas: all spheres, and all observables.

use crate::observe::Snapshot;
use crate::record::RunRecord;
use crate::store::StoreError;
use crate::store::atomic::write_atomic_with;
use std::io::Write;
use std::path::Path;

/// What a table of spheres begins with.
pub const SPHERES_SIGNATURE: &[u8] = b"time,sphere,x,y,z,";

/// Writes these states of a record as a table of one row per state and sphere: `time` (s),
/// `sphere` (from 0), centre `x`, `y`, `z` (m), velocity `vx`, `vy`, `vz` (m/s), spin `wx`, `wy`,
/// `wz` (rad/s; empty without rotation), `radius` (m), `mass` (kg).
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
            for (sphere, (radius, mass)) in record.radius.iter().zip(&record.mass).enumerate() {
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
