//! Data sets of HDF5 files, each of which is a column.
//!
//! A file may hold any number of others, of all shapes: only those that are asked for are read.

use super::NumberTable;
use super::columns::{check_names, no_rows};
use super::error::{TableError, list, quote};
use super::npy::Fault;
use hdf5_pure::{DType, Dataset, Error, File, FormatError, Layout, Source};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// How often the bytes of a file may be read for one column, on average. In a damaged file tables
/// of addresses may lead to the same tables in many ways, and the library follows all of them.
const MOST_READINGS: u64 = 16;

/// How many bytes one byte of a file can become at most, by deflate.
const MOST_EXPANSION: u64 = 1032;

/// What to do about a file that is cut short or damaged.
const DAMAGED: &str =
    "the program was stopped while it wrote, or the file is damaged: run it again";

/// Reads the data sets with these paths, such as `group/velocity`.
pub(super) fn read(
    path: &Path,
    bytes: Vec<u8>,
    names: &[String],
    most_bytes: u64,
) -> Result<NumberTable, TableError> {
    let wrong = |(message, help): Fault| TableError::in_file(path, message, help);
    check_names(names).map_err(|(message, help)| wrong((message, help)))?;
    let bytes = Arc::new(bytes);
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut left = most_bytes;
    for name in names {
        let of_column = |(message, help): Fault| {
            wrong((format!("the data set {} {message}", quote(name)), help))
        };
        let file = open(&bytes).map_err(wrong)?;
        let column = ColumnData::find(&file, name).map_err(of_column)?;
        if let (Some(first), Some(first_name)) = (columns.first(), names.first())
            && first.len() as u64 != column.rows
        {
            let (rows, expected) = (column.rows, first.len());
            let message = format!(
                "has the length {rows}, but {} has {expected}",
                quote(first_name)
            );
            let help = "read data sets of equal length; a file may be read as several tables";
            return Err(of_column((message, help)));
        }
        let file_length = bytes.len() as u64;
        left -= column.check_size(file_length, left).map_err(of_column)?;
        columns.push(column.read().map_err(of_column)?);
    }
    let table = NumberTable {
        names: names.to_vec(),
        columns,
    };
    match table.rows() {
        0 => Err(no_rows(path)),
        _ => Ok(table),
    }
}

fn open(bytes: &Arc<Vec<u8>>) -> Result<File, Fault> {
    let source = LimitedBytes {
        bytes: Arc::clone(bytes),
        left: AtomicU64::new(MOST_READINGS * bytes.len() as u64),
    };
    let file = File::from_source(source).map_err(|error| match error {
        Error::Format(FormatError::SignatureNotFound) => (
            "it is no HDF5 file".to_owned(),
            "write it as HDF5, such as with h5py, or say the format that it has",
        ),
        Error::FileMarkedInUse(_) => ("it was not closed".to_owned(), DAMAGED),
        error => (format!("it cannot be opened: {error}"), DAMAGED),
    })?;
    match file.superblock().eof_address > bytes.len() as u64 {
        true => Err(("it is cut short".to_owned(), DAMAGED)),
        false => Ok(file),
    }
}

/// A data set of numbers with one dimension.
struct ColumnData {
    data: Dataset,
    rows: u64,
    bytes_per_number: u64,
}

impl ColumnData {
    fn find(file: &File, name: &str) -> Result<Self, Fault> {
        let data = file.dataset(name).map_err(|error| match error {
            Error::Format(FormatError::PathNotFound(_)) | Error::NotAGroup(_) => {
                let help = "give the path of a data set, such as `group/velocity`";
                (missing(file, name), help)
            }
            Error::NotADataset(_) => {
                let help = "give the path of a data set in it";
                ("is a group".to_owned(), help)
            }
            error => unreadable(error),
        })?;
        if !is_number(&data.dtype().map_err(unreadable)?) {
            let message = "holds no numbers, or none of a usual type".to_owned();
            return Err((message, "write it as float64, with `array.astype(float)`"));
        }
        let bytes_per_number = data.element_size().map_err(unreadable)?;
        let shape = data.shape().map_err(unreadable)?;
        let [rows] = shape[..] else {
            let message = format!("has {} dimensions, but a column has 1", shape.len());
            let help = "write each column as a data set of its own, of one dimension";
            return Err((message, help));
        };
        Ok(Self {
            data,
            rows,
            bytes_per_number,
        })
    }

