//! One axis of a sweep.

use super::spacing::{self, MOST_VALUES};
use super::{VARIANT, Variant};
use crate::document::unit;
use crate::document::{Problem, number, one_of};
use crate::refine::Borders;
use crate::scene::{Scene, leaf};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One axis of a sweep: a numeric key of the scene and the values it takes, or variants of the
/// scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Path of the key, such as `spheres.radius`; [`VARIANT`] of variants.
    pub key: String,
    /// Short name, such as `radius`: the column of labels.csv.
    pub name: String,
    /// Values, in the key's SI unit; of variants their places among [`variants`](Self::variants).
    pub values: Vec<f64>,
    /// The variants of the scene, if the axis is not of numbers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub variants: Vec<Variant>,
}

impl Axis {
    /// The axis of a numeric key.
    pub fn of_numbers(key: impl Into<String>, name: impl Into<String>, values: Vec<f64>) -> Self {
        Self {
            key: key.into(),
            name: name.into(),
            values,
            variants: Vec::new(),
        }
    }

    /// The axis of variants.
    pub fn of_variants(variants: Vec<Variant>) -> Self {
        Self {
            key: VARIANT.to_owned(),
            name: VARIANT.to_owned(),
            values: (0..variants.len()).map(|place| place as f64).collect(),
            variants,
        }
    }

    /// Whether its values are variants.
    pub fn is_of_variants(&self) -> bool {
        !self.variants.is_empty()
    }

    /// The variant of a value, if it is one.
    pub fn variant(&self, value: f64) -> Option<&Variant> {
        self.variants.get(value as usize)
    }

    /// A value as tables and messages show it: a number, or the name of a variant.
    pub fn word(&self, value: f64) -> String {
        self.variant(value)
            .map_or_else(|| value.to_string(), |variant| variant.name.clone())
    }

    /// The value that is the variant of that name.
    pub fn place_of(&self, name: &str) -> Option<f64> {
        let place = self.variants.iter().position(|it| it.name == name)?;
        Some(place as f64)
    }

    /// All values as messages show them.
    pub fn words(&self) -> Vec<String> {
        self.values.iter().map(|value| self.word(*value)).collect()
    }
}

/// An axis as a sweep file writes it: `values`, or `from` and `to` with `step` or `count`.
#[derive(Deserialize, JsonSchema)]
pub(crate) struct AxisEntry {
    /// Any numeric key of the scene, by its path, such as `spheres.radius`.
    key: String,
    /// Name in tables and figures. Default: the last part of the key, such as `radius`.
    name: Option<String>,
    /// All values one by one, in the unit of the key. Give these, or `from` and `to` with `step`
    /// or `count`.
    #[schemars(transform = unit("of the key"))]
    values: Option<Vec<f64>>,
    /// First value, in the unit of the key.
    #[schemars(transform = unit("of the key"))]
    from: Option<f64>,
    /// Last value, in the unit of the key.
    #[schemars(transform = unit("of the key"))]
    to: Option<f64>,
    /// Distance between values, in the unit of the key.
    #[schemars(transform = unit("of the key").above(0.0))]
    step: Option<f64>,
    /// Number of values, in place of `step`.
    #[schemars(range(min = 2))]
    count: Option<usize>,
    /// How `count` values lie between `from` and `to` (default `linear`).
    spacing: Option<Spacing>,
}

/// How `count` values lie between `from` and `to`.
#[derive(Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum Spacing {
    /// At equal distances.
    Linear,
    /// At equal ratios.
    Log,
}

/// Other columns in the tables of results than those of borders; no axis may have such a name.
const RESERVED: [&str; 10] = [
    VARIANT,
    "id",
    "setting",
    "seed",
    "seeds",
    "label",
    "code",
    "settle_time",
    "agreement",
    "steady",
];

impl AxisEntry {
    /// The axis of `scene` that stands at `path` in the sweep file.
    pub(crate) fn expand(&self, scene: &Scene, path: &str) -> Result<Axis, Problem> {
        let key = scene.resolve_key(&self.key).map_err(|problem| Problem {
            path: format!("{path}.key"),
            ..problem
        })?;
        let name = self.name.clone().unwrap_or_else(|| leaf(&key).to_owned());
        check_name(&name, path)?;
        let values = self.expand_values(path)?;
        Ok(Axis::of_numbers(key, name, values))
    }

    fn expand_values(&self, path: &str) -> Result<Vec<f64>, Problem> {
        let given = [
            ("from", self.from.is_some()),
            ("to", self.to.is_some()),
            ("step", self.step.is_some()),
            ("count", self.count.is_some()),
            ("spacing", self.spacing.is_some()),
        ];
        let given: Vec<&str> = given
            .iter()
            .filter(|(_, is)| *is)
            .map(|(name, _)| *name)
            .collect();
        match (&self.values, self.from, self.to) {
            (Some(values), ..) if given.is_empty() => check_values(values, path),
            (Some(_), ..) => {
                let message = format!("`values` and {} exclude each other", one_of(&given));
                let help = "keep the list, or the range";
                Err(Problem::new(format!("{path}.values"), message)
                    .help(help)
                    .at_key())
            }
            (None, Some(from), Some(to)) => self.expand_range(from, to, path),
            (None, ..) => {
                let message = "the axis does not say which values it takes";
                Err(Problem::new(path, message)
                    .help("add `values = [...]`, or `from`, `to` and `step` (or `count`)"))
            }
        }
    }

