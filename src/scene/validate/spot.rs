//! Whether the tables of a scene suit the spot model, and the spots the box.

use super::rounded;
use crate::document::{Problem, at_least, at_most, number};
use crate::scene::{
    Guards, Neighbours, Output, RelaxationMethod, STICKING_OUT, Scene, Shape, Spot, SpotRelaxation,
    Start, StartSphere,
};

/// Largest displacement of a sphere in one move, in diameters: beyond it spheres pass through one
/// another.
const LONGEST_DISPLACEMENT: f64 = 0.5;

/// Largest number of spots present at once.
const MOST_SPOTS: f64 = 1e7;

/// Margin in diameters: spheres may start up to this far above the height of all spheres stacked on
/// each other.
const HIGHEST: f64 = 1000.0;

/// Deepest overlap at the start, in diameters: packings of soft spheres overlap a little.
const DEEPEST_OVERLAP: f64 = 0.05;

/// The first pair of listed spheres that overlaps by more than a share of the diameter (m): the
/// larger number first, and the distance (m).
fn overlap(spheres: &[StartSphere], share: f64, diameter: f64) -> Option<(usize, usize, f64)> {
    let least = diameter * (1.0 - share);
    let mut by_height: Vec<usize> = (0..spheres.len()).collect();
    let height = |it: &usize| spheres[*it].position[2];
    by_height.sort_by(|one, other| height(one).total_cmp(&height(other)));
    let mut found: Option<(usize, usize, f64)> = None;
    for (place, one) in by_height.iter().enumerate() {
        let above = by_height[place + 1..].iter();
        for other in above.take_while(|it| height(it) - height(one) < least) {
            let squares = (0..3).map(|axis| {
                let apart = spheres[*one].position[axis] - spheres[*other].position[axis];
                apart * apart
            });
            let distance = squares.sum::<f64>().sqrt();
            let pair = (*one.max(other), *one.min(other), distance);
            if distance < least && found.is_none_or(|it| (pair.0, pair.1) < (it.0, it.1)) {
                found = Some(pair);
            }
        }
    }
    found
}

/// Refuses a ratio with methods that have none.
fn check_relaxation_of_spots(relaxation: &SpotRelaxation, problems: &mut Vec<Problem>) {
    let name = match relaxation.method {
        RelaxationMethod::EveryMove => "every-move",
        RelaxationMethod::Off => "off",
        RelaxationMethod::AtRandom | RelaxationMethod::Counted | RelaxationMethod::Global => return,
    };
    if relaxation.ratio != SpotRelaxation::default().ratio {
        let message = format!("relaxation with `method = \"{name}\"` has no ratio");
        let help = "remove `ratio`, or use the method `at-random`, `counted` or `global`";
        let problem = Problem::new("spot.relaxation.ratio", message).help(help);
        problems.push(problem.at_key());
    }
}

impl Scene {
    pub(super) fn check_spot(&self, problems: &mut Vec<Problem>) {
        let Some(spot) = &self.spot else { return };
        self.check_tables_beside_spots(problems);
        self.check_spheres_of_spots(problems);
        check_relaxation_of_spots(&spot.relaxation, problems);
        let before = problems.len();
        self.check_box_of_spots(spot, problems);
        if problems.len() == before {
            self.check_sizes_of_spots(spot, problems);
            self.check_number_of_spots(spot, problems);
            self.check_listed_places(problems);
            self.check_listed_packing(problems);
        }
    }

