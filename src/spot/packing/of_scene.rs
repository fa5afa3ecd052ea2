//! The packing of a scene: its name, and how it is made.

use super::{PackingError, random_packing};
use crate::scene::Scene;
use crate::spot::parameters::Parameters;

/// The quantities on which a packing depends.
struct PackingKey {
    /// Version of the method: another version makes other packings.
    version: u32,
    spheres: usize,
    radius: f64,
    /// Width and depth of the tank (m).
    sides: [f64; 2],
    seed: u64,
}

/// Version of the method.
const VERSION: u32 = 3;

impl PackingKey {
    fn of(scene: &Scene) -> Self {
        let tank = scene.tank.clone().unwrap_or_default();
        Self {
            version: VERSION,
            spheres: scene.spheres.count,
            radius: scene.spheres.radius.mean(),
            sides: [tank.width, tank.depth].map(|side| side.unwrap_or(0.0)),
            seed: scene.seed,
        }
    }
}

/// The name of the packing that a scene starts with: scenes with the same name start with the same
/// packing. The height of the floor and everything else in the scene do not matter.
pub fn name(scene: &Scene) -> String {
    let choice = PackingKey::of(scene);
    let text = format!(
        "{} {} {:?} {:?} {}",
        choice.version, choice.spheres, choice.radius, choice.sides, choice.seed
    );
    blake3::hash(text.as_bytes()).to_hex()[..16].to_owned()
}

/// The centres (m) of the packing that a scene starts with, above its floor.
///
/// # Errors
/// If the spheres cannot be pushed apart.
pub fn make(scene: &Scene, threads: usize) -> Result<Vec<[f64; 3]>, PackingError> {
    let choice = PackingKey::of(scene);
    let diameter = 2.0 * choice.radius;
    let [half_width, half_depth] = choice.sides.map(|side| 0.5 * side);
    let parameters = Parameters {
        half_width,
        half_depth,
        ..Parameters::figure_2(diameter)
    };
    let centres = random_packing(&parameters, choice.spheres, choice.seed, threads)?;
    Ok(centres.into_iter().map(|it| [it.x, it.y, it.z]).collect())
}
