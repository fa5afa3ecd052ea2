//! Relaxation of all spheres at once: method 3 of Rycroft, Wong and Bazant (2010), section 5.

use super::arrangement::Arrangement;
use super::guard::Fault;
use super::model::SpotRules;
use super::profile::DrainagePart;
use super::region::NOWHERE;
use super::relax::{EightDisplacements, RelaxedRegion, displacements};
use super::simulation::SpotSimulation;
use super::slack::Wear;
use super::threads::in_parallel;
use crate::particles::block::ROWS;
use crate::particles::vector::Vector;

/// Spheres that one task relaxes.
const TASK: usize = 2048;

/// The spheres of one task: their first slot, centres, and displacements.
struct RelaxationTask<'a> {
    first: usize,
    position: &'a mut [Vector],
    displacement: &'a mut [EightDisplacements],
    result: Result<(), Fault>,
    wear: Wear,
}

impl SpotSimulation {
    /// Removes overlaps of all spheres at once.
    pub(super) fn relax_all(&mut self) -> Result<(), Fault> {
        self.sort_if_stale()?;
        self.scratch.clock.begin_whole();
        let Self {
            model,
            arrangement,
            position,
            scratch,
            workers,
            ..
        } = self;
        let displacement = &mut scratch.displacement;
        workers.install(|| {
            let longest = 0.5 * model.diameter;
            model.displacements_of_all((arrangement, position), longest, displacement)?;
            model.displace_all(arrangement, position, displacement, &mut scratch.wear);
            Ok(())
        })?;
        let lowest = |slot: &u32| {
            let z = position[*slot as usize].z;
            model.silo.floor_is_within(0.0, z) && z > NOWHERE.z
        };
        let low: Vec<u32> = (0..arrangement.spheres as u32).filter(lowest).collect();
        model.keep_above_floor(&low, position, &mut scratch.left);
        self.counts.global_relaxations += 1;
        self.count_left();
        self.scratch.clock.end_whole(DrainagePart::Relaxation);
        Ok(())
    }
}

impl SpotRules {
    /// Computes the displacements that remove overlaps of all spheres.
    pub(crate) fn displacements_of_all(
        &self,
        (arrangement, position): (&Arrangement, &[Vector]),
        longest: f64,
        displacement: &mut Vec<EightDisplacements>,
    ) -> Result<(), Fault> {
        let spheres = arrangement.spheres;
        displacement.resize(spheres.div_ceil(ROWS), EightDisplacements::default());
        let region = RelaxedRegion {
            centre: Vector::ZERO,
            radius: f64::INFINITY,
            longest,
        };
        let chunks = displacement.chunks_mut(TASK / ROWS).enumerate();
        let mut tasks: Vec<RelaxationTask<'_>> = chunks
            .map(|(task, displacement)| RelaxationTask::new(task, &mut [], displacement))
            .collect();
        in_parallel(&mut tasks, &|task: &mut RelaxationTask<'_>| {
            let last = (task.first + TASK).min(spheres);
            let mut slots: Vec<u32> = (task.first as u32..last as u32).collect();
            slots.resize(slots.len().next_multiple_of(ROWS), spheres as u32);
            let of = (&slots[..], &mut *task.displacement);
            task.result = fearless_simd::dispatch!(self.level, simd => {
                displacements(simd, (self, arrangement), position, region, of)
            });
        });
        tasks.into_iter().try_for_each(|task| task.result)
    }

    /// Displaces all spheres.
    fn displace_all(
        &self,
        arrangement: &Arrangement,
        position: &mut [Vector],
        displacement: &mut [EightDisplacements],
        wear: &mut Wear,
    ) {
        let position = position[..arrangement.spheres].chunks_mut(TASK);
        let chunks = position
            .zip(displacement.chunks_mut(TASK / ROWS))
            .enumerate();
        let mut tasks: Vec<RelaxationTask<'_>> = chunks
            .map(|(task, (position, by))| RelaxationTask {
                wear: wear.unused(),
                ..RelaxationTask::new(task, position, by)
            })
            .collect();
        in_parallel(&mut tasks, &|task: &mut RelaxationTask<'_>| {
            for (k, place) in task.position.iter_mut().enumerate() {
                if place.z > NOWHERE.z {
                    let displacement = task.displacement[k / ROWS].vector(k % ROWS);
                    *place = self.silo.between_walls(*place + displacement);
                    let slot = task.first + k;
                    let distance = (*place - arrangement.reference[slot]).norm_squared();
                    task.wear.note(distance, arrangement.farthest_squared[slot]);
                }
            }
        });
        for task in tasks {
            wear.note_all(task.wear);
        }
    }
}

impl<'a> RelaxationTask<'a> {
    fn new(
        task: usize,
        position: &'a mut [Vector],
        displacement: &'a mut [EightDisplacements],
    ) -> Self {
        Self {
            first: task * TASK,
            position,
            displacement,
            result: Ok(()),
            wear: Wear::default(),
        }
    }
}
