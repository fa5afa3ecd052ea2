//! Whether the walls of a tank are consistent and fit the spheres.

use crate::document::{Problem, number};
use crate::scene::validate::rounded;
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

    /// The opening in the floor of a tank.
    pub(super) fn check_opening(&self, problems: &mut Vec<Problem>) {
        let Some(tank) = &self.tank else { return };
        let Some((key, half_width)) = tank.opening() else {
            return;
        };
        let mut refuse =
            |message: &str, help: &str| problems.push(Problem::new(key, message).help(help));
        if tank.orifice_radius.is_some() && tank.slit_width.is_some() {
            return refuse(
                "`tank.orifice_radius` and `tank.slit_width` exclude each other",
                "remove one of the two",
            );
        }
        if tank.floor.is_none() {
            return refuse(
                "the opening is in a floor, but there is none",
                "add `floor` to [tank]",
            );
        }
        let radius = self.radius_range().1;
        if half_width < radius {
            let message = format!(
                "spheres of radius {} m do not fit through an opening {} m wide",
                number(radius),
                rounded(2.0 * half_width)
            );
            return refuse(&message, "make the opening wider or the spheres smaller");
        }
        let across = tank.orifice_radius.and(tank.depth);
        let diameter = tank.radius.map(|radius| 2.0 * radius);
        let sides = [tank.width, across, diameter].into_iter().flatten();
        let room = 0.5 * sides.fold(f64::INFINITY, f64::min);
        if half_width > room {
            let message = format!(
                "the opening reaches {} m from the axis, but the walls stand at {} m",
                rounded(half_width),
                rounded(room)
            );
            refuse(&message, "make the opening narrower or the tank wider");
        }
    }

    /// Refuses a coefficient of friction at walls in a scene without friction.
    pub(super) fn check_friction_of_walls(&self, problems: &mut Vec<Problem>) {
        let tank = self.tank.as_ref();
        let is_given = tank.is_some_and(|tank| tank.friction_coefficient.is_some());
        if is_given && self.dem.friction.is_none() {
            let message = "`tank.friction_coefficient` needs [friction], but there is none";
            let help = "add [friction] with its law, or remove the coefficient";
            problems.push(Problem::new("tank.friction_coefficient", message).help(help));
        }
    }

    /// The first key of walls too narrow for the largest sphere, and its value (m).
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
