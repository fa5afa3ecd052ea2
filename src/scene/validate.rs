//! What a scene must satisfy beyond the kinds of its values.

use super::schema::SCENE;
use super::{Contact, Radii, Scene, Start};
use crate::dem::timestep;
use crate::document::Problem;
use std::f64::consts::PI;

/// Largest share of the space open to the spheres that a random start may fill. Random placement
/// one by one without overlap cannot exceed 0.384 (Zhang and Torquato, Phys. Rev. E 88, 053312
/// (2013)) and needs ever more attempts on the way there.
const PACKING_LIMIT: f64 = 0.30;

/// Two times count as commensurate if their ratio is a whole number within this.
const ROUNDING: f64 = 1e-6;

impl Scene {
    /// Everything that is wrong with this scene; a scene without problems can be run.
    ///
    /// Radii and starts that are still the names of files are not looked into.
    pub fn problems(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        SCENE.check(&self.tree(), "", &mut problems);
        // The questions below take numbers in their ranges for granted.
        if problems.is_empty() {
            self.check_laws(&mut problems);
            self.check_spheres(&mut problems);
            self.check_start(&mut problems);
            self.check_times(&mut problems);
        }
        if problems.is_empty() {
            self.check_time_step(&mut problems);
        }
        problems
    }

    fn check_laws(&self, problems: &mut Vec<Problem>) {
        if self.drag.is_none() {
            let users = [
                ("swirl", self.swirl.is_some()),
                ("updraught", self.updraught.is_some()),
            ];
            for (name, _) in users.iter().filter(|(_, present)| *present) {
                let message = format!("[{name}] needs a drag law, but there is no [drag]");
                let help = "add [drag] with `law` and `linear` or `quadratic`";
                problems.push(Problem::new(*name, message).help(help));
            }
        } else if self.swirl.is_none() && self.updraught.is_none() {
            let message = "[drag] acts through [swirl] or [updraught], but there is neither";
            let help = "add [swirl], with `omega = 0.0` for still air, or remove [drag]";
            problems.push(Problem::new("drag", message).help(help));
        }
        if self.friction.is_some() && self.contact.is_none() {
            let message = "[friction] acts at contacts, but there is no [contact]";
            let help = "add [contact] with `law = \"hertz\"`, or remove [friction]";
            problems.push(Problem::new("friction", message).help(help));
        }
        if self.spin_damping.is_some() && self.friction.is_none() {
            let message = "[spin_damping] acts on spins, but without [friction] there are none";
            let help = "add [friction], or remove [spin_damping]";
            problems.push(Problem::new("spin_damping", message).help(help));
        }
        if let Some(Contact::Hertz {
            dissipation_time,
            restitution,
            ..
        }) = &self.contact
        {
            match (dissipation_time, restitution) {
                (None, None) => problems.push(
                    Problem::new("contact", "[contact] does not say how much it dissipates")
                        .help("add `dissipation_time` (0.0 is elastic) or `restitution`"),
                ),
                (Some(_), Some(_)) => problems.push(
                    Problem::new(
                        "contact.restitution",
                        "`contact.dissipation_time` and `contact.restitution` exclude each other",
                    )
                    .help("keep the one that is known and remove the other"),
                ),
                _ => {}
            }
        }
    }

