//! Whose fault an error is: what a program needs to know to choose its exit code.

use std::fmt::Display;

/// An error that is either a refusal or a failure.
pub trait Refusal: Display {
    /// Whether the request was at fault and nothing was begun: a wrong file, a folder in use.
    /// Otherwise something failed, such as the disk.
    fn is_refusal(&self) -> bool;
}

/// Implements [`Refusal`] for errors that are all refusals (`true`) or all failures (`false`).
macro_rules! always {
    ($is_refusal:literal: $($error:ty),+) => {$(
        impl $crate::refusal::Refusal for $error {
            fn is_refusal(&self) -> bool {
                $is_refusal
            }
        }
    )+};
}

pub(crate) use always;

// No threads, or no picture: errors of other crates.
always!(false: rayon::ThreadPoolBuildError, png::EncodingError, gif::EncodingError);
