//! Whether the spheres of a scene can start where it says.

use super::{plural, rounded};
use crate::document::{Problem, accepted, number};
use crate::scene::{Scene, Shape, Start, Tank};

/// Largest number of spheres side by side on the floor under a packing.
const MOST_BESIDE: f64 = 1e7;

impl Scene {
    pub(super) fn check_start(&self, problems: &mut Vec<Problem>) {
        match &self.start {
            Start::Random { z_min, z_max, .. } => self.check_random_start(*z_min, *z_max, problems),
            Start::List { .. } => self.check_listed_start(problems),
            Start::Packing {} => self.check_packed_start(problems),
            Start::Feed { .. } | Start::File { .. } => {}
        }
    }

    fn check_random_start(&self, z_min: f64, z_max: f64, problems: &mut Vec<Problem>) {
        if z_min > z_max {
            let message = format!(
                "`start.z_min` = {} is above `start.z_max` = {}",
                number(z_min),
                number(z_max)
            );
            problems.push(Problem::new("start.z_min", message).help("exchange the two"));
            return;
        }
        for (key, side) in ["start.x", "start.y"].into_iter().zip(self.start_box()) {
            if side.is_some_and(|[low, high]| low > high) {
                let message = format!("the first number of `{key}` is above the second");
                problems.push(Problem::new(key, message).help("exchange the two"));
                return;
            }
        }
        if self.start_area().is_none() {
            let message = "a random start needs a tank with walls all around";
            let help = "add `radius`, or `width` and `depth`, to [tank], or `x` and `y` to \
                        [start], or list the spheres with `kind = \"list\"`";
            problems.push(Problem::new("start.kind", message).help(help));
            return;
        }
        if self.misfit().is_some() {
            return;
        }
        let largest = self.radius_range().1;
        let floor = self.tank.as_ref().and_then(|tank| tank.floor);
        let clears = |z_min: f64, floor: f64| z_min - floor >= largest * (1.0 - 1e-9);
        if let Some(floor) = floor.filter(|floor| !clears(z_min, *floor)) {
            let message = format!(
                "`start.z_min` = {} puts spheres of radius {} m into the floor at {} m",
                number(z_min),
                number(largest),
                number(floor)
            );
            let least = accepted(floor + largest, |it| clears(it, floor));
            let help = match least {
                Some(least) => format!("use at least `z_min = {least}`"),
                None => "use a higher one".to_owned(),
            };
            problems.push(Problem::new("start.z_min", message).help(help));
        }
    }

    fn check_packed_start(&self, problems: &mut Vec<Problem>) {
        let tank = self.tank.clone().unwrap_or_default();
        let sides = [
            ("width", tank.width),
            ("depth", tank.depth),
            ("floor", tank.floor),
        ];
        for (key, _) in sides.iter().filter(|(_, side)| side.is_none()) {
            let message = format!("a packing lies in a box, but there is no `tank.{key}`");
            let help = format!("add `{key}` to [tank]");
            problems.push(Problem::new("start.kind", message).help(help));
        }
        self.check_floor_of_packing(&tank, problems);
        let (smallest, largest) = self.radius_range();
        if smallest < largest {
            let message = "the program makes packings of spheres of one size";
            let help = "give `spheres.radius` as one number, or the places in a file";
            problems.push(Problem::new("spheres.radius", message).help(help));
        }
        if self.spheres.shape != Shape::Sphere {
            let message = "the program makes packings of spheres, not of discs";
            problems.push(Problem::new("spheres.shape", message).help("remove it"));
        }
    }

    /// The search allocates cells of the size of a sphere for the whole box.
    fn check_floor_of_packing(&self, tank: &Tank, problems: &mut Vec<Problem>) {
        let diameter = 2.0 * self.radius_range().1;
        let spheres = tank.area().map_or(0.0, |area| area / (diameter * diameter));
        if spheres > MOST_BESIDE {
            let message = format!(
                "the floor of the box has room for {} spheres side by side, more than {}",
                rounded(spheres),
                number(MOST_BESIDE)
            );
            let help = "make the tank narrower, or the spheres larger";
            problems.push(Problem::new("tank.width", message).help(help));
        }
    }

    fn check_listed_start(&self, problems: &mut Vec<Problem>) {
        let Start::List { spheres } = &self.start else {
            return;
        };
        let count = self.spheres.count;
        if spheres.len() != count {
            let message = format!(
                "the start lists {}, but `spheres.count` is {count}",
                plural(spheres.len(), "sphere", "spheres")
            );
            let help = format!("use `count = {}`, or list {count}", spheres.len());
            problems.push(Problem::new("start.spheres", message).help(help));
        }
        let tank = self.tank.clone().unwrap_or_default();
        for (index, sphere) in spheres.iter().enumerate() {
            let [x, y, z] = sphere.position;
            if let Some(outside) = tank.outside(sphere.position, self.dem.door.is_some()) {
                let message = format!("sphere {index} at ({x}, {y}, {z}) m is {outside}");
                let path = format!("start.spheres[{index}].position");
                problems.push(Problem::new(path, message).help("move its centre into the tank"));
            }
        }
        if self.dem.contact.is_some() {
            self.check_coincident(problems);
        }
    }

    /// Two equal centres have no direction in which to push each other.
    fn check_coincident(&self, problems: &mut Vec<Problem>) {
        let Start::List { spheres } = &self.start else {
            return;
        };
        let mut seen = std::collections::HashMap::new();
        for (index, sphere) in spheres.iter().enumerate() {
            // Adding zero turns -0 into 0.
            let place = sphere.position.map(|part| (part + 0.0).to_bits());
            if let Some(first) = seen.insert(place, index) {
                let message = format!("spheres {first} and {index} have the same centre");
                let path = format!("start.spheres[{index}].position");
                problems.push(Problem::new(path, message).help("move one of them"));
            }
        }
    }
}
