//! The critical rotation of spheres with friction.

use super::{critical_rotation, unshielded_lift};
use crate::scene::{Drag, Scene, Swirl, Updraught};
use std::f64::consts::PI;

/// Parts of the radius over which forces are averaged, an even number.
const PARTS: usize = 32;

/// Halvings that find a rotation to the last bits.
const HALVINGS: usize = 80;

/// Critical angular velocity Omega_mu (rad/s) of the air where friction with floor and wall holds
/// the spheres back: the bed turns with [Omega_c](critical_rotation) only if the air turns faster.
///
/// The bed is a disc of the tank's radius R that turns as a whole with Omega_c. The torque of the
/// air, drag(u rho / R) at a distance rho from the axis, with the relative velocity u = (Omega_mu -
/// Omega_c) R at the wall, balances the torque of friction, with the floor under the weight and
/// with the wall under the centrifugal force:
///
/// mean(drag(u rho / R) rho) = mu m (g max(1 - L, 0) + Omega_c^2 R) mean(rho),
///
/// with the mean over the disc, m the mass of a sphere and mu the coefficient of friction at walls.
/// The updraught carries the part L of the weight,
///
/// L = F_z / (m g) (1 - alpha^N) / ((1 - alpha) N),   N = 16 n r^2 / (pi R^2),
///
/// the mean over the N spheres in a column of eq. 24's square 4 r x 4 r, each of which shields
/// those above it from the force F_z at the floor. With quadratic drag only,
///
/// Omega_mu = Omega_c + sqrt(5 mu m (g max(1 - L, 0) + Omega_c^2 R) / (3 c2)) / R.
///
/// In a fluid, buoyancy is subtracted from the weight, the mass at the wall is m + C rho V, and the
/// pressure of the rotating fluid reduces the load on the wall by (rho_b + C rho_a) V Omega_mu^2 R,
/// at most to zero. Omega_c does not change, because weight and centrifugal force of a bed that
/// turns with its fluid are reduced by the same factor.
///
/// Neglected: the height of the bed, over which the updraught decays, and the weight carried by the
/// wall.
///
/// `None` without a tank with floor, gravity, swirl, or friction that can hold spheres at rest.
pub fn critical_rotation_with_friction(scene: &Scene) -> Option<f64> {
    let without = critical_rotation(
        scene.spheres.count as f64,
        scene.spheres.radius.of_mean_volume(),
        scene.tank.as_ref()?.radius?,
        scene.dem.effects.gravity.as_ref()?.acceleration,
    );
    let bed = TurningBed::of(scene, without)?;
    // The torque of the air rises with its rotation, and the load on the floor does not.
    let moves = |omega: f64| bed.drag_at(omega) >= bed.friction_at(omega);
    let mut high = 2.0 * without.max(f64::MIN_POSITIVE);
    while !moves(high) {
        high *= 2.0;
        if !high.is_finite() {
            return None;
        }
    }
    let mut low = without;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match moves(middle) {
            true => high = middle,
            false => low = middle,
        }
    }
    Some(high)
}

/// A bed that turns with Omega_c.
struct TurningBed<'a> {
    drag: &'a Drag,
    updraught: Option<&'a Updraught>,
    /// Coefficient of friction mu.
    friction: f64,
    /// Omega_c (rad/s).
    rotation: f64,
    radius: f64,
    tank_radius: f64,
    floor: f64,
    /// Mass of a sphere (kg).
    mass: f64,
    /// Gravity in the fluid (m/s2).
    gravity: f64,
    /// Spheres in a column of the shield, N.
    column: f64,
    /// Inertial mass over mass, and mass that the fluid's pressure accelerates over mass.
    inertial_factor: f64,
    pressed_mass_ratio: f64,
}

