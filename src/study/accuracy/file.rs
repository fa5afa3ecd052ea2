//! What the file of a study of accuracy may say.

use crate::document::{Schema, unit};
use crate::grid::{AxisEntry, SeedsEntry, VariantEntry, or_path};
use crate::scene::{Change, Scene};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// The keys of the file.
pub(crate) static ACCURACY: LazyLock<Schema> = LazyLock::new(Schema::of::<AccuracyFile>);

/// What the file says.
#[derive(Deserialize, JsonSchema)]
pub(crate) struct AccuracyFile {
    /// Which study the file describes.
    #[serde(rename = "study")]
    _study: OwnName,
    /// Free text, the title of figures.
    pub(super) title: Option<String>,
    /// What every setting starts from: the path of a scene or sweep, relative to this file, or a
    /// scene itself in the tables `[scene.spheres]` and so on.
    #[schemars(with = "Option<Scene>", transform = or_path)]
    pub(super) scene: Option<Value>,
    /// Name of a case of `phase verify`, in place of `scene`: errors are then those of its known
    /// numbers. Ladders are over its own keys, such as `setup.dt`, and over `integrator`.
    pub(super) case: Option<String>,
    /// What all settings have in common and the scene, or the case, does not.
    pub(super) base: Option<Changes>,
    /// Axes, in place of those of a sweep that `scene` names.
    pub(super) axis: Option<Vec<AxisEntry>>,
    /// Seeds, in place of those of the sweep. Errors of labels and order parameters are told from
    /// noise by these: five are few, twenty are many.
    pub(super) seeds: Option<SeedsEntry>,
    /// Times at which motions are compared (s), in place of labels: for what is not chaotic before
    /// the last of them.
    #[schemars(transform = unit("s"))]
    pub(super) times: Option<Vec<f64>>,
    /// Ladders of choices: one key each, and the values that it takes.
    #[serde(default)]
    pub(super) ladder: Vec<Ladder>,
    /// Variants: any keys at once, under a name.
    #[serde(default)]
    pub(super) variant: Vec<VariantEntry>,
    /// Whether one ladder is climbed at a time, or all their choices are combined.
    #[serde(default)]
    pub(super) combine: Combine,
    /// The setting that others are compared with. Default: the scene as it is; with `times`, the
    /// smallest time step of the ladder.
    pub(super) reference: Option<Changes>,
    /// How large an error is allowed.
    #[serde(default)]
    pub(super) tolerance: Tolerance,
    /// Names of axes, or last parts of the keys of ladders: against each a figure shows the
    /// processor time of a step.
    #[serde(default)]
    pub(super) step_time: Vec<String>,
}

/// The name of this study.
#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum OwnName {
    /// What settings of a scene cost, and how wrong they are.
    Accuracy,
}

/// A key and the values that it takes.
#[derive(Deserialize, JsonSchema)]
pub(super) struct Ladder {
    /// Path of the key, such as `time.dt`, `time.integrator` or `drag.form`.
    pub(super) key: String,
    /// Its values: numbers or words.
    pub(super) values: Vec<Value>,
}

/// Keys of the scene that are set or left out.
#[derive(Deserialize, JsonSchema)]
pub(super) struct Changes {
    /// As of a variant.
    #[serde(default)]
    set: BTreeMap<String, Value>,
    /// As of a variant.
    #[serde(default)]
    without: Vec<String>,
}

/// How ladders go together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Combine {
    /// One ladder at a time, the other keys as in the scene.
    #[default]
    Each,
    /// Every choice of one ladder with every choice of the others.
    All,
}

/// How large an error is allowed.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Tolerance {
    /// Share of the labels that may change, beyond what seeds change by themselves.
    #[schemars(transform = unit("").above(0.0).at_most(1.0))]
    pub labels: f64,
    /// Shift of order parameters, in units of their spread over seeds (root mean square over the
    /// points). Absent: any.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = unit("").above(0.0))]
    pub shift: Option<f64>,
    /// Relative error of the motion at given times, or of the numbers of a case.
    #[schemars(transform = unit("").above(0.0))]
    pub error: f64,
}

impl Default for Tolerance {
    fn default() -> Self {
        Self {
            labels: 0.02,
            shift: None,
            error: 1e-3,
        }
    }
}

impl Changes {
    pub(super) fn change(&self) -> Change {
        Change {
            set: self
                .set
                .iter()
                .map(|(key, it)| (key.clone(), it.clone()))
                .collect(),
            remove: self.without.clone(),
            scale: Vec::new(),
        }
    }
}
