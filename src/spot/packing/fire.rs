//! Minimisation of the energy of a soft repulsion: FIRE (Bitzek, Koskinen, Gähler, Moseler and
//! Gumbsch, Physical Review Letters 97 (2006) 170201), with their parameters.

use crate::particles::block::ROWS;
use crate::particles::vector::Vector;
use crate::spot::arrangement::{Arrangement, Sorting};
use crate::spot::guard::{Fault, SpotFailure};
use crate::spot::model::SpotRules;
use crate::spot::neighbours::NeighbourLists;
use crate::spot::parameters::Parameters;
use crate::spot::random::RandomStream;
use crate::spot::relax::EightDisplacements;
use crate::spot::slack::Slack;
use crate::spot::state::SpotError;

/// The first time step, in units in which mass and stiffness of an overlap are 1 and 1/2.
const FIRST_STEP: f64 = 0.3;

/// The longest time step. A sphere with twelve contacts vibrates with frequencies up to 2.
const LONGEST_STEP: f64 = 0.5;

/// Greatest component of the velocities at first, in diameters.
const SHAKE: f64 = 0.025;

/// Steps in which spheres keep moving with these velocities, under repulsion and drag. Without such
/// steps the packing fraction stays at .62. With twice the velocity and four times the steps more
/// than half of the packing crystallises.
const SHAKEN: usize = 50;

/// Slack of the spheres, in diameters.
const SLACK: f64 = 0.15;

/// Share of the velocity that is lost in each step. Without it, spheres that do not touch would
/// never stop.
const DRAG: f64 = 0.02;

/// Steps within which spheres separate; otherwise they count as jammed.
const MOST_STEPS: usize = 6000;

/// Steps between two searches for overlaps.
const CHECK: usize = 25;

/// Pushes spheres apart.
pub(super) struct Minimizer {
    model: SpotRules,
    /// Required distance of centres (m); the diameter of `model` is slightly larger.
    apart: f64,
    displacement: Vec<EightDisplacements>,
    random: RandomStream,
}

/// The moving spheres.
struct MovingSpheres {
    arrangement: Arrangement,
    position: Vec<Vector>,
    velocity: Vec<Vector>,
}

/// Sums over all spheres that steer the minimisation.
#[derive(Clone, Copy, Default)]
struct FireSums {
    power: f64,
    force_squared: f64,
    speed_squared: f64,
}

impl Minimizer {
    /// A minimiser for spheres of an inflated diameter, until centres are at least `apart` (m).
    pub(super) fn new(inflated: &Parameters, apart: f64, random: RandomStream) -> Self {
        Self {
            model: SpotRules::new(inflated.clone()),
            apart,
            displacement: Vec::new(),
            random,
        }
    }

    /// Pushes spheres apart below a lid at a height (m), and sorts them. False if some still
    /// overlap after many steps.
    pub(super) fn push_apart(
        &mut self,
        centres: &mut Vec<Vector>,
        height: f64,
    ) -> Result<bool, SpotError> {
        let velocity = centres.iter().map(|_| self.shove()).collect();
        let mut spheres = self.sort(std::mem::take(centres), velocity)?;
        let apart = self.minimize(&mut spheres, height)?;
        spheres.position.truncate(spheres.arrangement.spheres);
        *centres = spheres.position;
        Ok(apart)
    }

    /// A random velocity. Its component across walls that leave no room is zero.
    fn shove(&mut self) -> Vector {
        let mut along = || SHAKE * self.model.diameter * (2.0 * self.random.uniform() - 1.0);
        let [x, y, z] = [along(), along(), along()];
        let [wide, deep] = self.model.silo.room().map(|room| room > 0.0);
        let within = |along: f64, has_room: bool| if has_room { along } else { 0.0 };
        Vector::new(within(x, wide), within(y, deep), z)
    }

    fn sort(
        &self,
        mut position: Vec<Vector>,
        velocity: Vec<Vector>,
    ) -> Result<MovingSpheres, SpotError> {
        let ids = (0..velocity.len() as u32).collect();
        let sorted = (&mut position, ids);
        let diameter = self.model.diameter;
        let sorting = Sorting {
            slack: Slack::uniform(SLACK * diameter, diameter),
            ..self.model.sorting()
        };
        let arrangement = Arrangement::sorted(sorting, sorted, NeighbourLists::new());
        let arrangement = arrangement.map_err(start_error)?;
        let velocity = arrangement
            .id
            .iter()
            .map(|&from| velocity[from as usize])
            .collect();
        Ok(MovingSpheres {
            arrangement,
            position,
            velocity,
        })
    }

