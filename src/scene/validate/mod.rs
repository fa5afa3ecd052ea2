//! What a scene must satisfy beyond the types of its values.

mod driven;
mod neighbours;
mod output;
mod periodic;
mod program;
mod silo;
mod spot;
mod start;
mod steady;
mod tank;
mod time;
mod walls;

pub(super) use program::complete as complete_program;
pub(crate) use time::multiple;

use super::{
    Contact, Friction, Geometry, LIST_KEY, Radii, SCENE, START_SPHERE, Scene, Spheres, Start,
};
use crate::document::{Problem, any_of, number};
use crate::particles::vector::Vector;

/// Largest number of spheres: each takes up to 600 bytes of memory.
const MOST_SPHERES: usize = 10_000_000;

impl Scene {
    /// Values of the wrong type, and numbers out of range.
    pub(crate) fn problems_of_values(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        if self.program.is_some() {
            let mut tree = self.tree();
            program::add_absent(&mut tree);
            SCENE.kind.check(&tree, "", &mut problems);
            return problems;
        }
        let Some((without_them, spheres)) = self.apart_from_list() else {
            SCENE.kind.check(&self.tree(), "", &mut problems);
            return problems;
        };
        // Listed spheres one by one: a tree of all would take a kilobyte for each.
        SCENE.kind.check(&without_them.tree(), "", &mut problems);
        for (k, sphere) in spheres.iter().enumerate() {
            let sphere = serde_json::to_value(sphere).expect("a sphere holds no map");
            let path = format!("{LIST_KEY}[{k}]");
            START_SPHERE.kind.check(&sphere, &path, &mut problems);
        }
        problems
    }

    /// Finds keys that do not go together. Numbers must be in their ranges. Radii and starts that
    /// are still file names are not checked.
    ///
    /// The engine checks two things later: whether the time step is stable, and whether a random
    /// start finds room.
    pub(crate) fn check_relations(&self, problems: &mut Vec<Problem>) {
        self.check_laws(problems);
        self.check_spheres(problems);
        self.check_tank(problems);
        self.check_opening(problems);
        self.check_friction_of_walls(problems);
        self.check_walls(problems);
        self.check_periodic(problems);
        self.check_start(problems);
        self.check_times(problems);
        self.check_silo(problems);
        self.check_driven(problems);
        self.check_spot(problems);
        self.check_steady(problems);
        self.check_neighbours(problems);
        self.check_output(problems);
    }

    fn check_laws(&self, problems: &mut Vec<Problem>) {
        problems.extend(self.dem.effects.problems(&self.facts()));
        if self.dem.friction.is_some() && self.dem.contact.is_none() {
            let message = "[friction] acts at contacts, but there is no [contact]";
            let help = "add [contact] with `law = \"hertz\"`, or remove [friction]";
            problems.push(Problem::new("friction", message).help(help));
        }
        if let (Some(contact), Some(friction)) = (&self.dem.contact, &self.dem.friction)
            && !friction.goes_with(contact)
        {
            let contacts = friction.contacts().collect::<Vec<_>>().join(" or ");
            let message = format!("this friction law goes with the {contacts} contact only");
            let named = |law: &str| format!("law = \"{law}\"");
            let here = any_of(Friction::laws_with(contact).map(named));
            let there = any_of(friction.contacts().map(named));
            let help = format!("use {here} here, or {there} in [contact]");
            problems.push(Problem::new("friction.law", message).help(help));
        }
        let contact = self.dem.contact.iter();
        problems.extend(contact.flat_map(Contact::problems));
        self.check_rolling(problems);
    }

    fn check_rolling(&self, problems: &mut Vec<Problem>) {
        if self.dem.rolling.is_none() {
            return;
        }
        let (message, help) = match &self.dem.friction {
            None => (
                "[rolling] acts on spins, but without [friction] there are none",
                "add [friction], or remove [rolling]",
            ),
            Some(Friction::Spin(_)) => (
                "[rolling] needs spheres that roll, but spin friction has no sliding, so that \
                    spheres never start to roll",
                "use another friction law, such as `law = \"coulomb\"`, or remove [rolling]",
            ),
            Some(_) => return,
        };
        problems.push(Problem::new("rolling", message).help(help));
    }

