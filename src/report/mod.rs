//! Pages about results: one file of HTML each, with its data, styles and scripts, and no network.
//!
//! What a page holds is a [`PageDocument`] of sections, which `page/README.md` describes and the
//! scripts in `page/` show. [`html`] puts both together.

mod codes;
mod document;
mod html;
mod records;
mod series;
mod states;
mod studies;
mod sweep;

pub use document::{
    AblationSection, AccuracySection, PageDocument, RecordsSection, Section, SweepSection,
};
pub use html::html;
pub use records::{NamedRecord, records};
pub use studies::study;
pub use sweep::{RecordReader, SweepResults, one_of_each_label, sweep};
