//! Light and shadows.

use super::depth::{DepthMap, Hit, Rays};
use super::{Camera, Image, Rgb, Stage};
use crate::particles::vector::Vector;

/// A sphere to draw.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadedSphere {
    pub(super) centre: Vector,
    pub(super) radius: f64,
    pub(super) color: Rgb,
}

impl ShadedSphere {
    pub(super) fn is_drawable(&self) -> bool {
        let Vector { x, y, z, .. } = self.centre;
        [x, y, z, self.radius].iter().all(|v| v.is_finite()) && self.radius > 0.0
    }

    /// Whether a part of it is between two heights (m).
    pub(super) fn is_between(&self, low: f64, high: f64) -> bool {
        self.centre.z + self.radius >= low && self.centre.z - self.radius <= high
    }
}

/// Rays per pixel, along each side: smooth edges.
const SAMPLES: usize = 3;
/// Unit vector to the light, with components right, up and to the viewer.
const LIGHT: [f64; 3] = [-0.36, 0.48, 0.8];
/// Ambient light, and light from the lamp.
const AMBIENT: f64 = 0.42;
const LAMP: f64 = 0.66;
/// Share of the lamp's light that is mirrored.
const GLOSS: f64 = 0.18;
/// How much the farthest objects fade into the background.
const HAZE: f64 = 0.28;
const FLOOR: Rgb = [232, 234, 238];
const GLASS: Rgb = [246, 247, 249];
const OUTLINE: Rgb = [88, 92, 100];
/// Width of outlines (pixels).
const STROKE: f64 = 1.2;
/// Largest side of the map of shadows.
const LARGEST_SHADOW: f64 = 4096.0;

pub(super) fn render(
    spheres: &[ShadedSphere],
    stage: &Stage,
    camera: &Camera,
    width: usize,
    height: usize,
) -> Image {
    let axes = [camera.right, camera.up, camera.viewer];
    let scale = camera.scale(width, height);
    let mut view = DepthMap::new(
        Rays {
            axes,
            centre: camera.centre,
            scale: scale * SAMPLES as f64,
            width: width * SAMPLES,
            height: height * SAMPLES,
        },
        spheres,
    );
    view.add_floor(stage);
    let light = axes[0] * LIGHT[0] + axes[1] * LIGHT[1] + axes[2] * LIGHT[2];
    let largest = spheres.iter().fold(0.0, |r, sphere| sphere.radius.max(r));
    let shader = Shader {
        spheres,
        stage,
        shadows: shadow_map(spheres, light, camera.up, scale),
        light,
        half: (light + camera.viewer).unit(),
        depths: depths(spheres, camera),
        reach: largest,
        places: (0..SAMPLES * SAMPLES).map(places_around).collect(),
        view: &view,
    };
    let mut samples: Vec<[f32; 3]> = Vec::with_capacity(view.rays.width * view.rays.height);
    for row in 0..view.rays.height {
        samples.extend((0..view.rays.width).map(|column| shader.color(column, row)));
    }
    for line in outlines(stage, camera) {
        draw_line(&line, &view, &mut samples);
    }
    average(&samples, width, height)
}

/// Data from which a ray finds its colour.
struct Shader<'a> {
    spheres: &'a [ShadedSphere],
    stage: &'a Stage,
    view: &'a DepthMap,
    shadows: DepthMap,
    /// Unit vector to the light.
    light: Vector,
    /// Unit vector half way between the light and the viewer.
    half: Vector,
    /// Depth of the farthest and of the nearest sphere (m).
    depths: [f64; 2],
    /// Reach within which neighbours darken a place (m).
    reach: f64,
    /// Places where each ray of a pixel looks for neighbours, over this reach.
    places: Vec<Vec<[f64; 2]>>,
}

