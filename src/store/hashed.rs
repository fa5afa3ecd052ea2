//! A file whose content is hashed on the way.

use std::io::{self, Write};

/// A file whose content is hashed on the way.
pub(super) struct Hashed<'a, W> {
    file: &'a mut W,
    hasher: blake3::Hasher,
    /// The failure of the file, which whoever writes may not hand on.
    failure: Option<io::Error>,
}

impl<'a, W: Write> Hashed<'a, W> {
    /// That of a file so far empty.
    pub(super) fn new(file: &'a mut W) -> Self {
        Self {
            file,
            hasher: blake3::Hasher::new(),
            failure: None,
        }
    }

    /// Ends the content after what somebody wrote, who may have failed: a mark follows it, then its hash.
    ///
    /// # Errors
    /// The failure of the file, or else of whoever wrote.
    pub(super) fn seal(self, written: io::Result<()>, mark: &[u8]) -> io::Result<()> {
        let Self {
            file,
            hasher,
            failure,
        } = self;
        if let Some(failure) = failure {
            return Err(failure);
        }
        written?;
        file.write_all(mark)?;
        file.write_all(hasher.finalize().as_bytes())
    }
}

impl<W: Write> Write for Hashed<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.file.write(bytes) {
            Ok(count) => {
                self.hasher.update(&bytes[..count]);
                Ok(count)
            }
            Err(error) => {
                let kind = error.kind();
                self.failure = Some(error);
                Err(kind.into())
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}
