//! Damage is noticed, whatever it is.

use super::examples;
use phase::store::{StoreError, read_record, read_record_header, write_record};
use std::path::Path;

/// The error of reading a file of these bytes.
fn refusal(bytes: &[u8]) -> StoreError {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    std::fs::write(&path, bytes).unwrap();
    let of_header = read_record_header(&path).unwrap_err().to_string();
    let error = read_record(&path).unwrap_err();
    assert_eq!(error.to_string(), of_header);
    assert!(of_header.contains("run.h5"), "{of_header}");
    error
}

fn good() -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    write_record(&examples::record(20, 3, 4, 2), &path).unwrap();
    std::fs::read(path).unwrap()
}

#[test]
fn any_flipped_bit() {
    let good = good();
    // Every 97th byte, and the whole of both ends: signature and checksum.
    let ends = (0..64).chain(good.len() - 64..good.len());
    for at in (0..good.len()).step_by(97).chain(ends) {
        let mut bytes = good.clone();
        bytes[at] ^= 1 << (at % 8);
        let error = refusal(&bytes);
        assert!(
            matches!(error, StoreError::Damaged { .. }),
            "byte {at}: {error}"
        );
    }
}

#[test]
fn any_missing_end() {
    let good = good();
    for missing in [1, 2, 8, 39, 40, 41, 1000, good.len() - 8] {
        let error = refusal(&good[..good.len() - missing]);
        // Of its first eight bytes nobody can tell whose they are.
        let known = missing < good.len() - 8;
        assert!(
            matches!(error, StoreError::Damaged { .. }) == known,
            "{missing}: {error}"
        );
    }
    let error = refusal(&[]);
    assert!(
        error
            .to_string()
            .ends_with("run.h5 is damaged: it is empty; the run must be made again")
    );
}

#[test]
fn anything_added() {
    for extra in [&b"\0"[..], b"\n", &[0; 4096]] {
        let error = refusal(&[&good(), extra].concat());
        assert!(matches!(error, StoreError::Damaged { .. }), "{error}");
    }
}

#[test]
fn another_kind_of_file() {
    let error = refusal(b"r,omega\n0.002,4\n");
    assert!(matches!(error, StoreError::NotARecord { .. }));
    assert!(
        error
            .to_string()
            .ends_with("run.h5 is not a run record of phase: it is not an HDF5 file")
    );
}

#[test]
fn a_missing_file() {
    let message = read_record(Path::new("no/run.h5")).unwrap_err().to_string();
    assert!(message.starts_with("cannot read no/run.h5: "), "{message}");
    assert!(message.ends_with("; check the path"), "{message}");
}

#[test]
fn a_failed_write_keeps_the_record_that_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    let mut record = examples::record(20, 3, 4, 2);
    write_record(&record, &path).unwrap();
    record.observations.kinetic.truncate(3);
    write_record(&record, &path).unwrap_err();
    assert_eq!(std::fs::read(&path).unwrap(), good());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
