//! Further columns: observables that only those runs have that ask for them.

use super::{Scene, Shape};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a scene must have for a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ColumnNeeds {
    /// Nothing but spheres.
    Spheres,
    /// Velocities that describe motion.
    Motion,
    /// Spins.
    Spins,
    /// A law of contact.
    Contacts,
    /// Spheres in a layer of known volume.
    Layer,
    /// Moving spheres in such a layer.
    MotionInLayer,
    /// Contacts in such a layer.
    ContactsInLayer,
}

/// Declares the further columns once: as the values of `output.columns`, with names, units and
/// definitions.
macro_rules! further_columns {
    ($($Column:ident $name:literal $unit:literal $needs:ident $description:literal;)*) => {
        /// A column that is computed only in runs that ask for it.
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
        )]
        pub enum FurtherColumn {
            $(#[doc = concat!($description, " (", $unit, ").")] #[serde(rename = $name)] $Column,)*
        }

        impl FurtherColumn {
            /// All of them, in the order in which records list them.
            pub const ALL: &[Self] = &[$(Self::$Column,)*];

            /// Name, as in files and records.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$Column => $name,)*
                }
            }

            /// Unit, as in the record.
            pub const fn unit(self) -> &'static str {
                match self {
                    $(Self::$Column => $unit,)*
                }
            }

            /// Definition and source, in one line.
            pub const fn description(self) -> &'static str {
                match self {
                    $(Self::$Column => $description,)*
                }
            }

            const fn needs(self) -> ColumnNeeds {
                match self {
                    $(Self::$Column => ColumnNeeds::$needs,)*
                }
            }
        }
    };
}

further_columns! {
    HeightDeviation "height_deviation" "m" Spheres
        "Root mean square distance of the heights z of the centres from their mean";
    GranularTemperature "granular_temperature" "m^2/s^2" Motion
        "Mean square velocity relative to the mean velocity of all spheres, over the number of \
         dimensions: 3, of discs 2 (Goldhirsch, 2003)";
    RotationalTemperature "rotational_temperature" "m^2/s^2" Spins
        "Mean of I w^2 / m of all spheres, over the number of axes: 3, of discs 1 (Luding, \
         Huthmann, McNamara and Zippelius, 1998)";
    SurfaceAngle "surface_angle" "rad" Spheres
        "Angle between the horizontal and the plane of least squares through the highest centre \
         over each square of two mean diameters";
    PackingFraction "packing_fraction" "1" Layer
        "Share of the layer's volume that is inside spheres; overlaps count twice";
    ShearRate "shear_rate" "1/s" MotionInLayer
        "Change of the horizontal velocity with height, by least squares over the spheres whose \
         centres are in the layer";
    Coordination "coordination" "1" Contacts
        "Mean number of contacts of a sphere, not a number without spheres";
    ShareWithoutContact "share_without_contact" "1" Contacts
        "Share of the spheres that touch neither a sphere nor a wall";
    ShareAtWall "share_at_wall" "1" Contacts
        "Share of the spheres that touch a wall or the floor of the tank";
    Pressure "pressure" "Pa" ContactsInLayer
        "A third of the trace of the stress in the layer";
    StressXx "stress_xx" "Pa" ContactsInLayer
        "Stress in the layer: (sum of m v' v' + sum of f b) / V, with the velocities v' relative \
         to the layer's, forces f and branches b of contacts; compression is positive \
         (Goldhirsch, 2010; Weinhart et al., 2012)";
    StressXy "stress_xy" "Pa" ContactsInLayer "Stress in the layer: of forces along x, branches y";
    StressXz "stress_xz" "Pa" ContactsInLayer "Stress in the layer: of forces along x, branches z";
    StressYx "stress_yx" "Pa" ContactsInLayer "Stress in the layer: of forces along y, branches x";
    StressYy "stress_yy" "Pa" ContactsInLayer "Stress in the layer: of forces along y, branches y";
    StressYz "stress_yz" "Pa" ContactsInLayer "Stress in the layer: of forces along y, branches z";
    StressZx "stress_zx" "Pa" ContactsInLayer "Stress in the layer: of forces along z, branches x";
    StressZy "stress_zy" "Pa" ContactsInLayer "Stress in the layer: of forces along z, branches y";
    StressZz "stress_zz" "Pa" ContactsInLayer "Stress in the layer: of forces along z, branches z";
    InertialNumber "inertial_number" "1" ContactsInLayer
        "Shear rate times the mean diameter over the root of pressure over the density of the \
         spheres, in the layer (GDR MiDi, 2004); not a number without pressure";
}

impl FurtherColumn {
    /// The column of this name.
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|it| it.name() == name)
    }

    /// Whether it is one of contacts, which the model measures; else it follows from the spheres
    /// of a frame.
    pub fn is_of_contacts(self) -> bool {
        matches!(
            self.needs(),
            ColumnNeeds::Contacts | ColumnNeeds::ContactsInLayer
        )
    }

    /// Whether the forces of contacts are needed for it.
    pub fn is_of_forces(self) -> bool {
        self.needs() == ColumnNeeds::ContactsInLayer
    }

    /// Why runs of this scene cannot have it, if they cannot.
    pub fn absent_in(self, scene: &Scene) -> Option<&'static str> {
        let still = || apart_from_spots(scene);
        let apart = || {
            let why = "spheres touch only in a scene with [contact]";
            scene.dem.contact.is_none().then_some(why)
        };
        let layerless = || without_layer(scene);
        match self.needs() {
            ColumnNeeds::Spheres => None,
            ColumnNeeds::Motion => still(),
            ColumnNeeds::Spins => {
                let why = "spheres turn only in a scene with [friction]";
                scene.dem.friction.is_none().then_some(why)
            }
            ColumnNeeds::Contacts => apart(),
            ColumnNeeds::Layer => layerless(),
            ColumnNeeds::MotionInLayer => still().or_else(layerless),
            ColumnNeeds::ContactsInLayer => apart().or_else(layerless),
        }
    }

    /// Whether runs of this scene have it, asked for or not.
    pub(crate) fn is_usual_in(self, scene: &Scene) -> bool {
        self == Self::Coordination && scene.has_flow() && scene.dem.contact.is_some()
    }
}

/// Why velocities of a scene do not describe motion, if they do not.
pub(super) fn apart_from_spots(scene: &Scene) -> Option<&'static str> {
    let why = "in a scene of spots velocities are no more than mean displacements";
    scene.spot.is_some().then_some(why)
}

/// Why a layer of a scene has no known volume, if it has none.
pub(super) fn without_area(scene: &Scene) -> Option<&'static str> {
    let area = scene.cross_section();
    let why = "a layer has a volume only in a tank with `radius`, or `width` and `depth`, or \
               between periodic sides";
    (scene.spheres.shape == Shape::Disc || area.is_none()).then_some(why)
}

/// Why a scene has no layer of known volume, if it has none.
fn without_layer(scene: &Scene) -> Option<&'static str> {
    if let Some(why) = without_area(scene) {
        return Some(why);
    }
    let tank = scene.tank.as_ref();
    let has_floor = tank.is_some_and(|tank| tank.floor.is_some());
    let why = "a tank without a floor has a layer only with `output.layer`";
    let is_periodic = scene.domain().periods()[2].is_some();
    (!has_floor && !is_periodic && scene.output.layer.is_none()).then_some(why)
}
