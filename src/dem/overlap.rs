//! How deep spheres overlap at the start: each other, fixed spheres, and walls.

use super::neighbours::visit_pairs;
use super::timestep::fastest::Fastest;
use crate::particles::Particles;
use crate::scene::{Scene, Start};
use crate::start;
use crate::walls::{Wall, WallName};

/// Overlaps below this share of the radius come from rounded positions.
const NEGLIGIBLE: f64 = 1e-6;

/// Overlaps beyond this share of the radius are always reported, whatever the speeds in the scene:
/// few contacts are so soft.
const DEEP: f64 = 0.5;

/// What a sphere overlaps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OverlapPartner {
    /// Another sphere that moves, by its number.
    Sphere(usize),
    /// A fixed sphere, by its centre (m).
    Fixed([f64; 3]),
    /// A wall, by its name.
    Wall(WallName),
}

/// An overlap at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap {
    /// Number of the sphere.
    pub sphere: usize,
    /// Its radius (m).
    pub radius: f64,
    /// What it overlaps.
    pub partner: OverlapPartner,
    /// How deep (m).
    pub depth: f64,
    /// How deep, in radii of the smaller partner.
    pub depth_in_radii: f64,
    /// Distance of the centres, or of the sphere's centre from the wall (m).
    pub distance: f64,
    /// The speed (m/s) at which its elastic energy pushes the two apart.
    pub speed: f64,
}

impl std::fmt::Display for OverlapPartner {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Sphere(number) => write!(formatter, "sphere {number}"),
            Self::Fixed([x, y, z]) => {
                write!(formatter, "the fixed sphere at ({x}, {y}, {z}) m")
            }
            Self::Wall(name) => write!(formatter, "the {name}"),
        }
    }
}

/// Visits every overlap of the spheres that a scene lists, if they have contacts. Overlaps of
/// driven spheres with walls, fixed spheres and one another are left out, because driven spheres
/// pass through these. Other starts have no overlaps.
pub(super) fn visit(scene: &Scene, mut visit: impl FnMut(Overlap)) {
    let Some(contact) = &scene.dem.contact else {
        return;
    };
    // Radii may be drawn at random, so the spheres must be placed.
    let (Start::List { .. }, Ok(spheres)) = (&scene.start, start::place(scene)) else {
        return;
    };
    let mut particles = start::fixed(scene);
    particles.append(spheres);
    particles.domain = scene.domain();
    for path in &scene.dem.driven {
        if let Some(driven) = particles
            .inverse_mass
            .get_mut(particles.fixed + path.sphere)
        {
            *driven = 0.0;
        }
    }
    let fixed = particles.fixed;
    let Particles {
        domain,
        position,
        radius,
        inverse_mass,
        ..
    } = &particles;
    let elastic_energy = contact.elastic_energy();
    let speed = |depth: f64, effective_radius: f64, inverse_mass: f64| {
        (2.0 * elastic_energy(depth, effective_radius) * inverse_mass).sqrt()
    };
    visit_pairs(&particles, |i, j| {
        let distance = domain.offset(position[i], position[j]).norm();
        let sum = radius[i] + radius[j];
        let depth = sum - distance;
        let inverse_mass = inverse_mass[i] + inverse_mass[j];
        if depth > 0.0 && inverse_mass > 0.0 {
            let effective_radius = radius[i] * radius[j] / sum;
            let [x, y, z] = [position[i].x, position[i].y, position[i].z];
            visit(Overlap {
                sphere: j - fixed,
                radius: radius[j],
                partner: match i.checked_sub(fixed) {
                    Some(number) => OverlapPartner::Sphere(number),
                    None => OverlapPartner::Fixed([x, y, z]),
                },
                depth,
                depth_in_radii: depth / radius[i].min(radius[j]),
                distance,
                speed: speed(depth, effective_radius, inverse_mass),
            });
        }
    });
    for wall in Wall::of_scene(scene) {
        for i in (fixed..particles.len()).filter(|i| !particles.is_prescribed(*i)) {
            let contact = wall.contact(position[i], radius[i]);
            if contact.touches && contact.overlap > 0.0 {
                visit(Overlap {
                    sphere: i - fixed,
                    radius: radius[i],
                    partner: OverlapPartner::Wall(wall.name),
                    depth: contact.overlap,
                    depth_in_radii: contact.overlap / radius[i],
                    distance: radius[i] - contact.overlap,
                    speed: speed(contact.overlap, radius[i], inverse_mass[i]),
                });
            }
        }
    }
}

/// The deepest overlap (m); zero if none touch.
pub(super) fn deepest_at_start(scene: &Scene) -> f64 {
    let mut deepest = 0.0;
    visit(scene, |overlap| deepest = f64::max(deepest, overlap.depth));
    deepest
}

/// Overlaps at the start that are deeper than half a radius, or push spheres apart faster than any
/// impact expected in the scene. Contacts taken over from an earlier state are hardly ever faster,
/// because impacts or weights in the same scene made them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Release {
    /// The overlap with the greatest speed.
    pub fastest: Overlap,
    /// How many more there are.
    pub others: usize,
    /// The fastest impact expected in the scene (m/s).
    pub impact: f64,
}

impl Release {
    /// Such overlaps of a scene, if there are any.
    pub fn of_scene(scene: &Scene) -> Option<Self> {
        let impact = Fastest::of(scene).impact;
        let mut found: Option<Self> = None;
        visit(scene, |overlap| {
            let is_deep = overlap.depth_in_radii > DEEP;
            if overlap.depth_in_radii < NEGLIGIBLE || (overlap.speed <= impact && !is_deep) {
                return;
            }
            found = Some(match found {
                None => Self {
                    fastest: overlap,
                    others: 0,
                    impact,
                },
                Some(before) => Self {
                    fastest: match overlap.speed > before.fastest.speed {
                        true => overlap,
                        false => before.fastest,
                    },
                    others: before.others + 1,
                    impact,
                },
            });
        });
        found
    }
}
