//! Profiles: columns for each of several bins over height, or over the distance from the axis.

use super::Scene;
use super::columns::{apart_from_spots, without_area};
use crate::document::quantities::place;
use crate::document::quantity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A profile of the spheres, with a column for each bin: `velocity_x_height_1` for the first one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ColumnProfile {
    /// What is measured of the spheres in each bin.
    pub of: ProfiledQuantity,
    /// Along what the bins lie.
    pub over: ProfileAxis,
    /// Lower end of the first bin (m).
    #[schemars(transform = place("z_1", "lower end of the first bin"))]
    pub from: f64,
    /// Upper end of the last bin (m).
    #[schemars(transform = place("z_n", "upper end of the last bin"))]
    pub to: f64,
    /// Number of bins, of equal width.
    #[schemars(transform = quantity("n", "", "bins of a profile").at_least(1).at_most(200.0))]
    pub bins: usize,
}

/// Declares what profiles may be of: names, units and definitions.
macro_rules! profiled_quantities {
    ($($Quantity:ident $name:literal $unit:literal $description:literal;)*) => {
        /// What a profile measures of the spheres whose centres are in a bin. Not a number in a bin
        /// without spheres, unless it is a count or a share of a volume.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
        #[serde(rename_all = "snake_case")]
        pub enum ProfiledQuantity {
            $(#[doc = concat!($description, " (", $unit, ").")] $Quantity,)*
        }

        impl ProfiledQuantity {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$Quantity,)*];

            /// Name, as in files and records.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$Quantity => $name,)*
                }
            }

            /// Unit, as in the record.
            pub const fn unit(self) -> &'static str {
                match self {
                    $(Self::$Quantity => $unit,)*
                }
            }

            /// Definition and source, in one line.
            pub const fn description(self) -> &'static str {
                match self {
                    $(Self::$Quantity => $description,)*
                }
            }
        }
    };
}

profiled_quantities! {
    Count "count" "1" "Number of spheres whose centres are in the bin";
    VelocityX "velocity_x" "m/s" "Mean velocity along x of the spheres in the bin";
    VelocityY "velocity_y" "m/s" "Mean velocity along y of the spheres in the bin";
    VelocityZ "velocity_z" "m/s" "Mean vertical velocity of the spheres in the bin";
    AngularVelocity "angular_velocity" "rad/s"
        "Rotation rate of the spheres in the bin about the axis of z: angular momentum over moment \
         of inertia of the centres";
    GranularTemperature "granular_temperature" "m^2/s^2"
        "Mean square velocity relative to the bin's mean velocity, over the number of dimensions: \
         3, of discs 2 (Goldhirsch, 2003)";
    PackingFraction "packing_fraction" "1"
        "Share of the bin's volume that is inside spheres; overlaps count twice";
}

/// Along what the bins of a profile lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ProfileAxis {
    /// The height z of the centres.
    Height,
    /// The distance of the centres from the axis of z.
    Radius,
}

impl ProfileAxis {
    fn name(self) -> &'static str {
        match self {
            Self::Height => "height",
            Self::Radius => "radius",
        }
    }
}

impl ColumnProfile {
    /// The beginning of the names of its columns, which end with the number of the bin from 1.
    pub fn stem(&self) -> String {
        format!("{}_{}_", self.of.name(), self.over.name())
    }

    /// The names of its columns.
    pub fn columns(&self) -> impl Iterator<Item = String> + use<> {
        let stem = self.stem();
        (1..=self.bins).map(move |bin| format!("{stem}{bin}"))
    }

    /// The ends of a bin (m), counted from 0.
    pub fn ends(&self, bin: usize) -> [f64; 2] {
        let width = (self.to - self.from) / self.bins as f64;
        [bin, bin + 1].map(|edge| self.from + edge as f64 * width)
    }

    /// Whether its bins lie along an axis that is periodic, or distances from the axis of z count.
    fn crosses_period(&self, scene: &Scene) -> bool {
        let [x, y, z] = scene.domain().periods();
        let is_about_axis =
            self.over == ProfileAxis::Radius || self.of == ProfiledQuantity::AngularVelocity;
        (is_about_axis && x.or(y).is_some()) || (self.over == ProfileAxis::Height && z.is_some())
    }

    /// Why runs of this scene cannot have it, if they cannot.
    pub(crate) fn absent_in(&self, scene: &Scene) -> Option<&'static str> {
        match self.of {
            _ if self.crosses_period(scene) => {
                Some("it needs places along an axis that is periodic, where they have no limits")
            }
            ProfiledQuantity::Count => None,
            ProfiledQuantity::PackingFraction if self.over == ProfileAxis::Radius => {
                Some("the height of its bins is not known over the distance from the axis")
            }
            ProfiledQuantity::PackingFraction => without_area(scene),
            _ => apart_from_spots(scene),
        }
    }
}
