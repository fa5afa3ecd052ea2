//! Marks in texts, which stand for values: `@{name}`. `@@{` stands for `@{`.
//!
//! The sign is none of Python's, LAMMPS's or JSON's: a decorator of Python has a name behind `@`,
//! LAMMPS writes `${name}`, and JSON and C have `@` in texts only.

use std::ops::Range;

/// How a mark begins.
const OPEN: &str = "@{";

/// The marks of a text.
pub(crate) struct Marks<'a> {
    text: &'a str,
    at: usize,
}

/// A piece of a text.
#[derive(Debug, PartialEq)]
pub(crate) enum TextPiece<'a> {
    /// As it is written.
    Plain(&'a str),
    /// A mark with this name, at this place (bytes).
    Mark(&'a str, Range<usize>),
    /// A mark without an end, at this place (bytes).
    Open(Range<usize>),
}

impl TextPiece<'_> {
    /// Whether a value takes its place.
    pub(crate) fn is_mark(&self) -> bool {
        !matches!(self, Self::Plain(_))
    }
}

impl<'a> Marks<'a> {
    /// The pieces of a text, in order.
    pub(crate) fn of(text: &'a str) -> Self {
        Self { text, at: 0 }
    }
}

impl<'a> Iterator for Marks<'a> {
    type Item = TextPiece<'a>;

    fn next(&mut self) -> Option<TextPiece<'a>> {
        let rest = &self.text[self.at..];
        let Some(place) = rest.find(OPEN) else {
            self.at = self.text.len();
            return (!rest.is_empty()).then_some(TextPiece::Plain(rest));
        };
        if rest[..place].ends_with('@') {
            // The sign itself, without the one that says so.
            if place > 1 {
                self.at += place - 1;
                return Some(TextPiece::Plain(&rest[..place - 1]));
            }
            self.at += place + OPEN.len();
            return Some(TextPiece::Plain(OPEN));
        }
        if place > 0 {
            self.at += place;
            return Some(TextPiece::Plain(&rest[..place]));
        }
        let inside = &rest[OPEN.len()..];
        let line = inside.find('\n').unwrap_or(inside.len());
        let Some(end) = inside[..line].find('}') else {
            let place = self.at..self.at + OPEN.len() + line;
            self.at = place.end;
            return Some(TextPiece::Open(place));
        };
        let place = self.at..self.at + OPEN.len() + end + 1;
        self.at = place.end;
        Some(TextPiece::Mark(inside[..end].trim(), place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn marks_are_found_and_what_is_no_mark_stays() {
        let pieces = |text: &'static str| Marks::of(text).collect::<Vec<_>>();
        assert_eq!(pieces(""), []);
        assert_eq!(
            pieces("a @{b} @@{c} @{ d }"),
            [
                TextPiece::Plain("a "),
                TextPiece::Mark("b", 2..6),
                TextPiece::Plain(" "),
                TextPiece::Plain("@{"),
                TextPiece::Plain("c} "),
                TextPiece::Mark("d", 13..19),
            ]
        );
        assert_eq!(
            pieces("@@{x"),
            [TextPiece::Plain("@{"), TextPiece::Plain("x")]
        );
        assert_eq!(
            pieces("@{x\n}"),
            [TextPiece::Open(0..3), TextPiece::Plain("\n}")]
        );
        let others = "${x} @decorator {\"a\": 1} f'{x}' %(x)s @ {x}";
        assert_eq!(pieces(others), [TextPiece::Plain(others)]);
    }

    proptest! {
        /// A text without marks stays as it is, and any text is taken apart without an end missing.
        #[test]
        fn pieces_cover_the_text(text in "[@{}a\n ]{0,30}") {
            let mut joined = String::new();
            for piece in Marks::of(&text) {
                match piece {
                    TextPiece::Plain("@{") => joined += "@@{",
                    TextPiece::Plain(plain) => joined += plain,
                    TextPiece::Mark(_, place) | TextPiece::Open(place) => joined += &text[place],
                }
            }
            prop_assert_eq!(joined, text);
        }
    }
}