    fn expand_range(&self, from: f64, to: f64, path: &str) -> Result<Vec<f64>, Problem> {
        if from >= to {
            let message = format!(
                "`from` = {} must be below `to` = {}",
                number(from),
                number(to)
            );
            return Err(Problem::new(format!("{path}.from"), message).help("exchange the two"));
        }
        match (self.step, self.count) {
            (Some(step), None) => {
                if self.spacing == Some(Spacing::Log) {
                    let message = "logarithmic spacing has no constant step";
                    return Err(Problem::new(format!("{path}.step"), message)
                        .help("give `count` in place of `step`")
                        .at_key());
                }
                expand_steps(from, to, step, path)
            }
            (None, Some(count)) => {
                check_count(count as f64, &format!("{path}.count"))?;
                match self.spacing.unwrap_or(Spacing::Linear) {
                    Spacing::Linear => Ok(spacing::linear(from, to, count)),
                    Spacing::Log if from > 0.0 => Ok(spacing::logarithmic(from, to, count)),
                    Spacing::Log => {
                        let message = format!(
                            "logarithmic spacing needs `from` above 0, but it is {}",
                            number(from)
                        );
                        Err(Problem::new(format!("{path}.from"), message)
                            .help("start above 0, or use `spacing = \"linear\"`"))
                    }
                }
            }
            (Some(_), Some(_)) => {
                let message = "`step` and `count` exclude each other";
                Err(Problem::new(format!("{path}.count"), message)
                    .help("keep one of them")
                    .at_key())
            }
            (None, None) => Err(
                Problem::new(path, "the axis has neither `step` nor `count`")
                    .help("add `step = ...`, or `count = ...` for that many values"),
            ),
        }
    }
}

fn expand_steps(from: f64, to: f64, step: f64, path: &str) -> Result<Vec<f64>, Problem> {
    let path = format!("{path}.step");
    check_count((to - from) / step + 1.0, &path)?;
    match spacing::whole_steps(from, to, step) {
        Some(whole) if whole >= 1.0 => Ok(spacing::steps(from, step, whole as usize)),
        _ => {
            let message = format!(
                "steps of {} from {} do not end at {}",
                number(step),
                number(from),
                number(to)
            );
            let below = libm::floor((to - from) / step) as usize;
            let ends = spacing::steps(from, step, below + 1);
            let ends = if below == 0 {
                &ends[1..]
            } else {
                &ends[below..]
            };
            let ends: Vec<String> = ends
                .iter()
                .map(|end| format!("`to = {}`", number(*end)))
                .collect();
            Err(Problem::new(path, message).help(format!("use {}", ends.join(" or "))))
        }
    }
}

fn check_count(count: f64, path: &str) -> Result<(), Problem> {
    if count <= MOST_VALUES as f64 {
        return Ok(());
    }
    let message = format!("the axis would have {count:.0} values");
    Err(Problem::new(path, message).help(format!(
        "{MOST_VALUES} are the most; use fewer values or larger steps"
    )))
}

fn check_values(values: &[f64], path: &str) -> Result<Vec<f64>, Problem> {
    let path = format!("{path}.values");
    if values.is_empty() {
        return Err(Problem::new(path, "the axis has no values").help("list at least one"));
    }
    let mut seen = std::collections::HashSet::new();
    // Adding zero makes one of the two zeros.
    let values: Vec<f64> = values.iter().map(|value| value + 0.0).collect();
    for (index, value) in values.iter().enumerate() {
        if !seen.insert(value.to_bits()) {
            let message = format!("duplicate value {}", number(*value));
            return Err(Problem::new(format!("{path}[{index}]"), message)
                .help("remove one; replicates of a point belong in [seeds]"));
        }
    }
    Ok(values)
}

fn check_name(name: &str, path: &str) -> Result<(), Problem> {
    let path = format!("{path}.name");
    let plain = |character: char| character.is_ascii_alphanumeric() || "_-.".contains(character);
    if name.is_empty() || !name.chars().all(plain) {
        let message = format!("\"{name}\" cannot be the name of an axis");
        let help = "use letters, digits, `_`, `-` and `.`";
        return Err(Problem::new(path, message).help(help));
    }
    if RESERVED.contains(&name) || Borders::COLUMNS.contains(&name) {
        let message = format!("the tables of results have a column \"{name}\" of their own");
        return Err(Problem::new(path, message).help("choose another `name`"));
    }
    Ok(())
}
