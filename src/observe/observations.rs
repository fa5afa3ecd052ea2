//! The observables of a run: one value (or one row) per frame.

use crate::scene::{FurtherColumn, Scene};
use crate::simulation::Column;
use ndarray::{Array2, Array3};
use serde::{Deserialize, Serialize};

/// A scalar observable with its values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScalarSeries<'a> {
    /// Name, as in the record.
    pub name: &'a str,
    /// Unit, as in the record.
    pub unit: &'a str,
    /// What it is, in one line.
    pub description: &'a str,
    /// One value per frame.
    pub values: &'a [f32],
}

/// A scalar observable that a model declares for itself.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OwnSeries {
    /// Name, as in the record.
    pub name: String,
    /// Unit, as in the record.
    pub unit: String,
    /// What it is, in one line.
    pub description: String,
    /// One value per frame.
    pub values: Vec<f32>,
}

impl From<Column> for OwnSeries {
    fn from(column: Column) -> Self {
        Self {
            name: column.name.to_owned(),
            unit: column.unit.to_owned(),
            description: column.description.to_owned(),
            values: Vec::new(),
        }
    }
}

/// Declares the scalar observables of spheres once: as fields, as a list to write, as a list to
/// read.
macro_rules! scalars {
    ($($name:ident $unit:literal $description:literal;)*) => {
        /// Observables of a run, one entry per frame; the first frame is the start.
        ///
        /// An observable that the scene does not need is empty (see [`Observer`](super::Observer)).
        /// Values have single precision: the record stays small, and sieves read exactly what a
        /// record holds.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
        pub struct Observations {
            /// Time of each frame (s).
            pub time: Vec<f64>,
            $(#[doc = concat!($description, " (", $unit, ").")] pub $name: Vec<f32>,)*
            /// What the model itself declares.
            pub own: Vec<OwnSeries>,
            /// Height of the highest centre in each radial bin (m); not a number for an empty bin.
            /// Shape: frames x bins, inner bin first, bins of equal width up to R; the outermost
            /// includes everything beyond R. No bins without a tank radius.
            pub profile: Array2<f32>,
            /// Number of spheres that rose faster, by a given speed, than the mean since the
            /// previous frame, and that were then within a share of R of the axis; zero at the
            /// first frame, and at most 65535. Shape: frames x `rise_radii` x `rise_speeds` of the
            /// scene's output table; without a tank radius, frames x 0 x `rise_speeds`.
            pub rising: Array3<u16>,
        }

        impl Observations {
            /// All scalar observables of spheres.
            pub const COLUMNS: &[Column] = &[
                $(Column {
                    name: stringify!($name),
                    unit: $unit,
                    description: $description,
                },)*
            ];

            /// The scalar observables that are not empty, in a fixed order.
            pub fn scalars(&self) -> Vec<ScalarSeries<'_>> {
                let of_spheres = [$(self.$name.as_slice(),)*];
                let of_spheres = Self::COLUMNS.iter().zip(of_spheres);
                let of_spheres = of_spheres.map(|(column, values)| ScalarSeries {
                    name: column.name,
                    unit: column.unit,
                    description: column.description,
                    values,
                });
                let own = self.own.iter().map(|series| ScalarSeries {
                    name: &series.name,
                    unit: &series.unit,
                    description: &series.description,
                    values: &series.values,
                });
                let all = of_spheres.chain(own);
                all.filter(|series| !series.values.is_empty()).collect()
            }

            /// The scalar observable of spheres with this name, to fill it.
            pub fn scalar_mut(&mut self, name: &str) -> Option<&mut Vec<f32>> {
                match name {
                    $(stringify!($name) => Some(&mut self.$name),)*
                    _ => None,
                }
            }
        }
    };
}

