//! Random dense packings to start from.
//!
//! Spheres at random places under a lid are pushed apart until none overlap: the energy of a soft
//! repulsion is minimised. Between close walls they may find no room; the lid is then raised, and
//! they start from other places. The lid is then lowered in small steps, each with a minimisation,
//! until the middle of the box has the packing fraction of random close packing, or until the
//! spheres jam: the procedure of O'Hern, Silbert, Liu and Nagel, Physical Review E 68
//! (2003) 011306. There is no gravity. The lid is then taken away, which leaves the top free.

mod fire;
mod fraction;
mod of_scene;

use super::parameters::{Parameters, Relaxation};
use super::random::RandomStream;
use super::state::SpotError;
use super::threads::Workers;
use crate::particles::vector::Vector;
use fire::Minimizer;

pub use fraction::packing_fraction;
pub use of_scene::{make, name};

/// Packing fraction in the middle of the box at which the lid stops.
pub const PACKING_FRACTION: f64 = 0.64;

/// Packing fraction of the whole box at which minimisation begins; it always succeeds there, except
/// between walls a few diameters apart.
const FIRST_FRACTION: f64 = 0.57;

/// The lid is raised by this factor if spheres find no room below it.
const RAISE: f64 = 1.2;

/// Greatest height of the lid, over the height of all spheres stacked: each has room then.
const HIGHEST: f64 = 4.0;

/// Share of the height by which the lid is lowered in one step.
const STEP: f64 = 0.003;

/// The least share of the height.
const LEAST_STEP: f64 = 0.0002;

/// Spheres are kept apart by this additional share of the diameter, so that the minimisation ends
/// after finitely many steps.
const INFLATION: f64 = 1e-3;

/// Why there is no packing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PackingError {
    /// A parameter is invalid, or threads cannot be started.
    #[error(transparent)]
    Start(#[from] SpotError),
    /// There are no spheres.
    #[error("a packing needs at least one sphere")]
    NoSpheres,
    /// Spheres still overlap.
    #[error(
        "{spheres} spheres could not be pushed apart below a lid at {height} m; make `tank.width` \
         and `tank.depth` larger"
    )]
    Jammed {
        /// Number of spheres.
        spheres: usize,
        /// Height of the lid (m).
        height: f64,
    },
}

/// Centres (m) of spheres in a random dense packing between the walls of a silo and above its
/// floor, the orifice closed. No two centres are nearer than the diameter. The same number and seed
/// give the same bits for any number of threads.
///
/// # Errors
///
/// If a parameter is invalid, if there are no spheres, or if they cannot be pushed apart.
pub fn random_packing(
    parameters: &Parameters,
    spheres: usize,
    seed: u64,
    threads: usize,
) -> Result<Vec<Vector>, PackingError> {
    if spheres == 0 {
        return Err(PackingError::NoSpheres);
    }
    parameters.check_box().map_err(SpotError::from)?;
    let workers = Workers::new(threads).map_err(|it| SpotError::Threads(it.to_string()))?;
    workers.install(|| lower_lid(parameters, spheres, seed))
}

fn lower_lid(
    parameters: &Parameters,
    spheres: usize,
    seed: u64,
) -> Result<Vec<Vector>, PackingError> {
    let diameter = parameters.diameter * (1.0 + INFLATION);
    let area = 4.0 * parameters.half_width * parameters.half_depth;
    let volume = std::f64::consts::PI / 6.0 * diameter * diameter * diameter;
    let mut height = spheres as f64 * volume / (FIRST_FRACTION * area) + diameter;
    let inflated = Parameters {
        diameter,
        relaxation: Relaxation::Global { ratio: 1 },
        relaxation_strength: 1.0,
        ..parameters.clone()
    };
    let mut minimizer = Minimizer::new(
        &inflated,
        parameters.diameter,
        RandomStream::new("shaking", seed),
    );
    let mut centres = random_centres(&inflated, height, spheres, seed);
    while !minimizer.push_apart(&mut centres, height)? {
        if height > HIGHEST * spheres as f64 * diameter {
            return Err(PackingError::Jammed { spheres, height });
        }
        height *= RAISE;
        centres = random_centres(&inflated, height, spheres, seed);
    }
    let mut step = STEP;
    while step >= LEAST_STEP && packing_fraction(parameters, &centres) < PACKING_FRACTION {
        let lower = height * (1.0 - step);
        let scale = (lower - diameter) / (height - diameter);
        let radius = 0.5 * diameter;
        let squeeze = |it: &Vector| Vector::new(it.x, it.y, radius + (it.z - radius) * scale);
        let mut squeezed: Vec<Vector> = centres.iter().map(squeeze).collect();
        if minimizer.push_apart(&mut squeezed, lower)? {
            (centres, height) = (squeezed, lower);
        } else {
            step *= 0.5;
        }
    }
    Ok(centres)
}

/// Centres at random between the walls, the floor and a lid.
fn random_centres(parameters: &Parameters, height: f64, spheres: usize, seed: u64) -> Vec<Vector> {
    let mut random = RandomStream::new("start packing", seed);
    let radius = 0.5 * parameters.diameter;
    let halves = [parameters.half_width, parameters.half_depth];
    let mut place = || {
        let room = halves.map(|half| (half - radius).max(0.0));
        let [x, y] = room.map(|room| room * (2.0 * random.uniform() - 1.0));
        Vector::new(x, y, radius + (height - 2.0 * radius) * random.uniform())
    };
    (0..spheres).map(|_| place()).collect()
}
