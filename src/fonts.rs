//! The fonts of figures and of labels in pictures, which are part of the program.

use std::sync::LazyLock;

/// DejaVu Sans (TTF).
// Statics, because the compiler puts one more copy of the file wherever it sees through a function that returns it.
pub(crate) static REGULAR: LazyLock<&[u8]> = LazyLock::new(dejavu::sans::regular);

/// DejaVu Sans, oblique (TTF).
pub(crate) static OBLIQUE: LazyLock<&[u8]> = LazyLock::new(dejavu::sans::oblique);
