use super::read;
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use flate2::{Compression, write::ZlibEncoder};
use proptest::prelude::*;
use std::io::Write as _;
use std::path::Path;

/// How a file stores its arrays.
#[derive(Clone, Copy, Debug)]
struct Variant {
    /// `ascii`, `binary`, or the encoding of appended arrays.
    format: &'static str,
    is_wide: bool,
    is_big: bool,
    is_compressed: bool,
}

const SPHERES: [(u64, [f64; 3]); 3] = [
    (7, [0.5, -1.0, 2.0]),
    (3, [-0.5, 1.0, 4.0]),
    (250, [0.25, 0.0, 1e3]),
];

fn variants() -> Vec<Variant> {
    let mut variants = Vec::new();
    for format in ["ascii", "binary", "raw", "base64"] {
        for bits in 0..8 {
            variants.push(Variant {
                format,
                is_wide: bits & 1 > 0,
                is_big: bits & 2 > 0,
                is_compressed: bits & 4 > 0,
            });
        }
    }
    variants
}

impl Variant {
    fn ordered(self, mut bytes: Vec<u8>) -> Vec<u8> {
        if self.is_big {
            bytes.reverse();
        }
        bytes
    }

    fn size(self, size: usize) -> Vec<u8> {
        self.ordered(match self.is_wide {
            true => (size as u64).to_le_bytes().to_vec(),
            false => (size as u32).to_le_bytes().to_vec(),
        })
    }

    /// Floating point numbers, or whole ones, of two widths.
    fn number(self, value: f64, is_whole: bool) -> Vec<u8> {
        self.ordered(match (is_whole, self.is_wide) {
            (false, true) => value.to_le_bytes().to_vec(),
            (false, false) => (value as f32).to_le_bytes().to_vec(),
            (true, true) => (value as i64).to_le_bytes().to_vec(),
            (true, false) => vec![value as u8],
        })
    }

    /// The bytes behind their sizes, in blocks of 16 bytes where they are compressed.
    fn coded(self, bytes: &[u8]) -> Vec<u8> {
        let mut head = self.size(bytes.len());
        let mut body = bytes.to_vec();
        if self.is_compressed {
            body.clear();
            let sizes = [bytes.len().div_ceil(16), 16, bytes.len() % 16];
            head = sizes.iter().flat_map(|it| self.size(*it)).collect();
            for block in bytes.chunks(16) {
                let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
                encoder.write_all(block).unwrap();
                let block = encoder.finish().unwrap();
                head.extend(self.size(block.len()));
                body.extend(block);
            }
        }
        let encode = |bytes: &[u8]| BASE64_STANDARD.encode(bytes);
        match (self.format, self.is_compressed) {
            ("raw", _) => [head, body].concat(),
            // Compressed bytes are encoded apart from their sizes.
            (_, true) => (encode(&head) + &encode(&body)).into_bytes(),
            (_, false) => encode(&[head, body].concat()).into_bytes(),
        }
    }

    /// An array, and what is appended for it.
    fn array(self, name: &str, values: &[f64], appended: &mut Vec<u8>) -> String {
        let is_whole = name != "Points";
        let kind = match (is_whole, self.is_wide) {
            (false, true) => "Float64",
            (false, false) => "Float32",
            (true, true) => "Int64",
            (true, false) => "UInt8",
        };
        let components = if is_whole { 1 } else { 3 };
        let bytes: Vec<u8> = (values.iter())
            .flat_map(|it| self.number(*it, is_whole))
            .collect();
        let (format, content) = match self.format {
            "ascii" => {
                let words: Vec<String> = values.iter().map(f64::to_string).collect();
                (" format=\"ascii\"".to_owned(), words.join("\n "))
            }
            "binary" => {
                let text = String::from_utf8(self.coded(&bytes)).unwrap();
                (" format=\"binary\"".to_owned(), format!("\n  {text}\n"))
            }
            _ => {
                let offset = appended.len();
                appended.extend(self.coded(&bytes));
                let format = format!(" format=\"appended\" offset=\"{offset}\"");
                (format, String::new())
            }
        };
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\"\
             {format}>{content}</DataArray>\n"
        )
    }

    /// A file of the spheres in two pieces.
    fn file(self) -> Vec<u8> {
        let order = if self.is_big {
            "BigEndian"
        } else {
            "LittleEndian"
        };
        let header = if self.is_wide { "UInt64" } else { "UInt32" };
        let compressor = match self.is_compressed {
            true => " compressor=\"vtkZLibDataCompressor\"",
            false => "",
        };
        let mut text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" byte_order=\"{order}\" \
             header_type=\"{header}\"{compressor}>\n<PolyData>\n"
        );
        let mut appended = Vec::new();
        for spheres in [&SPHERES[..2], &[], &SPHERES[2..]] {
            let values: Vec<f64> = spheres.iter().flat_map(|it| it.1).collect();
            let numbers: Vec<f64> = spheres.iter().map(|it| it.0 as f64).collect();
            let numbers = self.array("Id", &numbers, &mut appended);
            let points = self.array("Points", &values, &mut appended);
            text += &format!(
                "<Piece NumberOfPoints=\"{}\">\n<PointData>\n{numbers}</PointData>\n\
                 <Points>\n{points}</Points>\n</Piece>\n",
                spheres.len()
            );
        }
        let encoding = if self.format == "raw" {
            "raw"
        } else {
            "base64"
        };
        text += &format!("</PolyData>\n<AppendedData encoding=\"{encoding}\">\n _");
        [text.as_bytes(), &appended, b"\n</AppendedData></VTKFile>"].concat()
    }
}

