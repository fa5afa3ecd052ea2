//! The contacts at the present positions, one after the other, for measurements.

use super::System;
use super::contact_laws::{Laws, Loading};
use super::contact_state::ContactState;
use super::partners::Partners;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::particles::vector::Vector;

/// A contact of a sphere that moves.
#[derive(Clone, Copy, Debug)]
pub(in crate::dem) struct SeenContact {
    /// Index of the sphere.
    pub(in crate::dem) sphere: usize,
    /// What it touches.
    pub(in crate::dem) partner: Partner,
    /// Height of its centre (m).
    pub(in crate::dem) height: f64,
    /// From the other end of the contact's branch to its centre (m). That is the centre of a sphere
    /// that moves too, but the point of contact with a fixed one or a wall.
    pub(in crate::dem) branch: Vector,
    /// Force on the sphere (N), if forces are asked for.
    pub(in crate::dem) force: Vector,
    /// How often it counts: less than once where walls join, each of which counts there.
    pub(in crate::dem) weight: f64,
}

/// What a sphere touches.
#[derive(Clone, Copy, Debug)]
pub(in crate::dem) enum Partner {
    /// A sphere that moves, by its index.
    Sphere(usize),
    /// A fixed sphere.
    Fixed,
    /// A wall or the floor, or a place where walls join.
    Wall(WallTouch),
}

/// Where a sphere touches a wall.
#[derive(Clone, Copy, Debug)]
pub(in crate::dem) struct WallTouch {
    /// The place of the wall among the walls and their joints.
    pub(in crate::dem) wall: usize,
    /// The point of the wall (m), in the box of a periodic space.
    pub(in crate::dem) point: Vector,
    /// Torque of rolling resistance on the sphere (N m), if forces are asked for.
    pub(in crate::dem) rolling: Vector,
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Shows all contacts of spheres that move, in an order that is part of the bits of sums over
    /// them: all pairs, then wall by wall. Forces are those of the present positions and
    /// velocities;
    /// tangential springs are as at their latest evaluation, at most a step ago.
    pub(super) fn see_contacts(&mut self, forces: bool, see: &mut dyn FnMut(SeenContact)) {
        if !N::ACTS || self.neighbours.list.is_none() {
            return;
        }
        if self.neighbours.stale && self.refresh().is_err() {
            return;
        }
        let laws = Laws {
            loading: Loading::present(0.0),
            ..self.laws()
        };
        self.see_pairs(forces.then_some(laws), see);
        self.see_walls(forces.then_some(laws), see);
    }

    fn see_pairs(&self, laws: Option<Laws<N, T>>, see: &mut dyn FnMut(SeenContact)) {
        let particles = &self.particles;
        let (position, radius) = (&particles.position, &particles.radius);
        let spheres = Partners::all(particles, &[]);
        let pairs = self.neighbours.near.pairs().iter();
        for (pair, history) in pairs.zip(&self.pair_history) {
            let [i, j] = pair.sides().map(|side| side as usize);
            let sum = radius[i] + radius[j];
            let offset = particles.domain.offset(position[i], position[j]);
            if offset.norm_squared() >= sum * sum {
                continue;
            }
            let force = laws.map_or(Vector::ZERO, |laws| {
                let state = ContactState::of_pair(&spheres, pair.i(), pair.j());
                laws.pair_force(&state, *history).force
            });
            // Fixed spheres come first.
            let fixed = [i, j].map(|side| side < particles.fixed);
            let contact = match fixed {
                [false, false] => SeenContact {
                    sphere: i,
                    partner: Partner::Sphere(j),
                    height: position[i].z,
                    branch: offset,
                    force,
                    weight: 1.0,
                },
                [true, false] => SeenContact {
                    sphere: j,
                    partner: Partner::Fixed,
                    height: position[j].z,
                    branch: -offset * (radius[j] / sum),
                    force: -force,
                    weight: 1.0,
                },
                [false, true] => SeenContact {
                    sphere: i,
                    partner: Partner::Fixed,
                    height: position[i].z,
                    branch: offset * (radius[i] / sum),
                    force,
                    weight: 1.0,
                },
                [true, true] => continue,
            };
            see(contact);
        }
    }

    fn see_walls(&self, laws: Option<Laws<N, T>>, see: &mut dyn FnMut(SeenContact)) {
        let particles = &self.particles;
        let spheres = Partners::all(particles, &[]);
        for (place, wall) in self.walls.iter().enumerate() {
            for (near, history) in wall.near.iter().zip(&wall.histories) {
                let sphere = near.i as usize;
                let (centre, radius) = (particles.position[sphere], particles.radius[sphere]);
                let contact = wall.wall.contact(centre, radius);
                if sphere < particles.fixed || !contact.touches {
                    continue;
                }
                let force = laws.map_or(Vector::ZERO, |laws| {
                    let state = ContactState::at_wall(&spheres, near.i);
                    laws.wall_force(&wall.wall, &state, *history).force * wall.wall.weight
                });
                let rolling = laws.map_or(Vector::ZERO, |laws| {
                    self.rolling_at_wall(laws, (&wall.wall, place as u32), near.i)
                });
                let branch = contact.normal * (radius - contact.overlap);
                see(SeenContact {
                    sphere,
                    partner: Partner::Wall(WallTouch {
                        wall: place,
                        point: particles.domain.wrapped(centre - branch),
                        rolling,
                    }),
                    height: centre.z,
                    branch,
                    force,
                    weight: wall.wall.weight,
                });
            }
        }
    }
}
