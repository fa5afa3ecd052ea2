//! The checksum at the end of a record: a mark, then the BLAKE3 hash of all before the mark.
//!
//! HDF5's own checksums cover its tables but not the data, and a file that lacks its last byte
//! still opens.

use super::StoreError;
use std::path::Path;

const MARK: &[u8; 8] = b"\nblake3:";
const LENGTH: usize = MARK.len() + blake3::OUT_LEN;
/// What every HDF5 file begins with.
pub const HDF5_SIGNATURE: &[u8; 8] = b"\x89HDF\r\n\x1a\n";

/// Appends the checksum.
pub(super) fn append(bytes: &mut Vec<u8>) {
    let hash = blake3::hash(bytes);
    bytes.extend_from_slice(MARK);
    bytes.extend_from_slice(hash.as_bytes());
}

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
    if bytes.starts_with(HDF5_SIGNATURE) {
        return Err(StoreError::NotARecord {
            path: path.to_owned(),
            reason:
                "it is an HDF5 file without the checksum at its end: another program's, or cut \
                     off"
                .to_owned(),
        });
    }
    Err(StoreError::NotARecord {
        path: path.to_owned(),
        reason: "it is not an HDF5 file".to_owned(),
    })
}