impl Shader<'_> {
    /// The colour of a ray, in linear light.
    fn color(&self, column: usize, row: usize) -> [f32; 3] {
        let (depth, hit) = self.view.at(column, row);
        let origin = self.view.rays.origin(column, row);
        let point = origin + self.view.rays.axes[2] * depth;
        let (color, normal, gloss) = match hit {
            Hit::Nothing => return linear(self.background(origin)),
            Hit::Floor => (FLOOR, Vector::new(0.0, 0.0, 1.0), 0.0),
            Hit::Sphere(index) => {
                let sphere = &self.spheres[index as usize];
                let normal = (point - sphere.centre) * (1.0 / sphere.radius);
                (sphere.color, normal, GLOSS)
            }
        };
        // Shadows on the floor must not look like spheres.
        let darkness = if hit == Hit::Floor { 0.45 } else { 1.0 };
        let lit = 1.0 - darkness * self.shadow(point, hit);
        let ambient = AMBIENT * (1.0 - self.occlusion(column, row, (depth, hit)));
        let matt = ambient + LAMP * lit * normal.dot(self.light).max(0.0);
        let mirrored = gloss * lit * thirty_second_power(normal.dot(self.half).max(0.0));
        let haze = match hit {
            Hit::Sphere(_) => HAZE * self.distance(depth),
            _ => 0.0,
        };
        let paper = linear(GLASS);
        let mut result = linear(color);
        for (channel, paper) in result.iter_mut().zip(paper) {
            let shaded = f64::from(*channel) * matt * 1.12 + mirrored;
            *channel = (shaded + haze * (f64::from(paper) - shaded)) as f32;
        }
        result
    }

    /// 0 for the nearest sphere, 1 for the farthest.
    fn distance(&self, depth: f64) -> f64 {
        let [far, near] = self.depths;
        ((near - depth) / (near - far).max(self.reach)).clamp(0.0, 1.0)
    }

    /// Share of the lamp that other spheres hide from a point.
    fn shadow(&self, point: Vector, hit: Hit) -> f64 {
        let [column, row, depth] = self.shadows.rays.project(point);
        let mut hidden = 0;
        for down in [-1.0, 0.0, 1.0] {
            for across in [-1.0, 0.0, 1.0] {
                // A sphere never casts a shadow on its own lit side.
                hidden += match self.shadows.near(column + across, row + down) {
                    Some((above, blocker)) if blocker != hit && above > depth => 1,
                    _ => 0,
                };
            }
        }
        f64::from(hidden) / 9.0
    }

    /// Share of the ambient light that nearer neighbours in the view hide.
    fn occlusion(&self, column: usize, row: usize, (depth, hit): (f64, Hit)) -> f64 {
        let reach = self.reach * self.view.rays.scale;
        // The rays of a pixel look at different places, so that their mean is smooth.
        let places = &self.places[column % SAMPLES + SAMPLES * (row % SAMPLES)];
        let hidden: f64 = places
            .iter()
            .filter_map(|[across, down]| {
                let column = column as f64 + 0.5 + across * reach;
                let row = row as f64 + 0.5 + down * reach;
                let (near, neighbour) = self.view.near(column, row)?;
                if hit == Hit::Floor && neighbour == hit {
                    return None;
                }
                let rise = (near - depth) / self.reach;
                // Objects far in front of a place do not darken it.
                Some(rise.clamp(0.0, 1.0) * (2.0 - 0.25 * rise).clamp(0.0, 1.0))
            })
            .sum();
        (1.3 * hidden / places.len() as f64).min(0.85)
    }

    /// The background: the inside of the tank, or white.
    fn background(&self, origin: Vector) -> Rgb {
        const PAPER: Rgb = [255, 255, 255];
        let Some(radius) = self.stage.radius else {
            let is_glass = self.stage.has_sides() && self.is_before_side(origin);
            return if is_glass { GLASS } else { PAPER };
        };
        let near = self.view.rays.axes[2];
        let outside = origin.x * origin.x + origin.y * origin.y - radius * radius;
        let horizontal = near.x * near.x + near.y * near.y;
        let past_axis = origin.x * near.x + origin.y * near.y;
        let half_chord_squared = past_axis * past_axis - horizontal * outside;
        let [low, high] = self.stage.seen;
        let inside = if horizontal == 0.0 {
            outside <= 0.0
        } else {
            // The far side of the cylinder is behind everything.
            let wall = origin - near * ((past_axis + half_chord_squared.sqrt()) / horizontal);
            half_chord_squared >= 0.0 && (low[2]..=high[2]).contains(&wall.z)
        };
        if inside { GLASS } else { PAPER }
    }

    /// Whether the ray from the viewer through this point leaves the box through one of the plane
    /// sides. A ray straight down counts if it would meet one of the lower sides.
    fn is_before_side(&self, origin: Vector) -> bool {
        let near = self.view.rays.axes[2];
        let [low, high] = self.stage.seen;
        let (mut far, mut first) = (f64::NEG_INFINITY, f64::INFINITY);
        let axes = [(origin.x, near.x), (origin.y, near.y)];
        for ((place, way), [least, most]) in axes.into_iter().zip(self.stage.between_sides()) {
            if way == 0.0 {
                if !(least..=most).contains(&place) {
                    return false;
                }
                continue;
            }
            let ends = [(least - place) / way, (most - place) / way];
            far = far.max(ends[0].min(ends[1]));
            first = first.min(ends[0].max(ends[1]));
        }
        let height = origin.z + near.z * far;
        far <= first && (far == f64::NEG_INFINITY || (low[2]..=high[2]).contains(&height))
    }
}

