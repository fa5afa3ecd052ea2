//! The fonts of figures and of labels in pictures, which are part of the program.

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
