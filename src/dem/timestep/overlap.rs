//! How deep spheres overlap at the start.

use crate::dem::neighbours::visit_pairs;
use crate::dem::walls::{TankWall, Wall};
use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::scene::{Scene, Start};
use crate::start;

/// The deepest overlap (m) of two listed spheres, or of one with a wall. Zero if none touch. Other
/// starts have no overlap.
pub(super) fn deepest_at_start(scene: &Scene) -> f64 {
    // Radii may be drawn at random, so the spheres must be placed.
    let (Start::List { .. }, Ok(spheres)) = (&scene.start, start::place(scene)) else {
        return 0.0;
    };
    let pairs = deepest_pair(&spheres);
    let Some(tank) = &scene.tank else {
        return pairs;
    };
    let tank_walls = TankWall::of_tank(tank, scene.dem.door.is_some());
    let centres = spheres.position.iter().zip(&spheres.radius);
    let walls = centres.map(|(&centre, &radius)| into_walls(&tank_walls, centre, radius));
    walls.fold(pairs, f64::max)
}

fn into_walls(walls: &[TankWall], centre: Vector, radius: f64) -> f64 {
    let contacts = walls.iter().map(|wall| wall.contact(centre, radius));
    let touching = contacts.filter(|contact| contact.touches);
    touching.map(|contact| contact.overlap).fold(0.0, f64::max)
}

/// The deepest overlap of two spheres.
fn deepest_pair(spheres: &Particles) -> f64 {
    let Particles {
        position, radius, ..
    } = spheres;
    let mut deepest = 0.0;
    visit_pairs(spheres, |i, j| {
        let distance = (position[i] - position[j]).norm();
        deepest = f64::max(deepest, radius[i] + radius[j] - distance);
    });
    deepest
}
