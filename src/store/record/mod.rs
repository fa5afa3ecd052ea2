//! The record of one run: an HDF5 file, then a checksum.
//!
//! ```text
//! /             attributes: format, format_version, program_version, program_commit, identity,
//!               seed, units, scene (JSON), scene_toml, outcome, work, cpu_seconds, Conventions,
//!               title (if there is one); of an unstable run also guard, guard_step, guard_time,
//!               guard_sphere, guard_detail
//! /start        of a start that lists more than 1000 spheres, which the texts leave out then:
//!               position, velocity, spin                    n x 3
//!               radius                                      n
//! /spheres      radius, mass                                n
//! /observations time and each scalar                        frames
//!               profile                                     frames x bins
//!               rising                                      frames x radii x speeds
//! /snapshots    time                                        snapshots
//!               position, velocity, spin (if there is any)  snapshots x n x 3
//! /trajectory   the same at every frame, if it was asked for
//! /             sphere, component, bin_radius, rise_radius, rise_speed: their axes
//! ```
//!
//! Every dataset has the attributes `unit` and `description`. The file is netCDF as well: datasets
//! have dimension scales for axes, and `units` and `long_name` of the conventions CF. The checksum
//! comes after the end that the HDF5 file knows of, where other programs do not look. A record
//! holds no time of day: the same run gives the same bytes, but for `cpu_seconds`.

mod attributes;
mod cf;
mod headers;
mod part;
mod read;
mod scales;
mod seal;
mod write;

pub use seal::HDF5_SIGNATURE;

use super::StoreError;
use super::atomic::write_atomic_with;
use super::hashed::Hashed;
use crate::record::{Outcome, Program, RunRecord};
use crate::scene::{Output, Scene};
use std::io;
use std::path::Path;

/// What the attribute `format` of a record says.
const FORMAT: &str = "phase run record";
/// Raised with every change after which this program cannot read older records (a new
/// observable, say) or older programs cannot read its own.
const FORMAT_VERSION: u64 = 3;

/// Most spheres that the text of a scene lists. A reader needs several hundred bytes for each.
const MOST_IN_TEXT: usize = 1000;

/// What a record says of its run besides what was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordHeader {
    /// The resolved scene.
    pub scene: Scene,
    /// The program that ran it.
    pub program: Program,
    /// How the run ended.
    pub outcome: Outcome,
    /// Work of the run, in the unit of its model.
    pub work: u64,
    /// Processor time of the run (s).
    pub cpu_seconds: f64,
}

/// Writes a record, all or nothing.
///
/// # Errors
/// [`StoreError::DiskFull`], [`StoreError::Write`], or [`StoreError::Content`] if the parts of the
/// record do not fit together.
pub fn write_record(record: &RunRecord, path: &Path) -> Result<(), StoreError> {
    write(content(record, path)?, path)
}

/// The same for a record whose snapshots and trajectory are not needed any more: it loses them when
/// the content of the file is put together, before that is compressed and written, even if this
/// fails.
///
/// # Errors
/// As for [`write_record`].
pub fn write_record_and_drop_states(record: &mut RunRecord, path: &Path) -> Result<(), StoreError> {
    let content = content(record, path)?;
    record.snapshots = Vec::new();
    record.trajectory = Vec::new();
    write(content, path)
}

fn content(record: &RunRecord, path: &Path) -> Result<write::Content, StoreError> {
    let provenance = Some((&record.program, record.cpu_seconds));
    write::build(record, provenance).map_err(|reason| StoreError::content(path, reason))
}

fn write(content: write::Content, path: &Path) -> Result<(), StoreError> {
    let mut reason = None;
    let result = write_atomic_with(path, |file| {
        let mut hashed = Hashed::new(file);
        let written = content.write_to(&mut hashed).map_err(|error| match error {
            hdf5_pure::Error::Io(error) => error,
            error => io::Error::other(reason.insert(error.to_string()).clone()),
        });
        hashed.seal(written, seal::MARK)
    });
    match reason {
        Some(reason) => Err(StoreError::content(path, reason)),
        None => result,
    }
}

/// Reads a record.
///
/// # Errors
/// [`StoreError::Read`]; [`StoreError::Damaged`] if any bit is not as it was written;
/// [`StoreError::NotARecord`] if it is another kind of file.
pub fn read_record(path: &Path) -> Result<RunRecord, StoreError> {
    read::Reader::open(path)?.record()
}

/// Reads the header of a record. The whole file is checked for damage, but what was measured is
/// not unpacked, which makes this several times faster than [`read_record`].
///
/// # Errors
/// As for [`read_record`].
pub fn read_record_header(path: &Path) -> Result<RecordHeader, StoreError> {
    read::Reader::open(path)?.header()
}

/// A hash of everything in a record but the program and its processor time: equal for two runs
/// that measured the same bits.
///
/// # Errors
/// What does not fit together in the record.
pub fn content_digest(record: &RunRecord) -> Result<String, String> {
    let mut hasher = blake3::Hasher::new();
    let content = write::build(record, None)?;
    content
        .write_to(&mut hasher)
        .map_err(|error| error.to_string())?;
    Ok(hasher.finalize().to_hex().to_string())
}

/// The same for two runs of which more or less was stored: a hash of the outcome, of what was
/// observed at every frame besides further columns, and of all spheres at the end.
///
/// # Errors
/// What does not fit together in the record.
pub fn motion_digest(record: &RunRecord) -> Result<String, String> {
    content_digest(&RunRecord {
        scene: Scene {
            title: None,
            output: Output {
                snapshot_interval: 0.0,
                trajectory: false,
                columns: Vec::new(),
                profiles: Vec::new(),
                walls: false,
                layer: None,
                ..record.scene.output.clone()
            },
            ..record.scene.clone()
        },
        program: record.program.clone(),
        outcome: record.outcome.clone(),
        radius: record.radius.clone(),
        mass: record.mass.clone(),
        milestones: record.milestones.clone(),
        observations: record.observations.usual_in(&record.scene),
        snapshots: record.snapshots.last().cloned().into_iter().collect(),
        trajectory: Vec::new(),
        work: record.work,
        cpu_seconds: record.cpu_seconds,
    })
}
