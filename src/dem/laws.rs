//! The engine compiled for a scene's laws of contact and friction.

use super::system::{Engine, System, SystemSetup};
use crate::forces::contact::{Contact, ContactKeys, NoContact, NormalLaw, with_keys};
use crate::forces::friction::{
    Friction, FrictionKeys, Frictionless, TangentialLaw, with_pairs_of_laws,
};
use crate::particles::Particles;
use crate::scene::Scene;
use crate::start::StartError;

/// Why a scene cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum DemBuildError {
    /// The spheres cannot be placed.
    #[error(transparent)]
    Start(#[from] StartError),
    /// There is friction but no contact.
    #[error("friction acts at contacts, but the scene has no contact law")]
    FrictionWithoutContact,
    /// The friction law is made for another contact law.
    #[error("this friction law does not go with this contact law")]
    LawsDoNotGoTogether,
    /// There is rolling resistance without friction, or with a friction law without sliding.
    #[error("rolling resistance needs a friction law with sliding")]
    RollingWithoutFriction,
}

/// The engine compiled for the scene's contact and friction. Each pair of laws costs compile time,
/// so only pairs that go together are here.
pub(super) fn engine(
    scene: &Scene,
    setup: SystemSetup,
    particles: Particles,
) -> Result<Box<dyn Engine>, DemBuildError> {
    type Spheres = (SystemSetup, Particles);
    fn boxed<N: NormalLaw, T: TangentialLaw>(
        normal: N,
        tangential: T,
        (setup, particles): Spheres,
    ) -> Box<dyn Engine> {
        Box::new(System::new(normal, tangential, setup, particles))
    }
    let friction = scene.dem.friction.as_ref();
    let slides = friction.is_some_and(|it| !matches!(it, Friction::Spin(_)));
    if scene.dem.rolling.is_some() && !slides {
        return Err(DemBuildError::RollingWithoutFriction);
    }
    let dt = scene.time.dt;
    let spheres = (setup, particles);
    let radius = scene.mean_radius();
    let mass = scene.spheres.shape.mass(scene.spheres.density, radius) * scene.inertial_factor();
    macro_rules! of_pair {
        ($(($contact:ident, $friction:ident),)+) => {
            match (&scene.dem.contact, &scene.dem.friction) {
                (None, None) => Ok(boxed(NoContact, Frictionless, spheres)),
                (None, Some(_)) => Err(DemBuildError::FrictionWithoutContact),
                (Some(contact), None) => Ok(with_keys!(contact, contact => {
                    boxed(contact.law(radius, mass), Frictionless, spheres)
                })),
                $((Some(Contact::$contact(contact)), Some(Friction::$friction(friction))) => {
                    Ok(boxed(contact.law(radius, mass), friction.law(contact, dt), spheres))
                })+
                (Some(_), Some(_)) => Err(DemBuildError::LawsDoNotGoTogether),
            }
        };
    }
    with_pairs_of_laws!(of_pair)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dem::DemSimulation;
    use serde_json::json;

    #[test]
    fn the_engine_is_compiled_for_the_pairs_of_laws_that_a_scene_may_name() {
        let contacts = [
            json!({
                "law": "hertz", "young_modulus": 1e7, "poisson_ratio": 0.3, "restitution": 0.5
            }),
            json!({ "law": "linear", "stiffness": 100.0, "damping": 0.02 }),
            json!({ "law": "silbert", "stiffness": 1e7, "damping": 1e3 }),
            json!({
                "law": "tsuji", "young_modulus": 1e7, "poisson_ratio": 0.3, "restitution": 0.5
            }),
            json!({ "law": "hooke", "stiffness": 100.0, "damping_rate": 50.0 }),
        ];
        let frictions = [
            json!({ "law": "spin", "coefficient": 0.3 }),
            json!({ "law": "coulomb", "coefficient": 0.3, "regularisation": 1e-3 }),
            json!({ "law": "cundall-strack", "coefficient": 0.3, "stiffness": 60.0 }),
            json!({ "law": "mindlin", "coefficient": 0.3 }),
            json!({ "law": "mindlin-deresiewicz", "coefficient": 0.3 }),
            json!({ "law": "silbert", "coefficient": 0.3, "stiffness": 1e7 }),
            json!({ "law": "hooke", "coefficient": 0.3, "stiffness": 60.0 }),
        ];
        let mut together = 0;
        for contact in &contacts {
            for friction in &frictions {
                let scene: Scene = serde_json::from_value(json!({
                    "spheres": { "count": 1, "radius": 0.004, "density": 1e3 },
                    "contact": contact,
                    "friction": friction,
                    "start": { "kind": "list", "spheres": [{ "position": [0.0, 0.0, 0.0] }] },
                    "time": { "dt": 1e-5, "duration": 1e-3, "frame_interval": 1e-3 },
                }))
                .unwrap();
                let allowed = scene.dem.friction.as_ref().zip(scene.dem.contact.as_ref());
                let allowed =
                    allowed.is_some_and(|(friction, contact)| friction.goes_with(contact));
                together += usize::from(allowed);
                let built = DemSimulation::new(&scene);
                assert_eq!(built.is_ok(), allowed, "{contact} {friction}");
            }
        }
        assert_eq!(together, 12);
    }
}
