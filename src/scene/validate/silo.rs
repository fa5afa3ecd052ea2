//! Checks whether geometry, feed, door, rest and outlet of a scene go together.

use super::rounded;
use crate::document::{Problem, accepted, at_most, number};
use crate::scene::{
    Friction, Geometry, Hopper, MOST_HOPPER_SPHERES, Scene, Shape, Start, Tank, may_hold,
};

/// Shortest `rest.hold` (s): the spheres are checked twice in this time.
const LEAST_HOLD: f64 = 0.02;

impl Scene {
    pub(super) fn check_silo(&self, problems: &mut Vec<Problem>) {
        self.check_discs(problems);
        self.check_geometry(problems);
        self.check_door(problems);
        self.check_feed(problems);
        self.check_rest(problems);
        self.check_outlet(problems);
        self.check_comings_and_goings(problems);
    }

    /// Whether spheres come or go during the run. If so, snapshots hold NaN for a sphere that is
    /// not in.
    pub fn has_flow(&self) -> bool {
        matches!(self.start, Start::Feed { .. })
            || self.dem.door.is_some()
            || self.dem.rest.is_some()
            || self.dem.outlet.is_some()
            || self.tank.as_ref().is_some_and(Tank::has_opening)
    }

    /// Refuses what would push discs out of their plane.
    fn check_discs(&self, problems: &mut Vec<Problem>) {
        if self.spheres.shape != Shape::Disc {
            return;
        }
        let mut refuse = |path: String, what: &str, help: &str| {
            let message = format!("discs lie in the plane y = 0, but {what}");
            problems.push(Problem::new(path, message).help(help));
        };
        let shape = "or use `shape = \"sphere\"`";
        if self.tank.as_ref().is_some_and(|tank| tank.radius.is_some()) {
            let help = format!("use [geometry] for walls, {shape}");
            refuse(
                "tank.radius".to_owned(),
                "a cylinder stands across it",
                &help,
            );
        }
        if self.tank.as_ref().is_some_and(|tank| tank.depth.is_some()) {
            let help = format!("remove it, {shape}");
            refuse("tank.depth".to_owned(), "two sides stand along it", &help);
        }
        let effects = &self.dem.effects;
        for (table, is_there) in [
            ("buoyancy", effects.buoyancy.is_some()),
            ("added_mass", effects.added_mass.is_some()),
            ("magnus", effects.magnus.is_some()),
        ] {
            if is_there {
                let help = format!("remove it, {shape}");
                refuse(table.to_owned(), "this fluid is three-dimensional", &help);
            }
        }
        if self.dem.effects.swirl.is_some() || self.dem.effects.updraught.is_some() {
            let path = if self.dem.effects.swirl.is_some() {
                "swirl"
            } else {
                "updraught"
            };
            refuse(
                path.to_owned(),
                "this air moves in three dimensions",
                &format!("remove it, {shape}"),
            );
        }
        let off = |place: &[f64; 3]| place[1] != 0.0;
        let place = format!("set the second number to 0, {shape}");
        if effects.shaking.iter().any(|it| off(&it.direction)) {
            let path = "shaking.direction".to_owned();
            refuse(path, "this leads out of it", &place);
        }
        match &self.start {
            Start::Feed {
                position, velocity, ..
            } => {
                for (key, vector) in [("position", position), ("velocity", velocity)] {
                    if off(vector) {
                        refuse(format!("start.{key}"), "this leads out of it", &place);
                    }
                }
            }
            Start::List { spheres } => {
                let out = |spin: &[f64; 3]| spin[0] != 0.0 || spin[2] != 0.0;
                let first = spheres
                    .iter()
                    .position(|it| off(&it.position) || off(&it.velocity) || out(&it.spin));
                if let Some(index) = first {
                    let what = "this one lies, moves or turns out of it";
                    refuse(format!("start.spheres[{index}]"), what, &place);
                }
            }
            Start::Random { .. } | Start::Packing {} | Start::File { .. } => {}
        }
        if let Some(Geometry::List { walls, door }) = &self.dem.geometry
            && let Some(index) = walls.iter().chain(door).position(|it| off(&it.position))
        {
            let path = match index.checked_sub(walls.len()) {
                None => format!("geometry.walls[{index}].position"),
                Some(index) => format!("geometry.door[{index}].position"),
            };
            refuse(path, "this fixed one does not", &place);
        }
    }

