//! Attributes that `hdf5-pure` cannot write: those that make dimension scales of HDF5 datasets.
//!
//! As in the *HDF5 Dimension Scale Specification*. The bytes are messages of version 2 (HDF5 File
//! Format Specification Version 3.0, IV.A.2.m).

use hdf5_pure::AttrValue;

/// Type of the address of an object.
const REFERENCE: [u8; 8] = [0x17, 0, 0, 0, 8, 0, 0, 0];
/// Type of a list of such addresses, which stands in a heap.
const LIST_OF_REFERENCES: [u8; 8] = [0x19, 0, 0, 0, 16, 0, 0, 0];
/// Type of a whole number from 0 of four bytes.
const WHOLE: [u8; 12] = [0x10, 0, 0, 0, 4, 0, 0, 0, 0, 0, 32, 0];
/// The shape of a single value.
const SCALAR: [u8; 4] = [2, 0, 0, 0];
/// The bytes of a message before its name.
const SIZES: usize = 8;
/// The bytes of the type of a text.
const TEXT_TYPE: usize = 8;

/// What marks a dataset as a dimension scale.
pub(super) fn class() -> Vec<u8> {
    text("CLASS", "DIMENSION_SCALE")
}

/// The name of a dimension.
pub(super) fn name(name: &str) -> Vec<u8> {
    text("NAME", name)
}

/// The scales of a dataset, one for each of its axes: the entries of the heap at that address.
pub(super) fn dimension_list(heap: u64, entries: &[usize]) -> Vec<u8> {
    let kind = [LIST_OF_REFERENCES, REFERENCE].concat();
    let mut data = Vec::new();
    for &entry in entries {
        data.extend(1_u32.to_le_bytes());
        data.extend(heap.to_le_bytes());
        data.extend((entry as u32).to_le_bytes());
    }
    message("DIMENSION_LIST", &kind, &row(entries.len()), &data)
}

/// The datasets of a scale: their addresses, and which of their axes it is.
pub(super) fn reference_list(users: &[(u64, usize)]) -> Vec<u8> {
    // A compound of 16 bytes with two members, each with its name and its place in it.
    let head: &[u8] = &[0x36, 2, 0, 0, 16, 0, 0, 0];
    let members: [&[u8]; 4] = [b"dataset\0\0", &REFERENCE, b"dimension\0\x08", &WHOLE];
    let kind = [head, &members.concat()].concat();
    let mut data = Vec::new();
    for &(address, axis) in users {
        data.extend(address.to_le_bytes());
        data.extend((axis as u64).to_le_bytes());
    }
    message("REFERENCE_LIST", &kind, &row(users.len()), &data)
}

/// An attribute with that name that `hdf5-pure` writes, of the same length.
pub(super) fn placeholder(message: &[u8]) -> (String, AttrValue) {
    let name = name_of(message);
    let taken = SIZES + name.len() + TEXT_TYPE + SCALAR.len();
    let name = String::from_utf8_lossy(&name[..name.len() - 1]).into_owned();
    (
        name,
        AttrValue::AsciiString("-".repeat(message.len() - taken)),
    )
}

/// Whether two messages are attributes with the same name.
pub(super) fn is_named(message: &[u8], other: &[u8]) -> bool {
    name_of(message) == name_of(other)
}

/// The name of an attribute and the zero at its end.
fn name_of(message: &[u8]) -> &[u8] {
    let name = message.get(SIZES..).unwrap_or_default();
    let end = name.iter().position(|&byte| byte == 0);
    end.map_or(name, |end| &name[..=end])
}

/// A text with a zero at its end: the HDF5 library takes no other for the class of a scale.
fn text(name: &str, value: &str) -> Vec<u8> {
    let data = [value.as_bytes(), &[0]].concat();
    let kind = [&[0x13, 0, 0, 0], &(data.len() as u32).to_le_bytes()[..]].concat();
    message(name, &kind, &SCALAR, &data)
}

/// The shape of a row of values.
fn row(length: usize) -> [u8; 12] {
    let mut shape = [2, 1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0];
    shape[4..].copy_from_slice(&(length as u64).to_le_bytes());
    shape
}

fn message(name: &str, kind: &[u8], shape: &[u8], data: &[u8]) -> Vec<u8> {
    let name = [name.as_bytes(), &[0]].concat();
    let mut message = vec![2, 0];
    for part in [&name, kind, shape] {
        message.extend((part.len() as u16).to_le_bytes());
    }
    for part in [&name, kind, shape, data] {
        message.extend(part);
    }
    message
}
