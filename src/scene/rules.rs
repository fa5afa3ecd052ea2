//! Labels and measures that a file states itself, as rules over the columns of a run.

use crate::document::unit;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A label that a rule gives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LabelRule {
    /// Name in tables and figures: small letters, digits and `-`.
    pub name: String,
    /// The condition, such as `min(height_mean) > 3 * spheres.radius`. The first label whose
    /// condition holds is the run's; without one it is `other`.
    pub when: String,
    /// The part of the run that counts. Absent: the whole run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over: Option<RuleWindow>,
    /// Colour in figures, such as `"#b03a2e"`. Absent: the next of a palette.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<String>,
}

/// A number of each run that a rule measures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasureRule {
    /// Name of its column in `labels.csv`: small letters, digits and `_`.
    pub name: String,
    /// The number, such as `max(height_mean) / spheres.radius`.
    pub value: String,
    /// The part of the run that counts. Absent: the whole run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over: Option<RuleWindow>,
    /// What figures call it. Absent: its name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantity: Option<String>,
}

/// The part of a run that a rule looks at: `{ last = 2.0 }`, `{ from = 1.0, to = 3.0 }`,
/// `{ any = 1.5 }` or `{ steady = true }`. In a run that is shorter nothing is known.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RuleWindow {
    /// The time before the end (s).
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = unit("s").above(0.0))]
    pub last: Option<f64>,
    /// From this time on (s).
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = unit("s").at_least(0.0))]
    pub from: Option<f64>,
    /// Until this time (s). Absent: the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = unit("s").above(0.0))]
    pub to: Option<f64>,
    /// A window of this length (s), anywhere in the run: a label's rule holds if it holds in one.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = unit("s").above(0.0))]
    pub any: Option<f64>,
    /// The steady part at the end, of a scene whose runs end when they are steady.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub steady: bool,
}
