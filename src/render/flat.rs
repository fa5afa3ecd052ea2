//! Flat pictures: circles in the plane of x and z, as SVG elements in metres.
//!
//! Objects in this plane are drawn to scale. For spheres in space this is the view from the side,
//! with front spheres drawn over those behind. `resvg` draws them as pixels, as for figures.

use super::{Rgb, Stage};
use crate::observe::Snapshot;
use crate::record::{Milestone, MilestoneKind};
use crate::scene::{FixedSphere, FixedSpheres, Scene, Shape};
use crate::walls::Wall;
use std::fmt::Write;

/// Colour of grains if colours have no meaning.
pub(crate) const GRAIN: Rgb = [0x3f, 0x7f, 0xd0];
/// Colour of walls.
pub(crate) const WALL: Rgb = [0xd0, 0x2b, 0x2b];
/// Colour of the door.
pub(crate) const DOOR: Rgb = [0x1f, 0x9d, 0x3a];

/// Width of the white line around a circle, over the smallest radius.
const RIM: f64 = 0.06;
/// Width of the lines of a tank, over the width of the view.
const STROKE: f64 = 0.006;

/// A rectangle of the plane (m): its corner with the least x and z, then the opposite corner.
pub(crate) type Window = [[f64; 2]; 2];

/// Fixed parts: the walls, and a door while it is closed.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenery {
    fixed: FixedSpheres,
    /// When the door opened (s), if it did.
    opened: Option<f64>,
    /// Distance of a tank's walls from its axis along x, and height of its floor (m).
    tank: [Option<f64>; 2],
    /// Edges of listed walls as lines (m) from point to point.
    edges: Vec<Window>,
}

impl Scenery {
    /// The fixed parts of a scene, and when its door opened.
    pub fn new(scene: &Scene, milestones: &[Milestone]) -> Self {
        let opening = milestones
            .iter()
            .find(|it| it.kind == MilestoneKind::DoorOpened);
        let tank = scene.tank.as_ref();
        Self {
            fixed: scene.fixed_in_box(),
            opened: opening.map(|opening| opening.time),
            tank: [
                tank.and_then(|tank| tank.reach()[0]),
                tank.and_then(|tank| tank.floor),
            ],
            edges: edges(scene),
        }
    }

    /// The same if flat pictures show a scene completely, or better than others: discs, or fixed
    /// spheres.
    pub fn if_flat(scene: &Scene, milestones: &[Milestone]) -> Option<Self> {
        let is_flat = scene.spheres.shape == Shape::Disc || scene.dem.geometry.is_some();
        is_flat.then(|| Self::new(scene, milestones))
    }

    /// The walls.
    pub fn walls(&self) -> &[FixedSphere] {
        &self.fixed.walls
    }

    /// The door, whether open or closed.
    pub fn door(&self) -> &[FixedSphere] {
        &self.fixed.door
    }

    /// When the door opened (s), if it did.
    pub fn opened(&self) -> Option<f64> {
        self.opened
    }

    /// The door at a time (s): empty once it is open.
    pub fn door_at(&self, time: f64) -> &[FixedSphere] {
        // The same instant, counted in steps and in frames, may differ in its last bits.
        let is_open = self.opened.is_some_and(|opened| time > opened - 1e-9);
        if is_open { &[] } else { &self.fixed.door }
    }

    /// Walls of a tank as lines (m) from point to point, as high as the window.
    pub fn lines(&self, window: &Window) -> Vec<Window> {
        let [reach, floor] = self.tank;
        let [low, high] = window;
        let foot = floor.unwrap_or(low[1]);
        let ends = reach.map_or([low[0], high[0]], |reach| [-reach, reach]);
        let floor = floor.map(|floor| [[ends[0], floor], [ends[1], floor]]);
        let sides = reach
            .into_iter()
            .flat_map(|reach| [-reach, reach].map(|x| [[x, foot], [x, high[1]]]));
        let edges = self.edges.iter().copied();
        sides.chain(floor).chain(edges).collect()
    }

    /// The stage, extended to include all fixed parts.
    #[must_use]
    pub fn on(&self, stage: Stage) -> Stage {
        let fixed = self.fixed.walls.iter().chain(&self.fixed.door);
        stage.around_spheres(fixed.map(|it| (it.position, it.radius)))
    }

    /// Everything as SVG elements, in metres; heights point against the y axis of SVG.
    ///
    /// * `radius`: radius of every sphere (m)
    /// * `colors`: colour of every sphere; without them all are blue
    pub fn elements(
        &self,
        snapshot: &Snapshot,
        radius: &[f64],
        colors: Option<&[Rgb]>,
        window: &Window,
    ) -> String {
        let pen = Pen::new(window);
        let mut elements = pen.lines(&self.lines(window));
        for (name, color, spheres) in [
            ("walls", WALL, &self.fixed.walls[..]),
            ("door", DOOR, self.door_at(snapshot.time)),
        ] {
            let circles = spheres
                .iter()
                .map(|it| pen.circle(it.position, it.radius, None));
            elements += &group(name, color, "", circles);
        }
        let present = radius.iter().copied().zip(snapshot.position.rows());
        let mut spheres: Vec<(usize, [f64; 3], f64)> = present
            .enumerate()
            .map(|(sphere, (radius, centre))| (sphere, [centre[0], centre[1], centre[2]], radius))
            .filter(|(_, centre, _)| centre.iter().all(|value| value.is_finite()))
            .collect();
        // The viewer is at low y.
        spheres.sort_by(|(_, a, _), (_, b, _)| b[1].total_cmp(&a[1]));
        let circles = spheres.iter().map(|&(sphere, centre, radius)| {
            pen.circle(centre, radius, colors.map(|colors| colors[sphere]))
        });
        let least = radius.iter().copied().fold(f64::INFINITY, f64::min);
        let rim = if least.is_finite() { RIM * least } else { 0.0 };
        let rim = format!(
            " stroke=\"#fff\" stroke-width=\"{}\"",
            pen.number(rim.max(pen.least()))
        );
        elements + &group("grains", GRAIN, &rim, circles)
    }
}

