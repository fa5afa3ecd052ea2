//! The parameters in the form that loops need, and the effect of a spot's move.

use super::arrangement::{Arrangement, Sorting};
use super::guard::{Fault, SpotGuard};
use super::parameters::{Influence, Parameters};
use super::profile::Clock;
use super::region::{NOWHERE, collect};
use super::relax::{EightDisplacements, RelaxedRegion, displacements};
use super::silo::Silo;
use super::slack::{Slack, Wear};
use crate::particles::block::ROWS;
use crate::particles::vector::Vector;
use fearless_simd::{Level, Simd};
use std::ops::Range;

/// What does not change during a simulation.
#[derive(Clone, Debug)]
pub(crate) struct SpotRules {
    pub(crate) parameters: Parameters,
    pub(crate) silo: Silo,
    pub(crate) level: Level,
    pub(crate) slack: Slack,
    /// Diameter of the spheres (m).
    pub(crate) diameter: f64,
    /// Share of an overlap that one relaxation removes.
    pub(crate) relaxation_strength: f64,
}

/// Buffers of moves, and their results.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    pub(crate) ranges: Vec<Range<u32>>,
    /// Slots of the spheres that the spot moved.
    pub(crate) moved: Vec<u32>,
    /// Slots of the spheres that were relaxed.
    pub(crate) relaxed: Vec<u32>,
    pub(crate) displacement: Vec<EightDisplacements>,
    /// Slots and last places of the spheres that have left through the orifice.
    pub(crate) left: Vec<(u32, Vector)>,
    pub(crate) wear: Wear,
    /// Times of its parts, if requested.
    pub(crate) clock: Clock,
}

impl SpotRules {
    pub(crate) fn new(parameters: Parameters) -> Self {
        Self {
            silo: Silo::new(&parameters),
            slack: Slack::of(&parameters),
            level: Level::new(),
            diameter: parameters.diameter,
            relaxation_strength: parameters.relaxation_strength,
            parameters,
        }
    }

