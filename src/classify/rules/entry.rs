//! Labels and measures as a file states them.

use super::window::RuleWindow;
use crate::document::Problem;
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

/// Longest name.
const LONGEST_NAME: usize = 40;

/// Whether a name begins with a small letter and goes on with these, digits and one sign.
pub(super) fn check_name(path: &str, name: &str, sign: char) -> Result<(), Problem> {
    let mut letters = name.chars();
    let begins_well = letters.next().is_some_and(|it| it.is_ascii_lowercase());
    let goes_on_well =
        letters.all(|it| it.is_ascii_lowercase() || it.is_ascii_digit() || it == sign);
    if begins_well && goes_on_well && name.len() <= LONGEST_NAME {
        return Ok(());
    }
    let message = format!("`{name}` is no name of a column or label");
    let help = format!(
        "use small letters, digits and `{sign}`, a letter first, {LONGEST_NAME} characters at most"
    );
    Err(Problem::new(path, message).help(help))
}

/// A colour such as `#b03a2e`.
pub(super) fn color(text: &str) -> Option<[u8; 3]> {
    let hex = text.strip_prefix('#').filter(|it| it.len() == 6)?;
    let number = u32::from_str_radix(hex, 16).ok()?;
    Some(crate::color::rgb(number))
}
