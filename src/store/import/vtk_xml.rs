//! VTK XML: one state as PolyData (`.vtp`) or UnstructuredGrid (`.vtu`).
//!
//! The numbers of an array stand as text, or as bytes behind their size: in base64 in the place of
//! the text, or "appended" behind the XML, raw or in base64. Raw bytes are not XML, so they are cut
//! off before it is parsed.

use super::line_at;
use super::vtk_bytes::{Coding, Source};
use super::vtk_numbers::{
    ByteOrder, NumberType, Points, Spheres, centres, is_number, numbers, spheres,
};
use crate::store::StoreError;
use roxmltree::{Document, Node};
use std::borrow::Cow;
use std::path::Path;

/// The spheres of a file that holds these bytes.
pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<Spheres, StoreError> {
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
        let reason = format!("it is no file of VTK, which is XML or begins with `# vtk`: {error}");
        StoreError::text(path, error.pos().row.into(), reason)
    })?;
    let root = document.root_element();
    let file = File::new(path, root, appended).map_err(|reason| refuse(path, root, &reason))?;
    let pieces = file.grid.children().filter(|it| it.has_tag_name("Piece"));
    let pieces = pieces.map(|piece| file.points(piece));
    Ok(spheres(pieces.collect::<Result<_, _>>()?))
}

/// The XML of a file, and what is appended to it.
fn split(bytes: &[u8]) -> (Cow<'_, [u8]>, &[u8]) {
    const TAG: &[u8] = b"<AppendedData";
    let whole = (Cow::Borrowed(bytes), &[][..]);
    let Some(tag) = bytes.windows(TAG.len()).position(|it| it == TAG) else {
        return whole;
    };
    let Some(length) = bytes[tag..].iter().position(|it| *it == b'>') else {
        return whole;
    };
    let (xml, rest) = bytes.split_at(tag + length + 1);
    if xml.ends_with(b"/>") {
        return whole;
    }
    let appended = rest.iter().position(|it| *it == b'_').map(|it| it + 1);
    let closed = [xml, b"</AppendedData></VTKFile>"].concat();
    (Cow::Owned(closed), &rest[appended.unwrap_or(rest.len())..])
}

/// A file: its kind of numbers, and where they are.
struct File<'a> {
    path: &'a Path,
    grid: Node<'a, 'a>,
    appended: &'a [u8],
    is_raw: bool,
    coding: Coding,
}

impl<'a> File<'a> {
    fn new(path: &'a Path, root: Node<'a, 'a>, appended: &'a [u8]) -> Result<Self, String> {
        let kind = root.attribute("type").unwrap_or_default();
        if !matches!(kind, "PolyData" | "UnstructuredGrid") {
            return Err(format!(
                "it is a `{kind}`; save the spheres as PolyData (`.vtp`) or UnstructuredGrid \
                 (`.vtu`)"
            ));
        }
        let grid = child(root, kind).ok_or_else(|| format!("`{kind}` is missing"))?;
        let is_raw = match child(root, "AppendedData").and_then(|it| it.attribute("encoding")) {
            Some("raw") => true,
            Some("base64") | None => false,
            Some(other) => return Err(format!("`{other}` is no encoding; use raw or base64")),
        };
        Ok(Self {
            path,
            grid,
            appended,
            is_raw,
            coding: coding(root)?,
        })
    }

