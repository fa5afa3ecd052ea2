//! The checkpoint of one run, from which it continues after an interruption.
//!
//! ```text
//! signature   21 bytes, "phase checkpoint" between marks
//! version     u32
//! header      version and commit of the program, the scene (JSON) without the spheres that its
//!             start lists, and a hash of these
//! state       of the run at one frame
//! checksum    32 bytes, the BLAKE3 hash of all before
//! ```
//!
//! Version, header and state are in the encoding of postcard, in which a number keeps all its bits,
//! also one that is not a number. Only the very program that wrote a checkpoint reads it: another
//! one might continue with other bits. Signature, version and checksum stay where they are in all
//! versions.

use super::StoreError;
use super::atomic::write_atomic_with;
use super::hashed::Hashed;
use crate::document::differing_keys;
use crate::record::Program;
use crate::run::Run;
use crate::scene::{LIST_KEY, Scene};
use serde::{Deserialize, Serialize};
use std::fmt::Display;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// What every checkpoint begins with.
pub const CHECKPOINT_SIGNATURE: &[u8; 21] = b"\x89phase checkpoint\r\n\x1a\n";
/// Raised with every change of the layout above; what a state holds follows from the program.
const VERSION: u32 = 3;

/// Why a run cannot continue from a checkpoint. The file stays as it is.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct CheckpointError(String);

impl CheckpointError {
    fn new(path: &Path, reason: impl Display) -> Self {
        Self(format!("{}: {reason}", path.display()))
    }

    /// The file is not what was once written; `reason` shows it.
    pub(crate) fn damaged(path: &Path, reason: &str) -> Self {
        Self::new(
            path,
            format_args!("this checkpoint is damaged or cut short: {reason}"),
        )
    }

    /// The state in it is not one of the scene.
    pub(crate) fn unfit(path: &Path, reason: impl Display) -> Self {
        Self::new(
            path,
            format_args!("no run can continue from this checkpoint: {reason}"),
        )
    }
}

/// What is read before the state.
#[derive(Serialize, Deserialize)]
struct CheckpointHeader {
    program_version: String,
    program_commit: String,
    /// The resolved scene (JSON) without the spheres that its start lists: a million make a long
    /// text.
    scene: String,
    /// Hash of these, as [`hash_of_list`] makes it.
    list: String,
}

/// Writes the checkpoint of a run that no guard ended, all or nothing.
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`]; an older checkpoint is still there.
pub fn write_checkpoint(path: &Path, run: &Run) -> Result<(), StoreError> {
    write_atomic_with(path, |file| encode(run, &Program::current(), file))
}

/// Writes it piece by piece: a state may be most of what fits into memory.
fn encode(run: &Run, program: &Program, file: &mut impl Write) -> io::Result<()> {
    let scene = run.scene();
    let header = CheckpointHeader {
        program_version: program.version.clone(),
        program_commit: program.commit.clone(),
        scene: serde_json::to_string(&scene.without_list())
            .expect("a scene holds no map with odd keys"),
        list: hash_of_list(scene),
    };
    let mut hashed = Hashed::new(file);
    let mut pieces = BufWriter::new(&mut hashed);
    pieces.write_all(CHECKPOINT_SIGNATURE)?;
    let written = postcard::to_io(&(VERSION, header), &mut pieces)
        .map(drop)
        .map_err(io::Error::other)
        .and_then(|()| run.save(&mut pieces))
        .and_then(|()| pieces.flush());
    drop(pieces);
    hashed.seal(written, &[])
}

/// A checkpoint that was read, whose checksum and scene are right.
#[derive(Debug)]
pub struct Checkpoint {
    bytes: Vec<u8>,
    state: std::ops::Range<usize>,
}

impl Checkpoint {
    /// The state of the run, to be [restored](Run::restore).
    pub fn state(&self) -> &[u8] {
        &self.bytes[self.state.clone()]
    }
}

/// Reads the checkpoint of a run of that scene, if there is a file at all.
///
/// # Errors
/// If a run of this scene, by this program, cannot continue from this file.
pub fn read_checkpoint(path: &Path, scene: &Scene) -> Result<Option<Checkpoint>, CheckpointError> {
    match fs::read(path) {
        Ok(bytes) => {
            let state = find_state(&bytes, path, scene)?;
            Ok(Some(Checkpoint { bytes, state }))
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(CheckpointError(
            StoreError::reading(path, error).to_string(),
        )),
    }
}

/// Where the state stands in the bytes of a checkpoint.
fn find_state(
    bytes: &[u8],
    path: &Path,
    scene: &Scene,
) -> Result<std::ops::Range<usize>, CheckpointError> {
    let damaged = |reason| CheckpointError::damaged(path, reason);
    if !bytes.starts_with(CHECKPOINT_SIGNATURE) {
        return Err(match CHECKPOINT_SIGNATURE.starts_with(bytes) {
            true => damaged("it ends too early"),
            false => CheckpointError::new(path, "this is not a checkpoint of phase"),
        });
    }
    let (body, hash) = bytes
        .split_last_chunk::<{ blake3::OUT_LEN }>()
        .ok_or_else(|| damaged("it ends too early"))?;
    if blake3::hash(body) != *hash {
        return Err(damaged("its checksum differs"));
    }
    let body = body
        .get(CHECKPOINT_SIGNATURE.len()..)
        .ok_or_else(|| damaged("it ends too early"))?;
    let unreadable = |_| damaged("its content has another form");
    let (found, body) = postcard::take_from_bytes::<u32>(body).map_err(unreadable)?;
    if found != VERSION {
        let reason = format_args!(
            "this checkpoint has format {found}, but this program reads format {VERSION}"
        );
        return Err(CheckpointError::new(path, reason));
    }
    let (header, body) = postcard::take_from_bytes::<CheckpointHeader>(body).map_err(unreadable)?;
    let program = Program {
        version: header.program_version,
        commit: header.program_commit,
    };
    let own = Program::current();
    if program != own {
        let reason = format_args!(
            "this checkpoint was written by phase {} (commit {}), but this is phase {} (commit \
             {}), which may continue with other bits",
            program.version, program.commit, own.version, own.commit
        );
        return Err(CheckpointError::new(path, reason));
    }
    let saved = Scene::from_json(&header.scene).map_err(|_| damaged("its scene cannot be read"))?;
    let expected = scene.without_list().without_names();
    let mut keys = differing_keys(&saved.without_names(), &expected);
    if header.list != hash_of_list(scene) {
        keys.push(LIST_KEY.to_owned());
    }
    if !keys.is_empty() {
        let keys = keys.join(", ");
        let reason = format_args!("this checkpoint is of another run: they differ in {keys}");
        return Err(CheckpointError::new(path, reason));
    }
    let end = bytes.len() - blake3::OUT_LEN;
    Ok(end - body.len()..end)
}

/// A hash of the spheres that a start lists, as it lists them.
fn hash_of_list(scene: &Scene) -> String {
    let mut hasher = blake3::Hasher::new();
    if let Some((_, spheres)) = scene.apart_from_list() {
        serde_json::to_writer(&mut hasher, spheres).expect("a sphere holds no map");
    }
    hasher.finalize().to_hex().to_string()
}