    /// Refuses spheres that start outside the box, or higher than all of them stacked on each
    /// other.
    fn check_listed_places(&self, problems: &mut Vec<Problem>) {
        let (Start::List { spheres }, Some(tank)) = (&self.start, &self.tank) else {
            return;
        };
        let diameter = 2.0 * self.radius_range().1;
        let floor = tank.floor.unwrap_or(0.0);
        let highest = floor + (HIGHEST + spheres.len() as f64) * diameter;
        let inside = |place: [f64; 3]| -> bool {
            let ends =
                [tank.width, tank.depth].map(|side| side.map_or(f64::INFINITY, |it| 0.5 * it));
            let least = (0.5 - STICKING_OUT) * diameter;
            place[0].abs() <= ends[0] - least
                && place[1].abs() <= ends[1] - least
                && (floor + least..=highest).contains(&place[2])
        };
        let Some(sphere) = spheres.iter().position(|it| !inside(it.position)) else {
            return;
        };
        let [x, y, z] = spheres[sphere].position.map(number);
        let message = format!("sphere {sphere} at ({x}, {y}, {z}) is not inside the box");
        let help = format!(
            "centres are at least a radius from the walls, and at most {} m high",
            number(highest)
        );
        let path = format!("start.spheres[{sphere}]");
        problems.push(Problem::new(path, message).help(help));
    }

    /// Refuses spheres that start within each other: relaxation would throw them apart.
    fn check_listed_packing(&self, problems: &mut Vec<Problem>) {
        let Start::List { spheres } = &self.start else {
            return;
        };
        let diameter = 2.0 * self.radius_range().1;
        let Some((sphere, other, distance)) = overlap(spheres, DEEPEST_OVERLAP, diameter) else {
            return;
        };
        let message = format!(
            "spheres {other} and {sphere} are {} m apart, but {} m wide: they overlap by more than \
             {} % of that",
            rounded(distance),
            number(diameter),
            number(100.0 * DEEPEST_OVERLAP)
        );
        let help = "start from a packing without overlaps, such as `kind = \"packing\"`";
        let path = format!("start.spheres[{sphere}]");
        problems.push(Problem::new(path, message).help(help));
    }

    /// Nothing but spots moves the spheres.
    fn check_tables_beside_spots(&self, problems: &mut Vec<Problem>) {
        let dem = &self.dem;
        let mut there: Vec<&str> = [
            ("contact", dem.contact.is_some()),
            ("friction", dem.friction.is_some()),
            ("rolling", dem.rolling.is_some()),
            ("geometry", dem.geometry.is_some()),
            ("door", dem.door.is_some()),
            ("rest", dem.rest.is_some()),
            ("outlet", dem.outlet.is_some()),
            ("driven", !dem.driven.is_empty()),
            ("neighbours", dem.neighbours != Neighbours::default()),
            ("guards", dem.guards != Guards::default()),
        ]
        .into_iter()
        .filter_map(|(table, is_there)| is_there.then_some(table))
        .collect();
        there.extend(dem.effects.tables());
        for table in there {
            let message = format!("[{table}] belongs to the discrete element model");
            let help = format!("remove [{table}] or [spot]: spots alone move the spheres");
            problems.push(Problem::new(table, message).help(help));
        }
        self.check_output_of_spots(problems);
    }

    /// Refuses output that needs forces or a round tank.
    fn check_output_of_spots(&self, problems: &mut Vec<Problem>) {
        let (output, usual) = (&self.output, Output::default());
        let differing = [
            ("ledger", output.ledger),
            ("profile_bins", output.profile_bins.is_some()),
            ("rise_speeds", output.rise_speeds != usual.rise_speeds),
            ("rise_radii", output.rise_radii != usual.rise_radii),
        ];
        for (key, _) in differing.iter().filter(|(_, differs)| *differs) {
            let message = format!("`output.{key}` means nothing in a scene of spots");
            let problem = Problem::new(format!("output.{key}"), message);
            problems.push(problem.help("remove it").at_key());
        }
    }

    fn check_spheres_of_spots(&self, problems: &mut Vec<Problem>) {
        let (smallest, largest) = self.radius_range();
        if smallest < largest {
            let message = "the spot model needs spheres of one size";
            let help = "give `spheres.radius` as one number";
            problems.push(Problem::new("spheres.radius", message).help(help));
        }
        if self.spheres.shape != Shape::Sphere {
            let message = "the spot model does not support discs";
            problems.push(Problem::new("spheres.shape", message).help("remove it"));
        }
        if matches!(self.start, Start::Feed { .. }) {
            let message = "spots move a packing: spheres do not come in one after the other";
            let help = "use `kind = \"packing\"`, or a list or file of places";
            problems.push(Problem::new("start.kind", message).help(help));
        }
    }

