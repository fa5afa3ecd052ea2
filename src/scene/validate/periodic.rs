//! Whether the scene goes with its periodic sides.

use crate::document::{Problem, at_least, number};
use crate::particles::vector::Vector;
use crate::scene::{Integrator, Scene, SceneWall, Shape, Start};

/// Names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// A direction is along or across an axis if the other part of it is below this.
const ALONG: f64 = 1e-9;

impl Scene {
    pub(super) fn check_periodic(&self, problems: &mut Vec<Problem>) {
        let Some(periodic) = &self.dem.periodic else {
            return;
        };
        let periods = periodic.periods();
        if periods == [None; 3] {
            let help = "give a period, such as `x = 0.1`, or remove [periodic]";
            problems.push(Problem::new("periodic", "no axis is periodic").help(help));
            return;
        }
        self.check_beside_periodic(problems);
        self.check_keys_across(periods, problems);
        for (axis, period) in periods.into_iter().enumerate() {
            if let Some(period) = period {
                self.check_period(axis, period, problems);
                self.check_walls_across(axis, period, problems);
                self.check_effects_across(axis, problems);
            }
        }
    }

    fn check_period(&self, axis: usize, period: f64, problems: &mut Vec<Problem>) {
        let largest = self.radius_range().1;
        let fixed = self.fixed_in_box();
        let fixed = fixed.walls.iter().chain(&fixed.door);
        let partner = fixed.fold(largest, |most, it| most.max(it.radius));
        let least = 2.0 * (largest + partner);
        if period < least {
            let message = format!(
                "a period of {} m is less than {} m, twice the distance at which the largest \
                 spheres touch: a pair would meet across both sides",
                number(period),
                number(least)
            );
            let key = format!("periodic.{}", AXES[axis]);
            let help = format!("use at least {}", at_least(least));
            problems.push(Problem::new(key, message).help(help));
        }
    }

    /// Walls must look the same from each image of a sphere.
    fn check_walls_across(&self, axis: usize, period: f64, problems: &mut Vec<Problem>) {
        let along = AXES[axis];
        let tank = self.tank.clone().unwrap_or_default();
        let keys: &[(&str, bool)] = match axis {
            0 => &[
                ("radius", tank.radius.is_some()),
                ("width", tank.width.is_some()),
                ("orifice_radius", tank.orifice_radius.is_some()),
                ("slit_width", tank.slit_width.is_some()),
            ],
            1 => &[
                ("radius", tank.radius.is_some()),
                ("depth", tank.depth.is_some()),
                ("orifice_radius", tank.orifice_radius.is_some()),
            ],
            _ => &[("floor", tank.floor.is_some())],
        };
        for (key, _) in keys.iter().filter(|(_, is_given)| *is_given) {
            let message = format!("this wall ends the space along {along}, which is periodic");
            let help = format!("remove it, or remove `periodic.{along}`");
            problems.push(Problem::new(format!("tank.{key}"), message).help(help));
        }
        for (place, wall) in self.dem.walls.iter().enumerate() {
            if !is_same_along(wall, axis, period) {
                let message = format!("this wall is not the same everywhere along {along}");
                let help = format!(
                    "use planes parallel to {along}, and cylinders and rectangles that span the \
                     period along it, or remove `periodic.{along}`"
                );
                problems.push(Problem::new(format!("wall[{place}]"), message).help(help));
            }
        }
    }

    /// Effects must be the same at each image of a sphere.
    fn check_effects_across(&self, axis: usize, problems: &mut Vec<Problem>) {
        let along = AXES[axis];
        let effects = &self.dem.effects;
        let tables = [
            (
                "swirl",
                // Still air is the same everywhere.
                axis < 2 && effects.swirl.as_ref().is_some_and(|it| it.omega != 0.0),
            ),
            ("updraught", effects.updraught.is_some()),
        ];
        for (table, _) in tables.into_iter().filter(|(_, is_refused)| *is_refused) {
            let message = format!("this air is not the same everywhere along {along}");
            let help = format!("remove [{table}], or remove `periodic.{along}`");
            problems.push(Problem::new(table, message).help(help));
        }
        if axis == 2 && self.dem.outlet.is_some() {
            let message = "spheres leave below a height, but z is periodic";
            let help = "remove [outlet], or remove `periodic.z`";
            problems.push(Problem::new("outlet", message).help(help));
        }
        if axis == 1 && self.spheres.shape == Shape::Disc {
            let message = "discs lie in the plane y = 0, and nothing is across it";
            problems.push(Problem::new("periodic.y", message).help("remove it"));
        }
    }

    /// Refuses keys that mean nothing along periodic axes.
    fn check_keys_across(&self, [x, y, z]: [Option<f64>; 3], problems: &mut Vec<Problem>) {
        let guards = &self.dem.guards;
        let aside = x.is_some() && y.is_some();
        let layer = self.output.layer.is_some();
        let keys = [
            ("guards.horizontal", aside && guards.horizontal.is_some()),
            ("guards.vertical", z.is_some() && guards.vertical.is_some()),
            ("output.layer", z.is_some() && layer),
        ];
        for (key, _) in keys.into_iter().filter(|(_, is_given)| *is_given) {
            let message = format!("`{key}` means nothing along axes that are periodic");
            problems.push(Problem::new(key, message).help("remove it"));
        }
    }

    /// Refuses what does not know periodic sides.
    fn check_beside_periodic(&self, problems: &mut Vec<Problem>) {
        if self.time.integrator == Integrator::AdaptiveVerlet {
            let message = "adaptive Verlet does not know the periodic sides of `periodic`";
            let help = "use another integrator, such as `integrator = \"velocity-verlet\"`";
            problems.push(Problem::new("time.integrator", message).help(help));
        }
        if matches!(self.start, Start::Packing {}) {
            let message = "a packing lies in the box of [tank], without periodic sides";
            let help = "let the spheres fall from a start of `kind = \"random\"`, or list them";
            problems.push(Problem::new("start.kind", message).help(help));
        }
        if self.spot.is_some() {
            let message = "spots move in the box of [tank], without periodic sides";
            problems.push(Problem::new("periodic", message).help("remove it"));
        }
    }
}

/// Whether a wall is the same everywhere along an axis of this period (m).
fn is_same_along(wall: &SceneWall, axis: usize, period: f64) -> bool {
    let mut unit = [0.0; 3];
    unit[axis] = 1.0;
    let unit = Vector::from(unit);
    let spans = |length: f64| length >= period * (1.0 - ALONG);
    if let Some(plane) = &wall.plane {
        // A plane that turns is slower near its axis.
        return plane.unit_normal().dot(unit).abs() < ALONG && wall.angular_velocity.is_none();
    }
    if let Some(plate) = &wall.plate {
        let [one, other] = plate.edges();
        let is_rectangle = one.unit().dot(other.unit()).abs() < ALONG;
        let is_along = |edge: Vector| edge.unit().cross(unit).norm() < ALONG;
        let mut edges = [one, other].into_iter();
        return is_rectangle && edges.any(|edge| is_along(edge) && spans(edge.norm()));
    }
    wall.cylinder.as_ref().is_some_and(|it| {
        let is_along = Vector::from(it.axis).unit().cross(unit).norm() < ALONG;
        is_along && it.length.is_none_or(spans)
    })
}