    fn check_geometry(&self, problems: &mut Vec<Problem>) {
        let Some(geometry) = &self.dem.geometry else {
            return;
        };
        if self.dem.contact.is_none() {
            let message = "[geometry] holds spheres by contact, but there is no [contact]";
            let help = "add [contact] with `law = \"linear\"` or `\"hertz\"`";
            problems.push(Problem::new("geometry", message).help(help));
        }
        if let Some(Friction::Spin(_)) = self.dem.friction {
            let message = "spin friction was made for the tank and does not support fixed spheres";
            problems.push(Problem::new("friction.law", message).help("use `law = \"coulomb\"`"));
        }
        if let Geometry::Hopper(hopper) = geometry {
            check_hopper(hopper, problems);
        }
    }

    fn check_door(&self, problems: &mut Vec<Problem>) {
        let Some(door) = &self.dem.door else { return };
        let has_door = match &self.dem.geometry {
            Some(Geometry::File { .. }) => return,
            Some(geometry) => !geometry.spheres().door.is_empty(),
            None => false,
        };
        let is_there = has_door
            || self.tank.as_ref().is_some_and(Tank::has_opening)
            || self.dem.walls.iter().any(|wall| wall.is_door);
        if !is_there {
            let message = "[door] opens a door, but there is none";
            let help = "list the spheres of a door in [geometry], or add `orifice_radius` or \
                        `slit_width` to [tank], which it closes";
            problems.push(Problem::new("door", message).help(help));
        }
        if let Some(opens) = door.opens
            && opens >= self.time.duration
        {
            problems.push(too_late("door.opens", opens, "the door would open", self));
        }
        if door.opens.is_none() && self.dem.rest.is_none() {
            let message = "[door] opens when all spheres are at rest, but nothing defines rest";
            let help = "add [rest] with `kinetic_energy`, or a time `opens` to [door]";
            problems.push(Problem::new("door", message).help(help));
        }
    }

    fn check_rest(&self, problems: &mut Vec<Problem>) {
        let Some(rest) = &self.dem.rest else { return };
        if rest.hold >= self.time.duration {
            problems.push(too_late("rest.hold", rest.hold, "rest would be over", self));
        }
        if rest.hold < LEAST_HOLD {
            let message = format!(
                "`rest.hold` = {} s is no longer than the time between two checks of the spheres",
                number(rest.hold)
            );
            let help = format!("use `hold = {}` or more", number(LEAST_HOLD));
            problems.push(Problem::new("rest.hold", message).help(help));
        }
    }

    fn check_outlet(&self, problems: &mut Vec<Problem>) {
        let Some(outlet) = &self.dem.outlet else {
            return;
        };
        let mut refuse = |what: &str| {
            let message = format!(
                "the outlet, at {} m, is not below {what}",
                number(outlet.height)
            );
            problems.push(Problem::new("outlet.height", message).help("use a lower one"));
        };
        let start = match &self.start {
            Start::Feed { position, .. } => Some(position[2]),
            // Driven spheres never leave.
            Start::List { .. } => {
                let heights = self.free_listed().map(|(_, it)| it.position[2]);
                heights.reduce(f64::min)
            }
            Start::Random { z_min, .. } => Some(*z_min),
            Start::Packing {} | Start::File { .. } => None,
        };
        if start.is_some_and(|start| start <= outlet.height) {
            refuse("where spheres start");
        } else if self
            .lowest_support()
            .is_some_and(|support| support <= outlet.height)
        {
            refuse("everything that holds spheres: they would be removed too early");
        }
    }

