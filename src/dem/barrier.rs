//! How fast a disc must be to pass a wall of fixed discs, or to overlap it too deeply.

use super::process::wall_pairs;
use crate::scene::{FixedSphere, Geometry, Scene, Shape};

/// The weakest place of a scene's walls, and the disc that passes it most easily.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeakestWall {
    /// Speed above which the walls do not hold the disc (m/s).
    pub speed: f64,
    /// Radius of that disc (m).
    pub radius: f64,
    /// The fixed discs at that place: one, or two side by side.
    pub fixed: [FixedSphere; 2],
    /// How the wall fails.
    pub failure: WallFailure,
}

/// How a wall fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WallFailure {
    /// The disc passes between the two fixed ones.
    Passed,
    /// The disc presses into the first fixed one until the overlap guard ends the run.
    OverlapGuard,
}

impl WeakestWall {
    /// The weakest place in a scene's walls of fixed discs, its door included. `None` without such
    /// walls or without a contact law.
    ///
    /// At the place where a wall fails, the disc overlaps fixed discs. Its kinetic energy must
    /// equal the elastic energy of these contacts. Damping would raise this speed a little, and
    /// discs pushing from behind would lower it. Both are left out.
    pub fn of_scene(scene: &Scene) -> Option<Self> {
        let elastic_energy = scene.dem.contact.as_ref()?.elastic_energy();
        let fixed = scene.dem.geometry.as_ref().map(Geometry::spheres)?;
        if scene.spheres.shape != Shape::Disc {
            return None;
        }
        let with_door = [&fixed.walls[..], &fixed.door[..]].concat();
        let (smallest, largest) = scene.radius_range();
        let pairs = wall_pairs(&with_door, 2.0 * smallest);
        let alone = with_door.iter().map(|&one| [one, one]);
        let places = pairs.iter().copied().chain(alone).flat_map(|fixed| {
            [smallest, largest].into_iter().flat_map(move |radius| {
                let passed = [(WallFailure::Passed, gap(fixed))];
                let too_deep = deepest(scene, radius, fixed);
                let too_deep = too_deep.map(|place| (WallFailure::OverlapGuard, place));
                let is_pair = fixed[0] != fixed[1];
                let passed = passed.into_iter().filter(move |_| is_pair);
                passed.chain(too_deep).map(move |it| (it, radius, fixed))
            })
        });
        let places = places.map(|((failure, place), radius, fixed)| Self {
            speed: {
                let energy = energy_at(&elastic_energy, radius, place, &with_door);
                let mass = scene.spheres.shape.mass(scene.spheres.density, radius);
                (2.0 * energy / (mass * scene.inertial_factor())).sqrt()
            },
            radius,
            fixed,
            failure,
        });
        places.min_by(|a, b| a.speed.total_cmp(&b.speed))
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    libm::hypot(b[0] - a[0], b[2] - a[2])
}

/// The place midway between the surfaces of two fixed discs (m).
fn gap([one, other]: [FixedSphere; 2]) -> [f64; 3] {
    let apart = distance(one.position, other.position);
    let share = 0.5 * (apart + one.radius - other.radius) / apart;
    std::array::from_fn(|axis| (1.0 - share) * one.position[axis] + share * other.position[axis])
}

/// The place (m) at which a disc that moves straight at the wall overlaps the first fixed disc as
/// far as the overlap guard allows. `None` if the place is beyond that disc's centre: the guard is
/// then never broken.
fn deepest(scene: &Scene, radius: f64, [one, other]: [FixedSphere; 2]) -> Option<[f64; 3]> {
    let overlap = scene.dem.guards.overlap * radius.min(one.radius);
    let above = radius + one.radius - overlap;
    let apart = distance(one.position, other.position);
    let normal = match apart > 0.0 {
        true => [
            (other.position[2] - one.position[2]) / apart,
            (one.position[0] - other.position[0]) / apart,
        ],
        false => [0.0, 1.0],
    };
    let [x, y, z] = one.position;
    (above > 0.0).then(|| [x + above * normal[0], y, z + above * normal[1]])
}

/// The elastic energy (J) of the contacts of a disc with all `fixed` discs, at a place.
/// `of_contact` is the energy of one contact, from its overlap and effective radius.
fn energy_at(
    of_contact: &dyn Fn(f64, f64) -> f64,
    radius: f64,
    place: [f64; 3],
    fixed: &[FixedSphere],
) -> f64 {
    let contacts = fixed.iter().filter_map(|fixed| {
        let overlap = radius + fixed.radius - distance(fixed.position, place);
        let effective_radius = radius * fixed.radius / (radius + fixed.radius);
        (overlap > 0.0).then(|| of_contact(overlap, effective_radius))
    });
    contacts.sum()
}
