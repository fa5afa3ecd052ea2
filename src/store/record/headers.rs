//! The object headers of an HDF5 file that `hdf5-pure` writes: where they are, and how to put other
//! attributes in the place of some.
//!
//! All headers stand at the beginning of the file, before the data. They are of version 2, each in
//! one piece (HDF5 File Format Specification Version 3.0, IV.A.1.b).

use super::attributes::is_named;
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::num::Wrapping;
use std::ops::Range;

/// Where the superblock keeps the end of the file, the place of the root group, and its checksum.
const END_OF_FILE: usize = 28;
const ROOT_GROUP: usize = 36;
const SUPERBLOCK: usize = 44;

/// Kinds of messages.
const LINK_INFO: u8 = 0x02;
const LINK: u8 = 0x06;
const ATTRIBUTE: u8 = 0x0c;

/// Why headers cannot be read.
#[derive(Debug)]
pub(super) enum Unread {
    /// The beginning of the file must be at least so long (bytes).
    Short(usize),
    /// They are not as `hdf5-pure` writes them.
    Other(&'static str),
}

/// The header of an object.
#[derive(Clone, Debug)]
pub(super) struct Header {
    /// What its checksum covers; the checksum follows.
    place: Range<usize>,
    /// Kind and place of each message.
    messages: Vec<(u8, Range<usize>)>,
}

impl Header {
    fn read(head: &[u8], start: usize) -> Result<Self, Unread> {
        let prefix = part(head, start, 6)?;
        let width = match (&prefix[..5], prefix[5]) {
            (b"OHDR\x02", flags @ 0..=2) => 1 << flags,
            _ => return Err(Unread::Other("an object header is of another kind")),
        };
        let first = start + 6 + width;
        let end = first + number(part(head, start + 6, width)?);
        part(head, start, end + 4 - start)?;
        let mut messages = Vec::new();
        let mut at = first;
        while at + 4 <= end {
            let content = at + 4..at + 4 + number(&head[at + 1..at + 3]);
            if content.end > end {
                return Err(Unread::Other("a message is longer than its header"));
            }
            at = content.end;
            messages.push((head[content.start - 4], content));
        }
        let place = start..end;
        Ok(Self { place, messages })
    }

    /// Address of the object.
    pub(super) fn address(&self) -> u64 {
        self.place.start as u64
    }

    fn is_group(&self) -> bool {
        self.messages.iter().any(|(kind, _)| *kind == LINK_INFO)
    }

    /// Names of the objects of a group, and where their headers are, the last header first: it
    /// says best how long the beginning of the file must be.
    fn links(&self, head: &[u8]) -> Result<Vec<(String, usize)>, Unread> {
        let links = self.messages.iter().filter(|(kind, _)| *kind == LINK);
        let link = |(_, content): &(u8, Range<usize>)| {
            let content = &head[content.clone()];
            let odd = Unread::Other("a link is of another kind");
            let [1, flags @ 0..=2, ..] = *content else {
                return Err(odd);
            };
            let first = 2 + (1 << flags);
            let length = content.get(2..first).map_or(0, number);
            match (
                content.get(first..first + length),
                content.get(first + length..),
            ) {
                (Some(name), Some(address)) if address.len() == 8 => {
                    Ok((String::from_utf8_lossy(name).into_owned(), number(address)))
                }
                _ => Err(odd),
            }
        };
        let mut links = links.map(link).collect::<Result<Vec<_>, _>>()?;
        links.sort_by_key(|(_, address)| Reverse(*address));
        Ok(links)
    }