    fn check_box_of_spots(&self, spot: &Spot, problems: &mut Vec<Problem>) {
        let tank = self.tank.clone().unwrap_or_default();
        let mut need = |key: &str, help: &str| {
            let message = format!("spots walk in a box, but there is no `{key}`");
            problems.push(Problem::new("spot", message).help(help).at_key());
        };
        if tank.width.is_none() {
            need("tank.width", "add `width` to [tank]");
        }
        if tank.depth.is_none() {
            need("tank.depth", "add `depth` to [tank]");
        }
        if tank.floor.is_none() {
            need("tank.floor", "add `floor` to [tank]");
        }
        if tank.opening().is_none() {
            need(
                "tank.orifice_radius",
                "add `orifice_radius` or `slit_width` to [tank]",
            );
        }
        let sides = [tank.width, tank.depth].into_iter().flatten();
        let half = 0.5 * sides.fold(f64::INFINITY, f64::min);
        let distance = self.wall_distance_of_spots(spot);
        if distance.abs() >= half {
            let message = format!(
                "spots that keep {} m from the walls have no room between walls {} m apart",
                rounded(distance),
                rounded(2.0 * half)
            );
            let help = format!(
                "use a `wall_distance` between {} and {}",
                at_least(-half),
                at_most(half)
            );
            problems.push(Problem::new("spot.wall_distance", message).help(help));
        }
        if spot.radius > half {
            let message = format!(
                "a spot of radius {} m is wider than the box, whose walls are {} m apart",
                number(spot.radius),
                rounded(2.0 * half)
            );
            let help = "make the spot smaller or the tank wider";
            problems.push(Problem::new("spot.radius", message).help(help));
        }
    }

    fn check_sizes_of_spots(&self, spot: &Spot, problems: &mut Vec<Problem>) {
        let radius = self.radius_range().1;
        if spot.radius <= radius {
            let message = format!(
                "a spot of radius {} m is no larger than a sphere of {} m",
                number(spot.radius),
                number(radius)
            );
            let help = "a spot covers several spheres: 2.6 diameters in the paper";
            problems.push(Problem::new("spot.radius", message).help(help));
        }
        let region = spot.relaxation.radius.filter(|it| *it <= radius);
        if let Some(region) = region {
            let message = format!(
                "a region of relaxation of radius {} m is no larger than a sphere of {} m",
                number(region),
                number(radius)
            );
            let help = "remove it: the default is the spot's radius plus a diameter";
            problems.push(Problem::new("spot.relaxation.radius", message).help(help));
        }
        let farthest = spot.farthest_displacement();
        let most = LONGEST_DISPLACEMENT * 2.0 * radius;
        if farthest > most {
            let message = format!(
                "a spot could move spheres by {} m at once, more than half of their diameter",
                rounded(farthest)
            );
            let (key, help) = match &spot.weighting {
                _ if spot.longest_step() > spot.radius => (
                    match spot.horizontal_step() > spot.vertical_step {
                        true => "spot.diffusion_length",
                        false => "spot.vertical_step",
                    },
                    "make it smaller: a step of a spot is longer than its radius",
                ),
                Some(it) if it.volume_ratio / it.least_count > 1.0 / spot.displacement_ratio => (
                    "spot.weighting.least_count",
                    "make it larger, or `volume_ratio` smaller",
                ),
                _ => (
                    "spot.displacement_ratio",
                    "make it larger, or the steps of the spot shorter",
                ),
            };
            problems.push(Problem::new(key, message).help(help));
        }
    }

