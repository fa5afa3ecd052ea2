//! How fast a disc must be to squeeze through a wall of fixed ones.

use super::contact::{Hertz, Linear, NormalLaw, Silbert};
use super::process::wall_pairs;
use super::timestep;
use crate::scene::{Contact, FixedSphere, Geometry, Scene, Shape};

/// The weakest place of a scene's walls, for the disc that passes it most easily.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeakestWall {
    /// Speed above which a disc passes (m/s).
    pub speed: f64,
    /// Radius of that disc (m).
    pub radius: f64,
    /// The fixed ones between which it passes.
    pub between: [FixedSphere; 2],
}

impl WeakestWall {
    /// The weakest place of the walls of discs of a scene, its door included. None without any, or
    /// without a contact law.
    ///
    /// A disc that passes between two fixed ones, midway between their surfaces, overlaps them and
    /// perhaps others. What these contacts store there it must bring along as kinetic energy. The
    /// damping, which makes it a little harder, and discs that push from behind, which make it
    /// easier, are left out.
    pub fn of_scene(scene: &Scene) -> Option<Self> {
        let contact = scene.contact.as_ref()?;
        let fixed = scene.geometry.as_ref().map(Geometry::spheres)?;
        if scene.spheres.shape != Shape::Disc {
            return None;
        }
        let with_door = [&fixed.walls[..], &fixed.door[..]].concat();
        let (smallest, largest) = scene.radius_range();
        let pairs = wall_pairs(&with_door, 2.0 * smallest);
        let places = pairs.iter().flat_map(|&between| {
            [smallest, largest].map(|radius| Self {
                speed: passing_speed(scene, contact, radius, between, &with_door),
                radius,
                between,
            })
        });
        places.min_by(|a, b| a.speed.total_cmp(&b.speed))
    }
}

/// The speed (m/s) at which a disc has the energy that its contacts with all `fixed` ones store
/// where it passes between two of them.
fn passing_speed(
    scene: &Scene,
    contact: &Contact,
    radius: f64,
    between: [FixedSphere; 2],
    fixed: &[FixedSphere],
) -> f64 {
    let distance = |a: [f64; 3], b: [f64; 3]| libm::hypot(b[0] - a[0], b[2] - a[2]);
    let [one, other] = between;
    let apart = distance(one.position, other.position);
    let share = 0.5 * (apart + one.radius - other.radius) / apart;
    let place = std::array::from_fn(|axis| {
        (1.0 - share) * one.position[axis] + share * other.position[axis]
    });
    let contacts = fixed.iter().filter_map(|fixed| {
        let overlap = radius + fixed.radius - distance(fixed.position, place);
        let effective_radius = radius * fixed.radius / (radius + fixed.radius);
        (overlap > 0.0).then(|| elastic_energy(scene, contact, overlap, effective_radius))
    });
    let mass = scene.spheres.shape.mass(scene.spheres.density, radius);
    (2.0 * contacts.sum::<f64>() / mass).sqrt()
}

fn elastic_energy(scene: &Scene, contact: &Contact, overlap: f64, effective_radius: f64) -> f64 {
    match *contact {
        Contact::Linear {
            stiffness,
            damping,
            drag,
        } => Linear::new(stiffness, damping, drag).elastic_energy(overlap, effective_radius),
        Contact::Silbert { stiffness, damping } => {
            Silbert::new(stiffness, damping).elastic_energy(overlap, effective_radius)
        }
        Contact::Hertz {
            young_modulus,
            poisson_ratio,
            dissipation_factor,
            ..
        } => {
            let time = timestep::dissipation_time(scene);
            Hertz::new(young_modulus, poisson_ratio, time, dissipation_factor)
                .elastic_energy(overlap, effective_radius)
        }
    }
}