/// The edges and rims of the walls that a scene lists, seen along y, as lines (m) from point to
/// point. Those along y are left out.
pub(crate) fn edges(scene: &Scene) -> Vec<Window> {
    let walls = Wall::of_scene(scene).into_iter();
    let lines = walls.flat_map(|wall| wall.outline());
    let lines = lines.flat_map(|line| {
        let flat: Vec<_> = line.iter().map(|it| [it.x, it.z]).collect();
        let pairs = flat.windows(2).map(|two| [two[0], two[1]]);
        pairs.filter(|[from, to]| from != to).collect::<Vec<_>>()
    });
    lines.collect()
}

/// The window of a stage.
pub(crate) fn window(stage: &Stage) -> Window {
    stage.seen.map(|[x, _, z]| [x, z])
}

/// Digits after the point that make rounding invisible in a view of this size.
pub(crate) fn digits(size: f64) -> usize {
    const FINENESS: f64 = 2e4;
    if size.is_finite() && size > 0.0 {
        libm::ceil(-libm::log10(size / FINENESS)).clamp(0.0, 12.0) as usize
    } else {
        4
    }
}

/// Colour as SVG writes it.
pub(crate) fn hex([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// A group of circles of one colour, a circle per line.
fn group(name: &str, color: Rgb, more: &str, circles: impl Iterator<Item = String>) -> String {
    let circles: String = circles.collect();
    if circles.is_empty() {
        return circles;
    }
    let color = hex(color);
    format!("<g id=\"{name}\" fill=\"{color}\"{more}>\n{circles}</g>\n")
}

/// Writes elements with the digits that a picture needs.
struct Pen {
    digits: usize,
    /// Width of the lines of a tank (m).
    stroke: f64,
}

impl Pen {
    fn new([low, high]: &Window) -> Self {
        let [width, height] = [0, 1].map(|axis| high[axis] - low[axis]);
        Self {
            digits: digits(width.max(height)),
            stroke: STROKE * width,
        }
    }

    /// The least length that is not written as zero (m).
    fn least(&self) -> f64 {
        libm::exp10(-(self.digits as f64))
    }

    /// A length (m), without zeros at its end.
    fn number(&self, value: f64) -> String {
        let text = format!("{value:.*}", self.digits);
        let text = match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.'),
            false => &text,
        };
        if text == "-0" { "0" } else { text }.to_owned()
    }

    fn circle(&self, [x, _, z]: [f64; 3], radius: f64, color: Option<Rgb>) -> String {
        let [x, y, radius] = [x, -z, radius].map(|value| self.number(value));
        let fill = color.map(|color| format!(" fill=\"{}\"", hex(color)));
        let fill = fill.unwrap_or_default();
        format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"{fill}/>\n")
    }

    fn lines(&self, lines: &[Window]) -> String {
        if lines.is_empty() {
            return String::new();
        }
        let mut path = String::new();
        for [from, to] in lines {
            let [[x, y], [end, foot]] =
                [from, to].map(|[x, z]| [*x, -z].map(|value| self.number(value)));
            // Writing to memory cannot fail.
            let _ = write!(path, "M{x} {y}L{end} {foot}");
        }
        let (color, width) = (hex(WALL), self.number(self.stroke));
        format!(
            "<path id=\"tank\" d=\"{path}\" fill=\"none\" stroke=\"{color}\" \
             stroke-width=\"{width}\" stroke-linecap=\"square\"/>\n"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_a_picture_needs() {
        for (size, value, text) in [
            (5.0, -1.23456, "-1.2346"),
            (5.0, 1.5, "1.5"),
            (0.12, 0.0123456, "0.012346"),
            (5.0, -1e-9, "0"),
            (1e6, 120.4, "120"),
            (1e6, 120.0, "120"),
        ] {
            let pen = Pen::new(&[[0.0, 0.0], [size, size]]);
            assert_eq!(pen.number(value), text);
        }
    }

    #[test]
    fn a_tank_is_drawn_as_lines() {
        let scenery = Scenery {
            fixed: FixedSpheres::default(),
            opened: None,
            tank: [Some(0.06), Some(-0.2)],
            edges: Vec::new(),
        };
        let window = [[-0.06, -0.2], [0.06, 0.1]];
        let lines = scenery.lines(&window);
        assert_eq!(lines.len(), 3);
        assert_eq!(lines[1], [[0.06, -0.2], [0.06, 0.1]]);
        assert_eq!(lines[2], [[-0.06, -0.2], [0.06, -0.2]]);
    }
}
