//! Whether the spheres of a feed have room where they come in, and leave it again.

use crate::dem::process::ROUNDING;
use crate::dem::timestep::fastest_impact;
use crate::document::{Problem, at_most, number, rounded_down, rounded_up};
use crate::particles::vector::Vector;
use crate::scene::{FixedSphere, Geometry, Scene, Start, Tank, rounded};
use crate::start;
use crate::walls::Wall;

/// Largest number of moves in search of a clear place: more than a corner between walls needs.
const MOST_MOVES: usize = 100;

/// Where the largest sphere of a feed may come in: anywhere within `spread` (m) of a position along
/// x.
#[derive(Clone, Copy)]
struct FeedPlace {
    position: [f64; 3],
    spread: f64,
    radius: f64,
}

impl Scene {
    /// Checks that nothing is in the way of the largest sphere, wherever along x it comes in. Any
    /// overlap is a fault: spheres come in one by one, and each would be pushed out.
    pub(super) fn check_feed_place(&self, problems: &mut Vec<Problem>) {
        let Start::Feed {
            position, spread, ..
        } = self.start
        else {
            return;
        };
        // Spot scenes cannot have a feed: it is refused elsewhere.
        if self.spot.is_some() {
            return;
        }
        let place = FeedPlace {
            position,
            spread,
            radius: self.radius_range().1,
        };
        let before = problems.len();
        self.check_fixed_spheres_at(place, problems);
        // One position at a time is proposed.
        if problems.len() == before && self.misfit().is_none() {
            self.check_walls_at(place, problems);
        }
        self.check_room_for_the_second(problems);
        self.check_driven_at_the_feed(problems);
    }

    fn check_fixed_spheres_at(&self, place: FeedPlace, problems: &mut Vec<Problem>) {
        let fixed = self.dem.geometry.as_ref().map(Geometry::spheres);
        let fixed = fixed.unwrap_or_default();
        let fixed = [fixed.walls, fixed.door].concat();
        if let Some(sphere) = place.in_the_way(&fixed) {
            let [x, _, z] = sphere.position;
            let message = format!(
                "spheres of radius {} m come in where a fixed one stands, at ({}, {}) m",
                number(place.radius),
                rounded(x),
                rounded(z)
            );
            let help = match self.clear_of_fixed(place, &fixed) {
                Some(clear) => format!("use `position = [{}]`", clear.map(number).join(", ")),
                None => "move it away from there".to_owned(),
            };
            problems.push(Problem::new("start.position", message).help(help));
        }
    }

    /// The nearest position beside, below or above a place at which neither fixed spheres nor walls
    /// are in the way, over the whole spread, if there is one. Rounded to six digits.
    fn clear_of_fixed(&self, place: FeedPlace, fixed: &[FixedSphere]) -> Option<[f64; 3]> {
        let mut start = place;
        if let Some(tank) = self.tank.as_ref()
            && self.fault_at(place.position, place.radius).is_some()
        {
            start.position = place.clear_of(tank);
        }
        let ways = [(0, -1.0), (0, 1.0), (2, -1.0), (2, 1.0)];
        let found = ways.into_iter().filter_map(|(axis, sign)| {
            let mut place = start;
            for _ in 0..MOST_MOVES {
                match place.in_the_way(fixed) {
                    Some(sphere) => place.position[axis] = place.beyond(sphere, axis, sign),
                    None => break,
                }
            }
            let [x, y, z] = place.position;
            let is_free = |x: f64| self.fault_at([x, y, z], place.radius).is_none();
            let is_clear = place.in_the_way(fixed).is_none() && is_free(x);
            let has_room = is_free(x - place.spread) && is_free(x + place.spread);
            is_clear.then_some((has_room, place.position))
        });
        let way = |it: [f64; 3]| (Vector::from(it) - Vector::from(place.position)).norm();
        let nearest = found.min_by(|(room, one), (other_room, other)| {
            let order = other_room.cmp(room);
            order.then(way(*one).total_cmp(&way(*other)))
        });
        nearest.map(|(_, position)| position)
    }

