//! Files of VTK in XML without compression: the spheres of one state as PolyData (`.vtp`) or
//! UnstructuredGrid (`.vtu`).
//!
//! The numbers of an array stand as text, or as bytes behind their size: in base64 in the place of
//! the text, or "appended" behind the XML, raw or in base64. Raw bytes are not XML, so they are cut
//! off before it is parsed.

use super::line_at;
use crate::store::StoreError;
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use roxmltree::{Document, Node};
use std::borrow::Cow;
use std::fmt::Display;
use std::path::Path;

/// The numbers and centres of spheres.
pub(super) struct NumberedCentres {
    /// Whether the file has the numbers; else the spheres count from 0 in their order.
    pub(super) are_numbered: bool,
    pub(super) all: Vec<(u64, [f64; 3])>,
}

/// The spheres of a file that holds these bytes.
pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<NumberedCentres, StoreError> {
    if bytes.starts_with(b"# vtk") {
        let reason = "it is a legacy file of VTK, which cannot be read; save it as XML without \
                      compression (`.vtp` or `.vtu`), or write a dump or extended XYZ";
        return Err(StoreError::text(path, 1, reason));
    }
    let (xml, appended) = split(bytes);
    let text = str::from_utf8(&xml).map_err(|error| {
        let line = xml[..error.valid_up_to()].split(|it| *it == b'\n').count();
        StoreError::text(
            path,
            line as u64,
            "it is no file of VTK: it is not text here",
        )
    })?;
    let document = Document::parse(text).map_err(|error| {
        let reason = format!("it is no file of VTK, which is XML: {error}");
        StoreError::text(path, error.pos().row.into(), reason)
    })?;
    let root = document.root_element();
    let file = VtkFile::new(path, root, appended).map_err(|reason| refuse(path, root, &reason))?;
    let (mut centres, mut numbers, mut are_numbered) = (Vec::new(), Vec::new(), true);
    for piece in file.grid.children().filter(|it| it.has_tag_name("Piece")) {
        let (own, numbers_there) = file.points(piece)?;
        are_numbered &= numbers_there.is_some() || own.is_empty();
        centres.extend(own);
        numbers.extend(numbers_there.into_iter().flatten());
    }
    Ok(NumberedCentres {
        are_numbered,
        all: match are_numbered {
            true => numbers.into_iter().zip(centres).collect(),
            false => (0..).zip(centres).collect(),
        },
    })
}

/// The XML of a file, and what is appended to it.
fn split(bytes: &[u8]) -> (Cow<'_, [u8]>, &[u8]) {
    let find = |bytes: &[u8], part: &[u8]| bytes.windows(part.len()).position(|it| it == part);
    let tag = find(bytes, b"<AppendedData");
    let end = tag.and_then(|tag| Some(tag + find(&bytes[tag..], b">")? + 1));
    match end.map(|end| bytes.split_at(end)) {
        Some((xml, rest)) if !xml.ends_with(b"/>") => {
            let closed = [xml, b"</AppendedData></VTKFile>"].concat();
            let start = find(rest, b"_").map_or(rest.len(), |it| it + 1);
            (Cow::Owned(closed), &rest[start..])
        }
        _ => (Cow::Borrowed(bytes), &[]),
    }
}

/// Centres of the spheres of a piece, and their numbers if it has them.
type PieceCentres = (Vec<[f64; 3]>, Option<Vec<u64>>);

/// A file: its kind of numbers, and where they are.
struct VtkFile<'a> {
    path: &'a Path,
    grid: Node<'a, 'a>,
    appended: &'a [u8],
    is_raw: bool,
    /// Bytes of the size before the numbers of an array.
    header: usize,
    compressor: Option<&'a str>,
}

