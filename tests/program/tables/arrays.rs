//! Arrays that are refused, and how.

use super::{MOST, data, read_bytes};
use phase::scene::TableFormat::Numpy;

/// Checks the message without the name.
fn check(name: &str, bytes: &[u8], expected: &str) {
    let error = read_bytes(name, bytes, Numpy, &["t"], MOST).unwrap_err();
    assert_eq!(error.to_string(), format!("{name}{expected}"));
}

fn npy(header: &str, data: usize) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16 + 1).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.push(b'\n');
    bytes.extend(vec![0; data]);
    bytes
}

#[test]
fn files() {
    for (name, expected) in [
        (
            "record.npy",
            ": the array is wrong: its elements are records, or it is no array of NumPy; save \
             each field of records as an array, with `numpy.savez`",
        ),
        (
            "type-U3.npy",
            ": the array is wrong: its elements are of the type \"<U3\"; save it as float64, \
             with `array.astype(float)`",
        ),
        (
            "type-f2.npy",
            ": the array is wrong: its elements are of the type \"<f2\"; save it as float64, \
             with `array.astype(float)`",
        ),
        (
            "savetxt.csv",
            ": the array is wrong: it does not begin like one of NumPy; write it with \
             `numpy.save`, or say the format that it has",
        ),
        (
            "matrix.npz",
            ": it has no array of one dimension; save each column as an array of its own, with \
             `numpy.savez`",
        ),
        (
            "unequal.npz",
            ": the array \"e\" has the length 2, but \"t\" has 3; save the arrays of one table, \
             all of equal length",
        ),
    ] {
        check(name, &data(name), expected);
    }
}

#[test]
fn headers() {
    for (name, header, data, expected) in [
        (
            "huge.npy",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (4611686018427387904, 3)}",
            8,
            ": the array is wrong: its shape [4611686018427387904, 3] needs more bytes than the \
             8 it has; the program was stopped while it wrote: run it again",
        ),
        (
            "larger-than-any.npy",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999999,)}",
            8,
            ": the array is wrong: its header is not one of NumPy; write it with `numpy.save`",
        ),
        (
            "cut.npy",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (3,)}",
            16,
            ": the array is wrong: its shape [3] needs more bytes than the 16 it has; the \
             program was stopped while it wrote: run it again",
        ),
        (
            "two-arrays.npy",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (3,)}",
            32,
            ": the array is wrong: its shape [3] needs fewer bytes than the 32 it has; write one \
             array to a file, or several with `numpy.savez`",
        ),
        (
            "no-rows.npy",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (0, 99999999999)}",
            0,
            ": it has no rows; check whether the program ran long enough to write one",
        ),
        (
            "deep.npy",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1, 1)}",
            8,
            ": its array has 3 dimensions, but a table has 1 or 2; save an array of rows x columns",
        ),
        (
            "single.npy",
            "{'descr': '<f8', 'fortran_order': False, 'shape': ()}",
            8,
            ": its array has 0 dimensions, but a table has 1 or 2; save an array of rows x columns",
        ),
        (
            "no-order.npy",
            "{'descr': '<f8', 'shape': (1,)}",
            8,
            ": the array is wrong: its header is not one of NumPy; write it with `numpy.save`",
        ),
        (
            "brackets.npy",
            "(((((((((((((((((((((",
            8,
            ": the array is wrong: its elements are records, or it is no array of NumPy; save \
             each field of records as an array, with `numpy.savez`",
        ),
        (
            "two-columns.npy",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 2)}",
            16,
            ": the file has 2 columns, but `header` lists 1 name; give `header = [...]` with \
             one name for each column",
        ),
    ] {
        check(name, &npy(header, data), expected);
    }
}

#[test]
fn starts() {
    for (name, bytes, expected) in [
        (
            "cut-in-header.npy",
            &b"\x93NUMPY\x01\x00v\x00{"[..],
            ": the array is wrong: it ends within its header; the program was stopped while it \
             wrote: run it again",
        ),
        (
            "promised-header.npy",
            &b"\x93NUMPY\x02\x00\xff\xff\xff\xff{"[..],
            ": the array is wrong: it ends within its header; the program was stopped while it \
             wrote: run it again",
        ),
        (
            "cut-at-once.npy",
            &b"\x93NUMPY\x01\x00"[..],
            ": the array is wrong: it ends within its header; the program was stopped while it \
             wrote: run it again",
        ),
        (
            "version-4.npy",
            &b"\x93NUMPY\x04\x00\x01\x00\x00\x00\n"[..],
            ": the array is wrong: its header is not one of NumPy; write it with `numpy.save`",
        ),
        (
            "empty.npz",
            &b"PK\x05\x06\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0"[..],
            ": it has no array of one dimension; save each column as an array of its own, with \
             `numpy.savez`",
        ),
    ] {
        check(name, bytes, expected);
    }
}

#[test]
fn archives() {
    let damaged = "; the program was stopped while it wrote, or the file is damaged: write it \
                   again with `numpy.savez`";
    let stored = data("stored.npz");
    let missing = format!(": the directory of the archive is missing or wrong{damaged}");
    check("cut.npz", &stored[..1000], &missing);
    let other = format!(": the array \"time.npy\" is wrong: its checksum is another one{damaged}");
    check_changed("stored.npz", &other);
    let unpacked = ": the array \"energy.npy\" is wrong: it cannot be unpacked";
    check_changed("packed.npz", &format!("{unpacked}{damaged}"));
}

/// Checks the message if a bit of the file is another one.
fn check_changed(name: &str, expected: &str) {
    let mut bytes = data(name);
    bytes[170] ^= 1;
    check(name, &bytes, expected);
}

/// An archive that names the same bytes three times.
#[test]
fn entries_that_overlap() {
    let mut bytes = data("zeros.npz");
    let directory = bytes.windows(4).position(|it| it == b"PK\x01\x02").unwrap();
    let entries = bytes.split_off(directory);
    let (entries, end) = entries.split_at(entries.len() - 22);
    bytes.extend(entries.repeat(3));
    bytes.extend(end);
    let count = bytes.len() - 22 + 10;
    bytes[count] = 6;
    let error = read_bytes("a.npz", &bytes, Numpy, &[], MOST).unwrap_err();
    assert_eq!(
        error.message,
        "the directory of the archive is missing or wrong"
    );
    bytes[count] = 2;
    assert!(read_bytes("a.npz", &bytes, Numpy, &[], MOST).is_ok());
}

/// An archive of less than a kilobyte is refused before its 32 kilobytes are unpacked.
#[test]
fn bombs() {
    let bytes = data("zeros.npz");
    assert!(bytes.len() < 1000 && read_bytes("a.npz", &bytes, Numpy, &[], 40_000).is_ok());
    for (most, array) in [(1000, "t"), (20_000, "e")] {
        let error = read_bytes("a.npz", &bytes, Numpy, &[], most).unwrap_err();
        let expected = format!(
            "a.npz: the array \"{array}.npy\" is wrong: 16128 bytes when unpacked are more than \
             are read; let the program write fewer rows, or raise the limit"
        );
        assert_eq!(error.to_string(), expected);
    }
}

#[test]
fn one_array_needs_one_name() {
    for names in [&[][..], &["t", "e"]] {
        let error = read_bytes("one.npy", &data("one.npy"), Numpy, names, MOST).unwrap_err();
        let expected = match names {
            [] => "one.npy: the file has no names for its 1 column",
            _ => "one.npy: the file has 1 column, but `header` lists 2 names",
        };
        let help = "give `header = [...]` with one name for each column";
        assert_eq!(error.to_string(), format!("{expected}; {help}"));
    }
}
