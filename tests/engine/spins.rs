//! Spins that friction takes away for good.

use crate::scenes::{INTEGRATORS, tank};
use phase::dem::DemSimulation;
use phase::scene::{Friction, Radii, Spin, Start, StartSphere};

/// Symptom: a run of `theoretical.toml` took six times as long for a second of motion from the
/// seventh second on. Cause: the thesis's friction multiplied spins by 0.99 at every step of every
/// contact, down to subnormal numbers, which processors multiply slowly, and which never got to
/// zero.
#[test]
fn spins_that_friction_takes_away_become_zero() {
    for integrator in INTEGRATORS {
        let mut scene = tank(Some(Friction::Spin(Spin { coefficient: 0.1 })), integrator);
        scene.dem.effects.swirl = None;
        scene.dem.effects.updraught = None;
        scene.spheres.count = 1;
        scene.spheres.radius = Radii::One(0.004);
        // On the floor, which takes away the spins about the horizontal.
        let sphere = StartSphere::at([0.0, 0.0, -0.046]);
        scene.start = Start::list(vec![StartSphere {
            spin: [3.0, -4.0, 5.0],
            ..sphere
        }]);
        let mut simulation = DemSimulation::new(&scene).unwrap();
        simulation.advance(20_000).unwrap();
        let spin = simulation.particles().spin[0];
        assert_eq!([spin.x, spin.y], [0.0, 0.0], "{integrator:?}");
    }
}
