//! Whether the spheres of a feed have room where they come in, and leave it again.

use crate::dem::overlap;
use crate::dem::timestep::fastest_impact;
use crate::dem::walls::Wall;
use crate::document::{Problem, at_most, number, rounded_down, rounded_up};
use crate::scene::{Geometry, Scene, Start, Tank, rounded};

/// Overlaps below this share of the radius come from rounded positions.
const ROUNDING: f64 = 1e-9;

/// Where the largest sphere of a feed may come in: anywhere within `spread` (m) of a position along
/// x.
#[derive(Clone, Copy)]
struct Place {
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
        // Spots move no feed, which is refused there.
        if self.spot.is_some() {
            return;
        }
        let place = Place {
            position,
            spread,
            radius: self.radius_range().1,
        };
        self.check_fixed_spheres_at(place, problems);
        if self.misfit().is_none() {
            self.check_walls_at(place, problems);
        }
        self.check_room_for_the_second(problems);
    }

    fn check_fixed_spheres_at(&self, place: Place, problems: &mut Vec<Problem>) {
        let Place {
            position,
            spread,
            radius,
        } = place;
        let fixed = self.dem.geometry.as_ref().map(Geometry::spheres);
        let fixed = fixed.unwrap_or_default();
        let in_the_way = fixed.walls.iter().chain(&fixed.door).find(|sphere| {
            let [x, y, z] = std::array::from_fn(|axis| sphere.position[axis] - position[axis]);
            let aside = (x.abs() - spread).max(0.0);
            let reach = (radius + sphere.radius) * (1.0 - ROUNDING);
            aside * aside + y * y + z * z < reach * reach
        });
        if let Some(sphere) = in_the_way {
            let [x, _, z] = sphere.position;
            let message = format!(
                "spheres of radius {} m come in where a fixed one stands, at ({}, {}) m",
                number(radius),
                rounded(x),
                rounded(z)
            );
            problems.push(Problem::new("start.position", message).help("move it away from there"));
        }
    }

    fn check_walls_at(&self, place: Place, problems: &mut Vec<Problem>) {
        let Some(tank) = &self.tank else { return };
        let Place {
            position: [x, y, z],
            spread,
            radius,
        } = place;
        let mut clear = [x, y, z];
        if let Some(fault) = self.fault_at(clear, radius) {
            clear = place.clear_of(tank);
            let message = format!("spheres of radius {} m come in {fault}", number(radius));
            let help = format!("use `position = [{}]`", clear.map(number).join(", "));
            problems.push(Problem::new("start.position", message).help(help));
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
            let most = self.widest_spread(Place {
                position: clear,
                ..place
            });
            let help = format!("use `spread = {most}` or less");
            problems.push(Problem::new("start.spread", message).help(help));
        }
    }

    /// The widest spread (m), to six digits, at a clear position where its own is too wide. The
    /// shifts at which no wall is in the way are an interval.
    fn widest_spread(&self, place: Place) -> String {
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
        let tank = self.tank.as_ref()?;
        if let Some(outside) = tank.outside(centre, self.dem.door.is_some()) {
            return Some(outside.to_owned());
        }
        self.dem.contact.as_ref()?;
        let contacts = overlap::walls(self).into_iter().map(|wall| {
            let contact = wall.contact(centre.into(), radius);
            (
                wall.name(),
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
            let message = "nothing moves spheres from where they come in: the second finds no room";
            let help = "give them a `velocity`, or add [gravity]";
            problems.push(Problem::new("start", message).help(help));
        }
    }
}

impl Place {
    /// The nearest position at which walls and floor are not in the way, with as much of the spread
    /// as there is room for; to six digits.
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