    fn check_spheres(&self, problems: &mut Vec<Problem>) {
        let count = self.spheres.count;
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
            _ => {}
        }
        let Some(tank) = self.tank.as_ref().and_then(|tank| tank.radius) else {
            return;
        };
        let largest = self.radius_range().1;
        if largest >= tank {
            let message =
                format!("spheres of radius {largest} m do not fit into a tank of radius {tank} m");
            problems.push(
                Problem::new("spheres.radius", message)
                    .help("both are in metres; make the spheres smaller or `tank.radius` larger"),
            );
        }
    }

    fn check_start(&self, problems: &mut Vec<Problem>) {
        match &self.start {
            Start::Random { z_min, z_max, .. } => self.check_random_start(*z_min, *z_max, problems),
            Start::List { .. } => self.check_listed_start(problems),
            Start::File { .. } => {}
        }
    }

    fn check_random_start(&self, z_min: f64, z_max: f64, problems: &mut Vec<Problem>) {
        if z_min > z_max {
            let message = format!("`start.z_min` = {z_min} is above `start.z_max` = {z_max}");
            problems.push(Problem::new("start.z_min", message).help("exchange the two"));
            return;
        }
        let Some(tank) = self.tank.as_ref().and_then(|tank| tank.radius) else {
            let message = "a random start needs the cylinder of a tank to be in";
            let help = "add `radius` to [tank], or list the spheres with `kind = \"list\"`";
            problems.push(Problem::new("start.kind", message).help(help));
            return;
        };
        let largest = self.radius_range().1;
        if let Some(floor) = self.tank.as_ref().and_then(|tank| tank.floor)
            && z_min - floor < largest * (1.0 - ROUNDING)
        {
            let message = format!(
                "`start.z_min` = {z_min} puts spheres of radius {largest} m into the floor at \
                 {floor} m"
            );
            let help = format!("use at least `z_min = {}`", rounded(floor + largest));
            problems.push(Problem::new("start.z_min", message).help(help));
        }
        let radii = &self.spheres.radius;
        let volume = self.spheres.count as f64 * radii.mean_volume();
        let space = PI * tank * tank * (z_max - z_min + 2.0 * radii.mean());
        if largest < tank && volume > PACKING_LIMIT * space {
            let message = format!(
                "{} do not fit: they would fill {:.0} % of the space between `start.z_min` and \
                 `start.z_max`, and a random start fills {:.0} % at most",
                plural(self.spheres.count, "sphere", "spheres"),
                100.0 * volume / space,
                100.0 * PACKING_LIMIT
            );
            let height = volume / (PACKING_LIMIT * PI * tank * tank) - 2.0 * radii.mean();
            let help = format!(
                "use `z_max = {}` or more, or fewer or smaller spheres",
                rounded_up(z_min + height)
            );
            problems.push(Problem::new("start.z_max", message).help(help));
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
        let tank = self.tank.as_ref();
        let (radius, floor) = (tank.and_then(|t| t.radius), tank.and_then(|t| t.floor));
        for (index, sphere) in spheres.iter().enumerate() {
            let [x, y, z] = sphere.position;
            let wall = radius.is_some_and(|radius| x * x + y * y >= radius * radius);
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

    fn check_times(&self, problems: &mut Vec<Problem>) {
        let time = &self.time;
        let interval = time.frame_interval;
        let whole_steps = multiple(interval, time.dt);
        if !whole_steps {
            problems.push(not_multiple(
                "time.frame_interval",
                interval,
                "time.dt",
                time.dt,
            ));
        }
        if !multiple(time.duration, interval) {
            let name = "time.frame_interval";
            problems.push(not_multiple("time.duration", time.duration, name, interval));
        }
        let snapshots = self.output.snapshot_interval;
        if snapshots > 0.0 && !multiple(snapshots, interval) {
            let path = "output.snapshot_interval";
            problems.push(not_multiple(
                path,
                snapshots,
                "time.frame_interval",
                interval,
            ));
        }
    }

    fn check_time_step(&self, problems: &mut Vec<Problem>) {
        let Some(limit) = timestep::largest_stable(self) else {
            return;
        };
        let dt = self.time.dt;
        if dt <= limit.seconds {
            return;
        }
        let message = format!(
            "`time.dt` = {dt:e} s is {:.3} times the {} limit of {:.3e} s, above which the \
             motion is unstable ({}; impacts at up to {:.3} m/s)",
            dt / limit.seconds,
            limit.name,
            limit.seconds,
            limit.explanation,
            timestep::fastest_impact(self),
        );
        // A whole number of steps per frame, and some accuracy besides stability.
        let steps = libm::ceil(2.0 * self.time.frame_interval / limit.seconds);
        let help = format!(
            "use `dt = {:e}` or less: half the limit, {steps} steps per frame",
            rounded(self.time.frame_interval / steps)
        );
        problems.push(Problem::new("time.dt", message).help(help));
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

    /// The smallest radius of a sphere (m).
    pub fn smallest_radius(&self) -> f64 {
        self.radius_range().0
    }
}

fn plural(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// Whether `time` is a whole number of times `unit`, once or more often.
fn multiple(time: f64, unit: f64) -> bool {
    let ratio = time / unit;
    let whole = libm::round(ratio);
    whole >= 1.0 && (ratio - whole).abs() <= ROUNDING * whole.min(1e3)
}

fn not_multiple(path: &str, time: f64, unit_path: &str, unit: f64) -> Problem {
    let message = format!(
        "`{path}` = {time} s must be a whole multiple of `{unit_path}` = {unit} s, but is {} times \
         that",
        rounded(time / unit)
    );
    let below = libm::floor(time / unit);
    let multiples = match below {
        below if below < 1.0 => format!("`{unit} s`"),
        below => format!(
            "{} s or {} s",
            rounded(below * unit),
            rounded((below + 1.0) * unit)
        ),
    };
    Problem::new(path, message).help(format!("use {multiples}"))
}

/// To six significant digits, for messages.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// Upward to three significant digits, for messages.
fn rounded_up(value: f64) -> f64 {
    let three: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    if three >= value {
        return three;
    }
    format!("{:.2e}", value + 0.005 * value.abs())
        .parse()
        .unwrap_or(value)
}