    /// How spheres are sorted.
    pub(crate) fn sorting(&self) -> Sorting<'_> {
        Sorting {
            level: self.level,
            parameters: &self.parameters,
            slack: self.slack,
        }
    }

    /// The basic step of a spot that moves by `step` around `centre`, the middle of its way:
    /// spheres nearer than r_s to `centre` are displaced in the opposite direction.
    pub(crate) fn spot(
        &self,
        arrangement: &Arrangement,
        position: &mut [Vector],
        scratch: &mut Scratch,
        (centre, step): (Vector, Vector),
    ) {
        let radius = self.parameters.spot_radius;
        fearless_simd::dispatch!(self.level, simd => {
            self.find(simd, arrangement, position, (centre, radius), scratch);
        });
        let displacement = step * -self.displacement_per_step(centre.z, scratch.moved.len());
        let bounded = [self.parameters.half_width, self.parameters.half_depth]
            .into_iter()
            .zip([centre.x, centre.y])
            .any(|(half, place)| place.abs() + radius > half);
        let reflected = self.parameters.reflection && bounded;
        let floor = self.silo.floor_is_within(radius + self.diameter, centre.z);
        let mut wear = scratch.wear;
        let moved = std::mem::take(&mut scratch.moved);
        for &slot in &moved {
            let old = position[slot as usize];
            let images = if reflected {
                self.images(old, centre)
            } else {
                1.0
            };
            let new = self.silo.between_walls(old + displacement * images);
            let distance = (new - arrangement.reference[slot as usize]).norm_squared();
            wear.note(distance, arrangement.farthest_squared[slot as usize]);
            position[slot as usize] = new;
        }
        scratch.wear = wear;
        if floor {
            self.keep_above_floor(&moved, position, &mut scratch.left);
        }
        scratch.moved = moved;
    }

    /// Finds the spheres nearer than a radius to a centre (m); their slots are `scratch.moved`.
    #[inline(always)]
    pub(crate) fn find<S: Simd>(
        &self,
        simd: S,
        arrangement: &Arrangement,
        position: &[Vector],
        (centre, radius): (Vector, f64),
        scratch: &mut Scratch,
    ) {
        let Scratch { ranges, moved, .. } = scratch;
        arrangement.cover(centre, radius, ranges);
        collect(simd, position, ranges, (centre, radius), moved);
    }

    /// Displacement of a sphere over the spot's, which moves `count` spheres at a height (m).
    fn displacement_per_step(&self, height: f64, count: usize) -> f64 {
        match self.parameters.influence {
            Influence::Weighted {
                volume_ratio,
                least_count,
                above,
            } if height >= above => volume_ratio / (count as f64).max(least_count),
            _ => 1.0 / self.parameters.displacement_ratio,
        }
    }

    /// How many of a spot and its images in the walls are within r_s of a sphere that is within r_s
    /// of the spot itself.
    fn images(&self, sphere: Vector, spot: Vector) -> f64 {
        let images = |half: f64, sphere: f64, spot: f64| {
            [spot, 2.0 * half - spot, -2.0 * half - spot].map(|it| (sphere - it) * (sphere - it))
        };
        let x = images(self.parameters.half_width, sphere.x, spot.x);
        let y = images(self.parameters.half_depth, sphere.y, spot.y);
        let z = (sphere.z - spot.z) * (sphere.z - spot.z);
        let most = self.parameters.spot_radius * self.parameters.spot_radius;
        let pairs = x.iter().flat_map(|x| y.iter().map(move |y| x + y + z));
        pairs.filter(|squared| *squared < most).count() as f64
    }

    /// Removes overlaps of the spheres nearer than r_e to a centre.
    pub(crate) fn relax(
        &self,
        arrangement: &Arrangement,
        position: &mut [Vector],
        scratch: &mut Scratch,
        centre: Vector,
    ) -> Result<(), Fault> {
        let radius = self.parameters.relaxation_radius;
        let region = RelaxedRegion {
            centre,
            radius,
            longest: 0.5 * self.diameter,
        };
        let Scratch {
            ranges,
            relaxed,
            displacement,
            ..
        } = scratch;
        let mut inside = 0;
        fearless_simd::dispatch!(self.level, simd => {
            arrangement.cover(centre, radius, ranges);
            collect(simd, position, ranges, (centre, radius), relaxed);
            inside = relaxed.len();
            relaxed.resize(inside.next_multiple_of(ROWS), arrangement.spheres as u32);
            displacement.resize(relaxed.len() / ROWS, EightDisplacements::default());
            let of = (&relaxed[..], &mut displacement[..]);
            displacements(simd, (self, arrangement), position, region, of)
        })?;
        relaxed.truncate(inside);
        self.apply(arrangement, position, scratch);
        if self.silo.floor_is_within(radius + self.diameter, centre.z) {
            self.keep_above_floor(&scratch.relaxed, position, &mut scratch.left);
        }
        Ok(())
    }

    fn apply(&self, arrangement: &Arrangement, position: &mut [Vector], scratch: &mut Scratch) {
        let mut wear = scratch.wear;
        let groups = scratch.relaxed.chunks(ROWS).zip(&scratch.displacement);
        for (slots, displacement) in groups {
            for (lane, &slot) in slots.iter().enumerate() {
                let slot = slot as usize;
                let new = position[slot] + displacement.vector(lane);
                let new = self.silo.between_walls(new);
                let distance = (new - arrangement.reference[slot]).norm_squared();
                wear.note(distance, arrangement.farthest_squared[slot]);
                position[slot] = new;
            }
        }
        scratch.wear = wear;
    }

    /// Pushes spheres off the floor and the orifice's edge, and removes those that have left.
    pub(crate) fn keep_above_floor(
        &self,
        slots: &[u32],
        position: &mut [Vector],
        left: &mut Vec<(u32, Vector)>,
    ) {
        for &slot in slots {
            let centre = position[slot as usize];
            match self.silo.above_floor(centre) {
                Some(kept) => position[slot as usize] = kept,
                None => {
                    position[slot as usize] = NOWHERE;
                    left.push((slot, centre));
                }
            }
        }
    }

    /// An error if a spot that moves no sphere has spheres above it on all sides. A spot behind a
    /// wall, where a negative wall distance lets it go, may find none: near an edge its reach ends
    /// before the spheres that touch both walls.
    pub(crate) fn check_empty(
        &self,
        arrangement: &Arrangement,
        centre: Vector,
    ) -> Result<(), Fault> {
        let radius = self.parameters.spot_radius;
        let surface = arrangement.surface().lowest(centre, radius);
        let is_behind_wall = centre.x.abs() > self.parameters.half_width
            || centre.y.abs() > self.parameters.half_depth;
        if is_behind_wall || centre.z + radius >= surface {
            return Ok(());
        }
        let detail = format!("the spot finds no sphere below a surface at {surface} m");
        Err(Fault {
            guard: SpotGuard::EmptySpot,
            place: centre,
            slot: None,
            detail,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spot::{SpotSimulation, samples};

    /// Displacement of each sphere by a spot, and how many are moved.
    fn displaced(
        change: impl FnOnce(&mut Parameters),
        centre: Vector,
        step: Vector,
    ) -> (Vec<Vector>, usize) {
        let simulation = samples::simulation(change);
        let mut position = simulation.position.clone();
        let mut scratch = Scratch::default();
        let arrangement = &simulation.arrangement;
        simulation
            .model
            .spot(arrangement, &mut position, &mut scratch, (centre, step));
        let by = position
            .iter()
            .zip(&simulation.position)
            .map(|(new, old)| *new - *old);
        (by.collect(), scratch.moved.len())
    }

    #[test]
    fn a_spot_moves_what_is_in_its_range_the_other_way() {
        let centre = Vector::new(1.0, 0.3, 7.0);
        let (by, count) = displaced(|_| {}, centre, Vector::new(0.0, 0.0, 0.1));
        let start = samples::simulation(|_| {}).position;
        let mut moved = 0;
        for (by, start) in by.iter().zip(&start) {
            let near = (*start - centre).norm() < 2.6;
            moved += usize::from(near);
            let expected = if near { -0.1 / 399.0 } else { 0.0 };
            assert!((by.z - expected).abs() < 1e-12 && by.x == 0.0, "{by:?}");
        }
        assert_eq!(moved, count);
        // 84 spheres at the packing fraction .6, 90 at the initial one.
        assert!((80..100).contains(&count), "{count}");
    }

    #[test]
    fn weighted_spots_move_the_same_volume_whatever_is_in_range() {
        let weighted = |it: &mut Parameters| {
            it.influence = Influence::Weighted {
                volume_ratio: 0.2115,
                least_count: 20.0,
                above: 5.0,
            };
        };
        let step = Vector::new(0.0, 0.0, 0.1);
        let top = samples::packing()
            .iter()
            .fold(0.0, |most: f64, it| most.max(it.z));
        for (z, fewest) in [(8.0, 80), (top + 0.5, 20)] {
            let (by, count) = displaced(weighted, Vector::new(0.0, 0.0, z), step);
            let volume: f64 = by.iter().map(|it| -it.z).sum();
            assert!(count >= fewest, "{count}");
            assert!((volume / (0.1 * 0.2115) - 1.0).abs() < 1e-6, "{volume}");
        }
        let few = Vector::new(0.0, 0.0, top + 2.0);
        let (by, count) = displaced(weighted, few, step);
        let volume: f64 = by.iter().map(|it| -it.z).sum();
        assert!(count > 0 && count < 20, "{count}");
        assert!((volume / (0.1 * 0.2115 * count as f64 / 20.0) - 1.0).abs() < 1e-6);
        let below = displaced(weighted, Vector::new(0.0, 0.0, 4.0), step).0;
        let least = below.iter().fold(0.0, |least: f64, it| least.min(it.z));
        assert!((least + 0.1 / 399.0).abs() < 1e-12);
    }

    /// Displacement of spheres at these places by one relaxation about a centre.
    fn relaxed(places: &[Vector], centre: Vector) -> Vec<Vector> {
        let simulation = SpotSimulation::new(samples::parameters(), places, 1).expect("a start");
        let arrangement = &simulation.arrangement;
        let mut position = simulation.position.clone();
        let mut scratch = Scratch::default();
        let relaxed = simulation
            .model
            .relax(arrangement, &mut position, &mut scratch, centre);
        relaxed.expect("no guard breaks");
        let mut by = vec![Vector::ZERO; places.len()];
        for (&id, &place) in arrangement.id.iter().zip(&position) {
            by[id as usize] = place - places[id as usize];
        }
        by
    }

    /// Overlaps of .04 d, in rows along x; r_e = 3.6 d and alpha = .8.
    #[test]
    fn free_spheres_share_an_overlap_and_held_ones_stay() {
        let (both, one) = (0.8 * 0.04 / 2.0, 0.8 * 0.04);
        let cases: [(&[f64], &[f64]); 5] = [
            (&[-0.48, 0.48], &[-both, both]),
            // Both neighbours at once: the one in the middle stays.
            (&[-0.96, 0.0, 0.96], &[-both, 0.0, both]),
            (&[2.7, 3.66], &[-one, 0.0]),
            (&[3.7, 4.66], &[0.0, 0.0]),
            (&[-0.5, 0.5], &[0.0, 0.0]),
        ];
        for (places, expected) in cases {
            let places: Vec<_> = places.iter().map(|x| Vector::new(*x, 0.2, 7.0)).collect();
            let by = relaxed(&places, Vector::new(0.0, 0.2, 7.0));
            for (by, expected) in by.iter().zip(expected) {
                let error = (by.x - expected).abs();
                assert!(
                    error < 1e-12 && by.y == 0.0 && by.z == 0.0,
                    "{by:?} {expected}"
                );
            }
        }
    }

    #[test]
    fn a_spot_without_spheres_in_the_bed_is_an_error_with_its_place() {
        let simulation = samples::simulation(|_| {});
        let check = |x: f64, z: f64| {
            let centre = Vector::new(x, 0.0, z);
            simulation
                .model
                .check_empty(&simulation.arrangement, centre)
        };
        let fault = check(1.0, 5.0).expect_err("spheres lie above it");
        assert_eq!(fault.guard, SpotGuard::EmptySpot);
        assert_eq!(fault.place, Vector::new(1.0, 0.0, 5.0));
        assert!(check(1.0, 20.0).is_ok(), "above the bed");
        assert!(check(8.0, 5.0).is_ok(), "behind a wall");
    }

    #[test]
    fn the_reflected_part_of_a_spot_counts_once_more_at_each_wall() {
        let model = SpotRules::new(Parameters::figure_2(1.0));
        let images = |sphere: [f64; 3], spot: [f64; 3]| {
            model.images(Vector::from(sphere), Vector::from(spot))
        };
        assert_eq!(images([0.0, 3.0, 5.0], [0.0, 0.6, 5.0]), 1.0);
        assert_eq!(images([0.0, 3.4, 5.0], [0.0, 2.2, 5.0]), 2.0);
        assert_eq!(images([24.4, 3.4, 5.0], [24.0, 3.0, 5.0]), 4.0);
        assert_eq!(images([24.4, 1.4, 5.0], [24.0, 3.0, 5.0]), 2.0);
    }
}
