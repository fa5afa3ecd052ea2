//! A file whose content is hashed on the way.

use std::io::{self, Write};

/// A file whose content is hashed on the way.
pub(super) struct Hashed<'a, W> {
    file: &'a mut W,
    hasher: blake3::Hasher,
    /// The failure of the file, which the writer may not pass on.
    failure: Option<io::Error>,
}

impl<'a, W: Write> Hashed<'a, W> {
    /// A hashed file, which is empty so far.
    pub(super) fn new(file: &'a mut W) -> Self {
        Self {
            file,
            hasher: blake3::Hasher::new(),
            failure: None,
        }
    }

    /// Ends the content: a mark follows it, then its hash. `written` is the result of the writer.
    ///
    /// # Errors
    /// The failure of the file, or else of the writer.
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
        let result = self.file.write(bytes);
        let count = self.noted(result)?;
        self.hasher.update(&bytes[..count]);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        let result = self.file.flush();
        self.noted(result)
    }
}

impl<W> Hashed<'_, W> {
    /// The result. A failure is kept, except an interruption, after which writers try again.
    fn noted<T>(&mut self, result: io::Result<T>) -> io::Result<T> {
        result.map_err(|error| {
            let kind = error.kind();
            if kind != io::ErrorKind::Interrupted {
                self.failure = Some(error);
            }
            kind.into()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use io::ErrorKind::{Interrupted, StorageFull};

    /// A disk that is interrupted once, and turns out to be full when it is flushed.
    #[derive(Default)]
    struct Disk {
        content: Vec<u8>,
        was_interrupted: bool,
        is_full: bool,
    }

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if !std::mem::replace(&mut self.was_interrupted, true) {
                return Err(Interrupted.into());
            }
            self.content.extend_from_slice(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            match self.is_full {
                true => Err(StorageFull.into()),
                false => Ok(()),
            }
        }
    }

    fn write(disk: &mut Disk) -> io::Result<()> {
        let mut hashed = Hashed::new(disk);
        let written = hashed.write_all(b"content").and_then(|()| hashed.flush());
        // Whoever writes says no more than that it failed.
        let written = written.map_err(|_| io::Error::other("failed"));
        hashed.seal(written, b"mark")
    }

    #[test]
    fn the_hash_follows_the_content_whatever_interrupts() {
        let mut disk = Disk::default();
        write(&mut disk).unwrap();
        let hash = blake3::hash(b"content");
        assert_eq!(
            disk.content,
            [b"contentmark", &hash.as_bytes()[..]].concat()
        );
    }

    #[test]
    fn a_full_disk_is_named_wherever_it_shows() {
        let mut disk = Disk {
            is_full: true,
            ..Disk::default()
        };
        assert_eq!(write(&mut disk).unwrap_err().kind(), StorageFull);
    }
}