    fn check_walls_at(&self, place: FeedPlace, problems: &mut Vec<Problem>) {
        let FeedPlace {
            position: mut clear,
            spread,
            radius,
        } = place;
        if let Some(fault) = self.fault_at(clear, radius) {
            let message = format!("spheres of radius {} m come in {fault}", number(radius));
            let problem = Problem::new("start.position", message);
            let tank = self.tank.as_ref().map(|tank| place.clear_of(tank));
            let Some(inside) = tank.filter(|it| self.fault_at(*it, radius).is_none()) else {
                problems.push(problem.help("move it away from there"));
                return;
            };
            clear = inside;
            let help = format!("use `position = [{}]`", clear.map(number).join(", "));
            problems.push(problem.help(help));
        }
        // Walls are nearest at an end.
        let [x, y, z] = clear;
        let mut ends = [x - spread, x + spread].into_iter();
        if let Some(fault) = ends.find_map(|x| self.fault_at([x, y, z], radius)) {
            let message = format!(
                "spheres of radius {} m that come in up to {} m aside would be {fault}",
                number(radius),
                number(spread)
            );
            let most = self.widest_spread(FeedPlace {
                position: clear,
                ..place
            });
            let help = format!("use `spread = {most}` or less");
            problems.push(Problem::new("start.spread", message).help(help));
        }
    }

    /// The widest spread (m), to six digits, that fits at a clear position. The shifts at which no
    /// wall is in the way form an interval.
    fn widest_spread(&self, place: FeedPlace) -> String {
        let [x, y, z] = place.position;
        let (mut most, mut too_wide) = (0.0, place.spread);
        for _ in 0..f64::MANTISSA_DIGITS {
            let middle = 0.5 * (most + too_wide);
            let mut ends = [x - middle, x + middle].into_iter();
            match ends.any(|x| self.fault_at([x, y, z], place.radius).is_some()) {
                true => too_wide = middle,
                false => most = middle,
            }
        }
        at_most(most)
    }

    /// What is wrong with the place of a sphere that comes in, if walls are in its way.
    fn fault_at(&self, centre: [f64; 3], radius: f64) -> Option<String> {
        let tank = self.tank.as_ref();
        let is_closed = self.dem.door.is_some();
        if let Some(outside) = tank.and_then(|tank| tank.outside(centre, is_closed)) {
            return Some(outside.to_owned());
        }
        self.dem.contact.as_ref()?;
        let contacts = Wall::of_scene(self).into_iter().map(|wall| {
            let contact = wall.contact(centre.into(), radius);
            (
                wall.name,
                if contact.touches {
                    contact.overlap
                } else {
                    0.0
                },
            )
        });
        let (name, deepest) = contacts.max_by(|a, b| a.1.total_cmp(&b.1))?;
        (deepest > ROUNDING * radius).then(|| format!("{} m deep in the {name}", rounded(deepest)))
    }

    /// A sphere that stays where it came in leaves no room for the next.
    fn check_room_for_the_second(&self, problems: &mut Vec<Problem>) {
        let Start::Feed { spread, .. } = self.start else {
            return;
        };
        let gravity = self.gravity_in_fluid();
        let falls = gravity.is_some_and(|gravity| gravity.acceleration != 0.0);
        let moves = falls || fastest_impact(self) > 0.0;
        if !moves && self.spheres.count > 1 && spread == 0.0 {
            let message = "nothing moves spheres away from where they come in, so the second finds \
                no room";
            let help = "give them a `velocity`, or add [gravity]";
            problems.push(Problem::new("start", message).help(help));
        }
    }

