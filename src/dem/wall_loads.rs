//! Force and torque of the spheres on each wall of a scene.

use super::simulation::joined_within;
use super::system::WallTouch;
use crate::particles::vector::Vector;
use crate::scene::Scene;
use crate::walls::{Wall, sharers, with_joints};

/// Sums over the contacts with each wall. A place where walls join belongs to them in equal parts,
/// so that all forces are counted.
pub(super) struct WallLoads {
    /// The walls of the scene, without joints.
    walls: Vec<WallLoad>,
    /// For each wall and joint of the engine, the walls that share what acts there.
    sharers: Vec<Vec<usize>>,
    /// The same without the walls that have gone.
    present: Vec<Vec<usize>>,
}

/// What acts on a wall.
#[derive(Default)]
struct WallLoad {
    /// The point about which the torque is measured (m).
    centre: Vector,
    force: Vector,
    torque: Vector,
}

impl WallLoads {
    pub(super) fn new(scene: &Scene) -> Self {
        let (walls, tolerance) = (Wall::of_scene(scene), joined_within(scene));
        let load = |wall: &Wall| WallLoad {
            centre: wall.centre,
            ..WallLoad::default()
        };
        Self {
            walls: walls.iter().map(load).collect(),
            present: Vec::new(),
            sharers: {
                let count = walls.len();
                sharers(&with_joints(walls, tolerance), count, tolerance)
            },
        }
    }

    /// Begins a sum over all contacts, at walls and joints that act or do not.
    pub(super) fn begin(&mut self, acts: &[bool]) {
        for wall in &mut self.walls {
            (wall.force, wall.torque) = (Vector::ZERO, Vector::ZERO);
        }
        let staying = |all: &Vec<usize>| all.iter().copied().filter(|&it| acts[it]).collect();
        self.present = self.sharers.iter().map(staying).collect();
    }

    /// Adds a contact with this force (N) on its sphere.
    pub(super) fn add(&mut self, touch: &WallTouch, force: Vector) {
        let sharers = &self.present[touch.wall];
        let share = 1.0 / sharers.len() as f64;
        let (force, rolling) = (-force * share, -touch.rolling * share);
        for &place in sharers {
            let wall = &mut self.walls[place];
            wall.force += force;
            wall.torque += (touch.point - wall.centre).cross(force) + rolling;
        }
    }

    /// Force along x, y and z (N), then torque (N m), wall by wall.
    pub(super) fn values(&self) -> impl Iterator<Item = f64> {
        let vectors = self.walls.iter().flat_map(|it| [it.force, it.torque]);
        vectors.flat_map(|it| [it.x, it.y, it.z])
    }
}