    /// The points of a piece.
    fn points(&self, piece: Node<'_, '_>) -> Result<Points, StoreError> {
        let count = piece.attribute("NumberOfPoints").unwrap_or_default();
        let count: usize = count.trim().parse().map_err(|_| {
            let reason = format!("`NumberOfPoints` is `{count}`, but must be a whole number");
            refuse(self.path, piece, &reason)
        })?;
        if count == 0 {
            return Ok(Points::default());
        }
        let array = child(piece, "Points").and_then(|it| child(it, "DataArray"));
        let array =
            array.ok_or_else(|| refuse(self.path, piece, "the array `Points` is missing"))?;
        let of = |array: Node<'_, '_>, components: usize| self.values(array, count, components);
        let named = |array: Node<'_, '_>, name: &str, reason: String| {
            refuse(self.path, array, &format!("array `{name}`: {reason}"))
        };
        let centres = of(array, 3).and_then(|it| centres(&it));
        let centres = centres.map_err(|reason| named(array, "Points", reason))?;
        let is_id = |array: &Node<'_, '_>| {
            array.has_tag_name("DataArray") && array.attribute("Name").is_some_and(is_number)
        };
        let array = child(piece, "PointData").and_then(|it| it.children().find(is_id));
        let numbers = array.map(|array| {
            let numbers = of(array, 1).and_then(|it| numbers(&it));
            numbers.map_err(|reason| named(array, "id", reason))
        });
        Ok(Points {
            centres,
            numbers: numbers.transpose()?,
        })
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
            return Err(format!(
                "`NumberOfComponents` is `{own}`, but must be {components}"
            ));
        }
        let kind = array.attribute("type").unwrap_or_default();
        let kind = NumberType::of_xml(kind).ok_or_else(|| format!("`{kind}` is no type of VTK"))?;
        let count = points.checked_mul(components);
        let size = count.and_then(|it| it.checked_mul(kind.size()));
        let (Some(count), Some(size)) = (count, size) else {
            return Err(format!("no file holds {points} points"));
        };
        let text = || -> String {
            let texts = array.children().filter(Node::is_text);
            texts.filter_map(|it| it.text()).collect()
        };
        match array.attribute("format").unwrap_or("ascii") {
            "ascii" => values_of_text(&text(), count),
            "binary" => {
                let text: Vec<u8> = text()
                    .bytes()
                    .filter(|it| !it.is_ascii_whitespace())
                    .collect();
                let bytes = self.coding.bytes(Source::base64(&text), size)?;
                Ok(kind.values(&bytes, self.coding.order))
            }
            "appended" => {
                let source = self.appended_at(array.attribute("offset"))?;
                let bytes = self.coding.bytes(source, size)?;
                Ok(kind.values(&bytes, self.coding.order))
            }
            format => Err(format!(
                "`{format}` is no format; use ascii, binary or appended"
            )),
        }
    }

    /// The appended bytes from an offset on.
    fn appended_at(&self, offset: Option<&str>) -> Result<Source<'_>, String> {
        let offset = offset.unwrap_or_default();
        let start: Option<usize> = offset.trim().parse().ok();
        let data = start.and_then(|start| self.appended.get(start..));
        let data = data.ok_or_else(|| {
            format!("its offset is `{offset}`, where no appended data is in the file")
        })?;
        if self.is_raw {
            return Ok(Source::Raw(data));
        }
        let end = data.iter().position(|it| *it == b'<');
        let text = &data[..end.unwrap_or(data.len())];
        Ok(Source::base64(text.trim_ascii_end()))
    }
}

/// So many numbers of a text.
fn values_of_text(text: &str, count: usize) -> Result<Vec<f64>, String> {
    let number = |word: &str| {
        let number = word.parse();
        number.map_err(|_| format!("`{word}` is not a number"))
    };
    let words = text.split_ascii_whitespace();
    let values: Vec<f64> = words.map(number).collect::<Result<_, _>>()?;
    match values.len() == count {
        true => Ok(values),
        false => Err(format!(
            "it has {} numbers, but its points need {count}",
            values.len()
        )),
    }
}

/// How the file with this root stores bytes.
fn coding(root: Node<'_, '_>) -> Result<Coding, String> {
    let attribute = |name: &str| root.attribute(name).unwrap_or_default();
    let order = match attribute("byte_order") {
        "" | "LittleEndian" => ByteOrder::Little,
        "BigEndian" => ByteOrder::Big,
        order => return Err(format!("`{order}` is no order of bytes")),
    };
    let header = match attribute("header_type") {
        "" | "UInt32" => NumberType::UInt32,
        "UInt64" => NumberType::UInt64,
        header => return Err(format!("`{header}` is no type of headers")),
    };
    let is_compressed = match attribute("compressor") {
        "" => false,
        "vtkZLibDataCompressor" => true,
        compressor => {
            return Err(format!(
                "`{compressor}` cannot be read; save the file uncompressed or with zlib"
            ));
        }
    };
    Ok(Coding {
        order,
        header,
        is_compressed,
    })
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
