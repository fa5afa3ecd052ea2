//! Lines, words and bytes of legacy files of VTK.

use super::vtk_numbers::NumberType;
use crate::store::StoreError;
use std::path::Path;
use std::str::FromStr;

/// What is still to be read of a file.
pub(super) struct Reader<'a> {
    path: &'a Path,
    rest: &'a [u8],
    /// Ends of lines so far.
    ends: u64,
    /// Of the latest line or word, from 1.
    line: u64,
    /// The latest array of bytes. From the first one on lines cannot be counted.
    array: Option<String>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(path: &'a Path, bytes: &'a [u8]) -> Self {
        Self {
            path,
            rest: bytes,
            ends: 0,
            line: 0,
            array: None,
        }
    }

    /// The next line without spaces around it, or nothing at the end.
    pub(super) fn line(&mut self) -> &'a [u8] {
        self.line = self.ends + 1;
        let end = self.rest.iter().position(|it| *it == b'\n');
        let line = self.pass(end.map_or(self.rest.len(), |it| it + 1));
        line.trim_ascii()
    }

    /// The words of the next line that is not blank.
    pub(super) fn words(&mut self) -> Result<Option<Vec<&'a str>>, StoreError> {
        if self.is_at_end() {
            return Ok(None);
        }
        let line = self.line();
        let line = self.text(line)?;
        Ok(Some(line.split_ascii_whitespace().collect()))
    }

    /// The next word.
    pub(super) fn word(&mut self) -> Result<&'a str, StoreError> {
        if self.is_at_end() {
            return Err(self.ends_early());
        }
        self.line = self.ends + 1;
        let end = self.rest.iter().position(u8::is_ascii_whitespace);
        let word = self.pass(end.unwrap_or(self.rest.len()));
        self.text(word)
    }

    /// The next so many bytes, of an array.
    pub(super) fn bytes(&mut self, array: &str, count: usize) -> Result<&'a [u8], StoreError> {
        if self.array.as_deref() != Some(array) {
            self.array = Some(array.to_owned());
        }
        let bytes = self.rest.split_off(..count);
        bytes.ok_or_else(|| self.ends_early())
    }

    /// Does this word, in capitals, come next?
    pub(super) fn is_next(&self, word: &str) -> bool {
        let next = self.rest.get(..word.len());
        next.is_some_and(|it| it.eq_ignore_ascii_case(word.as_bytes()))
    }

    pub(super) fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// Passes over spaces. Is that all that is left?
    fn is_at_end(&mut self) -> bool {
        let space = self.rest.len() - self.rest.trim_ascii_start().len();
        self.pass(space);
        self.rest.is_empty()
    }

    fn pass(&mut self, count: usize) -> &'a [u8] {
        let (passed, rest) = self.rest.split_at(count);
        self.rest = rest;
        self.ends += passed.split(|it| *it == b'\n').count() as u64 - 1;
        passed
    }

    fn text(&self, bytes: &'a [u8]) -> Result<&'a str, StoreError> {
        str::from_utf8(bytes).map_err(|_| self.refuse("text is expected, but here are other bytes"))
    }

    pub(super) fn number<V: FromStr>(&self, word: &str, what: &str) -> Result<V, StoreError> {
        let number = word.parse();
        number.map_err(|_| self.refuse(&format!("`{}` is not {what}", short(word))))
    }

    pub(super) fn count(&self, word: &str) -> Result<usize, StoreError> {
        self.number(word, "a whole number from 0")
    }

    pub(super) fn kind(&self, word: &str) -> Result<Kind, StoreError> {
        match &word.to_ascii_lowercase()[..] {
            "bit" => Ok(Kind::Bits),
            "string" | "utf8_string" => Ok(Kind::Strings),
            name => match NumberType::of_legacy(name) {
                Some(kind) => Ok(Kind::Numbers(kind)),
                None => Err(self.refuse(&format!("`{}` is no type of VTK", short(word)))),
            },
        }
    }

    pub(super) fn product(&self, one: usize, other: usize) -> Result<usize, StoreError> {
        let product = one.checked_mul(other);
        product.ok_or_else(|| self.refuse("no file holds so many numbers"))
    }

    pub(super) fn ends_early(&self) -> StoreError {
        self.refuse("the file ends before its numbers do; write or copy it again")
    }

    /// An error in what was read last.
    pub(super) fn refuse(&self, reason: &str) -> StoreError {
        match &self.array {
            Some(array) => StoreError::array(self.path, array, reason),
            None => StoreError::text(self.path, self.line, reason),
        }
    }
}

/// What an array holds.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Numbers(NumberType),
    Bits,
    Strings,
}

/// The beginning of a word, for a message.
pub(super) fn short(word: &str) -> String {
    word.chars().take(30).collect()
}