    fn minimize(&mut self, spheres: &mut MovingSpheres, height: f64) -> Result<bool, SpotError> {
        const MIXING: f64 = 0.1;
        let (mut time_step, mut mixing, mut downhill) = (FIRST_STEP, MIXING, 0);
        for step in 1..=MOST_STEPS {
            let sums = self.kick(spheres, height, time_step)?;
            if step <= SHAKEN {
                // Velocities carry over.
            } else if sums.power > 0.0 {
                let turn = mixing * (sums.speed_squared / sums.force_squared).sqrt();
                self.turn(spheres, height, (mixing, turn));
                downhill += 1;
                if downhill > 5 {
                    time_step = (1.1 * time_step).min(LONGEST_STEP);
                    mixing *= 0.99;
                }
            } else {
                spheres.velocity.fill(Vector::ZERO);
                (time_step, mixing, downhill) = (0.5 * time_step, MIXING, 0);
            }
            if drift(spheres, time_step) {
                let position = std::mem::take(&mut spheres.position);
                let velocity = std::mem::take(&mut spheres.velocity);
                *spheres = self.sort(position, velocity)?;
            }
            if step % CHECK == 0 && self.are_apart(spheres) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Force on a sphere: from its neighbours, given as a displacement, and from the walls.
    #[inline(always)]
    fn force(&self, centre: Vector, displacement: Vector, height: f64) -> Vector {
        let radius = 0.5 * self.model.diameter;
        let boxed = self.model.silo.between_walls(centre);
        let z = centre.z.max(radius).min(height - radius);
        displacement + (Vector::new(boxed.x, boxed.y, z) - centre)
    }

    /// Adds forces to velocities.
    fn kick(
        &mut self,
        spheres: &mut MovingSpheres,
        height: f64,
        time_step: f64,
    ) -> Result<FireSums, SpotError> {
        let (arrangement, position) = (&spheres.arrangement, &spheres.position);
        let mut displacement = std::mem::take(&mut self.displacement);
        let found = self.model.displacements_of_all(
            (arrangement, position),
            f64::INFINITY,
            &mut displacement,
        );
        self.displacement = displacement;
        found.map_err(start_error)?;
        let mut sums = FireSums::default();
        for (slot, velocity) in spheres.velocity.iter_mut().enumerate() {
            let by_others = self.displacement[slot / ROWS].vector(slot % ROWS);
            let force = self.force(spheres.position[slot], by_others, height);
            *velocity = *velocity * (1.0 - DRAG) + force * time_step;
            sums.power += force.dot(*velocity);
            sums.force_squared += force.norm_squared();
            sums.speed_squared += velocity.norm_squared();
        }
        Ok(sums)
    }

    /// Turns velocities towards forces.
    fn turn(&self, spheres: &mut MovingSpheres, height: f64, (mixing, factor): (f64, f64)) {
        for (slot, velocity) in spheres.velocity.iter_mut().enumerate() {
            let by_others = self.displacement[slot / ROWS].vector(slot % ROWS);
            let force = self.force(spheres.position[slot], by_others, height);
            *velocity = *velocity * (1.0 - mixing) + force * factor;
        }
    }

    /// Whether all centres are far enough apart and inside the box of the true diameter.
    fn are_apart(&self, spheres: &MovingSpheres) -> bool {
        let MovingSpheres {
            arrangement,
            position,
            ..
        } = spheres;
        let neighbours = &arrangement.neighbours;
        let lists = neighbours.slot.chunks_exact(neighbours.width);
        let apart_squared = self.apart * self.apart;
        let outside = 0.5 * (self.model.diameter - self.apart);
        let present = position[..arrangement.spheres].iter();
        let mut all = present.zip(lists.zip(&neighbours.count));
        all.all(|(own, (list, &count))| {
            let by_walls = self.force(*own, Vector::ZERO, f64::INFINITY);
            let near =
                |other: &u32| (*own - position[*other as usize]).norm_squared() < apart_squared;
            by_walls.norm() <= outside && !list[..count as usize].iter().any(near)
        })
    }
}

/// Moves spheres by their velocities. True if they must be sorted.
fn drift(spheres: &mut MovingSpheres, time_step: f64) -> bool {
    let mut stale = false;
    let arrangement = &spheres.arrangement;
    for (slot, velocity) in spheres.velocity.iter().enumerate() {
        let place = &mut spheres.position[slot];
        *place += *velocity * time_step;
        let distance = (*place - arrangement.reference[slot]).norm_squared();
        stale |= distance > arrangement.farthest_squared[slot];
    }
    stale
}

fn start_error(fault: Fault) -> SpotError {
    SpotError::Failure(Box::new(SpotFailure {
        guard: fault.guard,
        moves: 0,
        time: 0.0,
        place: fault.place,
        sphere: fault.slot,
        detail: fault.detail,
    }))
}
