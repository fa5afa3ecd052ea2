//! Where walls join.
//!
//! A sphere that touches two walls at the place where they join would be held twice. So the place
//! itself becomes a wall whose forces count minus once: over the seam of two walls, one of them and
//! the seam cancel, and one is left. In general, every point counts once in all (inclusion and
//! exclusion): a line where n walls join counts 1 - n, a corner 1 minus the sum over all walls and
//! lines that meet there.
//!
//! The sum of the forces is then continuous, and it still has a potential energy: a sphere may roll
//! over an edge, or along it, without gaining any. In a corner from inside it touches each wall
//! away from the seam, which it does not reach, and the seam changes nothing. Friction passes from
//! one wall to the next while the sphere is within reach of the seam.
//!
//! Joints are found between planes, plates and discs, whatever their angle; between surfaces that
//! turn about one axis; and between a cylinder and an edge of a plate along it. Two planes need
//! none, as spheres are inside both.

use super::{ContactSurface, Parallelogram, Plane, Revolved, Segment, Wall, WallSurface};
use crate::particles::vector::Vector;

/// A place where walls join: a line, a circle or a point.
#[derive(Clone, Copy, Debug)]
enum Seam {
    Straight(Segment),
    Round(Revolved),
}

/// The walls, and after them the places where they join. Walls that are closer than `tolerance` (m)
/// count as joined. The places that a tank's own walls share are left out: they are corners.
pub fn with_joints(walls: Vec<Wall>, tolerance: f64) -> Vec<Wall> {
    let all: Vec<&Wall> = walls.iter().collect();
    let staying: Vec<&Wall> = walls
        .iter()
        .filter(|wall| wall.weight_when_open != 0.0)
        .collect();
    let mut joints = joints_of(&all, tolerance);
    for joint in &mut joints {
        joint.weight_when_open = 0.0;
    }
    for open in joints_of(&staying, tolerance) {
        let same = |joint: &&mut Wall| is_same(&joint.surface, &open.surface, tolerance);
        match joints.iter_mut().find(same) {
            Some(joint) => joint.weight_when_open = open.weight,
            None => joints.push(Wall {
                weight: 0.0,
                weight_when_open: open.weight,
                ..open
            }),
        }
    }
    joints.retain(|joint| joint.weight != 0.0 || joint.weight_when_open != 0.0);
    [walls, joints].concat()
}

/// Which walls share the forces of each wall or joint, by their places: for `joined`, the first
/// `count` of which are walls and the rest the joints that [`with_joints`] found between them. A
/// wall keeps its own; a joint's belong to the walls that hold it.
pub fn sharers(joined: &[Wall], count: usize, tolerance: f64) -> Vec<Vec<usize>> {
    let (walls, joints) = joined.split_at(count);
    let of_walls = (0..count).map(|place| vec![place]);
    let of_joints = joints.iter().map(|joint| {
        let is_held = |place: &usize| holds(&walls[*place].surface, &joint.surface, tolerance);
        let holding: Vec<usize> = (0..count).filter(is_held).collect();
        let named = || walls.iter().position(|wall| wall.name == joint.name);
        match holding.is_empty() {
            true => named().into_iter().collect(),
            false => holding,
        }
    });
    of_walls.chain(of_joints).collect()
}

fn joints_of(walls: &[&Wall], tolerance: f64) -> Vec<Wall> {
    let mut joints: Vec<Wall> = Vec::new();
    for (place, one) in walls.iter().enumerate() {
        for other in &walls[place + 1..] {
            if one.name.is_of_tank() && other.name.is_of_tank() {
                continue;
            }
            for seam in seams(&one.surface, &other.surface, tolerance) {
                let surface = seam.surface();
                let is_known = |joint: &Wall| is_same(&joint.surface, &surface, tolerance);
                if !joints.iter().any(is_known) {
                    joints.push(Wall { surface, ..**one });
                }
            }
        }
    }
    for joint in &mut joints {
        let holds = |wall: &&&Wall| holds(&wall.surface, &joint.surface, tolerance);
        joint.weight = 1.0 - walls.iter().filter(holds).count() as f64;
    }
    let corners = corners_of(walls, &joints, tolerance);
    joints.extend(corners);
    joints
}

