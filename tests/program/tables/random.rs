//! Any numbers are kept, and any bytes are read or refused.

use super::{MOST, data, read_bytes};
use phase::scene::TableFormat;
use proptest::prelude::*;

fn number() -> impl Strategy<Value = f64> {
    any::<u64>()
        .prop_map(f64::from_bits)
        .prop_filter("NaN has many bits", |it| !it.is_nan())
}

/// Rows of numbers, each `{:?}`, with a separator between them.
fn text(names: &[String], rows: &[Vec<f64>], separator: &str) -> String {
    let mut text = names.join(separator) + "\n";
    for row in rows {
        let entries: Vec<String> = row.iter().map(|value| format!("{value:?}")).collect();
        text += &(entries.join(separator) + "\n");
    }
    text
}

fn bits(columns: &[Vec<f64>]) -> Vec<Vec<u64>> {
    columns
        .iter()
        .map(|column| column.iter().map(|value| value.to_bits()).collect())
        .collect()
}

/// A `.npy` file of numbers, or of part of them.
fn npy(shape: &str, is_fortran: &str, values: &[f64]) -> Vec<u8> {
    let header = format!("{{'descr': '<f8', 'fortran_order': {is_fortran}, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}

/// Files of each format, to be damaged.
fn valid() -> Vec<(TableFormat, Vec<u8>)> {
    let files = [
        (TableFormat::Csv, "pandas.csv"),
        (TableFormat::Text, "savetxt.txt"),
        (TableFormat::LammpsLog, "two-runs.log"),
        (TableFormat::LammpsAverage, "average.txt"),
        (TableFormat::Numpy, "rows.npy"),
        (TableFormat::Numpy, "stored.npz"),
        (TableFormat::Numpy, "packed.npz"),
        (TableFormat::Hdf5, "plain.h5"),
        (TableFormat::Hdf5, "packed.h5"),
        (TableFormat::Hdf5, "packed-v114.h5"),
        (TableFormat::Hdf5, "grown.h5"),
    ];
    files.map(|(format, name)| (format, data(name))).to_vec()
}

/// All formats.
const FORMATS: [TableFormat; 6] = [
    TableFormat::Csv,
    TableFormat::Text,
    TableFormat::LammpsLog,
    TableFormat::LammpsAverage,
    TableFormat::Numpy,
    TableFormat::Hdf5,
];

/// What was read is a table as it is promised.
fn check(bytes: &[u8], format: TableFormat, names: &[&str]) {
    match read_bytes("file", bytes, format, names, MOST) {
        Ok(table) => {
            assert!(table.rows() > 0);
            assert_eq!(table.names.len(), table.columns.len());
            assert!(
                table
                    .columns
                    .iter()
                    .all(|column| column.len() == table.rows())
            );
        }
        Err(error) => {
            let message = error.to_string();
            assert!(message.starts_with("file"), "{message}");
            assert!(message.len() < 4000 && !message.contains('\n'), "{message}");
            let lines = bytes.split(|byte| *byte == b'\n').count() as u64;
            assert!(
                error.line.is_none_or(|line| (1..=lines).contains(&line)),
                "{message}"
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn numbers_keep_all_bits(
        (width, values) in (1_usize..6).prop_flat_map(|width| {
            let row = prop::collection::vec(number(), width);
            (Just(width), prop::collection::vec(row, 1..20))
        })
    ) {
        let names: Vec<String> = (0..width).map(|column| format!("c{column}")).collect();
        let columns: Vec<Vec<f64>> =
            (0..width).map(|column| values.iter().map(|row| row[column]).collect()).collect();
        for (format, separator) in
            [(TableFormat::Csv, ","), (TableFormat::Csv, " , "), (TableFormat::Text, " "), (TableFormat::Text, "\t")]
        {
            let text = text(&names, &values, separator);
            let table = read_bytes("file", text.as_bytes(), format, &[], MOST).unwrap();
            prop_assert_eq!(&table.names, &names);
            prop_assert_eq!(bits(&table.columns), bits(&columns));
        }
        let shape = format!("({}, {width})", values.len());
        let given: Vec<&str> = names.iter().map(String::as_str).collect();
        for (is_fortran, values) in [("False", values.concat()), ("True", columns.concat())] {
            let bytes = npy(&shape, is_fortran, &values);
            let table = read_bytes("file", &bytes, TableFormat::Numpy, &given, MOST).unwrap();
            prop_assert_eq!(bits(&table.columns), bits(&columns));
        }
    }

    #[test]
    fn any_bytes_are_read_or_refused(bytes: Vec<u8>) {
        for format in FORMATS {
            check(&bytes, format, &[]);
        }
    }

    #[test]
    fn any_words_are_read_or_refused(
        words in prop::collection::vec(prop::sample::select(&WORDS[..]), 0..60)
    ) {
        for format in FORMATS {
            check(words.concat().as_bytes(), format, &["a", "b"]);
        }
    }

    #[test]
    fn damaged_files_are_read_or_refused(
        file: prop::sample::Index,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4),
        length in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let (format, mut bytes) = file.get(&valid()).clone();
        for (place, byte) in changes {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        if let Some(length) = length {
            bytes.truncate(length.index(bytes.len()));
        }
        check(&bytes, format, &["time", "energy"]);
    }

    #[test]
    fn any_header_of_npy_is_read_or_refused(header in "[ -~]{0,80}", data: Vec<u8>) {
        for header in [header.clone(), format!("{{'descr': '<f8', 'fortran_order': {header}")] {
            let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
            bytes.extend((header.len() as u16 + 1).to_le_bytes());
            bytes.extend(header.as_bytes());
            bytes.push(b'\n');
            bytes.extend(&data);
            check(&bytes, TableFormat::Numpy, &["a"]);
        }
    }
}

const WORDS: [&str; 28] = [
    "a",
    "b",
    "0",
    "1.5",
    "nan",
    "-inf",
    "1e999",
    " ",
    " ",
    "\t",
    ",",
    ",",
    ";",
    "\n",
    "\n",
    "\r\n",
    "\"",
    "#",
    "# TimeStep a b\n",
    "# Row a\n",
    "Per MPI rank memory allocation\n",
    "Per MPI rank memory allocation\nStep a\n",
    "Loop time of 1\n",
    "WARNING: a\n",
    "ERROR: a",
    "---\n",
    "\u{feff}",
    "µ",
];

/// An array that ends early is never one.
#[test]
fn every_truncated_array_is_refused() {
    let arrays = valid().split_off(4).into_iter();
    for (format, bytes) in arrays.filter(|(_, bytes)| bytes.len() < 3000) {
        for length in (0..bytes.len()).step_by(bytes.len().div_ceil(700)) {
            let read = read_bytes("file", &bytes[..length], format, &["time", "energy"], MOST);
            assert!(read.is_err(), "{length}");
        }
    }
}
