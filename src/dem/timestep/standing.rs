//! The time step of a scene compared with its limits, and when to warn.

use super::{Limit, limits};
use crate::scene::Scene;

/// A time step compared with one limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepMargin {
    /// The limit.
    pub limit: Limit,
    /// Time step over limit.
    pub ratio: f64,
}

impl StepMargin {
    /// Above this part of a decisive limit there is a warning. A spring then has w dt > 1 and
    /// oscillates 5 % too fast, 2 asin(w dt / 2) > pi/3 instead of 1. A relaxation at the rate g
    /// has g dt > 1 and overshoots.
    pub const CAUTION: f64 = 0.5;

    /// A scene's step compared with each of its limits, in the order of [`limits`].
    pub fn all(scene: &Scene) -> Vec<Self> {
        let of = |limit: Limit| Self {
            limit,
            ratio: scene.time.dt / limit.seconds,
        };
        limits(scene).into_iter().map(of).collect()
    }

    /// A scene's step compared with the limit above which it is refused, if there is one.
    pub fn decisive(scene: &Scene) -> Option<Self> {
        Self::all(scene).into_iter().find(|it| it.limit.decisive)
    }

    /// The text of a warning, if the step is above [`CAUTION`](Self::CAUTION) times a decisive
    /// limit or above an advised limit. There is no warning for the Rayleigh time: a step is
    /// usually a fifth of it, but no force in this engine travels as a surface wave.
    pub fn consequence(&self) -> Option<&'static str> {
        let threshold = if self.limit.decisive {
            Self::CAUTION
        } else {
            1.0
        };
        let consequence = self.limit.consequence;
        consequence.filter(|_| self.ratio > threshold)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use std::path::Path;

    fn warns(limit: Limit, ratio: f64) -> bool {
        StepMargin { limit, ratio }.consequence().is_some()
    }

    #[test]
    fn warnings_begin_at_their_thresholds() {
        let limit = |decisive: bool, consequence| Limit {
            name: "some",
            seconds: 1.0,
            decisive,
            explanation: "",
            consequence,
        };
        let decisive = limit(true, Some("coarse"));
        assert!(!warns(decisive, 0.5) && warns(decisive, 0.501));
        let advised = limit(false, Some("coarse"));
        assert!(!warns(advised, 1.0) && warns(advised, 1.001));
        assert!(!warns(limit(false, None), 1.5));
    }

    /// A scene in the air with every limit that goes with the contact and friction.
    fn scene(contact: &str, friction: &str, dt: f64) -> Scene {
        let text = format!(
            "contact = {{ {contact} }}
            friction = {{ {friction} }}
            spheres = {{ count = 2, density = 1e4, radius = 0.004 }}
            tank = {{ radius = 0.06, floor = 0.0 }}
            start = {{ kind = 'random', z_min = 0.1, z_max = 0.2 }}
            gravity = {{ acceleration = 9.8 }}
            drag = {{ law = 'diameter', linear = 1e-4, quadratic = 0.2 }}
            swirl = {{ omega = 3.0 }}
            spin_damping = {{ coefficient = 1e-8 }}
            time = {{ dt = {dt:e}, duration = 1, frame_interval = 1e-3 }}"
        );
        Scene::from_toml(&text, Path::new("scene.toml")).unwrap_or_else(|error| panic!("{error}"))
    }

    const HERTZ: &str =
        "law = 'hertz', young_modulus = 2e6, poisson_ratio = 0.3, dissipation_time = 1e-4";
    const LINEAR: &str = "law = 'linear', stiffness = 100.0, damping = 0.05";
    const COULOMB: &str = "law = 'coulomb', coefficient = 0.3, regularisation = 1.0";
    const LAWS: [(&str, &str); 7] = [
        (
            "law = 'silbert', stiffness = 2e6, damping = 1e4",
            "law = 'silbert', coefficient = 0.3, stiffness = 6e5, damping = 5e3",
        ),
        (
            "law = 'hooke', stiffness = 100.0, damping_rate = 50.0",
            "law = 'hooke', coefficient = 0.3, stiffness = 80.0, damping_rate = 25.0",
        ),
        (
            "law = 'tsuji', young_modulus = 2e6, poisson_ratio = 0.3, restitution = 0.5",
            "law = 'mindlin', coefficient = 0.3",
        ),
        (HERTZ, COULOMB),
        (HERTZ, "law = 'mindlin', coefficient = 0.3"),
        (LINEAR, COULOMB),
        (
            LINEAR,
            "law = 'cundall-strack', coefficient = 0.3, stiffness = 80.0, damping = 0.05",
        ),
    ];

    #[test]
    fn every_limit_has_words_but_the_rayleigh_time() {
        let mut seen = std::collections::BTreeSet::new();
        for (contact, friction) in LAWS {
            for limit in limits(&scene(contact, friction, 1e-5)) {
                assert_eq!(
                    warns(limit, 2.0),
                    limit.name != "Rayleigh time",
                    "{}",
                    limit.name
                );
                seen.insert(limit.name);
            }
        }
        assert_eq!(seen.len(), 9, "{seen:?}");
    }

    #[test]
    fn no_limit_depends_on_the_step_that_it_limits() {
        for (contact, friction) in LAWS {
            let [short, long] = [1e-6, 1e-5].map(|dt| scene(contact, friction, dt));
            assert_eq!(limits(&short), limits(&long));
            let ratios = |scene: &Scene| {
                StepMargin::all(scene)
                    .iter()
                    .map(|it| it.ratio)
                    .sum::<f64>()
            };
            assert!((ratios(&long) / ratios(&short) - 10.0).abs() < 1e-9);
        }
    }
}
