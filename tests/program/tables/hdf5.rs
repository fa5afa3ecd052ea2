//! Data sets of HDF5, as h5py writes them.

use super::{MOST, data, owned, read_bytes};
use allocation_counter::measure;
use phase::scene::TableFormat::Hdf5;

const TIME: &[f64] = &[0.0, 0.1, 0.2, 0.30000000000000004];
const ENERGY: &[f64] = &[1.5, -2.25, f64::NAN, f64::INFINITY];
const COUNT: &[f64] = &[1.0, 2.0, 3.0, 4.0];

/// A file, paths of data sets in it, and their numbers.
type ColumnsOfFile<'a> = (&'a str, &'a [&'a str], &'a [&'a [f64]]);

#[test]
fn columns() {
    let types = [
        "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", "f4", "f8", ">i4", ">f4", ">f8", ">u2",
    ];
    let cases: &[ColumnsOfFile<'_>] = &[
        (
            "plain.h5",
            &["energy", "group/count", "/time"],
            &[ENERGY, COUNT, TIME],
        ),
        ("packed.h5", &["time", "energy"], &[TIME, ENERGY]),
        ("packed-v114.h5", &["time", "energy"], &[TIME, ENERGY]),
        ("grown.h5", &["time", "energy"], &[TIME, ENERGY]),
        ("others.h5", &["time"], &[TIME]),
        ("types.h5", &types, &[COUNT; 14]),
    ];
    for (name, paths, columns) in cases {
        let table = read_bytes(name, &data(name), Hdf5, paths, MOST).unwrap();
        assert_eq!(table.names, owned(paths), "{name}");
        // In this form NaN is equal to itself.
        assert_eq!(
            format!("{:?}", table.columns),
            format!("{columns:?}"),
            "{name}"
        );
    }
}

const STOPPED: &str =
    "; the program was stopped while it wrote, or the file is damaged: run it again";

#[test]
fn refused() {
    let cases: &[(&str, &[&str], &str)] = &[
        (
            "savetxt.csv",
            &["time"],
            "it is no HDF5 file; write it as HDF5, such as with h5py, or say the format that it \
             has",
        ),
        ("not-closed.h5", &["time"], "it was not closed"),
        (
            "latest.h5",
            &["time"],
            "the data set \"time\" cannot be read: HDF5 format error: invalid data layout \
             version: 5; write it for older programs, such as with `libver=\"v114\"` in h5py",
        ),
        (
            "plain.h5",
            &["group/velocity"],
            "the data set \"group/velocity\" is missing, but its group has \"count\"; give the \
             path of a data set, such as `group/velocity`",
        ),
        (
            "plain.h5",
            &["no/velocity"],
            "the data set \"no/velocity\" is missing; give the path of a data set, such as \
             `group/velocity`",
        ),
        (
            "plain.h5",
            &["time/velocity"],
            "the data set \"time/velocity\" is missing; give the path of a data set, such as \
             `group/velocity`",
        ),
        (
            "plain.h5",
            &["group"],
            "the data set \"group\" is a group; give the path of a data set in it",
        ),
        (
            "plain.h5",
            &["time", "time"],
            "two columns have the name \"time\"; give each column a name of its own",
        ),
        (
            "others.h5",
            &["time", "short"],
            "the data set \"short\" has the length 2, but \"time\" has 4; read data sets of equal \
             length; a file may be read as several tables",
        ),
        (
            "others.h5",
            &["empty"],
            "it has no rows; check whether the program ran long enough to write one",
        ),
        (
            "others.h5",
            &["group/matrix"],
            "the data set \"group/matrix\" has 2 dimensions, but a column has 1; write each \
             column as a data set of its own, of one dimension",
        ),
        (
            "others.h5",
            &["group/scalar"],
            "the data set \"group/scalar\" has 0 dimensions, but a column has 1; write each \
             column as a data set of its own, of one dimension",
        ),
        (
            "others.h5",
            &["names"],
            "the data set \"names\" holds no numbers, or none of a usual type; write it as \
             float64, with `array.astype(float)`",
        ),
        (
            "others.h5",
            &["half"],
            "the data set \"half\" holds no numbers, or none of a usual type; write it as \
             float64, with `array.astype(float)`",
        ),
        (
            "others.h5",
            &["unwritten"],
            "the data set \"unwritten\" was not written, or not all of it",
        ),
        (
            "others.h5",
            &["partly"],
            "the data set \"partly\" was not written, or not all of it",
        ),
    ];
    for (name, paths, expected) in cases {
        let error = read_bytes(name, &data(name), Hdf5, paths, MOST).unwrap_err();
        let stopped = match expected.contains(';') {
            true => "",
            false => STOPPED,
        };
        assert_eq!(error.to_string(), format!("{name}: {expected}{stopped}"));
    }
}