scalars! {
    kinetic "J" "Translational kinetic energy of all spheres and their added mass";
    rotational "J" "Rotational kinetic energy of all spheres";
    gravitational "J" "Gravitational energy m g z of all spheres, minus buoyancy";
    elastic "J" "Elastic energy of all contacts, without tangential springs";
    height_mean "m" "Mean height z of the centres";
    height_max "m" "Height z of the highest centre";
    hole_radius "m" "Distance from the axis of the centre next to it";
    speed_mean "m/s" "Mean speed of the spheres";
    air_speed_mean "m/s" "Mean speed of the swirling air at the spheres, 0 without swirl";
    rotation "rad/s"
        "Rotation rate of the spheres about the axis: angular momentum over moment of inertia of \
         the centres, 0 if all lie on it";
    fluctuation "m/s"
        "Root mean square velocity relative to rigid rotation at that rate and to the mean \
         vertical velocity";
    released "1" "Number of spheres that came in";
    discharged "1" "Number of spheres that left, without those that spilled";
    spilled "1" "Number of spheres that left while the door was still closed: over the rim";
    discharge_rate "1/s"
        "Number of spheres that left per second, over the last second or since the start";
    coordination "1" "Mean number of contacts of a sphere, not a number without spheres";
    mass_inside "kg" "Mass of all spheres that are in";
    springs "J" "Energy of the tangential springs of all contacts";
    dissipated_by_damping "J" "Energy that the damping of contacts dissipated since the start";
    dissipated_by_friction "J"
        "Energy that friction dissipated since the start: work against tangential forces that \
            springs do not store";
    work_of_air "J" "Work of the air on the spheres since the start, including the damping of \
        spins";
    work_of_shaking "J"
        "Work of the shaking on the spheres since the start, in the frame of the box";
    work_of_walls "J"
        "Work on the spheres since the start of walls that slide in themselves; dissipation by \
            damping and friction is counted apart";
    energy_brought "J"
        "Energy of spheres that came in since the start, minus the energy of spheres that left";
    residual "J"
        "All energy plus dissipation, minus the energy from air, shaking, walls and new spheres, \
            minus the same at the start: the error of the integrator";
}

impl Observations {
    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.time.len()
    }

    /// Whether it is the name of a usual column, or of one of the arrays beside them.
    pub fn is_usual(name: &str) -> bool {
        let arrays = ["profile", "rising"];
        arrays.contains(&name) || Self::COLUMNS.iter().any(|column| column.name == name)
    }

    /// Why runs of a scene have no observable of this name, if it is one that others have.
    pub fn absent_in(scene: &Scene, name: &str) -> Option<&'static str> {
        if !scene.output.records(name) && Self::is_usual(name) {
            return Some("the scene records only the columns that `output.usual` names");
        }
        let dem = &scene.dem;
        let is_round = scene.tank.as_ref().is_some_and(|it| it.radius.is_some());
        let (has_air, flows) = (dem.effects.swirl.is_some(), scene.has_flow());
        let (there, why) = match name {
            "kinetic" | "rotational" | "gravitational" => (
                scene.spot.is_none(),
                "in a scene of spots velocities are no more than mean displacements",
            ),
            "elastic" => (
                dem.contact.is_some(),
                "spheres touch only in a scene with [contact]",
            ),
            "hole_radius" | "rotation" | "fluctuation" => (
                !flows && (is_round || has_air),
                "only a round tank or one with [swirl] has an axis, if no sphere comes or goes",
            ),
            "air_speed_mean" => (has_air, "only a scene with [swirl] has moving air"),
            "released" | "discharged" | "spilled" | "discharge_rate" | "mass_inside" => (
                flows,
                "spheres come and go only through a feed, a door, an outlet or an opening",
            ),
            "work_of_shaking" if dem.effects.shaking.is_none() => {
                (false, "only a scene with [shaking] is shaken")
            }
            "springs"
            | "dissipated_by_damping"
            | "dissipated_by_friction"
            | "work_of_air"
            | "work_of_shaking"
            | "energy_brought"
            | "residual" => (
                scene.output.ledger,
                "the energy is balanced only with `output.ledger = true`",
            ),
            "work_of_walls" => (
                scene.output.ledger && scene.has_moving_walls(),
                "the work of walls is counted only with `output.ledger = true`, if a wall slides",
            ),
            "spots" => (scene.spot.is_some(), "only a scene with [spot] has spots"),
            _ => return None,
        };
        (!there).then_some(why)
    }

    /// The same of a run of `scene` without further columns.
    pub(crate) fn usual_in(&self, scene: &Scene) -> Self {
        let mut usual = self.clone();
        let further = FurtherColumn::ALL.iter().copied();
        for column in further.filter(|it| !it.is_usual_in(scene)) {
            match usual.scalar_mut(column.name()) {
                Some(values) => values.clear(),
                None => usual.own.retain(|series| series.name != column.name()),
            }
        }
        for profile in &scene.output.profiles {
            let stem = profile.stem();
            usual.own.retain(|series| !series.name.starts_with(&stem));
        }
        if scene.output.walls {
            let of_walls: Vec<_> = scene.wall_columns().map(|column| column.name).collect();
            usual.own.retain(|series| !of_walls.contains(&series.name));
        }
        usual
    }

    /// Moves series of the model that are observables of spheres, in scenes which usually lack
    /// them, to their places.
    pub(super) fn place_own(&mut self) {
        for series in std::mem::take(&mut self.own) {
            match self.scalar_mut(&series.name) {
                Some(values) => *values = series.values,
                None => self.own.push(series),
            }
        }
    }
}
