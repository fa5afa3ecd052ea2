//! Whether the listed walls are walls, and go with the rest of the scene.

use crate::document::{Problem, number};
use crate::particles::vector::Vector;
use crate::scene::{
    ConeWall, DiscWall, Friction, Integrator, PlateWall, Scene, SceneWall, Shape, Start,
};

/// Directions are parallel if the sine of their angle is below this.
const PARALLEL: f64 = 1e-9;

/// A velocity is across a wall if more than this share of it is.
const ACROSS: f64 = 1e-6;

impl Scene {
    pub(super) fn check_walls(&self, problems: &mut Vec<Problem>) {
        for (place, wall) in self.dem.walls.iter().enumerate() {
            let mut found = Vec::new();
            check_shape(wall, &mut found);
            if found.is_empty() {
                self.check_wall_in_scene(wall, &mut found);
            }
            self.check_name(place, wall, &mut found);
            let path = format!("wall[{place}]");
            problems.extend(found.into_iter().map(|problem| problem.within(&path)));
        }
        if !self.dem.walls.is_empty() {
            self.check_beside_walls(problems);
        }
    }

    fn check_name(&self, place: usize, wall: &SceneWall, problems: &mut Vec<Problem>) {
        let name = wall.called(place);
        let is_simple = |it: char| it.is_ascii_lowercase() || it.is_ascii_digit() || it == '_';
        let begins = name.starts_with(|it: char| it.is_ascii_lowercase());
        if !begins || !name.chars().all(is_simple) {
            let message = format!("{name:?} cannot be part of a column's name");
            let help =
                "use lower-case letters, digits and underscores, such as `name = \"funnel\"`";
            problems.push(Problem::new("name", message).help(help));
        }
        let before = self.dem.walls[..place].iter().enumerate();
        let mut names = before.map(|(place, wall)| wall.called(place));
        let mut of_tank = self.tank.iter().flat_map(|tank| tank.wall_names());
        if names.any(|it| it == name) || of_tank.any(|it| it == name) {
            let message = format!("another wall is called {name:?} already");
            problems.push(Problem::new("name", message).help("give each wall its own name"));
        }
    }

    /// Whether a wall goes with the laws and the door of the scene.
    fn check_wall_in_scene(&self, wall: &SceneWall, problems: &mut Vec<Problem>) {
        let mut refuse = |key: &str, message: &str, help: &str| {
            problems.push(Problem::new(key, message).help(help));
        };
        let motion = match wall.velocity {
            Some(_) => "velocity",
            None => "angular_velocity",
        };
        match &self.dem.friction {
            None if wall.friction_coefficient.is_some() => refuse(
                "friction_coefficient",
                "a coefficient of friction needs [friction], but there is none",
                "add [friction] with its law, or remove the coefficient",
            ),
            None if wall.moves() => refuse(
                motion,
                "a wall that slides in itself acts by friction, but there is no [friction]",
                "add [friction] with its law, or let the wall rest",
            ),
            Some(Friction::Spin(_)) if wall.moves() => refuse(
                motion,
                "spin friction ignores sliding, so that a wall that slides moves nothing",
                "use another friction law, such as `law = \"coulomb\"`",
            ),
            _ => {}
        }
        if wall.is_door && self.dem.door.is_none() {
            refuse(
                "is_door",
                "this wall goes away when the door opens, but there is no [door]",
                "add [door], with the time at which it opens in `opens`, or without",
            );
        }
        if self.spheres.shape == Shape::Disc && is_across_plane_of_discs(wall) {
            refuse(
                "",
                "discs lie in the plane y = 0, but this wall would push them out of it",
                "use planes and plates whose normals have no part along y, or \
                 `shape = \"sphere\"`",
            );
        }
    }

    /// Refuses what does not know listed walls.
    fn check_beside_walls(&self, problems: &mut Vec<Problem>) {
        if self.time.integrator == Integrator::AdaptiveVerlet {
            let message = "adaptive Verlet does not know the walls of `wall`";
            let help = "use another integrator, such as `integrator = \"velocity-verlet\"`";
            problems.push(Problem::new("time.integrator", message).help(help));
        }
        if matches!(self.start, Start::Packing {}) {
            let message = "a packing lies in the box of [tank], without the walls of `wall`";
            let help = "let the spheres fall from a start of `kind = \"random\"`, or list them";
            problems.push(Problem::new("start.kind", message).help(help));
        }
        if self.spot.is_some() {
            let message = "spots move in the box of [tank], without the walls of `wall`";
            problems.push(Problem::new("wall", message).help("remove them"));
        }
    }
}

/// Whether a wall pushes spheres along y.
fn is_across_plane_of_discs(wall: &SceneWall) -> bool {
    let normal = match (&wall.plane, &wall.plate) {
        (Some(plane), _) => plane.unit_normal(),
        (_, Some(plate)) => {
            let [first, second] = plate.edges();
            first.cross(second).unit()
        }
        _ => return true,
    };
    normal.y.abs() > PARALLEL
}