/// Places in the unit disc, in twelve directions and at twelve distances, rotated from ray to ray.
fn places_around(ray: usize) -> Vec<[f64; 2]> {
    const DIRECTIONS: usize = 12;
    let rays = (SAMPLES * SAMPLES) as f64;
    (0..DIRECTIONS)
        .map(|index| {
            let turn = (index as f64 + ray as f64 / rays) / DIRECTIONS as f64;
            let (sine, cosine) = libm::sincos(std::f64::consts::TAU * turn);
            // Every distance once, in an order that differs between rays; evenly over the area.
            let ring = (7 * index + 5 * ray) % DIRECTIONS;
            let distance = ((ring as f64 + 0.5) / DIRECTIONS as f64).sqrt();
            [distance * cosine, distance * sine]
        })
        .collect()
}

/// The first objects that the light meets.
fn shadow_map(spheres: &[ShadedSphere], light: Vector, up: Vector, scale: f64) -> DepthMap {
    let right = up.cross(light).unit();
    let axes = [right, light.cross(right), light];
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for sphere in spheres {
        for axis in 0..2 {
            let place = sphere.centre.dot(axes[axis]);
            low[axis] = low[axis].min(place - sphere.radius);
            high[axis] = high[axis].max(place + sphere.radius);
        }
    }
    let size = [0, 1].map(|axis| (high[axis] - low[axis]).max(0.0));
    let scale = scale.min(LARGEST_SHADOW / size[0].max(size[1]));
    let middle = |axis: usize| axes[axis] * (0.5 * (low[axis] + high[axis]));
    let cells = |length: f64| (length * scale).ceil() as usize + 2;
    let rays = Rays {
        axes,
        centre: if spheres.is_empty() {
            Vector::ZERO
        } else {
            middle(0) + middle(1)
        },
        scale,
        width: cells(size[0]),
        height: cells(size[1]),
    };
    DepthMap::new(rays, spheres)
}

/// Depth of the farthest and of the nearest sphere.
fn depths(spheres: &[ShadedSphere], camera: &Camera) -> [f64; 2] {
    let depth = |sphere: &ShadedSphere| (sphere.centre - camera.centre).dot(camera.viewer);
    spheres
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[far, near], sphere| {
            [far.min(depth(sphere)), near.max(depth(sphere))]
        })
}