    fn check_spheres(&self, problems: &mut Vec<Problem>) {
        let count = self.spheres.count;
        if count > MOST_SPHERES {
            let message = format!("{} spheres are too many", number(count as f64));
            let help = format!("the maximum is {MOST_SPHERES}");
            problems.push(Problem::new("spheres.count", message).help(help));
        }
        match &self.spheres.radius {
            Radii::Each(radii) if radii.len() != count => problems.push(
                Problem::new(
                    "spheres.radius",
                    format!(
                        "`spheres.radius` lists {}, but `spheres.count` is {count}",
                        plural(radii.len(), "radius", "radii")
                    ),
                )
                .help(format!("use `count = {}`, or list {count}", radii.len())),
            ),
            Radii::Shares(shares) if shares.is_empty() => problems.push(
                Problem::new("spheres.radius", "`spheres.radius` is an empty list")
                    .help("give one radius, or a list such as `[{ radius = 0.004, share = 1 }]`"),
            ),
            Radii::Shares(shares) if shares.iter().all(|share| share.share == 0.0) => problems
                .push(
                    Problem::new("spheres.radius", "all shares of `spheres.radius` are 0")
                        .help("give one of them a share above 0"),
                ),
            _ => {}
        }
    }

    /// The smallest and the largest radius of a sphere (m).
    pub fn radius_range(&self) -> (f64, f64) {
        let mut radii = Vec::new();
        let mut listed = false;
        if let Start::List { spheres } = &self.start {
            radii.extend(spheres.iter().filter_map(|sphere| sphere.radius));
            listed = radii.len() == spheres.len() && !radii.is_empty();
        }
        if !listed {
            radii.extend(self.spheres.radius.values());
        }
        let ends = (f64::INFINITY, 0.0);
        radii.iter().fold(ends, |(low, high): (f64, f64), radius| {
            (low.min(*radius), high.max(*radius))
        })
    }

    /// The mean radius of the spheres (m), including radii in the start list.
    pub fn mean_radius(&self) -> f64 {
        let mean = self.spheres.radius.mean();
        match &self.start {
            Start::List { spheres } if spheres.iter().any(|it| it.radius.is_some()) => {
                let radii = spheres.iter().map(|sphere| sphere.radius.unwrap_or(mean));
                radii.sum::<f64>() / spheres.len() as f64
            }
            _ => mean,
        }
    }

    /// The smallest radius of a sphere (m).
    pub fn smallest_radius(&self) -> f64 {
        self.radius_range().0
    }

    /// Mass of the smallest sphere (kg).
    pub fn smallest_mass(&self) -> f64 {
        let Spheres { shape, density, .. } = self.spheres;
        shape.mass(density, self.smallest_radius())
    }

    /// Mass of the largest sphere (kg).
    pub fn largest_mass(&self) -> f64 {
        let Spheres { shape, density, .. } = self.spheres;
        shape.mass(density, self.radius_range().1)
    }

    /// Height (m) of the lowest thing that can hold a sphere: the floor, a listed wall or a fixed
    /// sphere.
    pub(crate) fn lowest_support(&self) -> Option<f64> {
        let floor = self.tank.as_ref().and_then(|tank| tank.floor);
        let fixed = self.dem.geometry.as_ref().map(Geometry::spheres);
        let heights = fixed
            .iter()
            .flat_map(|fixed| fixed.walls.iter().chain(&fixed.door));
        let upward = Vector::new(0.0, 0.0, 1.0);
        let walls = self.dem.walls.iter().filter_map(|wall| wall.lowest(upward));
        floor
            .into_iter()
            .chain(walls)
            .chain(heights.map(|sphere| sphere.position[2]))
            .reduce(f64::min)
    }
}

/// A count and its noun.
pub(crate) fn plural(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// A number to six significant digits, for messages.
pub(crate) fn rounded(value: f64) -> String {
    number(format!("{value:.5e}").parse().unwrap_or(value))
}