/// Files of two kilobytes whose 32 kilobytes are not unpacked.
#[test]
fn bombs() {
    let bytes = data("zeros.h5");
    let read = |most| read_bytes("a.h5", &bytes, Hdf5, &["time", "energy"], most);
    assert!(bytes.len() < 3000 && read(32_000).is_ok());
    for (most, name, left) in [(15_000, "time", 15_000), (20_000, "energy", 4000)] {
        let expected = format!(
            "a.h5: the data set \"{name}\" needs 16000 bytes, but at most {left} are read; let \
             the program write fewer rows, or raise the limit"
        );
        assert_eq!(read(most).unwrap_err().to_string(), expected);
    }
}

/// The tree in a file that has the places of the chunks of `time`.
///
/// It begins with a mark, its kind and its height. Behind 24 bytes there is a key, of 24 bytes, and
/// a place for each of two chunks; a key begins with the size of its chunk.
fn tree_of_chunks(bytes: &[u8]) -> usize {
    let mut trees = bytes.windows(5);
    trees.position(|it| it == b"TREE\x01").unwrap()
}

fn read_time(bytes: &[u8]) -> String {
    let mut message = String::new();
    let memory = measure(|| {
        let read = read_bytes("a.h5", bytes, Hdf5, &["time"], MOST);
        message = read.unwrap_err().to_string();
    });
    let most = 100 * bytes.len() as u64;
    assert!(memory.bytes_max < most, "{} bytes", memory.bytes_max);
    message
}

/// Symptom: a file of 4 kilobytes asked for 4 gigabytes. Cause: the library believes the size of a
/// chunk.
#[test]
fn a_chunk_is_no_larger_than_the_file() {
    let mut bytes = data("packed.h5");
    let size = tree_of_chunks(&bytes) + 24;
    bytes[size..size + 4].copy_from_slice(&0xfff0_0000_u32.to_le_bytes());
    let expected = format!("a.h5: the data set \"time\" is larger than the file{STOPPED}");
    assert_eq!(read_time(&bytes), expected);
}

/// Symptom: a file was read without end. Cause: each of 40 trees has the next one as both of its
/// branches, so that the last one is reached in 2^40 ways.
#[test]
fn trees_are_read_a_few_times_only() {
    let mut bytes = data("packed.h5");
    let tree = tree_of_chunks(&bytes);
    let place = |place: usize| (place as u64).to_le_bytes();
    let mut words = bytes.windows(8);
    let root = words.position(|it| it == place(tree)).unwrap();
    let end = place(bytes.len());
    bytes[root..root + 8].copy_from_slice(&end);
    let length = 24 + 3 * 24 + 2 * 8;
    for number in 1..=40 {
        let mut branch = bytes[tree..tree + length].to_vec();
        branch[5] = 1;
        let next = match number {
            40 => tree,
            _ => bytes.len() + length,
        };
        for at in [48, 80] {
            branch[at..at + 8].copy_from_slice(&place(next));
        }
        bytes.extend(branch);
    }
    let message = read_time(&bytes);
    assert!(
        message.contains("its tables are read again and again"),
        "{message}"
    );
}