    /// Refuses driven spheres that stay where they came in until the end of the run, as they leave
    /// no room for a later one.
    fn check_driven_at_the_feed(&self, problems: &mut Vec<Problem>) {
        let (Start::Feed { interval, .. }, false) = (&self.start, self.dem.driven.is_empty())
        else {
            return;
        };
        let Ok(spheres) = start::place(self) else {
            return;
        };
        for (k, path) in self.dem.driven.iter().enumerate() {
            let number = path.sphere;
            let time = self.time.duration - number as f64 * interval;
            let way = path.farthest(time);
            let stays_in_the_way = |later: usize| {
                let apart = (spheres.position[number] - spheres.position[later]).norm();
                apart + way < spheres.radius[number] + spheres.radius[later]
            };
            if let Some(later) = (number + 1..spheres.len()).find(|it| stays_in_the_way(*it)) {
                let message = format!(
                    "the driven sphere {number} stays where sphere {later} is to come in, which \
                     would wait for ever"
                );
                let help = "give it a `velocity` that takes it away, or drive the last sphere";
                problems.push(Problem::new(format!("driven[{k}]"), message).help(help));
            }
        }
    }
}

impl FeedPlace {
    /// The first of these spheres that overlaps what comes in.
    fn in_the_way<'a>(&self, fixed: &'a [FixedSphere]) -> Option<&'a FixedSphere> {
        fixed.iter().find(|sphere| {
            let [aside, y, z] = self.offset(sphere);
            let reach = (self.radius + sphere.radius) * (1.0 - ROUNDING);
            aside * aside + y * y + z * z < reach * reach
        })
    }

    /// How far a sphere is from the nearest centre of what comes in, along each axis (m).
    fn offset(&self, sphere: &FixedSphere) -> [f64; 3] {
        let [x, y, z] = [0, 1, 2].map(|axis| (sphere.position[axis] - self.position[axis]).abs());
        [(x - self.spread).max(0.0), y, z]
    }

    /// The coordinate (m) along an axis at which what comes in is just beyond a sphere, on the side
    /// that `sign` gives.
    fn beyond(&self, sphere: &FixedSphere, axis: usize, sign: f64) -> f64 {
        let reach = self.radius + sphere.radius;
        let mut offset = self.offset(sphere);
        offset[axis] = 0.0;
        let along = (reach * reach - Vector::from(offset).norm_squared()).max(0.0);
        let spread = if axis == 0 { self.spread } else { 0.0 };
        let place = sphere.position[axis] + sign * (along.sqrt() + spread);
        match sign > 0.0 {
            true => rounded_up(place),
            false => rounded_down(place),
        }
    }

    /// The nearest position at which walls and floor are not in the way, with as much of the spread
    /// as fits. Rounded to six digits.
    fn clear_of(&self, tank: &Tank) -> [f64; 3] {
        let Self {
            position: [x, y, z],
            spread,
            radius,
        } = *self;
        let z = match tank.floor {
            Some(floor) => z.max(rounded_up(floor + radius)),
            None => z,
        };
        if let Some(wall) = tank.radius {
            let reach = wall - radius;
            let spread = spread.min(reach);
            // The largest share t of the distance from the axis with (t |x| + spread)^2 + (t y)^2
            // = reach^2.
            let square = x * x + y * y;
            let half = spread * x.abs();
            let root = (half * half + square * (reach * reach - spread * spread)).sqrt();
            let share = match square > 0.0 {
                true => ((root - half) / square).min(1.0),
                false => 1.0,
            };
            let [x, y] = [x, y].map(|place| match share < 1.0 {
                true => rounded_down((place * share).abs()).copysign(place),
                false => place,
            });
            return [x, y, z];
        }
        let within = |place: f64, side: Option<f64>, spread: f64| match side {
            Some(side) => {
                let most = (0.5 * side - radius - spread).max(0.0);
                match place.abs() > most {
                    true => rounded_down(most).copysign(place),
                    false => place,
                }
            }
            None => place,
        };
        [within(x, tank.width, spread), within(y, tank.depth, 0.0), z]
    }
}
