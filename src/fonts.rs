//! The fonts of figures and of labels in pictures, which are part of the program.

use ab_glyph::{Font, FontRef};
use resvg::usvg::Options;
use resvg::usvg::fontdb::{Database, Source};
use std::sync::{Arc, LazyLock};

/// Their family.
pub(crate) const FAMILY: &str = "DejaVu Sans";

/// DejaVu Sans (TTF).
// Statics, because the compiler puts one more copy of the file wherever it sees through a function
// that returns it.
pub(crate) static REGULAR: LazyLock<&[u8]> = LazyLock::new(dejavu::sans::regular);

/// DejaVu Sans, oblique (TTF).
pub(crate) static OBLIQUE: LazyLock<&[u8]> = LazyLock::new(dejavu::sans::oblique);

/// The letters of a text that the fonts lack, each once.
pub(crate) fn lacking(text: &str) -> Vec<char> {
    static FONT: LazyLock<Option<FontRef<'static>>> =
        LazyLock::new(|| FontRef::try_from_slice(*REGULAR).ok());
    let mut lacking: Vec<char> = Vec::new();
    for letter in text.chars().filter(|letter| !letter.is_whitespace()) {
        let is_there = |font: &FontRef<'_>| font.glyph_id(letter).0 != 0;
        if !lacking.contains(&letter) && !FONT.as_ref().is_none_or(is_there) {
            lacking.push(letter);
        }
    }
    lacking
}

/// How an SVG is read that is drawn with these fonts.
pub(crate) fn svg_options() -> Options<'static> {
    static DATABASE: LazyLock<Arc<Database>> = LazyLock::new(|| {
        let mut database = Database::new();
        for font in [*REGULAR, *OBLIQUE] {
            database.load_font_source(Source::Binary(Arc::new(font)));
        }
        Arc::new(database)
    });
    Options {
        font_family: FAMILY.to_owned(),
        fontdb: Arc::clone(&DATABASE),
        ..Options::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_that_the_font_lacks_are_named() {
        assert!(lacking("Ω_c ≈ 10⁻⁵ × √g, «Größe» Ελλάδα").is_empty());
        assert_eq!(lacking("spouts 漏斗, 漏"), ['漏', '斗']);
    }
}
