//! Whether the spheres of a scene have a place to start from.

use super::{plural, rounded};
use crate::dem::start;
use crate::document::{Problem, number};
use crate::scene::{Scene, Start, Tank};

/// Largest share of the space open to the spheres that a random start may fill. Random placement
/// one by one without overlap cannot exceed 0.384 (Zhang and Torquato, Phys. Rev. E 88, 053312
/// (2013)) and needs ever more attempts on the way there.
const PACKING_LIMIT: f64 = 0.30;

/// Share up to which a random start is taken to succeed without a trial.
const CERTAIN_PACKING: f64 = 0.10;

/// Largest number of spheres that are placed on trial; so many are small against their tank.
const MOST_TRIED: usize = 10_000;

impl Scene {
    pub(super) fn check_start(&self, problems: &mut Vec<Problem>) {
        match &self.start {
            Start::Random { z_min, z_max, .. } => self.check_random_start(*z_min, *z_max, problems),
            Start::List { .. } => self.check_listed_start(problems),
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
        let Some(area) = self.tank.as_ref().and_then(Tank::area) else {
            let message = "a random start needs a tank with walls all around to be in";
            let help = "add `radius`, or `width` and `depth`, to [tank], or list the spheres with `kind = \
                        \"list\"`";
            problems.push(Problem::new("start.kind", message).help(help));
            return;
        };
        if self.misfit().is_some() {
            return;
        }
        let largest = self.radius_range().1;
        if let Some(floor) = self.tank.as_ref().and_then(|tank| tank.floor)
            && z_min - floor < largest * (1.0 - 1e-9)
        {
            let message = format!(
                "`start.z_min` = {} puts spheres of radius {} m into the floor at {} m",
                number(z_min),
                number(largest),
                number(floor)
            );
            let help = format!("use at least `z_min = {}`", rounded(floor + largest));
            problems.push(Problem::new("start.z_min", message).help(help));
        }
        self.check_room(area, z_min, z_max, problems);
    }

    /// Whether the spheres fit between `z_min` and `z_max` within walls that enclose `area` (m2).
    fn check_room(&self, area: f64, z_min: f64, z_max: f64, problems: &mut Vec<Problem>) {
        let radii = &self.spheres.radius;
        let volume = self.spheres.count as f64 * radii.mean_volume();
        let height_for = |fraction: f64| volume / (fraction * area);
        let height = z_max - z_min + 2.0 * radii.mean();
        let fraction = height_for(1.0) / height;
        let limit = match fraction {
            fraction if fraction > PACKING_LIMIT => PACKING_LIMIT,
            // Spheres that are not small against the tank find less room: only a trial tells.
            fraction if fraction > CERTAIN_PACKING && self.trial_fails() => CERTAIN_PACKING,
            _ => return,
        };
        let message = format!(
            "{} do not fit: they would fill {:.0} % of the space between `start.z_min` and \
             `start.z_max`, and a random start without overlap fills {:.0} % at most",
            plural(self.spheres.count, "sphere", "spheres"),
            100.0 * fraction,
            100.0 * PACKING_LIMIT,
        );
        let message = if limit < PACKING_LIMIT {
            format!("{message} (less where spheres are large against the tank)")
        } else {
            message
        };
        let z_max = z_min + 1.01 * (height_for(limit) - 2.0 * radii.mean());
        let help = format!(
            "use `z_max = {}` or more, or fewer or smaller spheres",
            rounded(z_max)
        );
        problems.push(Problem::new("start.z_max", message).help(help));
    }

    /// Whether the spheres, if they are not too many for a quick trial, cannot be placed.
    fn trial_fails(&self) -> bool {
        self.spheres.count <= MOST_TRIED && start::place(self).is_err()
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
        let (round, floor) = (tank.radius.is_some(), tank.floor);
        for (index, sphere) in spheres.iter().enumerate() {
            let [x, y, z] = sphere.position;
            let wall = match (round, tank.reach()) {
                (true, [radius, _]) => {
                    radius.is_some_and(|radius| x * x + y * y >= radius * radius)
                }
                (false, [width, depth]) => [(x, width), (y, depth)]
                    .iter()
                    .any(|(place, reach)| reach.is_some_and(|reach| place.abs() >= reach)),
            };
            let below = floor.is_some_and(|floor| z <= floor);
            if wall || below {
                let place = if wall {
                    "outside the tank's wall"
                } else {
                    "below the tank's floor"
                };
                let message = format!("sphere {index} at ({x}, {y}, {z}) m is {place}");
                let path = format!("start.spheres[{index}].position");
                problems.push(Problem::new(path, message).help("move its centre into the tank"));
            }
        }
        if self.contact.is_some() {
            self.check_coincident(problems);
        }
    }

    /// Centres at the same place push each other in no direction.
    fn check_coincident(&self, problems: &mut Vec<Problem>) {
        let Start::List { spheres } = &self.start else {
            return;
        };
        let mut seen = std::collections::HashMap::new();
        for (index, sphere) in spheres.iter().enumerate() {
            // Adding zero makes one of the two zeros.
            let place = sphere.position.map(|part| (part + 0.0).to_bits());
            if let Some(first) = seen.insert(place, index) {
                let message = format!("spheres {first} and {index} have the same centre");
                let path = format!("start.spheres[{index}].position");
                problems.push(Problem::new(path, message).help("move one of them"));
            }
        }
    }
}
