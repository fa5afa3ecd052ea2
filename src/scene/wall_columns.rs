//! The columns of `output.walls`: force and torque of the spheres on each wall.

use super::Scene;

/// A column of the force or the torque of the spheres on a wall, along one axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WallColumn {
    /// Name, as in the record.
    pub name: String,
    /// Unit, as in the record.
    pub unit: &'static str,
    /// What it is, in one line.
    pub description: String,
}

impl WallColumn {
    /// The columns of a wall of that name, whose torque is about `centre`: its force along x, y and
    /// z, then its torque.
    fn of_wall(wall: &str, centre: &str) -> impl Iterator<Item = Self> {
        let kinds = [("force", "N"), ("torque", "N m")];
        let all = kinds
            .into_iter()
            .flat_map(|kind| ["x", "y", "z"].map(|axis| (kind, axis)));
        all.map(move |((kind, unit), axis)| Self {
            name: format!("{wall}_{kind}_{axis}"),
            unit,
            description: match kind {
                "force" => format!("Force of the spheres on the wall {wall} along {axis}"),
                _ => format!(
                    "Torque of the spheres on the wall {wall} about the line along {axis} through \
                     {centre}"
                ),
            },
        })
    }
}

impl Scene {
    /// The names of its walls in columns, with what their torques are about: those of the tank,
    /// then those that it lists, in the order in which they act.
    fn named_walls(&self) -> impl Iterator<Item = (String, &'static str)> {
        let of_tank = self.tank.iter().flat_map(|tank| tank.wall_names());
        let of_tank = of_tank.map(|name| (name.to_owned(), "the origin"));
        let listed = self.dem.walls.iter().enumerate();
        of_tank.chain(listed.map(|(place, wall)| (wall.called(place), wall.torque_centre())))
    }

    /// The columns that runs have with `output.walls`, wall by wall.
    pub fn wall_columns(&self) -> impl Iterator<Item = WallColumn> {
        let columns = |(name, centre): (String, &str)| {
            let columns: Vec<_> = WallColumn::of_wall(&name, centre).collect();
            columns
        };
        self.named_walls().flat_map(columns)
    }

    /// Why runs of this scene cannot have these columns, if they cannot.
    pub(crate) fn without_wall_columns(&self) -> Option<&'static str> {
        if self.dem.contact.is_none() {
            return Some("spheres touch only in a scene with [contact]");
        }
        let has_walls = self.named_walls().next().is_some();
        (!has_walls).then_some("there is no wall")
    }

    /// Whether a record of this scene has the output that `wanted`, of the same motion, asks for.
    pub(crate) fn has_output_of(&self, wanted: &Self) -> bool {
        let names = |scene: &Self| -> Vec<String> {
            let asked = scene.named_walls().filter(|_| wanted.output.walls);
            asked.map(|(name, _)| name).collect()
        };
        self.output.holds(&wanted.output) && names(self) == names(wanted)
    }

    /// Forgets the names of its walls, which do not change the motion.
    pub(crate) fn forget_names_of_walls(&mut self) {
        self.dem.walls.iter_mut().for_each(|wall| wall.name = None);
    }
}