impl<'a> VtkFile<'a> {
    fn new(path: &'a Path, root: Node<'a, 'a>, appended: &'a [u8]) -> Result<Self, String> {
        let attribute = |name: &str| root.attribute(name).unwrap_or_default();
        let kind = attribute("type");
        if !matches!(kind, "PolyData" | "UnstructuredGrid") {
            return Err(format!(
                "it is a `{kind}`; save the spheres as PolyData (`.vtp`) or UnstructuredGrid \
                 (`.vtu`)"
            ));
        }
        let order = attribute("byte_order");
        if !matches!(order, "" | "LittleEndian") {
            return Err(format!(
                "its order of bytes is `{order}`, but only LittleEndian can be read; save it so, \
                 or as text (`ascii`)"
            ));
        }
        let header = match attribute("header_type") {
            "" | "UInt32" => 4,
            "UInt64" => 8,
            header => return Err(format!("`{header}` is no type of headers")),
        };
        let encoding = child(root, "AppendedData").and_then(|it| it.attribute("encoding"));
        Ok(Self {
            path,
            grid: child(root, kind).ok_or_else(|| format!("`{kind}` is missing"))?,
            appended,
            is_raw: encoding == Some("raw"),
            header,
            compressor: root.attribute("compressor"),
        })
    }

    fn points(&self, piece: Node<'_, '_>) -> Result<PieceCentres, StoreError> {
        let count = piece.attribute("NumberOfPoints").unwrap_or_default();
        let count: usize = count.trim().parse().map_err(|_| {
            let reason = format!("`NumberOfPoints` is `{count}`, but must be a whole number");
            refuse(self.path, piece, &reason)
        })?;
        if count == 0 {
            return Ok((Vec::new(), None));
        }
        let array = (child(piece, "Points").and_then(|it| child(it, "DataArray")))
            .ok_or_else(|| refuse(self.path, piece, "the array `Points` is missing"))?;
        let named = |array: Node<'_, '_>, name: &str, reason: String| {
            refuse(self.path, array, &format!("array `{name}`: {reason}"))
        };
        let centres = self.values(array, count, 3).and_then(|it| centres(&it));
        let centres = centres.map_err(|reason| named(array, "Points", reason))?;
        let is_id = |array: &Node<'_, '_>| {
            let name = array.attribute("Name").unwrap_or_default();
            array.has_tag_name("DataArray") && name.eq_ignore_ascii_case("id")
        };
        let array = child(piece, "PointData").and_then(|it| it.children().find(is_id));
        let numbers = array.map(|array| {
            let numbers = self.values(array, count, 1).and_then(|it| numbers(&it));
            numbers.map_err(|reason| named(array, "id", reason))
        });
        Ok((centres, numbers.transpose()?))
    }

    /// The values of an array of so many points.
    fn values(
        &self,
        array: Node<'_, '_>,
        points: usize,
        components: usize,
    ) -> Result<Vec<f64>, String> {
        let own = array.attribute("NumberOfComponents").unwrap_or("1");
        if own.trim().parse() != Ok(components) {
            return Err(format!("`NumberOfComponents` is `{own}`, not {components}"));
        }
        // Numbers have at most 8 bytes: no size below overflows.
        let count = (points.checked_mul(components))
            .filter(|it| *it < usize::MAX / 16)
            .ok_or_else(|| format!("no file holds {points} points"))?;
        let text = || -> String {
            let texts = array.children().filter(Node::is_text);
            texts.filter_map(|it| it.text()).collect()
        };
        let kind = array.attribute("type").unwrap_or_default();
        match array.attribute("format").unwrap_or("ascii") {
            "ascii" => values_of_text(&text(), count),
            "binary" => {
                let mut text = text().into_bytes();
                text.retain(|it| !it.is_ascii_whitespace());
                self.values_of_bytes(&text, false, kind, count)
            }
            "appended" => {
                let offset = array.attribute("offset").unwrap_or_default();
                let start: Option<usize> = offset.trim().parse().ok();
                let data = start.and_then(|start| self.appended.get(start..));
                let data = data.ok_or_else(|| {
                    format!("its offset is `{offset}`, where no appended data is in the file")
                })?;
                self.values_of_bytes(data, self.is_raw, kind, count)
            }
            format => Err(format!(
                "`{format}` is no format; use ascii, binary or appended"
            )),
        }
    }