    fn check_feed(&self, problems: &mut Vec<Problem>) {
        let Start::Feed { interval, .. } = &self.start else {
            return;
        };
        let last = (self.spheres.count - 1) as f64 * interval;
        if last >= self.time.duration {
            problems.push(too_late(
                "start.interval",
                last,
                "the last sphere would come in",
                self,
            ));
        }
    }

    /// Effects that keep numbers per sphere exclude spheres that come or go.
    fn check_comings_and_goings(&self, problems: &mut Vec<Problem>) {
        if !self.has_flow() {
            return;
        }
        for name in self.dem.effects.with_numbers_per_sphere() {
            let message = format!("[{name}] does not go with spheres that come or go");
            let help =
                format!("remove [{name}], or the feed, [door], [rest] and [outlet] of the scene");
            problems.push(Problem::new(name, message).help(help));
        }
    }
}

/// The problem of an event after the end of the run.
fn too_late(key: &str, time: f64, what: &str, scene: &Scene) -> Problem {
    let message = format!(
        "{what} at {} s, but the run ends at `time.duration` = {} s",
        rounded(time),
        number(scene.time.duration)
    );
    Problem::new(key, message).help("make it earlier, or the duration longer")
}

fn check_hopper(hopper: &Hopper, problems: &mut Vec<Problem>) {
    if hopper.foot >= hopper.top {
        let message = format!(
            "`geometry.foot` = {} is not below `geometry.top` = {}",
            number(hopper.foot),
            number(hopper.top)
        );
        problems.push(Problem::new("geometry.foot", message).help("exchange the two"));
    }
    let widest = 2.0 * (hopper.half_width - hopper.radius);
    if hopper.opening >= widest {
        let message = format!(
            "an opening of {} m is as wide as the silo",
            number(hopper.opening)
        );
        let help = match may_hold("geometry.opening", widest) {
            true => format!("use less than {}", at_most(widest)),
            false => "make the silo wider, or the spheres of its walls smaller".to_owned(),
        };
        problems.push(Problem::new("geometry.opening", message).help(help));
    }
    check_spacing(hopper, problems);
}

/// Whether the spheres of the walls leave no gaps, and are not too many.
fn check_spacing(hopper: &Hopper, problems: &mut Vec<Problem>) {
    let fits = |spacing: f64| {
        let hopper = Hopper {
            spacing,
            ..hopper.clone()
        };
        hopper.count() <= MOST_HOPPER_SPHERES
    };
    let widest = 2.0 * hopper.radius;
    // Tolerates rounding of the last digit given.
    let may_be_closed = fits(widest * (1.0 - 1e-5));
    let mut refuse = |message: String, help: String| {
        let help = match may_be_closed {
            true => help,
            false => "use a larger `radius` in [geometry], or shorter walls".to_owned(),
        };
        problems.push(Problem::new("geometry.spacing", message).help(help));
    };
    let count = hopper.count();
    if count > MOST_HOPPER_SPHERES {
        let message = format!("the spacing makes walls of {} spheres", rounded(count));
        // Each part of the walls has a whole number of spacings.
        let least = 1.001 * hopper.spacing * count / MOST_HOPPER_SPHERES;
        let advice = match accepted(least.min(widest), |it| it <= widest && fits(it)) {
            Some(least) => format!("use `spacing = {least}` or more, or shorter walls"),
            None => "use a wider one, or shorter walls".to_owned(),
        };
        let most = number(MOST_HOPPER_SPHERES);
        refuse(message, format!("the maximum is {most}: {advice}"));
    } else if hopper.spacing > widest {
        let message = format!(
            "walls of spheres of radius {} m, {} m apart, have gaps",
            number(hopper.radius),
            number(hopper.spacing)
        );
        refuse(
            message,
            format!("use `spacing = {}` or less", at_most(widest)),
        );
    }
}
