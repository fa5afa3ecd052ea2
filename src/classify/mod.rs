//! The sieves: from the observables of a run to its label.
//!
//! Rice (2012), section 3. Windows are durations; each sieve is one file and reads
//! records, never simulations.

use serde::{Deserialize, Serialize};

/// The state of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Label {
    /// A numerical guard ended the run.
    Unstable,
    /// No steady state was reached.
    Unsettled,
    /// Steady, and none of the states below.
    Settled,
    /// The surface rises from the axis to the wall.
    Fluid,
    /// A hole about the axis.
    Pinned,
    /// A few spheres rise in the middle.
    SmallSpout,
    /// Many spheres rise in the middle.
    LargeSpout,
}

impl Label {
    /// All labels, in the order of their codes.
    pub const ALL: [Self; 7] = [
        Self::Unstable,
        Self::Unsettled,
        Self::Settled,
        Self::Fluid,
        Self::Pinned,
        Self::SmallSpout,
        Self::LargeSpout,
    ];

    /// The thesis's number of the state: 0 unsettled to 5 large spout; -1 unstable.
    pub fn code(self) -> i8 {
        self as i8 - 1
    }

    /// Name, as in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Unstable => "unstable",
            Self::Unsettled => "unsettled",
            Self::Settled => "settled",
            Self::Fluid => "fluid",
            Self::Pinned => "pinned",
            Self::SmallSpout => "small-spout",
            Self::LargeSpout => "large-spout",
        }
    }

    /// The label of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|label| label.name() == name)
    }
}

/// Thresholds of all sieves; every default is that of the thesis's listing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Sieves {
    /// When a run counts as steady.
    pub settle: SettleSieve,
    /// When a surface counts as a fluid's.
    pub fluid: FluidSieve,
    /// When a hole counts as pinned.
    pub pinned: PinnedSieve,
    /// When rising spheres count as a spout.
    pub spout: SpoutSieve,
}

/// Thresholds of the settle sieve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SettleSieve {
    /// Window (s).
    pub window: f64,
    /// No centre may be above this height (m) in the window.
    pub height: f64,
    /// Largest mean over the window of |change per frame of the energy per sphere| / (m g R).
    pub tolerance: f64,
}

impl Default for SettleSieve {
    fn default() -> Self {
        Self {
            window: 0.5,
            height: 0.20,
            tolerance: 1e-3,
        }
    }
}

/// Thresholds of the fluid sieve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FluidSieve {
    /// Window (s).
    pub window: f64,
    /// Least rise from a bin to the next outer one, in radii.
    pub rise: f64,
    /// Bins that may fail.
    pub failures: usize,
    /// Share of the window's frames that must pass.
    pub share: f64,
}

impl Default for FluidSieve {
    fn default() -> Self {
        Self {
            window: 1.5,
            rise: 0.1,
            failures: 1,
            share: 0.9,
        }
    }
}

/// Thresholds of the pinned sieve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PinnedSieve {
    /// Window (s).
    pub window: f64,
    /// Least radius of the hole, in radii of the spheres.
    pub hole: f64,
    /// Share of the window's frames that must have the hole.
    pub share: f64,
}

impl Default for PinnedSieve {
    fn default() -> Self {
        Self {
            window: 2.0,
            hole: 2.0,
            share: 0.5,
        }
    }
}

/// Thresholds of the spout sieve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SpoutSieve {
    /// Window (s).
    pub window: f64,
    /// Rise speed relative to the mean, in radii per second; one of the scene's
    /// `output.rise_speeds`.
    pub rise_speed: f64,
    /// Distance from the axis over R; one of the scene's `output.rise_radii`.
    pub radius: f64,
    /// Least number of rising spheres in every frame.
    pub least: usize,
    /// A small spout stays below this share of all spheres in every frame.
    pub small: f64,
    /// A spout stays below this share of all spheres in every frame; more is chaos.
    pub large: f64,
}

impl Default for SpoutSieve {
    fn default() -> Self {
        Self {
            window: 2.0,
            rise_speed: 10.0,
            radius: 0.75,
            least: 5,
            small: 0.125,
            large: 0.25,
        }
    }
}

/// What the sieves say of one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// The label.
    pub label: Label,
    /// Time from which the run counts as steady (s): the middle of the first steady window.
    pub settle_time: Option<f64>,
    /// How clearly each sieve decided.
    pub evidence: Evidence,
    /// Continuous measures besides the label, averaged over the steady part (over the last
    /// quarter of a run that did not settle).
    pub order: OrderParameters,
}

/// How clearly each sieve decided. A margin is positive when the sieve says yes; fields are empty
/// where a sieve could not act (no steady part, or too short a run).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    /// Smallest windowed energy change, over the tolerance; yes below 1.
    pub settle_change: Option<f64>,
    /// Largest share of passing frames of any fluid window.
    pub fluid_share: Option<f64>,
    /// That share less the threshold.
    pub fluid_margin: Option<f64>,
    /// Largest share of frames with a hole of any pinned window.
    pub pinned_share: Option<f64>,
    /// That share less the threshold.
    pub pinned_margin: Option<f64>,
    /// Largest share of frames that qualify as a spout of any spout window.
    pub spout_share: Option<f64>,
    /// That share less 1, which a spout needs.
    pub spout_margin: Option<f64>,
    /// Largest number of rising spheres in the deciding window, over all spheres.
    pub spout_peak: Option<f64>,
}

/// Continuous measures of the state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OrderParameters {
    /// Mean radius of the hole about the axis, over R.
    pub hole_radius: Option<f64>,
    /// Curvature of the paraboloid z = z0 + a rho^2 fitted to the mean surface profile, as the
    /// angular velocity sqrt(2 g a) (rad/s) of the fluid that has it; negative for a heap.
    pub paraboloid_rotation: Option<f64>,
    /// Root mean square residual of that fit, in radii of the spheres.
    pub paraboloid_residual: Option<f64>,
    /// Rotation rate of the spheres over Omega.
    pub rotation: Option<f64>,
    /// Velocity fluctuation over sqrt(2 r g).
    pub mobility: Option<f64>,
    /// Twice the mean height above the floor, over R.
    pub packing_height: Option<f64>,
    /// Mean number of rising spheres, over all spheres.
    pub spout_count: Option<f64>,
}