    /// The first so many numbers of these bytes, behind their size.
    fn values_of_bytes(
        &self,
        data: &[u8],
        is_raw: bool,
        kind: &str,
        count: usize,
    ) -> Result<Vec<f64>, String> {
        const SHORT: &str = "its numbers are cut off; write or copy the file again";
        if let Some(compressor) = self.compressor {
            return Err(format!(
                "it is compressed (`{compressor}`), which cannot be read; save the file without \
                 compression, or as text (`ascii`)"
            ));
        }
        let wanted = match kind {
            "Int32" | "UInt32" | "Float32" => 4 * count,
            "Int64" | "UInt64" | "Float64" => 8 * count,
            _ => {
                return Err(format!(
                    "numbers of type `{kind}` cannot be read; use Float32"
                ));
            }
        };
        let bytes = match is_raw {
            true => Cow::Borrowed(data),
            false => {
                // Four letters are three bytes.
                let letters = (self.header + wanted).div_ceil(3) * 4;
                let data = data.get(..letters).ok_or(SHORT)?;
                let bytes = BASE64_STANDARD.decode(data);
                Cow::Owned(bytes.map_err(|error| format!("it is no base64: {error}"))?)
            }
        };
        let (size, bytes) = bytes.split_at_checked(self.header).ok_or(SHORT)?;
        let size = size.iter().rev();
        let size = size.fold(0, |size: u64, byte| size << 8 | u64::from(*byte));
        if size != wanted as u64 {
            return Err(format!("it has {size} bytes, but its points need {wanted}"));
        }
        let bytes = bytes.get(..wanted).ok_or(SHORT)?;
        Ok(match kind {
            "Int32" => numbers_in(bytes, |it| i32::from_le_bytes(it).into()),
            "UInt32" => numbers_in(bytes, |it| u32::from_le_bytes(it).into()),
            "Int64" => numbers_in(bytes, |it| i64::from_le_bytes(it) as f64),
            "UInt64" => numbers_in(bytes, |it| u64::from_le_bytes(it) as f64),
            "Float32" => numbers_in(bytes, |it| f32::from_le_bytes(it).into()),
            _ => numbers_in(bytes, f64::from_le_bytes),
        })
    }
}

fn numbers_in<const SIZE: usize>(bytes: &[u8], read: fn([u8; SIZE]) -> f64) -> Vec<f64> {
    let (numbers, _) = bytes.as_chunks::<SIZE>();
    numbers.iter().map(|it| read(*it)).collect()
}

fn other_size(found: impl Display, what: &str, needed: usize) -> String {
    format!("it has {found} {what}, but its points need {needed}")
}

/// So many numbers of a text.
fn values_of_text(text: &str, count: usize) -> Result<Vec<f64>, String> {
    let number = |word: &str| {
        let number = word.parse();
        number.map_err(|_| format!("`{word}` is not a number"))
    };
    let words = text.split_ascii_whitespace();
    let values: Vec<f64> = words.map(number).collect::<Result<_, _>>()?;
    let found = values.len();
    (found == count)
        .then_some(values)
        .ok_or_else(|| other_size(found, "numbers", count))
}

/// The centres with these coordinates.
fn centres(coordinates: &[f64]) -> Result<Vec<[f64; 3]>, String> {
    let (centres, _) = coordinates.as_chunks::<3>();
    let is_bad = |centre: &[f64; 3]| centre.iter().any(|it| !it.is_finite());
    match centres.iter().position(is_bad) {
        Some(point) => Err(format!("a coordinate of point {point} is not finite")),
        None => Ok(centres.to_vec()),
    }
}

/// These values as numbers of spheres.
fn numbers(values: &[f64]) -> Result<Vec<u64>, String> {
    // Larger ones may stand for several whole numbers.
    const LIMIT: f64 = (1_u64 << f64::MANTISSA_DIGITS) as f64;
    let number = |value: &f64| match *value as u64 {
        whole if whole as f64 == *value && *value < LIMIT => Ok(whole),
        _ => Err(format!(
            "`{value}` is not a number of a sphere; use whole numbers from 0"
        )),
    };
    values.iter().map(number).collect()
}

fn child<'a>(node: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|it| it.has_tag_name(name))
}

fn refuse(path: &Path, node: Node<'_, '_>, reason: &str) -> StoreError {
    let line = line_at(node.document().input_text(), node.range().start);
    StoreError::text(path, line, reason)
}

#[cfg(test)]
mod tests;