fn check_shape(wall: &SceneWall, problems: &mut Vec<Problem>) {
    let shapes: Vec<_> = wall.shapes().collect();
    let help = "give one of `plane`, `plate`, `disc`, `cylinder` and `cone`";
    match shapes[..] {
        [] => problems.push(Problem::new("", "this wall has no shape").help(help)),
        [_] => {}
        [first, second, ..] => {
            let message = format!("`{first}` and `{second}` exclude each other");
            let help = "a wall has one shape; write a second `[[wall]]` for the other";
            problems.push(Problem::new(second, message).help(help));
        }
    }
    if let Some(plane) = &wall.plane {
        check_direction("plane.normal", plane.normal, problems);
        check_direction("plane.tilt_axis", plane.tilt_axis, problems);
    }
    if let Some(plate) = &wall.plate {
        check_plate(plate, problems);
    }
    if let Some(disc) = &wall.disc {
        check_direction("disc.axis", disc.axis, problems);
        check_hole(disc, problems);
    }
    if let Some(cylinder) = &wall.cylinder {
        check_direction("cylinder.axis", cylinder.axis, problems);
    }
    if let Some(cone) = &wall.cone {
        check_direction("cone.axis", cone.axis, problems);
        check_cone(cone, problems);
    }
    if problems.is_empty() {
        check_motion(wall, problems);
    }
}

fn check_direction(key: &str, direction: [f64; 3], problems: &mut Vec<Problem>) {
    let squared = Vector::from(direction).norm_squared();
    if !(1e-30..=1e30).contains(&squared) {
        let message = format!("`{key}` has no direction");
        let help = "give a vector such as `[0, 0, 1]`; only its direction counts";
        problems.push(Problem::new(key, message).help(help));
    }
}

fn check_plate(plate: &PlateWall, problems: &mut Vec<Problem>) {
    check_direction("plate.tilt_axis", plate.tilt_axis, problems);
    let [first, second] = [plate.first_edge, plate.second_edge].map(Vector::from);
    let lengths = [first, second].map(Vector::norm);
    let keys = ["plate.first_edge", "plate.second_edge"];
    if let Some(which) = (0..2).find(|&which| !(lengths[which] >= 1e-9)) {
        let message = format!("`{}` has no length", keys[which]);
        let help = "give the vector from `corner` to the end of that edge (m)";
        problems.push(Problem::new(keys[which], message).help(help));
    } else if first.cross(second).norm() <= PARALLEL * lengths[0] * lengths[1] {
        let message = "the two edges are parallel, so that the plate has no area";
        let help = "give two edges that meet at an angle";
        problems.push(Problem::new("plate.second_edge", message).help(help));
    }
}

fn check_hole(disc: &DiscWall, problems: &mut Vec<Problem>) {
    if let Some(hole) = disc.hole_radius.filter(|hole| *hole >= disc.radius) {
        let message = format!(
            "a hole of radius {} m leaves nothing of a disc of radius {} m",
            number(hole),
            number(disc.radius)
        );
        let help = "make the hole smaller or the disc larger";
        problems.push(Problem::new("disc.hole_radius", message).help(help));
    }
}

fn check_cone(cone: &ConeWall, problems: &mut Vec<Problem>) {
    let mut refuse = |key: &str, message: &str, help: &str| {
        problems.push(Problem::new(key, message).help(help));
    };
    let both = cone.radius.max(cone.end_radius);
    match (cone.length, cone.angle) {
        (Some(_), Some(_)) => refuse(
            "cone.angle",
            "`length` and `angle` exclude each other",
            "remove one of the two: each follows from the other and the radii",
        ),
        (None, None) => refuse(
            "cone",
            "this cone has neither `length` nor `angle`",
            "give its length along the axis (m), or its angle with the axis (rad)",
        ),
        _ if !(both >= 1e-9) => refuse(
            "cone.radius",
            "both radii are 0, so that the cone has no area",
            "give one of them a radius (m)",
        ),
        (None, Some(_)) if cone.radius == cone.end_radius => refuse(
            "cone.angle",
            "the radii are equal, so that the cone has no angle with its axis",
            "use a `cylinder`, or another radius",
        ),
        _ => {}
    }
}

/// Refuses motions that would move a wall out of its place.
fn check_motion(wall: &SceneWall, problems: &mut Vec<Problem>) {
    let shape = wall.shapes().next().unwrap_or_default();
    if wall.velocity.is_some() && wall.angular_velocity.is_some() {
        let message = "`velocity` and `angular_velocity` exclude each other";
        let help = "a wall slides along itself, or turns about its axis; remove one of the two";
        problems.push(Problem::new("angular_velocity", message).help(help));
        return;
    }
    if wall.angular_velocity.is_some() && wall.plate.is_some() {
        let message = "a plate that turns would leave its place";
        let help = "use a `disc`, or a `velocity` along the plate";
        problems.push(Problem::new("angular_velocity", message).help(help));
    }
    let Some(velocity) = wall.velocity.map(Vector::from) else {
        return;
    };
    let across = |normal: Vector| velocity.dot(normal);
    let (across, help) = match (&wall.plane, &wall.plate, &wall.disc, &wall.cylinder) {
        (Some(it), ..) => (across(it.unit_normal()), "a plane slides in itself"),
        (_, Some(it), ..) => {
            let [first, second] = it.edges();
            let normal = first.cross(second).unit();
            (across(normal), "a plate slides in its plane")
        }
        (_, _, Some(it), _) => {
            let axis = Vector::from(it.axis).unit();
            (across(axis), "a disc slides in its plane")
        }
        (.., Some(it)) => {
            let axis = Vector::from(it.axis).unit();
            let across = velocity.perpendicular_to(axis).norm();
            (across, "a cylinder slides along its axis")
        }
        _ => (
            velocity.norm(),
            "a cone turns about its axis: use `angular_velocity`",
        ),
    };
    if across.abs() > ACROSS * velocity.norm() {
        let message = format!("this `velocity` would move the {shape} out of its place");
        let help = format!("{help}; walls that move from place to place are not known");
        problems.push(Problem::new("velocity", message).help(help));
    }
}
