//! Legacy files of VTK (`.vtk`): one state as POLYDATA or UNSTRUCTURED_GRID, as text or as bytes.
//!
//! Sections follow each other, each behind a line with its keyword. Those that say nothing of
//! spheres are passed over, which needs their sizes.

use super::vtk_numbers::{
    ByteOrder, NumberType, Points, Spheres, centres, is_number, numbers, spheres,
};
use super::vtk_reader::{Kind, Reader, short};
use crate::store::StoreError;
use std::path::Path;

/// How the files begin.
pub(super) const SIGNATURE: &[u8] = b"# vtk DataFile Version";

/// The version from which on cells have offsets.
const OFFSETS_SINCE: f64 = 5.1;

/// The spheres of a file that holds these bytes.
pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<Spheres, StoreError> {
    let mut file = File::new(path, bytes)?;
    while let Some(words) = file.reader.words()? {
        file.section(&words)?;
    }
    let centres = file.centres.take();
    let centres = centres.ok_or_else(|| file.reader.refuse("the section `POINTS` is missing"))?;
    match &file.numbers {
        Some(numbers) if numbers.len() != centres.len() => Err(file.reader.refuse(&format!(
            "the array `id` has {} numbers for {} points",
            numbers.len(),
            centres.len()
        ))),
        _ => Ok(spheres(vec![Points {
            centres,
            numbers: file.numbers,
        }])),
    }
}

/// A file, as far as it is read.
struct File<'a> {
    reader: Reader<'a>,
    is_binary: bool,
    has_offsets: bool,
    /// Arrays have so many tuples, and are of points.
    tuples: usize,
    is_of_points: bool,
    centres: Option<Vec<[f64; 3]>>,
    numbers: Option<Vec<u64>>,
}

impl<'a> File<'a> {
    /// Reads the head of a file.
    fn new(path: &'a Path, bytes: &'a [u8]) -> Result<Self, StoreError> {
        let mut file = Self {
            reader: Reader::new(path, bytes),
            is_binary: false,
            has_offsets: false,
            tuples: 0,
            is_of_points: false,
            centres: None,
            numbers: None,
        };
        let first = file.reader.line();
        let version = first.strip_prefix(SIGNATURE).unwrap_or_default();
        let version = str::from_utf8(version).unwrap_or_default().trim();
        let version: f64 = file.reader.number(version, "a version of VTK")?;
        file.has_offsets = version >= OFFSETS_SINCE;
        let _title = file.reader.line();
        let form = file.reader.line().to_ascii_uppercase();
        file.is_binary = match &form[..] {
            b"ASCII" => false,
            b"BINARY" => true,
            _ => return Err(file.reader.refuse("`ASCII` or `BINARY` is expected")),
        };
        Ok(file)
    }

    /// Reads the section that begins with these words.
    fn section(&mut self, words: &[&str]) -> Result<(), StoreError> {
        let keyword = words[0].to_ascii_uppercase();
        let word = |index: usize| words.get(index).copied().unwrap_or_default();
        match &keyword[..] {
            "DATASET" => match &word(1).to_ascii_uppercase()[..] {
                "POLYDATA" | "UNSTRUCTURED_GRID" => Ok(()),
                _ => Err(self.reader.refuse(&format!(
                    "the data is `{}`; save the spheres as POLYDATA or UNSTRUCTURED_GRID",
                    short(word(1))
                ))),
            },
            "POINTS" => self.points(word(1), word(2)),
            "VERTICES" | "LINES" | "POLYGONS" | "TRIANGLE_STRIPS" | "CELLS" => {
                self.cells(&keyword, [word(1), word(2)])
            }
            "CELL_TYPES" => {
                let count = self.reader.count(word(1))?;
                self.skip(&keyword, Kind::Numbers(NumberType::Int32), count)
            }
            "POINT_DATA" | "CELL_DATA" => {
                self.is_of_points = keyword == "POINT_DATA";
                self.tuples = self.reader.count(word(1))?;
                Ok(())
            }
            "FIELD" => self.field(word(2)),
            "METADATA" => {
                while !self.reader.line().is_empty() {}
                Ok(())
            }
            _ => self.attribute(&keyword, words),
        }
    }

    fn points(&mut self, count: &str, kind: &str) -> Result<(), StoreError> {
        let count = self.reader.count(count)?;
        let kind = self.reader.kind(kind)?;
        let coordinates = self.values("POINTS", kind, self.reader.product(count, 3)?)?;
        let centres = centres(&coordinates).map_err(|reason| self.reader.refuse(&reason))?;
        self.centres.get_or_insert(centres);
        Ok(())
    }

    fn cells(&mut self, name: &str, counts: [&str; 2]) -> Result<(), StoreError> {
        let counts = [self.reader.count(counts[0])?, self.reader.count(counts[1])?];
        if !self.has_offsets {
            return self.skip(name, Kind::Numbers(NumberType::Int32), counts[1]);
        }
        for (keyword, count) in ["OFFSETS", "CONNECTIVITY"].into_iter().zip(counts) {
            let words = self.reader.words()?.unwrap_or_default();
            match words[..] {
                [first, kind] if first.eq_ignore_ascii_case(keyword) => {
                    let kind = self.reader.kind(kind)?;
                    self.skip(keyword, kind, count)?;
                }
                _ => return Err(self.reader.refuse(&format!("`{keyword}` is expected"))),
            }
        }
        Ok(())
    }

