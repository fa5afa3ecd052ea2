//! Why a run cannot be classified.

/// Why a run cannot be classified.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ClassifyError {
    /// A threshold of the sieves is out of range.
    #[error("`sieves.{key}` is {value}, but must be {expected}")]
    Threshold {
        /// The threshold, as `sieve.key`.
        key: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        expected: String,
    },
    /// Energy changes are measured in m g R, which the scene leaves undefined.
    #[error(
        "the settle sieve measures energy in m g R, and this scene has no {missing}: \
         give it `{key}`, or do not classify its runs"
    )]
    NoEnergyScale {
        /// What the scene lacks.
        missing: &'static str,
        /// The key that would supply it.
        key: &'static str,
    },
    /// The sieves of a silo count the grains that leave it, and none can.
    #[error(
        "the sieves of a silo count the grains that leave it, and this scene has no outlet: give \
         it `outlet.height`, or do not classify its runs"
    )]
    NoOutlet,
    /// The run did not count the rising spheres that the spout sieve asks for.
    #[error(
        "`sieves.spout.{key}` is {value}, but the run counted rising spheres for {counted:?} only: \
         choose one of these, or add {value} to `output.{list}` and run the scene again"
    )]
    NotCounted {
        /// The threshold of the spout sieve.
        key: &'static str,
        /// Its value.
        value: f64,
        /// The key of the scene's output table that lists what is counted.
        list: &'static str,
        /// What that list holds.
        counted: Vec<f64>,
    },
    /// A run may end before the window of a sieve is over.
    #[error(
        "`sieves.{sieve}.window` is {window} s, but runs end after {steady} s without a trend; use \
         `steady.window = {window}` in the scene, or a shorter window"
    )]
    SteadyTooShort {
        /// The sieve.
        sieve: &'static str,
        /// Its window (s).
        window: f64,
        /// Window of the scene's steady part (s).
        steady: f64,
    },
    /// The record lacks a column that a rule reads.
    #[error("the rule \"{rule}\" reads `{column}`, which this record lacks; run the scene again")]
    NoColumn {
        /// Name of the label or measure.
        rule: String,
        /// The column.
        column: String,
    },
    /// The record lacks columns that sieves read.
    #[error(
        "the sieves of a {family} read all its usual columns, and the scene records only those \
         that `output.usual` names; remove it and run the scene again"
    )]
    NoColumns {
        /// The family.
        family: &'static str,
    },
    /// A rule does not fit a record's scene.
    #[error("the rule \"{rule}\" does not fit the scene of this record: {reason}")]
    Rule {
        /// Name of the label or measure.
        rule: String,
        /// Why.
        reason: String,
    },
    /// The parts of a record contradict each other.
    #[error("the record contradicts itself: {0}; run the scene again")]
    Inconsistent(String),
}

crate::refusal::always!(true: ClassifyError);