fn read_of(bytes: &[u8]) -> Result<Vec<(u64, [f64; 3])>, String> {
    read(Path::new("a.vtp"), bytes)
        .map(|spheres| spheres.all)
        .map_err(|error| error.to_string())
}

#[test]
fn all_variants_give_the_same_spheres() {
    for variant in variants() {
        assert_eq!(read_of(&variant.file()).unwrap(), SPHERES, "{variant:?}");
    }
}

#[test]
fn points_without_numbers_are_numbered_in_their_order() {
    let text = String::from_utf8(TEXT.file()).unwrap();
    let spheres = read_of(text.replacen("\"Id\"", "\"type\"", 1).as_bytes()).unwrap();
    let numbers: Vec<u64> = spheres.iter().map(|it| it.0).collect();
    assert_eq!(numbers, [0, 1, 2]);
    let grid = text.replace("PolyData", "UnstructuredGrid");
    assert_eq!(read_of(grid.as_bytes()).unwrap(), SPHERES);
}

const TEXT: Variant = Variant {
    format: "ascii",
    is_wide: true,
    is_big: false,
    is_compressed: false,
};

#[test]
fn wrong_text_is_refused() {
    let text = String::from_utf8(TEXT.file()).unwrap();
    for (from, to, expected) in [
        (
            "type=\"PolyData\"",
            "type=\"ImageData\"",
            "a.vtp:2: it is a `ImageData`; save the spheres as PolyData",
        ),
        (
            "<PolyData>",
            "<PolyDatum>",
            "a.vtp:36: it is no file of VTK",
        ),
        (
            "<?xml",
            "<!DOCTYPE a><?xml",
            "a.vtp:1: it is no file of VTK",
        ),
        (
            "header_type=\"UInt64\"",
            "compressor=\"vtkLZ4DataCompressor\"",
            "`vtkLZ4DataCompressor` cannot be read; save the file uncompressed or with zlib",
        ),
        (
            "LittleEndian",
            "Middle",
            "a.vtp:2: `Middle` is no order of bytes",
        ),
        (
            "UInt64",
            "UInt16",
            "a.vtp:2: `UInt16` is no type of headers",
        ),
        ("base64", "base85", "a.vtp:2: `base85` is no encoding"),
        (
            "NumberOfPoints=\"2\"",
            "NumberOfPoints=\"-2\"",
            "a.vtp:4: `NumberOfPoints` is `-2`",
        ),
        (
            "NumberOfPoints=\"2\"",
            "NumberOfPoints=\"9999999999999999999\"",
            "a.vtp:10: array `Points`: no file holds 9999999999999999999 points",
        ),
        (
            "NumberOfPoints=\"2\"",
            "NumberOfPoints=\"3\"",
            "a.vtp:10: array `Points`: it has 6 numbers, but its points need 9",
        ),
        (
            "NumberOfComponents=\"3\"",
            "NumberOfComponents=\"2\"",
            "array `Points`: `NumberOfComponents` is `2`, but must be 3",
        ),
        (
            "<Points>",
            "<Points/><Points>",
            "a.vtp:4: the array `Points` is missing",
        ),
        (
            "Float64",
            "Float16",
            "array `Points`: `Float16` is no type of VTK",
        ),
        (
            "0.5",
            "half",
            "a.vtp:10: array `Points`: `half` is not a number",
        ),
        (
            "0.5",
            "nan",
            "array `Points`: a coordinate of point 0 is not finite",
        ),
        (
            ">7\n",
            ">-7\n",
            "a.vtp:6: array `id`: `-7` is not a number of a sphere",
        ),
        (
            ">7\n",
            ">0.5\n",
            "array `id`: `0.5` is not a number of a sphere",
        ),
        ("\"ascii\"", "\"hex\"", "array `Points`: `hex` is no format"),
    ] {
        let changed = text.replace(from, to);
        assert_ne!(changed, text, "{from}");
        let error = read_of(changed.as_bytes()).unwrap_err();
        assert!(error.contains(expected), "{error}\n{expected}");
    }
    let nested = format!("<VTKFile>{}", "<a>".repeat(100_000));
    assert!(read_of(nested.as_bytes()).is_err());
    let error = read_of(b"\n\n\x89HDF").unwrap_err();
    assert!(error.contains("a.vtp:3: it is no file of VTK"), "{error}");
}