    /// An array of points or cells with a section of its own.
    fn attribute(&mut self, keyword: &str, words: &[&str]) -> Result<(), StoreError> {
        const COLOURS: &str = "unsigned_char";
        let word = |index: usize| words.get(index).copied().unwrap_or_default();
        let name = word(1);
        let colours = match self.is_binary {
            true => COLOURS,
            false => "float",
        };
        let (kind, components) = match keyword {
            "SCALARS" => {
                let components = words.get(3).map_or(Ok(1), |it| self.reader.count(it))?;
                // The name of a table of colours, which some writers leave out.
                if self.reader.is_next("LOOKUP_TABLE") {
                    self.reader.line();
                }
                (word(2), components)
            }
            "VECTORS" | "NORMALS" => (word(2), 3),
            "TENSORS" => (word(2), 9),
            "TENSORS6" => (word(2), 6),
            "GLOBAL_IDS" | "PEDIGREE_IDS" | "EDGE_FLAGS" => (word(2), 1),
            "TEXTURE_COORDINATES" => (word(3), self.reader.count(word(2))?),
            "COLOR_SCALARS" => (colours, self.reader.count(word(2))?),
            "LOOKUP_TABLE" => {
                let count = self.reader.product(self.reader.count(word(2))?, 4)?;
                let kind = self.reader.kind(colours)?;
                return self.skip(name, kind, count);
            }
            _ => {
                let reason = format!("`{}` is no section of such a file", short(words[0]));
                return Err(self.reader.refuse(&reason));
            }
        };
        let kind = self.reader.kind(kind)?;
        self.array(name, kind, [components, self.tuples])
    }

    /// So many arrays, each with its line.
    fn field(&mut self, count: &str) -> Result<(), StoreError> {
        for _ in 0..self.reader.count(count)? {
            let words = loop {
                let words = self.reader.words()?;
                match words.as_deref() {
                    Some(["METADATA", ..]) => self.section(&["METADATA"])?,
                    Some(_) => break words.unwrap_or_default(),
                    None => return Err(self.reader.ends_early()),
                }
            };
            match words[..] {
                ["NULL_ARRAY", ..] => {}
                [name, components, tuples, kind] => {
                    let shape = [self.reader.count(components)?, self.reader.count(tuples)?];
                    let kind = self.reader.kind(kind)?;
                    self.array(name, kind, shape)?;
                }
                _ => {
                    let reason = "an array is expected: name, components, tuples and type";
                    return Err(self.reader.refuse(reason));
                }
            }
        }
        Ok(())
    }

    /// The numbers of the spheres, or an array that is passed over.
    fn array(
        &mut self,
        name: &str,
        kind: Kind,
        [components, tuples]: [usize; 2],
    ) -> Result<(), StoreError> {
        let count = self.reader.product(components, tuples)?;
        if !self.is_of_points || !is_number(name) || self.numbers.is_some() {
            return self.skip(name, kind, count);
        }
        if components != 1 {
            return Err(self.reader.refuse(&format!(
                "the array `{name}` has {components} numbers for each point, but must have one"
            )));
        }
        let values = self.values(name, kind, count)?;
        self.numbers = Some(numbers(&values).map_err(|reason| self.reader.refuse(&reason))?);
        Ok(())
    }

    /// The numbers of an array.
    fn values(&mut self, name: &str, kind: Kind, count: usize) -> Result<Vec<f64>, StoreError> {
        let Kind::Numbers(kind) = kind else {
            return Err(self
                .reader
                .refuse(&format!("the array `{name}` has no numbers")));
        };
        if self.is_binary {
            let size = self.reader.product(count, kind.size())?;
            let bytes = self.reader.bytes(name, size)?;
            return Ok(kind.values(bytes, ByteOrder::Big));
        }
        let value = |_| {
            let word = self.reader.word()?;
            self.reader.number(word, "a number")
        };
        (0..count).map(value).collect()
    }

    /// Passes over an array of so many values.
    fn skip(&mut self, name: &str, kind: Kind, count: usize) -> Result<(), StoreError> {
        match (self.is_binary, kind) {
            (true, Kind::Numbers(kind)) => {
                let size = self.reader.product(count, kind.size())?;
                self.reader.bytes(name, size)?;
            }
            (true, Kind::Bits) => {
                self.reader.bytes(name, count.div_ceil(8))?;
            }
            (true, Kind::Strings) => {
                for _ in 0..count {
                    self.skip_string(name)?;
                }
            }
            (false, Kind::Numbers(_) | Kind::Bits) => {
                for _ in 0..count {
                    self.reader.word()?;
                }
            }
            (false, Kind::Strings) => {
                for _ in 0..count {
                    if self.reader.is_empty() {
                        return Err(self.reader.ends_early());
                    }
                    self.reader.line();
                }
            }
        }
        Ok(())
    }

    /// Passes over a string behind its length. The first two bits say how many bytes that takes.
    fn skip_string(&mut self, name: &str) -> Result<(), StoreError> {
        let first = self.reader.bytes(name, 1)?[0];
        let further = match first >> 6 {
            3 => 0,
            2 => 1,
            1 => 3,
            _ => 7,
        };
        let length = self.reader.bytes(name, further)?.iter();
        let length = length.fold(u64::from(first & 0x3f), |length, byte| {
            length << 8 | u64::from(*byte)
        });
        self.reader
            .bytes(name, usize::try_from(length).unwrap_or(usize::MAX))?;
        Ok(())
    }
}

#[cfg(test)]
mod tests;
