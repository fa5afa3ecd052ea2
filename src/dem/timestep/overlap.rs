//! How deep spheres overlap at the start.

use crate::dem::start;
use crate::dem::vector::Vector;
use crate::dem::walls::{TankWall, Wall};
use crate::scene::{Scene, Start, Tank};

/// The deepest overlap (m) of two listed spheres, or of one with a wall; zero where none touch. Other
/// starts have none.
pub(super) fn deepest_at_start(scene: &Scene) -> f64 {
    // Radii may be dealt at random, which only placing the spheres tells.
    let (Start::List { .. }, Ok(spheres)) = (&scene.start, start::place(scene)) else {
        return 0.0;
    };
    let mut spheres: Vec<_> = spheres.position.into_iter().zip(spheres.radius).collect();
    spheres.sort_by(|(a, _), (b, _)| a.x.total_cmp(&b.x));
    let pairs = deepest_pair(&spheres);
    let Some(tank) = &scene.tank else {
        return pairs;
    };
    let walls = spheres.iter().map(|sphere| into_walls(tank, *sphere));
    walls.fold(pairs, f64::max)
}

fn into_walls(tank: &Tank, (centre, radius): (Vector, f64)) -> f64 {
    let walls = TankWall::of_tank(tank).into_iter();
    let contacts = walls.map(|wall| wall.contact(centre, radius));
    let touching = contacts.filter(|contact| contact.touches);
    touching.map(|contact| contact.overlap).fold(0.0, f64::max)
}

/// The deepest overlap of two spheres (centre and radius), which are sorted by their x.
fn deepest_pair(spheres: &[(Vector, f64)]) -> f64 {
    let largest = spheres.iter().fold(0.0, |most, &(_, r)| f64::max(most, r));
    let mut deepest = 0.0;
    for (i, &(centre, radius)) in spheres.iter().enumerate() {
        let end = centre.x + radius + largest;
        let others = spheres[i + 1..].iter().take_while(|(it, _)| it.x < end);
        for &(other, other_radius) in others {
            deepest = f64::max(deepest, radius + other_radius - (centre - other).norm());
        }
    }
    deepest
}
