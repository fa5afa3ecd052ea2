//! Arrays of NumPy (`.npy`).

use super::NumberTable;
use super::columns::{NAMES_NEEDED, check_names, given_names, no_rows};
use super::error::{TableError, quote};
use ndarray_npy::npy::header::Header;
use std::path::Path;

/// Most bytes of a header. That of an array of numbers has 128.
const LONGEST_HEADER: usize = 4096;

/// Most opening brackets of a header: one of its dictionary and one of the shape. The library that
/// reads it takes a time and a stack that grow with brackets inside of each other.
const MOST_BRACKETS: usize = 2;

/// An array of numbers.
pub(super) struct Array {
    /// Its numbers of elements.
    pub(super) shape: Vec<usize>,
    /// Whether the first index, not the last, is the one that changes from element to element.
    is_fortran: bool,
    /// All elements as they follow each other.
    pub(super) values: Vec<f64>,
}

/// Reads the columns of one array.
pub(super) fn read(path: &Path, bytes: &[u8], names: &[String]) -> Result<NumberTable, TableError> {
    let array = decode(bytes).map_err(|(message, help)| {
        TableError::in_file(path, format!("the array is wrong: {message}"), help)
    })?;
    let (rows, width) = match array.shape[..] {
        [rows] => (rows, 1),
        [rows, width] => (rows, width),
        _ => {
            let dimensions = array.shape.len();
            let message = format!("its array has {dimensions} dimensions, but a table has 1 or 2");
            let help = "save an array of rows x columns";
            return Err(TableError::in_file(path, message, help));
        }
    };
    // An array without elements may promise any number of the columns that it does not have.
    if rows == 0 || width == 0 {
        return Err(no_rows(path));
    }
    let names =
        given_names(names, width).map_err(|it| TableError::in_file(path, it, NAMES_NEEDED))?;
    check_names(&names).map_err(|(message, help)| TableError::in_file(path, message, help))?;
    let columns = (0..width)
        .map(|column| array.column(column, rows, width))
        .collect();
    Ok(NumberTable { names, columns })
}

impl Array {
    fn column(&self, column: usize, rows: usize, width: usize) -> Vec<f64> {
        match self.is_fortran {
            true => self
                .values
                .iter()
                .skip(column * rows)
                .take(rows)
                .copied()
                .collect(),
            false => self
                .values
                .iter()
                .skip(column)
                .step_by(width)
                .copied()
                .collect(),
        }
    }
}

