//! Parameters of a spot simulation: the silo, the spots, and how they move the spheres.

use serde::{Deserialize, Serialize};

/// Parameters of a simulation by spots. Lengths in metres, times in seconds.
///
/// Names, and the values of [`Parameters::figure_2`], follow Rycroft, Wong and Bazant, Powder
/// Technology 200 (2010), figure 2 and section 2.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameters {
    /// Half of the width of the box along x (m); walls stand at plus and minus this.
    pub half_width: f64,
    /// Half of the depth of the box along y (m).
    pub half_depth: f64,
    /// The opening in the floor z = 0.
    pub orifice: SpotOpening,
    /// Diameter d of the spheres (m).
    pub diameter: f64,
    /// Spots move spheres whose centres are nearer than this radius r_s (m).
    pub spot_radius: f64,
    /// Spheres nearer than this radius r_e are relaxed (m).
    pub relaxation_radius: f64,
    /// Displacement of a spot over the displacement of the spheres it moves, w.
    pub displacement_ratio: f64,
    /// Steps of a spot along x (either way), y (either way) and z (upwards) (m).
    pub step: [f64; 3],
    /// Spots inserted per time, lambda (1/s), at the centre of the orifice.
    pub insertion_rate: f64,
    /// Moves of each spot per time, mu (1/s).
    pub move_rate: f64,
    /// Distance d_w that spots keep from walls (m); a negative value lets them enter walls.
    pub wall_distance: f64,
    /// Share alpha of an overlap that one relaxation removes.
    pub relaxation_strength: f64,
    /// A spot is removed this high above the highest sphere (m), z_max.
    pub removal_height: f64,
    /// In which order spots move.
    pub schedule: Schedule,
    /// How often overlaps are removed.
    pub relaxation: Relaxation,
    /// How spots choose their way.
    pub walk: Walk,
    /// How far spots move spheres.
    pub influence: Influence,
    /// Whether the part of a spot outside the walls is reflected into the box (section 4 there).
    pub reflection: bool,
}

/// The opening in the floor, around the origin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SpotOpening {
    /// A circle of this radius (m).
    Circle {
        /// (m)
        radius: f64,
    },
    /// A slit across the whole depth.
    Slit {
        /// Half of its width along x (m).
        half_width: f64,
    },
}

/// In which order spots move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Schedule {
    /// Each insertion and each move happens at its own time, after exponential waiting times.
    Events,
    /// All spots move once in each step of 1/mu, in a new random order each time. A Poisson number
    /// of mean lambda/mu is inserted at the start of the step.
    StepsInRandomOrder,
    /// The same, but the spot that was inserted last moves first.
    StepsNewestFirst,
}

/// How often overlaps are removed (section 5 of the paper).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Relaxation {
    /// Around the spot after every move.
    EveryMove,
    /// Never.
    Off,
    /// Method 1: around the spot after a move, with probability 1/k.
    AtRandom {
        /// Ratio k.
        ratio: u64,
    },
    /// Method 2: around the spot after every k-th of its moves.
    Counted {
        /// Ratio k.
        ratio: u64,
    },
    /// Method 3: for all spheres, every k/mu of time.
    Global {
        /// Ratio k.
        ratio: u64,
    },
}

/// How spots choose one of the four places (+-dx, +-dy, dz) from where they are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Walk {
    /// All with the same probability.
    Unbiased,
    /// With probability p_i^beta / sum of p_j^beta, where p_i is the number of spheres that the
    /// move to place i would influence (section 3 of the paper). If all p_i are zero the spot is
    /// removed.
    Biased {
        /// Exponent beta.
        exponent: f64,
    },
}

/// How far a spot that moves by v moves each sphere.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Influence {
    /// By -v/w.
    Fixed,
    /// By -v V_s / (p V_p), where V_s is the volume that a spot carries, V_p the volume of a
    /// sphere, and p the number of spheres it moves (section 3 of the paper).
    Weighted {
        /// V_s / V_p.
        volume_ratio: f64,
        /// Lower bound of p.
        least_count: f64,
        /// Below this height the displacement is -v/w (m).
        above: f64,
    },
}

/// V_s / V_p: the 84.4 spheres in the range of a spot at the packing fraction .6, over w = 399.
pub const SPOT_VOLUME_RATIO: f64 = 0.2115;

impl Parameters {
    /// Box, spots and rates of the paper for spheres of this diameter (m) at unit gravity g = d/s2,
    /// which makes the paper's unit of time 1 s.
    pub fn figure_2(diameter: f64) -> Self {
        let d = diameter;
        Self {
            half_width: 25.0 * d,
            half_depth: 4.0 * d,
            orifice: SpotOpening::Circle { radius: 4.0 * d },
            diameter: d,
            spot_radius: 2.6 * d,
            relaxation_radius: 3.6 * d,
            displacement_ratio: 399.0,
            step: [0.676 * d, 0.676 * d, 0.1 * d],
            insertion_rate: 375.0,
            move_rate: 28.0,
            wall_distance: d,
            relaxation_strength: 0.8,
            removal_height: d,
            schedule: Schedule::Events,
            relaxation: Relaxation::EveryMove,
            walk: Walk::Unbiased,
            influence: Influence::Fixed,
            reflection: false,
        }
    }

    /// The weighting of the paper for spheres of this diameter (m): at least 20 spheres, and only
    /// above z = 30 d.
    pub fn weighting(diameter: f64) -> Influence {
        Influence::Weighted {
            volume_ratio: SPOT_VOLUME_RATIO,
            least_count: 20.0,
            above: 30.0 * diameter,
        }
    }

    /// Greatest displacement that a spot can give to a sphere in one move (m).
    pub(crate) fn greatest_displacement(&self) -> f64 {
        let [x, y, z] = self.step;
        let fixed = 1.0 / self.displacement_ratio;
        let factor = match self.influence {
            Influence::Fixed => fixed,
            Influence::Weighted {
                volume_ratio,
                least_count,
                ..
            } => fixed.max(volume_ratio / least_count),
        };
        // In a corner a sphere may be in the range of the spot and of three of its images.
        let images = if self.reflection { 4.0 } else { 1.0 };
        images * factor * (x * x + y * y + z * z).sqrt()
    }
}
