//! Stability limits of the time step.

use crate::scene::{Contact, Scene};

/// A.
pub fn dissipation_time(scene: &Scene) -> f64 {
    match &scene.contact {
        Some(Contact::Hertz {
            dissipation_time: Some(time),
            ..
        }) => *time,
        _ => 0.0,
    }
}
