//! Measures of a run: columns of `labels.csv`, and maps.

/// A measure of a run, a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measure {
    /// Name of its column in `labels.csv`; its map has dashes in place of underscores.
    pub name: &'static str,
    /// What it is, in full.
    pub description: &'static str,
    /// What it is, in a word or two with the markup of figures.
    pub quantity: &'static str,
    /// Unit; empty for a pure number.
    pub unit: &'static str,
    /// The values that it can have.
    pub range: MeasureRange,
    /// Whether it says how clearly a sieve decided, and not what the run did.
    pub is_evidence: bool,
}

/// The values that a measure can have, which decides how a figure shows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasureRange {
    /// Any, mostly positive.
    Any,
    /// Zero is the middle.
    Signed,
    /// From 0 to 1: how many of a number, which may be all or none by chance.
    Share,
    /// From 0 to 1: how much of something.
    Part,
}

/// A measure of what a run did.
pub(super) const fn measured(quantity: &'static str, unit: &'static str) -> Measure {
    Measure {
        name: "",
        description: "",
        quantity,
        unit,
        range: MeasureRange::Any,
        is_evidence: false,
    }
}

/// A measure of how clearly a sieve decided.
pub(super) const fn evidence(quantity: &'static str, unit: &'static str) -> Measure {
    Measure {
        is_evidence: true,
        ..measured(quantity, unit)
    }
}

impl Measure {
    /// The same with zero in the middle.
    pub(super) const fn signed(self) -> Self {
        Self {
            range: MeasureRange::Signed,
            ..self
        }
    }

    /// The same from 0 to 1, how many.
    pub(super) const fn share(self) -> Self {
        Self {
            range: MeasureRange::Share,
            ..self
        }
    }

    /// The same from 0 to 1, how much.
    pub(super) const fn part(self) -> Self {
        Self {
            range: MeasureRange::Part,
            ..self
        }
    }
}

/// Declares measures once: a struct with a field for each, their list `MEASURES`, and `values` in
/// the order of that list. A field's doc comment is the measure's description.
macro_rules! measures {
    (
        $(#[$about:meta])*
        struct $Name:ident {
            $($(#[doc = $description:literal])+ $field:ident: $measure:expr,)+
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Debug, Default, PartialEq)]
        pub(super) struct $Name {
            $($(#[doc = $description])+ pub(super) $field: Option<f64>,)+
        }

        impl $Name {
            /// What is measured, in the order of the columns.
            pub(super) const MEASURES: &'static [$crate::classify::Measure] = &[
                $($crate::classify::Measure {
                    name: stringify!($field),
                    description: concat!($($description),+),
                    ..$measure
                }),+
            ];

            /// The values, in the order of the columns.
            pub(super) fn values(&self) -> Vec<Option<f64>> {
                vec![$(self.$field),+]
            }
        }
    };
}
pub(super) use measures;
