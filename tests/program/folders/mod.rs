//! Folders of results: several at once, and folders that hold files of other programs.

mod failures;
mod foreign;
mod several;