/// The edges of the tank that the camera sees.
fn outlines(stage: &Stage, camera: &Camera) -> Vec<Vec<Vector>> {
    let [low, high] = stage.seen;
    let bottom = stage.floor.unwrap_or(low[2]);
    let mut lines = stage.lines.clone();
    if let Some(radius) = stage.radius {
        for side in [-radius, radius] {
            let at = |z| camera.right * side + Vector::new(0.0, 0.0, z);
            lines.push(vec![at(bottom), at(high[2])]);
        }
        if camera.viewer.z != 0.0 {
            lines.push(stage.rim(high[2]));
        }
    }
    if stage.has_sides() {
        for [x, y] in &stage.corners()[1..] {
            lines.push([bottom, high[2]].map(|z| Vector::new(*x, *y, z)).to_vec());
        }
        if camera.viewer.z != 0.0 {
            lines.push(stage.rim(high[2]));
        }
    }
    match (stage.floor, stage.radius.is_some() || stage.has_sides()) {
        (Some(floor), true) => lines.push(stage.rim(floor)),
        (Some(floor), false) if camera.viewer.z == 0.0 => {
            let at = |x| Vector::new(x, 0.0, floor);
            lines.push(vec![at(low[0]), at(high[0])]);
        }
        _ => {}
    }
    lines
}

/// Draws the visible parts of a line.
fn draw_line(line: &[Vector], view: &DepthMap, samples: &mut [[f32; 3]]) {
    let half = 0.5 * STROKE * SAMPLES as f64;
    let color = linear(OUTLINE);
    for ends in line.windows(2) {
        let (from, to) = (view.rays.project(ends[0]), view.rays.project(ends[1]));
        let length = (to[0] - from[0]).abs().max((to[1] - from[1]).abs());
        let steps = length.ceil().max(1.0);
        for step in 0..=steps as usize {
            let share = step as f64 / steps;
            let [x, y, depth] = [0, 1, 2].map(|axis| from[axis] + share * (to[axis] - from[axis]));
            for row in cells(y, half, view.rays.height) {
                for column in cells(x, half, view.rays.width) {
                    let (across, down) = (column as f64 + 0.5 - x, row as f64 + 0.5 - y);
                    let (nearest, hit) = view.at(column, row);
                    let hidden = matches!(hit, Hit::Sphere(_)) && nearest > depth;
                    if across * across + down * down <= half * half && !hidden {
                        samples[column + row * view.rays.width] = color;
                    }
                }
            }
        }
    }
}

/// Indices, of `count`, of the cells around a place.
fn cells(place: f64, half: f64, count: usize) -> std::ops::Range<usize> {
    let end = (place + half).ceil().max(0.0) as usize;
    ((place - half).floor() as usize).min(count)..end.min(count)
}

/// The pixels: the mean of their rays.
fn average(samples: &[[f32; 3]], width: usize, height: usize) -> Image {
    let mut image = Image::white(width, height);
    for row in 0..height {
        for column in 0..width {
            let mut sum = [0.0_f32; 3];
            for down in 0..SAMPLES {
                let first = column * SAMPLES + (row * SAMPLES + down) * width * SAMPLES;
                for sample in &samples[first..first + SAMPLES] {
                    for channel in 0..3 {
                        sum[channel] += sample[channel].min(1.0);
                    }
                }
            }
            let at = 4 * (column + row * width);
            for channel in 0..3 {
                let mean = f64::from(sum[channel]) / (SAMPLES * SAMPLES) as f64;
                image.rgba[at + channel] = (mean.sqrt() * 255.0).round() as u8;
            }
        }
    }
    image
}

/// The light of a colour. A square approximates the screen's exponent of 2.2.
fn linear(color: Rgb) -> [f32; 3] {
    color.map(|channel| {
        let value = f32::from(channel) / 255.0;
        value * value
    })
}

fn thirty_second_power(value: f64) -> f64 {
    (0..5).fold(value, |power, _| power * power)
}
