//! Whether the walls of a tank go together, and with the spheres.

use crate::document::{Problem, number};
use crate::scene::{Scene, Tank};

impl Scene {
    pub(super) fn check_tank(&self, problems: &mut Vec<Problem>) {
        let Some(tank) = &self.tank else { return };
        let sides = [("tank.width", tank.width), ("tank.depth", tank.depth)];
        if tank.radius.is_some() {
            for (key, _) in sides.iter().filter(|(_, side)| side.is_some()) {
                let message = format!("`tank.radius` and `{key}` exclude each other");
                let help = "a tank is round or has sides; remove one of the two";
                problems.push(Problem::new(*key, message).help(help));
            }
        }
        if let Some((key, size)) = self.misfit() {
            let what = key.trim_start_matches("tank.");
            let message = format!(
                "spheres of radius {} m do not fit into a tank of {what} {} m",
                number(self.radius_range().1),
                number(size)
            );
            let help = format!("both are in metres; make the spheres smaller or `{key}` larger");
            problems.push(Problem::new("spheres.radius", message).help(help));
        }
    }

    /// The first key of the walls that leave the largest sphere no room, and its value (m).
    pub(crate) fn misfit(&self) -> Option<(&'static str, f64)> {
        let Tank {
            radius,
            width,
            depth,
            ..
        } = *self.tank.as_ref()?;
        let largest = self.radius_range().1;
        let round = radius.filter(|radius| largest >= *radius);
        let narrow = |side: &f64| 2.0 * largest > *side;
        let keys = [
            ("tank.radius", round),
            ("tank.width", width.filter(narrow)),
            ("tank.depth", depth.filter(narrow)),
        ];
        keys.into_iter()
            .find_map(|(key, size)| size.map(|size| (key, size)))
    }
}