impl<'a> TurningBed<'a> {
    fn of(scene: &'a Scene, rotation: f64) -> Option<Self> {
        let (spheres, effects) = (&scene.spheres, &scene.dem.effects);
        effects.swirl.as_ref()?;
        let radius = spheres.radius.of_mean_volume();
        let tank_radius = scene.tank.as_ref()?.radius?;
        Some(Self {
            drag: effects.drag.as_ref()?,
            updraught: effects.updraught.as_ref(),
            friction: scene.friction_at_walls()?.holding_coefficient()?,
            rotation,
            radius,
            tank_radius,
            floor: scene.tank.as_ref()?.floor?,
            mass: spheres.shape.mass(spheres.density, radius),
            gravity: scene.gravity_in_fluid()?.acceleration,
            column: 16.0 * spheres.count as f64 * radius * radius
                / (PI * tank_radius * tank_radius),
            inertial_factor: scene.inertial_factor(),
            pressed_mass_ratio: scene.pressed_mass_ratio(),
        })
    }

    /// mean(drag(u rho / R) rho) / mean(rho) (N) in air of a rotation (rad/s), by Simpson's rule.
    fn drag_at(&self, omega: f64) -> f64 {
        let speed = (omega - self.rotation) * self.tank_radius;
        let at = |part: usize| {
            let share = part as f64 / PARTS as f64;
            let drag = self.drag.coefficient(self.radius, speed * share) * speed * share;
            3.0 * share * share * drag
        };
        let inner: f64 = (1..PARTS)
            .map(|part| at(part) * (2.0 + 2.0 * (part % 2) as f64))
            .sum();
        (at(0) + inner + at(PARTS)) / (3.0 * PARTS as f64)
    }

    /// mu m (g max(1 - L, 0) + Omega_c^2 R) (N) in air of a rotation (rad/s); less in a fluid.
    fn friction_at(&self, omega: f64) -> f64 {
        let lifted = self
            .updraught
            .map_or(0.0, |updraught| self.lifted(updraught, omega));
        let weight = self.gravity * (1.0 - lifted).max(0.0);
        let outward = self.inertial_factor * self.rotation * self.rotation;
        let pressed = self.pressed_mass_ratio * omega * omega;
        let on_wall = (outward - pressed).max(0.0) * self.tank_radius;
        self.friction * self.mass * (weight + on_wall)
    }