/// The ends of lines at which other lines join.
fn corners_of(walls: &[&Wall], joints: &[Wall], tolerance: f64) -> Vec<Wall> {
    let mut corners: Vec<Wall> = Vec::new();
    for joint in joints {
        let WallSurface::Segment(segment) = joint.surface else {
            continue;
        };
        for end in segment.ends() {
            let surface = WallSurface::Segment(Segment::new(end, Vector::ZERO));
            let is_known = |it: &Wall| is_same(&it.surface, &surface, tolerance);
            if corners.iter().chain(joints).any(is_known) {
                continue;
            }
            let here = |wall: &&Wall| lies_on(end, &wall.surface, tolerance);
            let of_walls = walls.iter().copied().filter(here).count() as f64;
            let of_lines: f64 = joints.iter().filter(here).map(|it| it.weight).sum();
            let weight = 1.0 - of_walls - of_lines;
            corners.push(Wall {
                surface,
                weight,
                ..*joint
            });
        }
    }
    corners.retain(|corner| corner.weight != 0.0);
    corners
}

impl Seam {
    fn surface(self) -> WallSurface {
        match self {
            Self::Straight(segment) => WallSurface::Segment(segment),
            Self::Round(circle) => WallSurface::Revolved(circle),
        }
    }
}

/// Whether a place lies on a surface.
fn lies_on(place: Vector, surface: &WallSurface, tolerance: f64) -> bool {
    (surface.foot(place) - place).norm() <= tolerance
}

/// Places of a seam. A wall that holds them all holds the seam.
fn probes(seam: &WallSurface) -> Vec<Vector> {
    match seam {
        WallSurface::Segment(segment) => {
            let share = |share: f64| segment.from + segment.along * share;
            [0.0, 0.3, 1.0].map(share).to_vec()
        }
        WallSurface::Revolved(circle) => {
            let across = across(circle.axis);
            let around = [across, -across, circle.axis.cross(across)];
            around.map(|it| circle.base + it * circle.radius).to_vec()
        }
        _ => Vec::new(),
    }
}

/// Whether a seam lies on a surface, or on another seam.
fn holds(surface: &WallSurface, seam: &WallSurface, tolerance: f64) -> bool {
    let mut places = probes(seam).into_iter();
    places.all(|place| lies_on(place, surface, tolerance))
}

/// Whether two seams are the same line.
fn is_same(one: &WallSurface, other: &WallSurface, tolerance: f64) -> bool {
    holds(one, other, tolerance) && holds(other, one, tolerance)
}

/// A unit vector across an axis.
fn across(axis: Vector) -> Vector {
    let least = match axis.x.abs() < 0.6 {
        true => Vector::new(1.0, 0.0, 0.0),
        false => Vector::new(0.0, 1.0, 0.0),
    };
    least.perpendicular_to(axis).unit()
}

/// The places where two surfaces join or cross.
fn seams(one: &WallSurface, other: &WallSurface, tolerance: f64) -> Vec<Seam> {
    if let (Some(one), Some(other)) = (Flat::of(one), Flat::of(other))
        && let Some(seams) = one.seams_with(&other, tolerance)
    {
        return seams;
    }
    let (one_turned, other_turned) = (turned(one), turned(other));
    match (one, other, one_turned, other_turned) {
        (_, _, Some(one), Some(other)) => round_seams(&one, &other, tolerance),
        (WallSurface::Plane(plane), _, _, Some(it))
        | (_, WallSurface::Plane(plane), Some(it), _) => seams_with_plane(plane, &it, tolerance),
        (WallSurface::Parallelogram(plate), _, _, Some(it))
        | (_, WallSurface::Parallelogram(plate), Some(it), _) => edges_along(plate, &it, tolerance),
        _ => Vec::new(),
    }
}

/// A surface that turned about an axis, if it is one.
fn turned(surface: &WallSurface) -> Option<Revolved> {
    let upward = Vector::new(0.0, 0.0, 1.0);
    match surface {
        WallSurface::Revolved(it) => Some(*it),
        WallSurface::Cylinder(it) => Some(Revolved::endless(Vector::ZERO, upward, it.radius)),
        WallSurface::Orifice(it) => Some(Revolved {
            base: Vector::new(0.0, 0.0, it.height),
            axis: upward,
            radius: it.radius,
            direction: [1.0, 0.0],
            ends: [0.0, f64::INFINITY],
        }),
        _ => None,
    }
}

