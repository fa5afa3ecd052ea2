//! Errors that point into the text of an expression.

use std::ops::Range;
use thiserror::Error;

/// Characters of a long line that are shown before the wrong part, and from its start on.
const SHOWN: usize = 60;

/// Why an expression is refused.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{message}")]
pub struct ExpressionError {
    /// What is wrong.
    pub message: String,
    /// The part of the text that is wrong, in bytes.
    pub span: Range<usize>,
    /// What to do about it.
    pub help: String,
}

impl ExpressionError {
    pub(in crate::rule) fn new(
        message: impl Into<String>,
        span: Range<usize>,
        help: impl Into<String>,
    ) -> Self {
        Self {
            message: message.into(),
            span,
            help: help.into(),
        }
    }

    /// The same error in a text that has `offset` more bytes in front.
    pub(in crate::rule) fn moved(mut self, offset: usize) -> Self {
        self.span = self.span.start + offset..self.span.end + offset;
        self
    }

    /// Four lines: the message, the line of `text` with carets under the wrong part, and the help.
    pub fn render(&self, text: &str) -> String {
        let start = text.floor_char_boundary(self.span.start);
        let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let line = text[line_start..].lines().next().unwrap_or("");
        let (before, rest) = line.split_at((start - line_start).min(line.len()));
        let wrong = rest.floor_char_boundary(self.span.end.saturating_sub(start));

        let skipped = before.chars().count().saturating_sub(SHOWN);
        let before = before.chars().skip(skipped).map(printable);
        let before: String = "…".chars().take(skipped).chain(before).collect();
        let mut after: String = rest.chars().take(SHOWN).map(printable).collect();
        if rest.chars().nth(SHOWN).is_some() {
            after.push('…');
        }
        // A tab moves the caret as it moves the text above it.
        let indent: String = before
            .chars()
            .map(|character| if character == '\t' { '\t' } else { ' ' })
            .collect();
        let carets = "^".repeat(rest[..wrong].chars().count().clamp(1, SHOWN));
        let Self { message, help, .. } = self;
        let line = format!("  {before}{after}");
        format!("{message}\n{}\n  {indent}{carets}\n{help}", line.trim_end())
    }
}

/// A character that cannot steer a terminal.
fn printable(character: char) -> char {
    if character.is_control() && character != '\t' {
        char::REPLACEMENT_CHARACTER
    } else {
        character
    }
}