    /// The part L of the weight that the updraught carries.
    fn lifted(&self, updraught: &Updraught, omega: f64) -> f64 {
        let swirl = Swirl { omega };
        let lift = unshielded_lift(updraught, Some(&swirl), self.drag, self.radius, self.floor);
        let shielded = match updraught.alpha {
            1.0 => 1.0,
            alpha => (1.0 - libm::pow(alpha, self.column)) / ((1.0 - alpha) * self.column),
        };
        lift * shielded / (self.mass * self.gravity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Buoyancy;
    use std::path::Path;

    /// Steel in air, of a radius (m).
    fn steel(radius: f64) -> Scene {
        let scene = Scene::load(Path::new("sweeps/scenes/steel.toml")).unwrap();
        scene.with_values([("spheres.radius", radius)]).unwrap()
    }

    fn without(radius: f64) -> f64 {
        critical_rotation(256.0, radius, 0.06, 9.8)
    }

    #[test]
    fn of_quadratic_drag_alone_it_has_a_closed_form() {
        for radius in [0.002, 0.004, 0.006] {
            let mut scene = steel(radius);
            scene.dem.effects.updraught = None;
            let drag = scene.dem.effects.drag.as_mut().unwrap();
            drag.linear = 0.0;
            let c2 = drag.quadratic * 4.0 * radius * radius;
            let mass = 7850.0 * 4.0 / 3.0 * PI * radius * radius * radius;
            let load = 9.8 + without(radius) * without(radius) * 0.06;
            let expected = without(radius) + (5.0 * 0.1 * mass * load / (3.0 * c2)).sqrt() / 0.06;
            let omega = critical_rotation_with_friction(&scene).unwrap();
            assert!((omega / expected - 1.0).abs() < 1e-6, "{omega} {expected}");
        }
    }

    /// The pressure of the rotating fluid reduces the load on the wall: to zero in fast fluid, and
    /// partly in slow fluid, where the balance is a quadratic equation.
    #[test]
    fn in_a_fluid_that_turns_the_wall_bears_less() {
        let radius = 0.004;
        let mass = 7850.0 * 4.0 / 3.0 * PI * radius * radius * radius;
        let (displaced, own) = (998.0 / 7850.0, without(radius));
        for (friction, wall_bears) in [(0.1, false), (1e-4, true)] {
            let mut scene = steel(radius);
            scene = scene
                .with_values([("friction.coefficient", friction)])
                .unwrap();
            scene.dem.effects.updraught = None;
            scene.dem.effects.buoyancy = Some(Buoyancy { density: 998.0 });
            let drag = scene.dem.effects.drag.as_mut().unwrap();
            drag.linear = 0.0;
            let c2 = drag.quadratic * 4.0 * radius * radius;
            // a (Omega - Omega_c)^2 = b + c (Omega_c^2 - d Omega^2)
            let a = 0.6 * c2 * 0.06 * 0.06;
            let b = friction * mass * 9.8 * (1.0 - displaced);
            let c = if wall_bears {
                friction * mass * 0.06
            } else {
                0.0
            };
            let (square, linear) = (a + c * displaced, a * own);
            let constant = a * own * own - b - c * own * own;
            let root = (linear * linear - square * constant).sqrt();
            let expected = (linear + root) / square;
            let bears = own * own > displaced * expected * expected;
            assert_eq!(bears, wall_bears, "{expected}");
            let omega = critical_rotation_with_friction(&scene).unwrap();
            assert!((omega / expected - 1.0).abs() < 1e-6, "{omega} {expected}");
        }
    }

    #[test]
    fn the_updraught_takes_the_weight_of_small_steel_off_the_floor() {
        // L = 5.2, 1.016 and .31 of the weight at 2, 4 and 6 mm.
        for (radius, carried) in [(0.002, 1.0), (0.004, 1.0), (0.006, 0.30765)] {
            let mut scene = steel(radius);
            let with = critical_rotation_with_friction(&scene).unwrap();
            scene.dem.effects.updraught = None;
            scene.dem.effects.gravity.as_mut().unwrap().acceleration = 9.8;
            let full = critical_rotation_with_friction(&scene).unwrap();
            // Both parts of the load, from the growth of the drag with the slip.
            let drag = |omega: f64| {
                let bed = TurningBed::of(&scene, without(radius)).unwrap();
                bed.drag_at(omega)
            };
            let centrifugal = without(radius) * without(radius) * 0.06;
            let share = (9.8 * (1.0 - carried) + centrifugal) / (9.8 + centrifugal);
            let found = drag(with) / drag(full);
            assert!((found - share).abs() < 1e-3, "{radius}: {found} {share}");
        }
    }

    #[test]
    fn without_friction_it_is_the_critical_rotation() {
        let mut scene = steel(0.004);
        scene = scene.with_values([("friction.coefficient", 0.0)]).unwrap();
        let omega = critical_rotation_with_friction(&scene).unwrap();
        assert!((omega - without(0.004)).abs() < 1e-9);
        // Symptom: 22 % less in water. Buoyancy reduced the weight but not the centrifugal force.
        scene.dem.effects.buoyancy = Some(Buoyancy { density: 998.0 });
        let in_water = critical_rotation_with_friction(&scene).unwrap();
        assert!((in_water - without(0.004)).abs() < 1e-9);
        scene.dem.friction = None;
        assert_eq!(critical_rotation_with_friction(&scene), None);
        let thesis = Scene::load(Path::new("sweeps/scenes/theoretical.toml")).unwrap();
        assert_eq!(critical_rotation_with_friction(&thesis), None);
    }
}
