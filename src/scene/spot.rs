//! The part of a scene that belongs to the spot model: what spots are, how they walk, and how they
//! move the spheres.

use super::is_default;
use crate::document::quantities::length;
use crate::document::quantity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Spheres may stick out of the box by this share of the diameter at the start, as in packings from
/// other programs; their first move puts them back.
pub(crate) const STICKING_OUT: f64 = 1e-3;

/// Spots of free volume that enter through the orifice of the tank, walk upward at random, and move
/// the spheres that they pass a little in the opposite direction (Rycroft, Wong and Bazant, 2010).
/// With this table nothing else moves the spheres: no contacts, no effects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spot {
    /// Radius r_s (m): a spot moves the spheres whose centres are within it.
    #[schemars(transform = length("r_s", "radius of a spot"))]
    pub radius: f64,
    /// Displacement of a spot over the displacement of the spheres that it moves.
    #[schemars(transform = quantity("w", "", "displacement ratio").above(0.0))]
    pub displacement_ratio: f64,
    /// Diffusion length b (m): a step goes sqrt(2 b Δz) in either direction along x and along y.
    #[schemars(transform = length("b", "diffusion length of spots"))]
    pub diffusion_length: f64,
    /// Upward part Δz of a step (m).
    #[schemars(transform = length("Δz", "upward step of a spot"))]
    pub vertical_step: f64,
    /// Spots that enter per second, λ, at the centre of the orifice.
    #[schemars(transform = rate("λ", "insertion rate of spots"))]
    pub insertion_rate: f64,
    /// Steps of a spot per second, μ.
    #[schemars(transform = rate("μ_s", "move rate of a spot"))]
    pub move_rate: f64,
    /// Distance d_w (m) that spots keep from the walls; a negative value lets them enter walls.
    /// Default: the diameter of a sphere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = quantity("d_w", "m", "distance of spots from walls"))]
    pub wall_distance: Option<f64>,
    /// Whether the part of a spot beyond a wall is reflected; spheres in the reflected part move
    /// twice as far.
    #[serde(default, skip_serializing_if = "is_default")]
    pub reflection: bool,
    /// When spots move.
    #[serde(default, skip_serializing_if = "is_default")]
    pub schedule: SpotSchedule,
    /// How spots choose their way. Absent: the four steps are equally likely.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub walk: Option<SpotWalk>,
    /// A spot carries a fixed volume, shared by the spheres that it moves. Absent: each moves by
    /// the step of the spot over `displacement_ratio`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weighting: Option<SpotWeighting>,
    /// How overlaps are removed.
    #[serde(default, skip_serializing_if = "is_default")]
    pub relaxation: SpotRelaxation,
}

/// A rate (1/s) of insertions or moves: more than a billion per second would take for ever.
fn rate(symbol: &str, name: &str) -> crate::document::Attribute {
    quantity(symbol, "1/s", name).above(0.0).at_most(1e9)
}

/// When spots move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SpotSchedule {
    /// Each insertion and each move at its own time, after exponential waiting times.
    #[default]
    Events,
    /// All spots once in each step of 1/μ, in a random order; a Poisson number of mean λ/μ enters
    /// at the start of the step.
    StepsRandom,
    /// The same, but the spot that entered last moves first.
    StepsNewestFirst,
}

/// How spots choose their way: step i has a probability proportional to p_i^β, where p_i is the
/// number of spheres that it would move. A spot that would move no sphere is removed. Free surfaces
/// form heaps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpotWalk {
    /// Exponent β: larger values give flatter heaps.
    #[schemars(
        transform = quantity("β_s", "", "bias of the walk of spots").at_least(0.0).at_most(100.0)
    )]
    pub bias: f64,
}

/// A spot carries a fixed volume V_s: each of the p spheres that it moves, of volume V_p, moves by
/// its step times V_s / (p V_p).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpotWeighting {
    /// V_s / V_p. Default: 84.4 / 399, for 84.4 spheres in range and a displacement ratio of 399.
    #[serde(default = "volume_ratio")]
    #[schemars(transform = quantity("V_s / V_p", "", "volume of a spot, in spheres").above(0.0))]
    pub volume_ratio: f64,
    /// If a spot moves fewer spheres than this, p is this number.
    #[serde(default = "least_count")]
    #[schemars(transform = quantity("p_{min}", "", "least number of spheres").at_least(1.0))]
    pub least_count: f64,
    /// Height (m) above the floor below which weighting is off, so that no gap opens at the
    /// orifice.
    #[serde(default)]
    #[schemars(transform = quantity("z_w", "m", "least height of the weighting").at_least(0.0))]
    pub above: f64,
}

fn volume_ratio() -> f64 {
    0.2115
}

fn least_count() -> f64 {
    20.0
}

/// How overlaps are removed: in one pass, each sphere moves by `strength` times its overlaps, or
/// half of that if both partners can move.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SpotRelaxation {
    /// Where and when.
    pub method: RelaxationMethod,
    /// The ratio k, for methods that have one.
    #[schemars(transform = quantity("k", "", "relaxation ratio").at_least(1))]
    pub ratio: u64,
    /// Share α of an overlap that one pass removes.
    #[schemars(transform = quantity("α_s", "", "strength of relaxation").above(0.0).at_most(1.0))]
    pub strength: f64,
    /// Radius r_e (m) of the region. Default: the spot's radius plus a sphere's diameter.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("r_e", "radius of relaxation"))]
    pub radius: Option<f64>,
}

impl Default for SpotRelaxation {
    fn default() -> Self {
        Self {
            method: RelaxationMethod::default(),
            ratio: 1,
            strength: 0.8,
            radius: None,
        }
    }
}

/// Where and when overlaps are removed (section 5 of the paper).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RelaxationMethod {
    /// Around the spot, after every move.
    #[default]
    EveryMove,
    /// Never.
    Off,
    /// Around the spot, after a move with probability 1/k (method 1).
    AtRandom,
    /// Around the spot, after every k-th of its moves (method 2).
    Counted,
    /// For all spheres, every k/μ seconds (method 3).
    Global,
}