#[test]
fn wrong_bytes_are_refused() {
    let raw = Variant {
        format: "raw",
        ..TEXT
    };
    let packed = Variant {
        is_compressed: true,
        ..raw
    };
    let inline = Variant {
        format: "binary",
        ..TEXT
    };
    // Points stand behind two numbers and their size, or behind one block of them.
    for (variant, from, to, expected) in [
        (
            raw,
            &b"offset=\"24\""[..],
            &b"offset=\"999\""[..],
            "array `Points`: its offset is `999`",
        ),
        (
            raw,
            b"offset=\"24\"",
            b"offset=\"-4\"",
            "its offset is `-4`",
        ),
        (
            raw,
            b"offset=\"24\"",
            b"offset=\"8\"",
            "it has 7 bytes, but its points need 48",
        ),
        (
            raw,
            b"_\x10\0\0\0\0\0\0\0",
            b"_\xff\xff\xff\xff\xff\xff\xff\xff",
            "array `id`: it has ",
        ),
        (
            packed,
            b"\x78\x9c",
            b"\x78\x9d",
            "it cannot be decompressed: ",
        ),
        (
            packed,
            b"_\x01\0\0\0\0\0\0\0",
            b"_\xff\xff\xff\xff\xff\xff\xff\xff",
            "but its points need",
        ),
        (
            packed,
            // Blocks without number that have no bytes, but for the last.
            b"_\x01\0\0\0\0\0\0\0\x10\0\0\0\0\0\0\0\0",
            b"_\xff\xff\xff\xff\xff\xff\xff\xff\0\0\0\0\0\0\0\0\x10",
            "array `id`: its numbers are cut off",
        ),
        (inline, b"==", b"", "array `id`: it is no base64: "),
        (
            inline,
            b"MAAAAAAAAA",
            b"MAAAAAAA",
            "array `id`: it is no base64: ",
        ),
        (
            inline,
            b"MAAAAAAAAA",
            b"M*AAAAAAAA",
            "array `id`: it is no base64: ",
        ),
    ] {
        let changed = replaced(&variant.file(), from, to);
        let error = read_of(&changed).unwrap_err();
        assert!(error.contains(expected), "{error}\n{expected}");
    }
    let whole = raw.file();
    let error = read_of(&whole[..whole.len() - 40]).unwrap_err();
    assert!(error.contains("its numbers are cut off"), "{error}");
}

/// The bytes with the first `from` as `to`.
fn replaced(bytes: &[u8], from: &[u8], to: &[u8]) -> Vec<u8> {
    let place = bytes.windows(from.len()).position(|it| it == from);
    let (before, rest) = bytes.split_at(place.unwrap());
    [before, to, &rest[from.len()..]].concat()
}

proptest! {
    #[test]
    fn no_damage_panics(
        variant in prop::sample::select(variants()),
        end in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4),
        is_cut in any::<bool>(),
    ) {
        let mut bytes = variant.file();
        for (place, byte) in changes {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        let end = if is_cut { end.index(bytes.len()) } else { bytes.len() };
        let _ = read_of(&bytes[..end]);
    }
}
