//! Archives as Python writes them: entries are stored or deflated, without encryption, and an
//! archive has less than 4 GiB.
//!
//! ```text
//! entries     each a local header, and the bytes
//! directory   of each entry: "PK\1\2", 6 bytes, flags u16, method u16, 4 bytes, checksum u32,
//!             packed size u32, size u32, lengths u16 of name, extra and comment, 8 bytes,
//!             start u32 of the local header; then name, extra and comment
//! end         "PK\5\6", 6 bytes, entries u16, size u32 and start u32 of the directory, length u16
//!             of the comment, comment
//! ```

use miniz_oxide::inflate::decompress_to_vec_with_limit;
use std::borrow::Cow;

const LOCAL: &[u8] = b"PK\x03\x04";
const DIRECTORY: &[u8] = b"PK\x01\x02";
const END: &[u8] = b"PK\x05\x06";
/// Bytes of these three without what has a length of its own.
const LOCAL_SIZE: usize = 30;
const DIRECTORY_SIZE: usize = 46;
const END_SIZE: usize = 22;

/// What to do about an archive that is cut short or damaged.
const DAMAGED: &str = "the program was stopped while it wrote, or the file is damaged: write it \
                       again with `numpy.savez`";

/// What is wrong with an archive, and what to do.
type ArchiveFault = (String, &'static str);

/// An entry of the directory.
pub(crate) struct Entry {
    /// The name of the file.
    pub(crate) name: String,
    flags: u16,
    method: u16,
    checksum: u32,
    packed: usize,
    size: usize,
    start: usize,
}

/// Whether a file is an archive.
pub(crate) fn is_archive(bytes: &[u8]) -> bool {
    bytes.starts_with(LOCAL) || bytes.starts_with(END)
}

/// The entries of an archive.
pub(crate) fn entries(bytes: &[u8]) -> Result<Vec<Entry>, ArchiveFault> {
    directory(bytes).ok_or_else(|| {
        (
            "the directory of the archive is missing or wrong".to_owned(),
            DAMAGED,
        )
    })
}

fn directory(bytes: &[u8]) -> Option<Vec<Entry>> {
    // The comment behind the end has at most 65535 bytes; NumPy writes none.
    let earliest = bytes.len().saturating_sub(END_SIZE + usize::from(u16::MAX));
    let end = bytes
        .get(earliest..)?
        .windows(END.len())
        .rposition(|it| it == END)?
        + earliest;
    let comment = usize::from(u16_at(bytes, end + 20)?);
    let count = u16_at(bytes, end + 10)?;
    let mut at = u32_at(bytes, end + 16)? as usize;
    let mut entries = Vec::new();
    let mut packed = 0_usize;
    for _ in 0..count {
        let header = bytes.get(at..at.checked_add(DIRECTORY_SIZE)?)?;
        if !header.starts_with(DIRECTORY) {
            return None;
        }
        let length = |place| u16_at(header, place).map(usize::from);
        let (name, rest) = (length(28)?, length(30)? + length(32)?);
        let name_start = at + DIRECTORY_SIZE;
        let name_end = name_start + name;
        let name = bytes.get(name_start..name_end)?;
        entries.push(Entry {
            name: String::from_utf8_lossy(name).into_owned(),
            flags: u16_at(header, 8)?,
            method: u16_at(header, 10)?,
            checksum: u32_at(header, 16)?,
            packed: u32_at(header, 20)? as usize,
            size: u32_at(header, 24)? as usize,
            start: u32_at(header, 42)? as usize,
        });
        at = name_end + rest;
        // Entries that overlap would be unpacked again and again.
        packed = packed.saturating_add(u32_at(header, 20)? as usize);
    }
    let is_whole = packed <= bytes.len() && bytes.len() >= end + END_SIZE + comment;
    is_whole.then_some(entries)
}

impl Entry {
    /// The bytes of the file, if there are no more than `most`.
    pub(crate) fn unpack<'b>(
        &self,
        bytes: &'b [u8],
        most: usize,
    ) -> Result<Cow<'b, [u8]>, ArchiveFault> {
        if self.flags & 1 != 0 {
            return Err(("it is encrypted".to_owned(), "save it without a password"));
        }
        if self.size > most {
            let message = format!("{} bytes when unpacked are more than are read", self.size);
            return Err((
                message,
                "let the program write fewer rows, or raise the limit",
            ));
        }
        let packed = self
            .packed(bytes)
            .ok_or_else(|| damaged("it is not where it should be"))?;
        let unpacked = match self.method {
            0 => Cow::Borrowed(packed),
            8 => decompress_to_vec_with_limit(packed, self.size)
                .map(Cow::Owned)
                .map_err(|_| damaged("it cannot be unpacked"))?,
            method => {
                let message = format!("it is packed by the method {method} of ZIP");
                return Err((
                    message,
                    "write it with `numpy.savez` or `numpy.savez_compressed`",
                ));
            }
        };
        let is_whole = unpacked.len() == self.size && crc32fast::hash(&unpacked) == self.checksum;
        match is_whole {
            true => Ok(unpacked),
            false => Err(damaged("its checksum is another one")),
        }
    }

    fn packed<'b>(&self, bytes: &'b [u8]) -> Option<&'b [u8]> {
        let header = bytes.get(self.start..self.start.checked_add(LOCAL_SIZE)?)?;
        let length = |place| u16_at(header, place).map(usize::from);
        let start = self.start + LOCAL_SIZE + length(26)? + length(28)?;
        let data = bytes.get(start..start.checked_add(self.packed)?)?;
        header.starts_with(LOCAL).then_some(data)
    }
}

fn damaged(message: &str) -> ArchiveFault {
    (message.to_owned(), DAMAGED)
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    let two = bytes.get(at..)?.first_chunk()?;
    Some(u16::from_le_bytes(*two))
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..)?.first_chunk()?;
    Some(u32::from_le_bytes(*four))
}