/// The circles in which two surfaces about the same axis meet.
fn round_seams(one: &Revolved, other: &Revolved, tolerance: f64) -> Vec<Seam> {
    let offset = other.base - one.base;
    let are_parallel = one.axis.cross(other.axis).norm() < 1e-9;
    if !are_parallel || offset.perpendicular_to(one.axis).norm() > tolerance {
        return Vec::new();
    }
    // The line of the other in the half plane of the first.
    let sense = one.axis.dot(other.axis).signum();
    let [across, along] = other.direction;
    let start = [other.radius, offset.dot(one.axis)];
    let direction = [across, sense * along];
    let from = [one.radius, 0.0];
    let apart = [start[0] - from[0], start[1] - from[1]];
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let turn = cross(one.direction, direction);
    let lengths = if turn.abs() < 1e-9 {
        // Lines along each other meet in their ends only.
        let ends = one.ends.into_iter().filter(|it| it.is_finite());
        ends.filter(|&length| {
            let [x, y] = one.profile_at(length);
            let along = (x - start[0]) * direction[0] + (y - start[1]) * direction[1];
            let across = cross([x - start[0], y - start[1]], direction);
            let is_end = (other.ends.iter()).any(|end| (along - end).abs() <= tolerance);
            is_end && across.abs() <= tolerance
        })
        .collect()
    } else {
        let on_one = cross(apart, direction) / turn;
        let on_other = cross(apart, one.direction) / turn;
        let is_within = |length: f64, [from, to]: [f64; 2]| {
            length >= from - tolerance && length <= to + tolerance
        };
        match is_within(on_one, one.ends) && is_within(on_other, other.ends) {
            true => vec![on_one],
            false => Vec::new(),
        }
    };
    let circle = |length: f64| {
        let [radius, height] = one.profile_at(length);
        round(one.base + one.axis * height, one.axis, radius, tolerance)
    };
    lengths.into_iter().map(circle).collect()
}

/// A circle, or a point of an axis.
fn round(centre: Vector, axis: Vector, radius: f64, tolerance: f64) -> Seam {
    match radius > tolerance {
        true => Seam::Round(Revolved::circle(centre, axis, radius)),
        false => Seam::Straight(Segment::new(centre, Vector::ZERO)),
    }
}

/// The circle in which a surface about the normal of a plane meets the plane.
fn seams_with_plane(plane: &Plane, surface: &Revolved, tolerance: f64) -> Vec<Seam> {
    let axis = surface.axis;
    let [across, along] = surface.direction;
    if plane.normal.cross(axis).norm() > 1e-9 || along.abs() < 1e-9 {
        return Vec::new();
    }
    let height = (plane.normal * plane.place - surface.base).dot(axis);
    let length = height / along;
    let [from, to] = surface.ends;
    match length >= from - tolerance && length <= to + tolerance {
        true => {
            let radius = surface.radius + across * length;
            vec![round(surface.base + axis * height, axis, radius, tolerance)]
        }
        false => Vec::new(),
    }
}

/// The edges of a plate that lie along a cylinder.
fn edges_along(plate: &Parallelogram, tube: &Revolved, tolerance: f64) -> Vec<Seam> {
    let axis = tube.axis;
    if tube.direction[0] != 0.0 {
        return Vec::new();
    }
    let along = plate.edges_from().into_iter().filter_map(|(from, edge)| {
        let is_parallel = edge.cross(axis).norm() < 1e-9 * edge.norm();
        let distance = (from - tube.base).perpendicular_to(axis).norm();
        let is_on_it = is_parallel && (distance - tube.radius).abs() <= tolerance;
        let ends = [from, from + edge].map(|it| (it - tube.base).dot(axis));
        let [low, high] = tube.ends;
        let shared = [
            ends[0].min(ends[1]).max(low),
            ends[0].max(ends[1]).min(high),
        ];
        (is_on_it && shared[1] - shared[0] > tolerance).then(|| {
            let start = from + axis * (shared[0] - ends[0]);
            Seam::Straight(Segment::new(start, axis * (shared[1] - shared[0])))
        })
    });
    along.collect()
}

/// A flat surface.
enum Flat {
    Endless(Plane),
    Plate(Parallelogram),
    /// With its disc.
    Ring(Revolved),
}

impl Flat {
    fn of(surface: &WallSurface) -> Option<Self> {
        match surface {
            WallSurface::Plane(it) => Some(Self::Endless(*it)),
            WallSurface::Parallelogram(it) => Some(Self::Plate(*it)),
            WallSurface::Revolved(it) if it.direction[1] == 0.0 => Some(Self::Ring(*it)),
            _ => None,
        }
    }

