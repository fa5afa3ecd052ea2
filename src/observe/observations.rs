//! The observables of a run: one value (or one row) per frame.

use ndarray::{Array2, Array3};
use serde::{Deserialize, Serialize};

/// One named scalar observable.
pub struct Series<'a> {
    /// Name, as in the record.
    pub name: &'static str,
    /// Unit, as in the record.
    pub unit: &'static str,
    /// What it is, in one line.
    pub description: &'static str,
    /// One value per frame.
    pub values: &'a [f32],
}

/// Declares the scalar observables once: as fields, as a list to write, as a list to read. The second
/// group is that of scenes where spheres come and go, the third that of the books of energy.
macro_rules! scalars {
    (
        { $($name:ident $unit:literal $description:literal;)* }
        { $($flow:ident $flow_unit:literal $flow_description:literal;)* }
        { $($ledger:ident $ledger_unit:literal $ledger_description:literal;)* }
    ) => {
        /// Observables of a run, one entry per frame; the first frame is the start.
        ///
        /// Values are single precision: the record stays small, and sieves read exactly what a
        /// record holds.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
        pub struct Observations {
            /// Time of each frame (s).
            pub time: Vec<f64>,
            $(#[doc = concat!($description, " (", $unit, ").")] pub $name: Vec<f32>,)*
            $(
                #[doc = concat!($flow_description, " (", $flow_unit, ").")]
                pub $flow: Vec<f32>,
            )*
            $(
                #[doc = concat!($ledger_description, " (", $ledger_unit, ").")]
                pub $ledger: Vec<f32>,
            )*
            /// Height of the highest centre in each radial bin (m); not a number for an empty
            /// bin. Shape: frames x bins, inner bin first, bins of equal width up to R; the
            /// outermost also holds what is beyond R. No bins without a tank radius.
            pub profile: Array2<f32>,
            /// Number of spheres that rose faster than the mean of all by a speed, since the frame
            /// before, and were within a share of R of the axis then; none at the first frame,
            /// and 65535 also stands for more. Shape: frames x `rise_radii` x `rise_speeds` of
            /// the scene's output table; without a tank radius, frames x 0 x `rise_speeds`.
            pub rising: Array3<u16>,
        }

        impl Observations {
            /// Names of all scalar observables.
            pub(crate) const NAMES: &[&str] = &[
                $(stringify!($name),)* $(stringify!($flow),)* $(stringify!($ledger),)*
            ];

            /// Names of those that only some scenes have: where spheres come and go, or books of energy
            /// are kept.
            pub(crate) const OPTIONAL: &[&str] =
                &[$(stringify!($flow),)* $(stringify!($ledger),)*];

            /// The scalar observables that there are, in a fixed order.
            pub fn scalars(&self) -> Vec<Series<'_>> {
                let series = [
                    $(Series {
                        name: stringify!($name),
                        unit: $unit,
                        description: $description,
                        values: &self.$name,
                    },)*
                    $(Series {
                        name: stringify!($flow),
                        unit: $flow_unit,
                        description: $flow_description,
                        values: &self.$flow,
                    },)*
                    $(Series {
                        name: stringify!($ledger),
                        unit: $ledger_unit,
                        description: $ledger_description,
                        values: &self.$ledger,
                    },)*
                ];
                let is_there =
                    |it: &Series<'_>| !it.values.is_empty() || !Self::OPTIONAL.contains(&it.name);
                series.into_iter().filter(is_there).collect()
            }

            /// The scalar observable of that name, to fill it.
            pub fn scalar_mut(&mut self, name: &str) -> Option<&mut Vec<f32>> {
                match name {
                    $(stringify!($name) => Some(&mut self.$name),)*
                    $(stringify!($flow) => Some(&mut self.$flow),)*
                    $(stringify!($ledger) => Some(&mut self.$ledger),)*
                    _ => None,
                }
            }
        }
    };
}

scalars! {
{
    kinetic "J" "Translational kinetic energy of all spheres";
    rotational "J" "Rotational kinetic energy of all spheres";
    gravitational "J" "Gravitational energy m g z of all spheres";
    elastic "J" "Elastic energy of all contacts, that of tangential springs left out";
    height_mean "m" "Mean height z of the centres";
    height_max "m" "Height z of the highest centre";
    hole_radius "m" "Distance from the axis of the centre next to it";
    speed_mean "m/s" "Mean speed of the spheres";
    air_speed_mean "m/s" "Mean speed of the swirling air at the spheres, 0 without swirl";
    rotation "rad/s" "Rotation rate of the spheres about the axis: angular momentum over moment of inertia of the centres, 0 if all lie on it";
    fluctuation "m/s" "Root mean square velocity relative to rigid rotation at that rate and to the mean vertical velocity";
}
{
    released "1" "Number of spheres that came in";
    discharged "1" "Number of spheres that left, but for those that spilled";
    spilled "1" "Number of spheres that left while the door was still closed: over the rim";
    discharge_rate "1/s" "Number of spheres that left per second, over the last second or since the start";
    coordination "1" "Mean number of contacts of a sphere, not a number without spheres";
    mass_inside "kg" "Mass of all spheres that are in";
}
{
    springs "J" "Energy of the tangential springs of all contacts";
    dissipated_by_damping "J" "Energy that the damping of contacts dissipated since the start";
    dissipated_by_friction "J" "Energy that friction dissipated since the start: work against tangential forces that springs do not hold";
    work_of_air "J" "Work of the air on the spheres since the start, the damping of spins included";
    energy_brought "J" "Energy of the spheres that came in since the start, less that of those that left";
    residual "J" "All energy and what was dissipated, less what the air and new spheres brought, less the same at the start: what the integrator got wrong";
}
}

impl Observations {
    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.time.len()
    }
}
