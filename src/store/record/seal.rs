//! The checksum at the end of a record: a mark, then the BLAKE3 hash of all before the mark.
//!
//! HDF5's own checksums cover its tables but not the data, and a file that lacks its last byte
//! still opens.

use super::{FORMAT, StoreError};
use std::path::Path;

/// What stands between the file and its hash.
pub(super) const MARK: &[u8; 8] = b"\nblake3:";
const LENGTH: usize = MARK.len() + blake3::OUT_LEN;
/// What every HDF5 file begins with.
pub const HDF5_SIGNATURE: &[u8; 8] = b"\x89HDF\r\n\x1a\n";

/// Verifies the checksum of the file `path`, whose content is `bytes`, and removes it.
pub(super) fn verify(bytes: &mut Vec<u8>, path: &Path) -> Result<(), StoreError> {
    let content = bytes.len().saturating_sub(LENGTH);
    let (body, seal) = bytes.split_at(content);
    let mark = seal.starts_with(MARK);
    if mark && seal[MARK.len()..] == *blake3::hash(body).as_bytes() {
        bytes.truncate(content);
        return Ok(());
    }
    if mark {
        return Err(StoreError::damaged(path, "its checksum differs"));
    }
    if bytes.is_empty() {
        return Err(StoreError::damaged(path, "it is empty"));
    }
    let is_hdf5 = bytes.starts_with(HDF5_SIGNATURE);
    let mut texts = bytes.windows(FORMAT.len());
    if is_hdf5 && texts.any(|text| text == FORMAT.as_bytes()) {
        let reason = "the checksum at its end is missing";
        return Err(StoreError::damaged(path, reason));
    }
    let reason = if is_hdf5 {
        "it is an HDF5 file of another program, or the beginning of one"
    } else {
        "it is not an HDF5 file"
    };
    Err(StoreError::NotARecord {
        path: path.to_owned(),
        reason: reason.to_owned(),
    })
}