    /// Puts an attribute in the place of one with the same name and length.
    pub(super) fn replace(&self, head: &mut [u8], message: &[u8]) -> Result<(), Unread> {
        let mut attributes = self.messages.iter().filter(|(kind, _)| *kind == ATTRIBUTE);
        let place = attributes.find(|(_, content)| is_named(&head[content.clone()], message));
        match place {
            Some((_, content)) if content.len() == message.len() => {
                head[content.clone()].copy_from_slice(message);
                write_checksum(head, self.place.clone());
                Ok(())
            }
            _ => Err(Unread::Other(
                "an attribute has no placeholder of its length",
            )),
        }
    }
}

/// The headers of all datasets in the root group and the groups there, by path.
pub(super) fn datasets(head: &[u8]) -> Result<BTreeMap<String, Header>, Unread> {
    let root = Header::read(head, number(part(head, ROOT_GROUP, 8)?))?;
    let mut found = BTreeMap::new();
    for (name, address) in root.links(head)? {
        let object = Header::read(head, address)?;
        if !object.is_group() {
            found.insert(name, object);
            continue;
        }
        for (inner, address) in object.links(head)? {
            found.insert(format!("{name}/{inner}"), Header::read(head, address)?);
        }
    }
    Ok(found)
}

/// The length of the file, according to its superblock.
pub(super) fn length(head: &[u8]) -> Result<u64, Unread> {
    Ok(number(part(head, END_OF_FILE, 8)?) as u64)
}

/// Makes the superblock say that the file is so long.
pub(super) fn set_length(head: &mut [u8], length: u64) {
    head[END_OF_FILE..END_OF_FILE + 8].copy_from_slice(&length.to_le_bytes());
    write_checksum(head, 0..SUPERBLOCK);
}

fn part(head: &[u8], start: usize, length: usize) -> Result<&[u8], Unread> {
    let end = start.saturating_add(length);
    head.get(start..end).ok_or(Unread::Short(end))
}

/// A number with its lowest byte first.
fn number(bytes: &[u8]) -> usize {
    let digits = bytes.iter().rev();
    digits.fold(0, |number, &byte| (number << 8) | usize::from(byte))
}

fn write_checksum(head: &mut [u8], place: Range<usize>) {
    let sum = checksum(&head[place.clone()]).to_le_bytes();
    head[place.end..place.end + 4].copy_from_slice(&sum);
}

/// Bob Jenkins' `lookup3`, which guards the headers of HDF5.
fn checksum(bytes: &[u8]) -> u32 {
    let seed = Wrapping(0xdead_beef_u32) + Wrapping(bytes.len() as u32);
    let mut state = [seed; 3];
    let mut rest = bytes;
    while rest.len() > 12 {
        let (block, behind) = rest.split_at(12);
        add(&mut state, block);
        mix(&mut state);
        rest = behind;
    }
    if !rest.is_empty() {
        let mut block = [0; 12];
        block[..rest.len()].copy_from_slice(rest);
        add(&mut state, &block);
        finish(&mut state);
    }
    state[2].0
}

fn add(state: &mut [Wrapping<u32>; 3], block: &[u8]) {
    for (part, bytes) in state.iter_mut().zip(block.chunks(4)) {
        *part += number(bytes) as u32;
    }
}

fn mix(state: &mut [Wrapping<u32>; 3]) {
    // The first is mixed with the last, and the one between them is added to the last.
    for (first, turn) in [(0, 4), (1, 6), (2, 8), (0, 16), (1, 19), (2, 4)] {
        let [last, between] = [(first + 2) % 3, (first + 1) % 3];
        state[first] -= state[last];
        state[first] ^= state[last].0.rotate_left(turn);
        let sum = state[between];
        state[last] += sum;
    }
}

fn finish(state: &mut [Wrapping<u32>; 3]) {
    let turns = [(2, 14), (0, 11), (1, 25), (2, 16), (0, 4), (1, 14), (2, 24)];
    for (first, turn) in turns {
        let before = state[(first + 2) % 3];
        state[first] ^= before;
        state[first] -= before.0.rotate_left(turn);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The examples in Bob Jenkins' `lookup3.c`, and one that needs more than a block.
    #[test]
    fn the_checksum_is_that_of_hdf5() {
        assert_eq!(checksum(b""), 0xdead_beef);
        assert_eq!(checksum(b"Four score and seven years ago"), 0x1777_0551);
    }

    #[test]
    fn a_beginning_that_is_too_short_says_how_long_it_must_be() {
        let mut file = hdf5_pure::FileBuilder::new();
        file.create_dataset("values").with_f64_data(&[1.0, 2.0]);
        let bytes = file.finish().unwrap();
        let mut asked = 0;
        let headers = loop {
            match datasets(&bytes[..asked]) {
                Err(Unread::Short(more)) if more > asked => asked = more,
                other => break other.unwrap(),
            }
        };
        assert_eq!(headers.keys().collect::<Vec<_>>(), ["values"]);
        assert!(asked < bytes.len());
        assert_eq!(length(&bytes).unwrap(), bytes.len() as u64);
    }

    #[test]
    fn what_is_no_header_is_refused() {
        let mut bytes = hdf5_pure::FileBuilder::new().finish().unwrap();
        bytes[SUPERBLOCK + 4] = b'X';
        assert!(matches!(datasets(&bytes), Err(Unread::Other(_))));
    }
}
