//! Where spheres can be: between the walls, above the floor, and in the orifice.

use super::parameters::{Parameters, SpotOpening};
use crate::particles::vector::Vector;

/// The box with its opening, for spheres of one diameter.
#[derive(Clone, Debug)]
pub(crate) struct Silo {
    /// Half of the room of centres along x and y (m).
    room: [f64; 2],
    /// Radius of the spheres (m).
    radius: f64,
    orifice: SpotOpening,
}

impl Silo {
    pub(crate) fn new(parameters: &Parameters) -> Self {
        let radius = 0.5 * parameters.diameter;
        let halves = [parameters.half_width, parameters.half_depth];
        Self {
            room: halves.map(|half| (half - radius).max(0.0)),
            radius,
            orifice: parameters.orifice,
        }
    }

    /// Half of the room of centres along x and y (m): zero between walls a diameter apart.
    pub(crate) fn room(&self) -> [f64; 2] {
        self.room
    }

    /// The nearest place to a centre with the sphere between the walls. Not for NaN.
    #[inline(always)]
    pub(crate) fn between_walls(&self, centre: Vector) -> Vector {
        let within = |value: f64, most: f64| {
            let value = if value > most { most } else { value };
            if value < -most { -most } else { value }
        };
        let [x, y] = self.room;
        Vector::new(within(centre.x, x), within(centre.y, y), centre.z)
    }

    /// Whether a sphere within this distance of a height may touch the floor (m).
    pub(crate) fn floor_is_within(&self, distance: f64, height: f64) -> bool {
        height - distance < 2.0 * self.radius
    }

    /// The nearest place to a centre where the sphere overlaps neither the floor nor the orifice's
    /// edge. `None` if the sphere has left: its centre is below the floor inside the orifice.
    pub(crate) fn above_floor(&self, centre: Vector) -> Option<Vector> {
        if centre.z >= self.radius {
            return Some(centre);
        }
        let (opening, outward) = match self.orifice {
            SpotOpening::Circle { radius } => {
                let distance = (centre.x * centre.x + centre.y * centre.y).sqrt();
                (radius, distance)
            }
            SpotOpening::Slit { half_width } => (half_width, centre.x.abs()),
        };
        let inward = opening - outward;
        if inward <= 0.0 {
            return Some(Vector::new(centre.x, centre.y, self.radius));
        }
        if centre.z < 0.0 {
            return None;
        }
        let from_edge = (inward * inward + centre.z * centre.z).sqrt();
        if from_edge >= self.radius || outward == 0.0 {
            return Some(centre);
        }
        let stretch = self.radius / from_edge;
        let scale = (opening - inward * stretch) / outward;
        let z = centre.z * stretch;
        Some(match self.orifice {
            SpotOpening::Circle { .. } => Vector::new(centre.x * scale, centre.y * scale, z),
            SpotOpening::Slit { .. } => Vector::new(centre.x * scale, centre.y, z),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_stay_in_the_box_and_leave_through_the_orifice() {
        let silo = Silo::new(&Parameters::figure_2(1.0));
        let at = Vector::new;
        assert_eq!(silo.between_walls(at(26.0, -4.0, 9.0)), at(24.5, -3.5, 9.0));
        assert_eq!(silo.above_floor(at(5.0, 0.0, 0.3)), Some(at(5.0, 0.0, 0.5)));
        assert_eq!(silo.above_floor(at(3.0, 0.0, 0.1)), Some(at(3.0, 0.0, 0.1)));
        assert_eq!(silo.above_floor(at(3.0, 0.0, -0.1)), None);
        assert_eq!(
            silo.above_floor(at(5.0, 0.0, -0.1)),
            Some(at(5.0, 0.0, 0.5))
        );
    }

    #[test]
    fn the_edge_pushes_a_sphere_off_to_its_radius() {
        let circle = Silo::new(&Parameters::figure_2(1.0));
        let slit = Silo::new(&Parameters {
            orifice: SpotOpening::Slit { half_width: 4.0 },
            ..Parameters::figure_2(1.0)
        });
        let kept = circle
            .above_floor(Vector::new(2.28, 3.04, 0.16))
            .expect("inside");
        let outward = libm::hypot(kept.x, kept.y);
        assert!((libm::hypot(4.0 - outward, kept.z) - 0.5).abs() < 1e-12);
        assert!((kept.y / kept.x - 3.04 / 2.28).abs() < 1e-12);
        let kept = slit
            .above_floor(Vector::new(-3.8, 1.0, 0.16))
            .expect("inside");
        assert!((libm::hypot(4.0 + kept.x, kept.z) - 0.5).abs() < 1e-12);
        assert_eq!(kept.y, 1.0);
    }
}