    fn check_number_of_spots(&self, spot: &Spot, problems: &mut Vec<Problem>) {
        let moves = self.packed_height() / spot.vertical_step;
        let spots = spot.insertion_rate * (moves / spot.move_rate).min(self.time.duration);
        if spots > MOST_SPOTS {
            let message = format!(
                "about {} spots would be present at once, more than {}",
                rounded(spots),
                number(MOST_SPOTS)
            );
            let help = "make it smaller, or `move_rate` larger";
            problems.push(Problem::new("spot.insertion_rate", message).help(help));
        }
    }

    /// Distance d_w (m) that spots keep from the walls.
    pub fn wall_distance_of_spots(&self, spot: &Spot) -> f64 {
        let diameter = 2.0 * self.radius_range().1;
        spot.wall_distance.unwrap_or(diameter)
    }
}

impl Spot {
    /// Step of a spot in either direction along x and along y (m): sqrt(2 b Δz).
    pub fn horizontal_step(&self) -> f64 {
        (2.0 * self.diffusion_length * self.vertical_step).sqrt()
    }

    /// Length of a spot's step away from walls (m).
    fn longest_step(&self) -> f64 {
        let across = self.horizontal_step();
        (2.0 * across * across + self.vertical_step * self.vertical_step).sqrt()
    }

    /// Longest displacement of a sphere in one move (m).
    fn farthest_displacement(&self) -> f64 {
        let step = self.longest_step();
        let fixed = 1.0 / self.displacement_ratio;
        let weighted = self.weighting.map(|it| it.volume_ratio / it.least_count);
        // In a corner a sphere may be in range of a spot and three of its images.
        let images = if self.reflection { 4.0 } else { 1.0 };
        images * step * weighted.map_or(fixed, |it| it.max(fixed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn scene(change: &str) -> Result<Scene, String> {
        let text = format!(
            "{change}
            spheres = {{ count = 2, radius = 0.5, density = 1.91 }}
            start = {{ kind = \"list\", spheres = [
                {{ position = [0, 0, 0.5] }}, {{ position = [2, 0, 0.5] }},
            ] }}
            tank = {{ width = 20.0, depth = 8.0, floor = 0.0, orifice_radius = 4.0 }}
            time = {{ duration = 4.0, frame_interval = 2.0 }}
            output = {{ snapshot_interval = 2.0 }}
            [spot]
            radius = 2.6
            displacement_ratio = 399.0
            diffusion_length = 2.28
            vertical_step = 0.1
            insertion_rate = 375.0
            move_rate = 28.0"
        );
        Scene::from_toml(&text, Path::new("scene.toml")).map_err(|error| error.to_string())
    }

    #[test]
    fn frames_are_the_only_steps() {
        let scene = scene("").unwrap();
        assert_eq!(scene.time.dt, 2.0);
        let finer = scene.with_values([("time.frame_interval", 1.0)]).unwrap();
        assert_eq!(finer.with_chosen_step().unwrap().time.dt, 1.0);
        let step = scene.spot.unwrap().horizontal_step();
        assert!((step * step - 0.456).abs() < 1e-12);
    }

    #[test]
    fn what_else_moves_spheres_is_refused() {
        let error = scene("gravity = { acceleration = 9.8 }").unwrap_err();
        assert!(
            error.contains("[gravity] belongs to the discrete element model"),
            "{error}"
        );
        for table in [
            "added_mass = { density = 1.2, coefficient = 0.5 }",
            "spin_damping = { coefficient = 1e-8 }",
            "neighbours = { search = \"all-pairs\" }",
            "guards = { overlap = 0.5 }",
        ] {
            let error = scene(table).unwrap_err();
            let name = table.split(' ').next().unwrap();
            let expected = format!("[{name}] belongs to the discrete element model");
            assert!(error.contains(&expected), "{error}");
        }
        let error = scene("accuracy = \"draft\"").unwrap_err();
        assert!(
            error.contains("which a scene of spots does not have"),
            "{error}"
        );
    }
}