    /// The bytes of the numbers, which are at most `left`. What the file says of them is believed
    /// only if a file of this length can hold them.
    fn check_size(&self, file_length: u64, left: u64) -> Result<u64, Fault> {
        let layout = self.data.layout().map_err(unreadable)?;
        let rows_per_chunk = match &layout {
            Layout::Chunked { chunk_shape, .. } => chunk_shape.first().copied().unwrap_or(0),
            Layout::Compact { .. } | Layout::Contiguous { .. } => self.rows,
            _ => {
                let message = "lies in other files".to_owned();
                return Err((message, "write its numbers into this file"));
            }
        };
        let bytes = self.rows.saturating_mul(self.bytes_per_number);
        let unpacked = bytes.max(rows_per_chunk.saturating_mul(self.bytes_per_number));
        if unpacked > left {
            let message = format!("needs {unpacked} bytes, but at most {left} are read");
            let help = "let the program write fewer rows, or raise the limit";
            return Err((message, help));
        }
        let too_large = ("is larger than the file".to_owned(), DAMAGED);
        if unpacked > file_length.saturating_mul(MOST_EXPANSION) {
            return Err(too_large);
        }
        let (written, stored) = match layout {
            Layout::Contiguous { address: None, .. } => (0, 0),
            Layout::Chunked { .. } => {
                let chunks = self.data.chunks().map_err(unreadable)?;
                let sizes = chunks.iter().map(|chunk| chunk.storage_size);
                let written = rows_per_chunk.saturating_mul(chunks.len() as u64);
                (written, sizes.fold(0, u64::saturating_add))
            }
            _ => (self.rows, bytes),
        };
        // Chunks that overlap would be unpacked again and again.
        if stored > file_length {
            return Err(too_large);
        }
        // What is not there would be read as zeros.
        if written < self.rows {
            return Err(("was not written, or not all of it".to_owned(), DAMAGED));
        }
        Ok(bytes)
    }

    fn read(&self) -> Result<Vec<f64>, Fault> {
        self.data.read_f64().map_err(unreadable)
    }
}

fn unreadable(error: Error) -> Fault {
    let help = match error {
        // Files of h5py have these with `libver="latest"` only.
        Error::Format(FormatError::InvalidLayoutVersion(5..)) => {
            "write it for older programs, such as with `libver=\"v114\"` in h5py"
        }
        Error::Format(FormatError::UnsupportedFilter(_)) => "compress it with gzip, or not at all",
        _ => DAMAGED,
    };
    (format!("cannot be read: {error}"), help)
}

fn is_number(kind: &DType) -> bool {
    use DType::{F32, F64, I8, I16, I32, I64, U8, U16, U32, U64};
    matches!(
        kind,
        F32 | F64 | I8 | I16 | I32 | I64 | U8 | U16 | U32 | U64
    )
}

/// The message about a path that leads nowhere, with the data sets of its group.
fn missing(file: &File, name: &str) -> String {
    let group = match name.trim_end_matches('/').rsplit_once('/') {
        Some((group, _)) if !group.is_empty() => file.group(group),
        _ => Ok(file.root()),
    };
    let mut known = group.and_then(|group| group.datasets()).unwrap_or_default();
    known.sort();
    match known.is_empty() {
        true => "is missing".to_owned(),
        false => format!("is missing, but its group has {}", list(&known)),
    }
}

/// The bytes of a file, of which only so many may be read.
struct LimitedBytes {
    bytes: Arc<Vec<u8>>,
    left: AtomicU64,
}

impl Source for LimitedBytes {
    fn len(&self) -> u64 {
        self.bytes.len() as u64
    }

    fn read_at(&self, offset: u64, buffer: &mut [u8]) -> Result<(), FormatError> {
        let start = usize::try_from(offset).unwrap_or(usize::MAX);
        let end = start.saturating_add(buffer.len());
        let bytes = self
            .bytes
            .get(start..end)
            .ok_or(FormatError::UnexpectedEof {
                expected: end,
                available: self.bytes.len(),
            })?;
        let asked = buffer.len().max(1) as u64;
        let less = |left: u64| left.checked_sub(asked);
        match self.left.fetch_update(Relaxed, Relaxed, less) {
            Ok(_) => {
                buffer.copy_from_slice(bytes);
                Ok(())
            }
            Err(_) => Err(FormatError::Source(
                "its tables are read again and again".to_owned(),
            )),
        }
    }
}