    /// A point of it and its unit normal.
    fn plane(&self) -> (Vector, Vector) {
        match self {
            Self::Endless(it) => (it.normal * it.place, it.normal),
            Self::Plate(it) => (it.corner, it.normal()),
            Self::Ring(it) => (it.base, it.axis),
        }
    }

    /// The lines that two of them share. `None` for two discs about one axis, which share circles.
    fn seams_with(&self, other: &Self, tolerance: f64) -> Option<Vec<Seam>> {
        let ((point, normal), (other_point, other_normal)) = (self.plane(), other.plane());
        let line = normal.cross(other_normal);
        if line.norm() > 1e-9 {
            if let (Self::Endless(_), Self::Endless(_)) = (self, other) {
                return Some(Vec::new());
            }
            // A point of both planes, at the least distance from the origin.
            let (c, d) = (normal.dot(point), other_normal.dot(other_point));
            let from = (other_normal.cross(line) * c + line.cross(normal) * d)
                * (1.0 / line.norm_squared());
            return Some(self.shared_on(other, from, line.unit(), tolerance));
        }
        let gap = (other_point - point).dot(normal);
        match (self, other) {
            (Self::Ring(one), Self::Ring(other)) => {
                let aside = (other.base - one.base).perpendicular_to(one.axis);
                (aside.norm() > tolerance).then(Vec::new)
            }
            (Self::Plate(one), Self::Plate(other)) if gap.abs() <= tolerance => {
                Some(shared_edges(one, other, tolerance))
            }
            _ => Some(Vec::new()),
        }
    }

    /// The parts of a line that lie on both.
    fn shared_on(&self, other: &Self, from: Vector, along: Vector, tolerance: f64) -> Vec<Seam> {
        let mut seams = Vec::new();
        for one in self.parts_of_line(from, along, tolerance) {
            for another in other.parts_of_line(from, along, tolerance) {
                let [low, high] = [one[0].max(another[0]), one[1].min(another[1])];
                if high >= low {
                    let length = if high - low > 4.0 * tolerance {
                        high - low
                    } else {
                        0.0
                    };
                    let start = from + along * low;
                    seams.push(Seam::Straight(Segment::new(start, along * length)));
                }
            }
        }
        seams
    }

    /// The parts of a line in its plane that lie on it, by where they begin and end along the line.
    fn parts_of_line(&self, from: Vector, along: Vector, tolerance: f64) -> Vec<[f64; 2]> {
        match self {
            Self::Endless(_) => vec![[f64::NEG_INFINITY, f64::INFINITY]],
            Self::Plate(it) => it
                .part_of_line(from, along, tolerance)
                .into_iter()
                .collect(),
            Self::Ring(it) => {
                let offset = from - it.base;
                let middle = -offset.dot(along);
                let squared = (offset + along * middle).norm_squared();
                let chord = |radius: f64| {
                    let radius = radius.max(0.0);
                    (radius * radius - squared).max(0.0).sqrt()
                };
                let [inner, outer] = it.ends.map(|length| it.radius + it.direction[0] * length);
                let [inner, outer] = [inner.min(outer), inner.max(outer) + tolerance];
                let (hole, half) = (chord(inner - tolerance), chord(outer));
                match (half > 0.0, hole > 0.0) {
                    (false, _) => Vec::new(),
                    (true, false) => vec![[middle - half, middle + half]],
                    (true, true) => vec![
                        [middle - half, middle - hole],
                        [middle + hole, middle + half],
                    ],
                }
            }
        }
    }
}

/// The parts of edges that two plates in one plane share.
fn shared_edges(one: &Parallelogram, other: &Parallelogram, tolerance: f64) -> Vec<Seam> {
    let mut seams = Vec::new();
    for (from, edge) in one.edges_from() {
        let (along, length) = (edge.unit(), edge.norm());
        for (start, edge) in other.edges_from() {
            let ends = [start, start + edge].map(|it| it - from);
            let is_on_line = (ends.iter()).all(|it| it.perpendicular_to(along).norm() <= tolerance);
            let places = ends.map(|it| it.dot(along));
            let low = places[0].min(places[1]).max(0.0);
            let high = places[0].max(places[1]).min(length);
            if is_on_line && high - low > 4.0 * tolerance {
                let segment = Segment::new(from + along * low, along * (high - low));
                seams.push(Seam::Straight(segment));
            }
        }
    }
    seams
}
