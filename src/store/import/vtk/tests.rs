use super::{numbers, read};
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use proptest::prelude::*;
use std::path::Path;

/// How a file stores its arrays.
#[derive(Clone, Copy, Debug)]
struct Variant {
    /// `ascii`, `binary`, or the encoding of appended arrays.
    format: &'static str,
    is_wide: bool,
}

const SPHERES: [(u64, [f64; 3]); 3] = [
    (7, [0.5, -1.0, 2.0]),
    (3, [-0.5, 1.0, 4.0]),
    (250, [0.25, 0.0, 1e3]),
];

fn variants() -> Vec<Variant> {
    let mut variants = Vec::new();
    for format in ["ascii", "binary", "raw", "base64"] {
        for is_wide in [false, true] {
            variants.push(Variant { format, is_wide });
        }
    }
    variants
}

impl Variant {
    fn size(self, size: usize) -> Vec<u8> {
        match self.is_wide {
            true => (size as u64).to_le_bytes().to_vec(),
            false => (size as u32).to_le_bytes().to_vec(),
        }
    }

    /// Floating point numbers, or whole ones, of two widths.
    fn number(self, value: f64, is_whole: bool) -> Vec<u8> {
        match (is_whole, self.is_wide) {
            (false, true) => value.to_le_bytes().to_vec(),
            (false, false) => (value as f32).to_le_bytes().to_vec(),
            (true, true) => (value as i64).to_le_bytes().to_vec(),
            (true, false) => (value as u32).to_le_bytes().to_vec(),
        }
    }

    /// The bytes behind their size.
    fn coded(self, bytes: &[u8]) -> Vec<u8> {
        let all = [&self.size(bytes.len())[..], bytes].concat();
        match self.format {
            "raw" => all,
            _ => BASE64_STANDARD.encode(all).into_bytes(),
        }
    }

    /// An array, and what is appended for it.
    fn array(self, name: &str, values: &[f64], appended: &mut Vec<u8>) -> String {
        let is_whole = name != "Points";
        let kind = match (is_whole, self.is_wide) {
            (false, true) => "Float64",
            (false, false) => "Float32",
            (true, true) => "Int64",
            (true, false) => "UInt32",
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
        let header = if self.is_wide { "UInt64" } else { "UInt32" };
        let mut text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" \
             header_type=\"{header}\">\n<PolyData>\n"
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
            "LittleEndian",
            "BigEndian",
            "a.vtp:2: its order of bytes is `BigEndian`, but only LittleEndian can be read",
        ),
        (
            "UInt64",
            "UInt16",
            "a.vtp:2: `UInt16` is no type of headers",
        ),
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
            "array `Points`: `NumberOfComponents` is `2`, not 3",
        ),
        (
            "<Points>",
            "<Points/><Points>",
            "a.vtp:4: the array `Points` is missing",
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
    let inline = Variant {
        format: "binary",
        ..TEXT
    };
    // Points stand behind two numbers and their size.
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
            raw,
            b"header_type",
            b"compressor=\"vtkZLibDataCompressor\" header_type",
            "array `Points`: it is compressed (`vtkZLibDataCompressor`), which cannot be read",
        ),
        (
            raw,
            b"\"Int64",
            b"\"Int16",
            "array `id`: numbers of type `Int16` cannot be read; use Float32",
        ),
        (inline, b"==", b"", "array `id`: its numbers are cut off"),
        (
            inline,
            b"MAAAAAAAAA",
            b"MAAAAAAA",
            "array `id`: its numbers are cut off",
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

#[test]
fn numbers_of_bytes_have_the_values_of_their_type() {
    let root = r#"<VTKFile type="PolyData"><PolyData><Piece NumberOfPoints="1"><PointData>
        <DataArray type="TYPE" Name="id" format="appended" offset="0"/></PointData><Points>
        <DataArray NumberOfComponents="3">0 0 0</DataArray></Points></Piece></PolyData>
        <AppendedData encoding="raw">_"#;
    for (kind, bytes) in [
        ("Int32", &7_i32.to_le_bytes()[..]),
        ("UInt32", &7_u32.to_le_bytes()),
        ("Int64", &7_i64.to_le_bytes()),
        ("UInt64", &7_u64.to_le_bytes()),
        ("Float32", &7_f32.to_le_bytes()),
        ("Float64", &7_f64.to_le_bytes()),
    ] {
        let text = root.replace("TYPE", kind);
        let size = (bytes.len() as u32).to_le_bytes();
        let file = [text.as_bytes(), &size, bytes].concat();
        assert_eq!(read_of(&file).unwrap(), [(7, [0.0; 3])], "{kind}");
    }
}

#[test]
fn numbers_of_spheres_are_whole() {
    assert_eq!(numbers(&[0.0, 7.0]), Ok(vec![0, 7]));
    for bad in [-1.0, 0.5, f64::NAN, f64::INFINITY, 9007199254740992.0] {
        assert!(numbers(&[bad]).is_err(), "{bad}");
    }
}
