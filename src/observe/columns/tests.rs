//! Properties of the columns; `verify/columns.toml` has their numbers.

use super::*;
use proptest::prelude::*;

/// A tank of 2 m x 1 m, with all columns that follow from spheres.
fn scene() -> Scene {
    toml::from_str(
        r#"
        spheres = { count = 1, radius = 0.05, density = 1000.0 }
        tank = { width = 2.0, depth = 1.0, floor = 0.0 }
        start = { kind = "list", spheres = [] }
        contact = { law = "linear", stiffness = 100.0, damping = 0.0 }
        time = { dt = 1e-4, duration = 5.0, frame_interval = 1e-3 }
        output.columns = ["height_deviation", "granular_temperature", "rotational_temperature",
            "surface_angle", "packing_fraction", "shear_rate"]
        "#,
    )
    .unwrap()
}

#[derive(Clone, Debug)]
struct Spheres {
    position: [Vec<f64>; 3],
    velocity: [Vec<f64>; 3],
    spin: [Vec<f64>; 3],
}

impl Spheres {
    /// Values of all columns, by name.
    fn values(&self) -> Vec<(String, f64)> {
        let count = self.position[0].len();
        let view = FrameView {
            position: self.position.each_ref().map(Vec::as_slice),
            velocity: self.velocity.each_ref().map(Vec::as_slice),
            spin: Some(self.spin.each_ref().map(Vec::as_slice)),
            radius: &vec![0.05; count],
            mass: &vec![0.5; count],
            inertia: &vec![5e-4; count],
            elastic_energy: 0.0,
            ledger: None,
            number: None,
            flow: None,
        };
        let columns = SphereColumns::new(&scene(), 0.05);
        let names: Vec<String> = columns.declared().map(|column| column.name).collect();
        names.into_iter().zip(columns.values(&view)).collect()
    }

    fn moved(mut self, drift: [f64; 3]) -> Self {
        for (speeds, drift) in self.velocity.iter_mut().zip(drift) {
            for speed in speeds {
                *speed += drift;
            }
        }
        self
    }
}

/// The rows of vectors as columns.
fn columns(rows: &[[f64; 3]]) -> [Vec<f64>; 3] {
    [0, 1, 2].map(|axis| rows.iter().map(|row| row[axis]).collect())
}

prop_compose! {
    fn spheres()(
        rows in prop::collection::vec(prop::array::uniform9(0.05..0.95), 2..60),
    ) -> Spheres {
        let part = |from: usize| -> Vec<[f64; 3]> {
            rows.iter().map(|row| [row[from], row[from + 1], row[from + 2]]).collect()
        };
        let (position, velocity, spin) = (part(0), part(3), part(6));
        Spheres {
            position: columns(&position),
            velocity: columns(&velocity),
            spin: columns(&spin),
        }
    }
}

proptest! {
    #[test]
    fn columns_are_in_their_ranges_and_do_not_see_a_common_drift(
        spheres in spheres(),
        drift in prop::array::uniform3(-3.0..3.0),
    ) {
        let here = spheres.values();
        let moved = spheres.moved(drift).values();
        prop_assert_eq!(here.len(), 6);
        for ((name, value), (_, other)) in here.into_iter().zip(moved) {
            if name == "surface_angle" && value.is_nan() {
                // All centres are over one square, which has no slope.
                prop_assert!(other.is_nan());
                continue;
            }
            prop_assert!(value >= 0.0, "{name}: {value}");
            prop_assert!((value - other).abs() <= 1e-9 * (1.0 + value), "{name}: {value}, {other}");
            let most = match name.as_str() {
                "surface_angle" => std::f64::consts::FRAC_PI_2,
                "packing_fraction" => 1.0,
                _ => f64::INFINITY,
            };
            prop_assert!(value <= most, "{name}: {value}");
        }
    }

    /// One sphere over each square, at the same place in it, is found at any slope.
    #[test]
    fn the_angle_of_a_plane_is_found(slope in prop::array::uniform2(-2.0..2.0)) {
        let places = (0..20).map(|k| [0.2 * f64::from(k / 4), 0.2 * f64::from(k % 4)]);
        let rows: Vec<[f64; 3]> = places
            .map(|[x, y]| [x + 0.05, y + 0.05, 9.0 + slope[0] * x + slope[1] * y])
            .collect();
        let still = vec![[0.0; 3]; rows.len()];
        let spheres = Spheres {
            position: columns(&rows),
            velocity: columns(&still),
            spin: columns(&still),
        };
        let angle = spheres.values().into_iter().find(|it| it.0 == "surface_angle").unwrap().1;
        let expected = libm::atan(libm::hypot(slope[0], slope[1]));
        prop_assert!((angle - expected).abs() < 1e-9, "{angle}, {expected}");
    }
}

/// Spheres in a plane, as in a silo of discs, have a slope along it.
#[test]
fn the_angle_of_a_line_is_found() {
    let rows: Vec<[f64; 3]> = (0..8)
        .map(|i| 0.2 * f64::from(i) + 0.05)
        .map(|x| [x, 0.0, 0.5 * x])
        .collect();
    let still = vec![[0.0; 3]; rows.len()];
    let spheres = Spheres {
        position: columns(&rows),
        velocity: columns(&still),
        spin: columns(&still),
    };
    let values = spheres.values();
    let angle = values.iter().find(|it| it.0 == "surface_angle").unwrap().1;
    assert!((angle - libm::atan(0.5)).abs() < 1e-12, "{angle}");
}

/// Without spheres nothing is defined, and nothing fails.
#[test]
fn without_spheres_columns_are_no_numbers() {
    let nothing = || columns(&[]);
    let spheres = Spheres {
        position: nothing(),
        velocity: nothing(),
        spin: nothing(),
    };
    assert!(spheres.values().iter().all(|(_, value)| value.is_nan()));
}
