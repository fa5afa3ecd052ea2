//! Which contact and friction laws go together, and the engine compiled for them.

use super::simulation::BuildError;
use super::system::{Engine, Setup, System};
use super::timestep;
use crate::forces::contact::{Hertz, Linear, NoContact, NormalLaw, Silbert};
use crate::forces::friction::{
    Coulomb, CundallStrack, Frictionless, Mindlin, SilbertFriction, SpinFriction, TangentialLaw,
};
use crate::particles::Particles;
use crate::scene::{Contact, Friction, Scene};

/// The engine compiled for the scene's contact and friction. Each pair of laws costs time to
/// compile, so only those are here that go together.
pub(super) fn engine(
    scene: &Scene,
    setup: Setup,
    particles: Particles,
) -> Result<Box<dyn Engine>, BuildError> {
    type Spheres = (Setup, Particles);
    fn boxed<N: NormalLaw, T: TangentialLaw>(
        normal: N,
        tangential: T,
        (setup, particles): Spheres,
    ) -> Box<dyn Engine> {
        Box::new(System::new(normal, tangential, setup, particles))
    }
    let dt = scene.time.dt;
    let spheres = (setup, particles);
    match scene.dem.contact {
        None => match scene.dem.friction {
            None => Ok(boxed(NoContact, Frictionless, spheres)),
            Some(_) => Err(BuildError::FrictionWithoutContact),
        },
        Some(Contact::Hertz {
            young_modulus,
            poisson_ratio,
            dissipation_factor,
            ..
        }) => {
            let dissipation_time = timestep::dissipation_time(scene);
            let normal = Hertz::new(
                young_modulus,
                poisson_ratio,
                dissipation_time,
                dissipation_factor,
            );
            Ok(match scene.dem.friction {
                None => boxed(normal, Frictionless, spheres),
                Some(Friction::CundallStrack { .. } | Friction::Silbert { .. }) => {
                    return Err(BuildError::LawsDoNotGoTogether);
                }
                Some(Friction::Spin { coefficient }) => {
                    boxed(normal, SpinFriction::new(coefficient, dt), spheres)
                }
                Some(Friction::Coulomb {
                    coefficient,
                    regularisation,
                }) => boxed(normal, Coulomb::new(coefficient, regularisation), spheres),
                Some(Friction::Mindlin { coefficient }) => {
                    let law = Mindlin::new(coefficient, young_modulus, poisson_ratio);
                    boxed(normal, law, spheres)
                }
            })
        }
        Some(Contact::Linear {
            stiffness,
            damping,
            drag,
        }) => {
            let normal = Linear::new(stiffness, damping, drag);
            match scene.dem.friction {
                None => Ok(boxed(normal, Frictionless, spheres)),
                Some(Friction::Coulomb {
                    coefficient,
                    regularisation,
                }) => Ok(boxed(
                    normal,
                    Coulomb::new(coefficient, regularisation),
                    spheres,
                )),
                Some(Friction::CundallStrack {
                    coefficient,
                    stiffness,
                    damping,
                }) => {
                    let law = CundallStrack::new(coefficient, stiffness, damping);
                    Ok(boxed(normal, law, spheres))
                }
                Some(
                    Friction::Spin { .. } | Friction::Mindlin { .. } | Friction::Silbert { .. },
                ) => Err(BuildError::LawsDoNotGoTogether),
            }
        }
        Some(Contact::Silbert { stiffness, damping }) => {
            let normal = Silbert::new(stiffness, damping);
            match scene.dem.friction {
                None => Ok(boxed(normal, Frictionless, spheres)),
                Some(Friction::Silbert {
                    coefficient,
                    stiffness,
                    damping,
                }) => {
                    let law = SilbertFriction::new(coefficient, stiffness, damping);
                    Ok(boxed(normal, law, spheres))
                }
                Some(_) => Err(BuildError::LawsDoNotGoTogether),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dem::Simulation;
    use serde_json::json;

    #[test]
    fn the_engine_is_compiled_for_the_pairs_of_laws_that_a_scene_may_name() {
        let contacts = [
            json!({ "law": "hertz", "young_modulus": 1e7, "poisson_ratio": 0.3, "restitution": 0.5 }),
            json!({ "law": "linear", "stiffness": 100.0, "damping": 0.02 }),
            json!({ "law": "silbert", "stiffness": 1e7, "damping": 1e3 }),
        ];
        let frictions = [
            json!({ "law": "spin", "coefficient": 0.3 }),
            json!({ "law": "coulomb", "coefficient": 0.3, "regularisation": 1e-3 }),
            json!({ "law": "cundall-strack", "coefficient": 0.3, "stiffness": 60.0 }),
            json!({ "law": "mindlin", "coefficient": 0.3 }),
            json!({ "law": "silbert", "coefficient": 0.3, "stiffness": 1e7 }),
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
                let built = Simulation::new(&scene);
                assert_eq!(built.is_ok(), allowed, "{contact} {friction}");
            }
        }
        assert_eq!(together, 6);
    }
}
