//! Which contact and friction laws go together, and the engine compiled for them.

use super::contact::{Hertz, Linear, NoContact, NormalLaw, Silbert};
use super::friction::{
    Coulomb, CundallStrack, Frictionless, Mindlin, SilbertFriction, SpinFriction, TangentialLaw,
};
use super::simulation::BuildError;
use super::system::{Engine, Parts, System};
use super::timestep;
use crate::scene::{Contact, Friction, Scene};

/// The engine compiled for the scene's contact and friction. Each pair of laws costs time to
/// compile, so only those are here that go together.
pub(super) fn engine(scene: &Scene, parts: Parts) -> Result<Box<dyn Engine>, BuildError> {
    fn boxed<N: NormalLaw, T: TangentialLaw>(
        normal: N,
        tangential: T,
        parts: Parts,
    ) -> Box<dyn Engine> {
        Box::new(System::new(normal, tangential, parts))
    }
    let dt = scene.time.dt;
    match scene.contact {
        None => match scene.friction {
            None => Ok(boxed(NoContact, Frictionless, parts)),
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
            Ok(match scene.friction {
                None => boxed(normal, Frictionless, parts),
                Some(Friction::CundallStrack { .. } | Friction::Silbert { .. }) => {
                    return Err(BuildError::LawsDoNotGoTogether);
                }
                Some(Friction::Spin { coefficient }) => {
                    boxed(normal, SpinFriction::new(coefficient, dt), parts)
                }
                Some(Friction::Coulomb {
                    coefficient,
                    regularisation,
                }) => boxed(normal, Coulomb::new(coefficient, regularisation), parts),
                Some(Friction::Mindlin { coefficient }) => {
                    let law = Mindlin::new(coefficient, young_modulus, poisson_ratio);
                    boxed(normal, law, parts)
                }
            })
        }
        Some(Contact::Linear {
            stiffness,
            damping,
            drag,
        }) => {
            let normal = Linear::new(stiffness, damping, drag);
            match scene.friction {
                None => Ok(boxed(normal, Frictionless, parts)),
                Some(Friction::Coulomb {
                    coefficient,
                    regularisation,
                }) => Ok(boxed(
                    normal,
                    Coulomb::new(coefficient, regularisation),
                    parts,
                )),
                Some(Friction::CundallStrack {
                    coefficient,
                    stiffness,
                    damping,
                }) => {
                    let law = CundallStrack::new(coefficient, stiffness, damping);
                    Ok(boxed(normal, law, parts))
                }
                Some(
                    Friction::Spin { .. } | Friction::Mindlin { .. } | Friction::Silbert { .. },
                ) => Err(BuildError::LawsDoNotGoTogether),
            }
        }
        Some(Contact::Silbert { stiffness, damping }) => {
            let normal = Silbert::new(stiffness, damping);
            match scene.friction {
                None => Ok(boxed(normal, Frictionless, parts)),
                Some(Friction::Silbert {
                    coefficient,
                    stiffness,
                    damping,
                }) => {
                    let law = SilbertFriction::new(coefficient, stiffness, damping);
                    Ok(boxed(normal, law, parts))
                }
                Some(_) => Err(BuildError::LawsDoNotGoTogether),
            }
        }
    }
}
