//! What all files of VTK share: types of numbers, numbers as bytes, and points that are spheres.

/// The order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ByteOrder {
    Little,
    Big,
}

/// The type of the numbers of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NumberType {
    Int8,
    UInt8,
    Int16,
    UInt16,
    Int32,
    UInt32,
    Int64,
    UInt64,
    Float32,
    Float64,
}

use NumberType::{Float32, Float64, Int8, Int16, Int32, Int64, UInt8, UInt16, UInt32, UInt64};

impl NumberType {
    /// The type of this name in an XML file.
    pub(super) fn of_xml(name: &str) -> Option<Self> {
        Some(match name {
            "Int8" => Int8,
            "UInt8" => UInt8,
            "Int16" => Int16,
            "UInt16" => UInt16,
            "Int32" => Int32,
            "UInt32" => UInt32,
            "Int64" => Int64,
            "UInt64" => UInt64,
            "Float32" => Float32,
            "Float64" => Float64,
            _ => return None,
        })
    }

    /// The type of this name in a legacy file.
    pub(super) fn of_legacy(name: &str) -> Option<Self> {
        Some(match &name.to_ascii_lowercase()[..] {
            "char" | "signed_char" => Int8,
            "unsigned_char" => UInt8,
            "short" => Int16,
            "unsigned_short" => UInt16,
            // VTK writes its indices in 32 bits, whatever they have in memory.
            "int" | "vtkidtype" => Int32,
            "unsigned_int" => UInt32,
            "long" | "vtktypeint64" => Int64,
            "unsigned_long" | "vtktypeuint64" => UInt64,
            "float" => Float32,
            "double" => Float64,
            _ => return None,
        })
    }

    /// Bytes of a number.
    pub(super) fn size(self) -> usize {
        match self {
            Int8 | UInt8 => 1,
            Int16 | UInt16 => 2,
            Int32 | UInt32 | Float32 => 4,
            Int64 | UInt64 | Float64 => 8,
        }
    }

    /// The numbers that these bytes are.
    pub(super) fn values(self, bytes: &[u8], order: ByteOrder) -> Vec<f64> {
        match self {
            Int8 => values(bytes, order, |it| i8::from_le_bytes(it).into()),
            UInt8 => values(bytes, order, |it| u8::from_le_bytes(it).into()),
            Int16 => values(bytes, order, |it| i16::from_le_bytes(it).into()),
            UInt16 => values(bytes, order, |it| u16::from_le_bytes(it).into()),
            Int32 => values(bytes, order, |it| i32::from_le_bytes(it).into()),
            UInt32 => values(bytes, order, |it| u32::from_le_bytes(it).into()),
            Int64 => values(bytes, order, |it| i64::from_le_bytes(it) as f64),
            UInt64 => values(bytes, order, |it| u64::from_le_bytes(it) as f64),
            Float32 => values(bytes, order, |it| f32::from_le_bytes(it).into()),
            Float64 => values(bytes, order, f64::from_le_bytes),
        }
    }
}

fn values<const SIZE: usize>(
    bytes: &[u8],
    order: ByteOrder,
    read: fn([u8; SIZE]) -> f64,
) -> Vec<f64> {
    let (numbers, _) = bytes.as_chunks::<SIZE>();
    let number = |bytes: &[u8; SIZE]| {
        let mut bytes = *bytes;
        if order == ByteOrder::Big {
            bytes.reverse();
        }
        read(bytes)
    };
    numbers.iter().map(number).collect()
}

/// The points of a file, or of one of its pieces.
#[derive(Default)]
pub(super) struct Points {
    /// The centre of each.
    pub(super) centres: Vec<[f64; 3]>,
    /// The number of each, if the file says it.
    pub(super) numbers: Option<Vec<u64>>,
}

/// The spheres of a file.
#[derive(Debug, PartialEq)]
pub(super) struct Spheres {
    /// Whether the file has their numbers; else they count from 0 in their order.
    pub(super) are_numbered: bool,
    /// Number and centre of each.
    pub(super) all: Vec<(u64, [f64; 3])>,
}

/// Is this the name of the array that numbers the spheres?
pub(super) fn is_number(name: &str) -> bool {
    name.eq_ignore_ascii_case("id")
}

/// The centres of which these are the coordinates.
pub(super) fn centres(coordinates: &[f64]) -> Result<Vec<[f64; 3]>, String> {
    let (centres, _) = coordinates.as_chunks::<3>();
    let is_bad = |centre: &[f64; 3]| centre.iter().any(|it| !it.is_finite());
    match centres.iter().position(is_bad) {
        Some(point) => Err(format!("a coordinate of point {point} is not finite")),
        None => Ok(centres.to_vec()),
    }
}

/// The numbers of spheres that these values are.
pub(super) fn numbers(values: &[f64]) -> Result<Vec<u64>, String> {
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

/// The spheres of all pieces. They are numbered in their order, unless every piece has numbers.
pub(super) fn spheres(pieces: Vec<Points>) -> Spheres {
    let has_numbers = |piece: &Points| piece.numbers.is_some() || piece.centres.is_empty();
    let are_numbered = pieces.iter().all(has_numbers);
    let (mut centres, mut numbers) = (Vec::new(), Vec::new());
    for piece in pieces {
        centres.extend(piece.centres);
        numbers.extend(piece.numbers.into_iter().flatten());
    }
    Spheres {
        are_numbered,
        all: match are_numbered {
            true => numbers.into_iter().zip(centres).collect(),
            false => (0..).zip(centres).collect(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_have_the_numbers_of_their_bytes() {
        let all = [0xff_u8, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xfe];
        for (name, big, little) in [
            ("Int8", -1.0, -1.0),
            ("UInt8", 255.0, 255.0),
            ("Int16", -1.0, -1.0),
            ("UInt16", 65535.0, 65535.0),
            ("Int32", -1.0, -1.0),
            ("UInt32", 4294967295.0, 4294967295.0),
            ("Int64", -2.0, -72057594037927937.0),
            ("UInt64", 18446744073709551614.0, 18374686479671623679.0),
        ] {
            let kind = NumberType::of_xml(name).unwrap();
            assert_eq!(kind.values(&all, ByteOrder::Big)[0], big, "{name}");
            assert_eq!(kind.values(&all, ByteOrder::Little)[0], little, "{name}");
            assert_eq!(kind.values(&all, ByteOrder::Big).len(), 8 / kind.size());
        }
        let float = NumberType::of_legacy("FLOAT").unwrap();
        let bytes = 0.75_f32.to_be_bytes();
        assert_eq!(float.values(&bytes, ByteOrder::Big), [0.75]);
        assert_eq!(NumberType::of_legacy("string"), None);
    }

    #[test]
    fn numbers_are_whole() {
        assert_eq!(numbers(&[0.0, 7.0]), Ok(vec![0, 7]));
        for bad in [-1.0, 0.5, f64::NAN, f64::INFINITY, 9007199254740992.0] {
            assert!(numbers(&[bad]).is_err(), "{bad}");
        }
    }

    #[test]
    fn pieces_are_numbered_by_all_or_none() {
        let piece = |numbers: Option<Vec<u64>>| Points {
            centres: vec![[0.5; 3]],
            numbers,
        };
        let numbered = spheres(vec![piece(Some(vec![8])), Points::default()]);
        assert_eq!(numbered.all, [(8, [0.5; 3])]);
        assert!(numbered.are_numbered);
        let mixed = spheres(vec![piece(Some(vec![8])), piece(None)]);
        assert_eq!(mixed.all, [(0, [0.5; 3]), (1, [0.5; 3])]);
        assert!(!mixed.are_numbered);
    }
}
