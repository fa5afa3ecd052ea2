//! What a run stores.

use super::{ColumnProfile, FurtherColumn, is_default};
use crate::document::quantities::place;
use crate::document::{quantity, unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Data stored in addition to the observables of every frame. Never changes the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Time between snapshots of all spheres (s); 0 for the last one only.
    #[schemars(transform = quantity("Δt_{snapshot}", "s", "time between snapshots").at_least(0.0))]
    pub snapshot_interval: f64,
    /// Store position, velocity and spin of every sphere at every frame.
    pub trajectory: bool,
    /// Balance the energy: dissipation by damping and friction, work of the air, and the
    /// integrator's error.
    #[serde(skip_serializing_if = "is_default")]
    pub ledger: bool,
    /// Which of the usual columns of the scene are recorded.
    #[serde(skip_serializing_if = "is_default")]
    pub usual: UsualColumns,
    /// Further columns, which cost time only in runs that ask for them. Columns that the labels and
    /// measures of a sweep file read are asked for by this.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub columns: Vec<FurtherColumn>,
    /// Profiles over height or radius, whose bins are further columns.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub profiles: Vec<ColumnProfile>,
    /// The force and the torque of the spheres on each wall of the scene, as further columns such
    /// as `floor_force_z` and `drum_torque_y`.
    #[serde(skip_serializing_if = "is_default")]
    pub walls: bool,
    /// The layer in which columns such as `pressure` are measured. Absent: from the floor to twice
    /// the mean height of the centres above it, which is the height of a uniform bed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layer: Option<Layer>,
    /// Radial bins of the surface profile. Default: round(R / 2r).
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(
        transform = quantity("n_{bins}", "", "radial bins of the surface profile").at_least(1)
    )]
    pub profile_bins: Option<usize>,
    /// Rise speeds, in radii per second above the mean, for which rising spheres are counted.
    #[schemars(transform = unit("1/s"))]
    pub rise_speeds: Vec<f64>,
    /// Distances from the axis, over R, within which rising spheres are counted.
    #[schemars(transform = unit("").above(0.0))]
    pub rise_radii: Vec<f64>,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            snapshot_interval: 1.0,
            trajectory: false,
            ledger: false,
            usual: UsualColumns::default(),
            columns: Vec::new(),
            profiles: Vec::new(),
            walls: false,
            layer: None,
            profile_bins: None,
            rise_speeds: vec![5.0, 10.0, 20.0],
            rise_radii: vec![0.5, 0.75, 1.0],
        }
    }
}

impl Output {
    /// Adds a further column, if it is not asked for yet.
    pub(crate) fn ask_for(&mut self, column: FurtherColumn) {
        if !self.columns.contains(&column) {
            self.columns.push(column);
            self.columns.sort_unstable();
        }
    }

    /// Whether the usual column of this name is recorded, if runs of the scene have it.
    pub fn records(&self, name: &str) -> bool {
        match &self.usual {
            UsualColumns::Word(_) => true,
            UsualColumns::Named(names) => names.iter().any(|it| it == name),
        }
    }

    /// Whether a record with this output has all that `wanted` asks for: it may have columns that
    /// are not asked for any more.
    pub(crate) fn holds(&self, wanted: &Self) -> bool {
        let apart = |output: &Self| Self {
            usual: UsualColumns::default(),
            columns: Vec::new(),
            profiles: Vec::new(),
            walls: false,
            ..output.clone()
        };
        let has_usual = match (&self.usual, &wanted.usual) {
            (UsualColumns::Word(_), _) => true,
            (UsualColumns::Named(_), UsualColumns::Word(_)) => false,
            (UsualColumns::Named(_), UsualColumns::Named(names)) => {
                names.iter().all(|it| self.records(it))
            }
        };
        let mut further = wanted.columns.iter();
        let mut profiles = wanted.profiles.iter();
        apart(self) == apart(wanted)
            && has_usual
            && (self.walls || !wanted.walls)
            && further.all(|it| self.columns.contains(it))
            && profiles.all(|it| self.profiles.contains(it))
    }
}

/// Which of the usual columns are recorded. Figures and sieves that read others cannot be had
/// without running again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum UsualColumns {
    /// By a word.
    Word(UsualChoice),
    /// These, and those that rules read.
    Named(Vec<String>),
}

/// Which of the usual columns are recorded, in a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum UsualChoice {
    /// All that runs of the scene have.
    All,
    /// Only those that its labels and measures read: of rules alone their columns, of sieves all.
    Needed,
}

impl Default for UsualColumns {
    fn default() -> Self {
        Self::Word(UsualChoice::All)
    }
}

/// A horizontal layer of the tank, over its whole cross-section.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Layer {
    /// Its lower side (m).
    #[schemars(transform = place("z_{low}", "lower side of the layer"))]
    pub z_min: f64,
    /// Its upper side (m).
    #[schemars(transform = place("z_{high}", "upper side of the layer"))]
    pub z_max: f64,
}