/// What is wrong with an array, and what to do.
pub(super) type Fault = (String, &'static str);

/// What to do about an array that was not finished.
const CUT: &str = "the program was stopped while it wrote: run it again";

/// The array in the bytes of a file.
pub(super) fn decode(bytes: &[u8]) -> Result<Array, Fault> {
    let start = header_length(bytes)?;
    let (header, data) = bytes.split_at_checked(start).ok_or_else(|| {
        let message = "it ends within its header".to_owned();
        (message, CUT)
    })?;
    let brackets = header.iter().filter(|byte| b"([{".contains(byte)).count();
    if start > LONGEST_HEADER || brackets > MOST_BRACKETS {
        let message = "its elements are records, or it is no array of NumPy".to_owned();
        return Err((
            message,
            "save each field of records as an array, with `numpy.savez`",
        ));
    }
    let header = Header::from_reader(&mut &header[..]).map_err(|_| {
        let message = "its header is not one of NumPy".to_owned();
        (message, "write it with `numpy.save`")
    })?;
    let descriptor = header
        .type_descriptor
        .as_string()
        .map_or("", String::as_str);
    let numbers = NumberType::of(descriptor).ok_or_else(|| {
        let message = format!("its elements are of the type {}", quote(descriptor));
        (message, "save it as float64, with `array.astype(float)`")
    })?;
    let elements = header
        .shape
        .iter()
        .try_fold(1, |all: usize, it| all.checked_mul(*it));
    let needed = elements.and_then(|elements| elements.checked_mul(numbers.size));
    if needed != Some(data.len()) {
        let (shape, follow) = (&header.shape, data.len());
        let (relation, help) = match needed.is_some_and(|needed| needed < follow) {
            true => (
                "fewer",
                "write one array to a file, or several with `numpy.savez`",
            ),
            false => ("more", CUT),
        };
        let message =
            format!("its shape {shape:?} needs {relation} bytes than the {follow} it has");
        return Err((message, help));
    }
    Ok(Array {
        shape: header.shape,
        is_fortran: header.layout.is_fortran(),
        values: numbers.decode(data),
    })
}

/// Where the header ends, as its start says.
fn header_length(bytes: &[u8]) -> Result<usize, Fault> {
    let (version, rest) = match bytes {
        [0x93, b'N', b'U', b'M', b'P', b'Y', version, _, rest @ ..] => (*version, rest),
        _ => {
            let message = "it does not begin like one of NumPy".to_owned();
            return Err((
                message,
                "write it with `numpy.save`, or say the format that it has",
            ));
        }
    };
    let length = match (version, rest) {
        (1, [low, high, ..]) => 10 + usize::from(u16::from_le_bytes([*low, *high])),
        (2.., [a, b, c, d, ..]) => {
            (u32::from_le_bytes([*a, *b, *c, *d]) as usize).saturating_add(12)
        }
        _ => return Err(("it ends within its header".to_owned(), CUT)),
    };
    Ok(length)
}

/// A type of numbers.
#[derive(Clone, Copy)]
struct NumberType {
    size: usize,
    is_big_endian: bool,
    kind: u8,
}

impl NumberType {
    /// The type of a descriptor such as `<f8`.
    fn of(descriptor: &str) -> Option<Self> {
        let [order, kind, size] = *descriptor.as_bytes() else {
            return None;
        };
        let size = usize::from(size.checked_sub(b'0')?);
        let is_known = match kind {
            b'f' => matches!(size, 4 | 8),
            b'i' | b'u' => matches!(size, 1 | 2 | 4 | 8),
            b'b' => size == 1,
            _ => false,
        };
        let is_ordered = b"<>".contains(&order) || (order == b'|' && size == 1);
        (is_known && is_ordered).then_some(Self {
            size,
            is_big_endian: order == b'>',
            kind,
        })
    }

    fn decode(self, bytes: &[u8]) -> Vec<f64> {
        let big = self.is_big_endian;
        match (self.kind, self.size) {
            (b'f', 4) => numbers(bytes, big, |it| f64::from(f32::from_le_bytes(it))),
            (b'f', _) => numbers(bytes, big, f64::from_le_bytes),
            (b'i', 1) => numbers(bytes, big, |it| f64::from(i8::from_le_bytes(it))),
            (b'i', 2) => numbers(bytes, big, |it| f64::from(i16::from_le_bytes(it))),
            (b'i', 4) => numbers(bytes, big, |it| f64::from(i32::from_le_bytes(it))),
            (b'i', _) => numbers(bytes, big, |it| i64::from_le_bytes(it) as f64),
            (b'u', 2) => numbers(bytes, big, |it| f64::from(u16::from_le_bytes(it))),
            (b'u', 4) => numbers(bytes, big, |it| f64::from(u32::from_le_bytes(it))),
            (b'u', 8) => numbers(bytes, big, |it| u64::from_le_bytes(it) as f64),
            // Truth values are written as 0 and 1.
            _ => numbers(bytes, big, |it| f64::from(u8::from_le_bytes(it))),
        }
    }
}

/// Numbers of `SIZE` bytes each, of which `number` takes the lowest first.
fn numbers<const SIZE: usize>(
    bytes: &[u8],
    is_big_endian: bool,
    number: impl Fn([u8; SIZE]) -> f64,
) -> Vec<f64> {
    let (chunks, _) = bytes.as_chunks::<SIZE>();
    let value = |chunk: &[u8; SIZE]| {
        let mut chunk = *chunk;
        if is_big_endian {
            chunk.reverse();
        }
        number(chunk)
    };
    chunks.iter().map(value).collect()
}
