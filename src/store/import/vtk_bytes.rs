//! Bytes of arrays in VTK XML: sizes before numbers, blocks compressed with zlib, base64.

use super::vtk_numbers::{ByteOrder, NumberType};
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use flate2::read::ZlibDecoder;
use std::io::Read as _;

/// How a file stores the bytes of its arrays.
pub(super) struct Coding {
    pub(super) order: ByteOrder,
    /// The type of the sizes before the numbers.
    pub(super) header: NumberType,
    pub(super) is_compressed: bool,
}

/// Where bytes of arrays come from.
pub(super) enum Source<'a> {
    Raw(&'a [u8]),
    Base64 {
        text: &'a [u8],
        /// What is decoded, but not yet taken.
        decoded: Vec<u8>,
    },
}

impl Coding {
    /// The bytes of an array, which must be so many.
    pub(super) fn bytes(&self, mut source: Source<'_>, wanted: usize) -> Result<Vec<u8>, String> {
        if self.is_compressed {
            return self.decompressed(source, wanted);
        }
        let size = self.size(&mut source)?;
        match size == wanted {
            true => source.take(wanted),
            false => Err(of_size(size, wanted)),
        }
    }

    /// The bytes of an array in compressed blocks. Before them stand their number, the size of a
    /// block before compression, that of the last if it is smaller, and the size of each after it.
    fn decompressed(&self, mut source: Source<'_>, wanted: usize) -> Result<Vec<u8>, String> {
        let mut size = || self.size(&mut source);
        let (blocks, block, last) = (size()?, size()?, size()?);
        let full = blocks.saturating_sub(usize::from(last > 0));
        let total = full.saturating_mul(block).saturating_add(last);
        if total != wanted {
            return Err(of_size(total, wanted));
        }
        let sizes = source.take(blocks.saturating_mul(self.header.size()))?;
        let mut bytes = Vec::new();
        for size in sizes.chunks_exact(self.header.size()) {
            let block = source.take(self.size(&mut Source::Raw(size))?)?;
            // One byte too many shows that there are too many.
            let room = (wanted - bytes.len().min(wanted)) as u64 + 1;
            let mut block = ZlibDecoder::new(&block[..]).take(room);
            let read = block.read_to_end(&mut bytes);
            read.map_err(|error| format!("it cannot be decompressed: {error}"))?;
        }
        match bytes.len() == wanted {
            true => Ok(bytes),
            false => Err(of_size(bytes.len(), wanted)),
        }
    }

    /// The size that comes next.
    fn size(&self, source: &mut Source<'_>) -> Result<usize, String> {
        let mut bytes = source.take(self.header.size())?;
        if self.order == ByteOrder::Big {
            bytes.reverse();
        }
        let size = bytes.iter().rev();
        let size = size.fold(0, |size: u64, byte| size << 8 | u64::from(*byte));
        usize::try_from(size).map_err(|_| format!("no array has {size} bytes"))
    }
}

impl<'a> Source<'a> {
    /// Bytes in base64 without spaces.
    pub(super) fn base64(text: &'a [u8]) -> Self {
        Self::Base64 {
            text,
            decoded: Vec::new(),
        }
    }

    /// The next so many bytes.
    fn take(&mut self, count: usize) -> Result<Vec<u8>, String> {
        const SHORT: &str = "its numbers are cut off; write or copy the file again";
        match self {
            Self::Raw(bytes) => {
                let taken = bytes.split_off(..count).ok_or(SHORT)?;
                Ok(taken.to_vec())
            }
            Self::Base64 { text, decoded } => {
                while decoded.len() < count {
                    // Four letters are three bytes. Where a header is encoded apart from what
                    // follows, it may end with padding.
                    let groups = (count - decoded.len()).div_ceil(3);
                    let length = groups.saturating_mul(4).min(text.len());
                    let padding = text[..length].iter().position(|it| *it == b'=');
                    let length = padding.map_or(length, |it| (it / 4 + 1) * 4);
                    let part = text.split_off(..length).filter(|it| !it.is_empty());
                    let bytes = BASE64_STANDARD.decode(part.ok_or(SHORT)?);
                    decoded.extend(bytes.map_err(|error| format!("it is no base64: {error}"))?);
                }
                let rest = decoded.split_off(count);
                Ok(std::mem::replace(decoded, rest))
            }
        }
    }
}

fn of_size(size: usize, wanted: usize) -> String {
    format!("it has {size} bytes, but its points need {wanted}")
}
