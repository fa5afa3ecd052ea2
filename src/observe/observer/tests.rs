//! The observer compared with the definitions of its observables.

use super::*;
use crate::observe::Flow;
use proptest::prelude::*;

/// A tank of R = 0.06 m with swirling air; frames of 1 ms.
fn scene() -> Scene {
    toml::from_str(
        r#"
        spheres = { count = 1, radius = 0.004, density = 1000.0 }
        tank = { radius = 0.06, floor = -0.2 }
        start = { kind = "list", spheres = [] }
        gravity = { acceleration = 9.8 }
        swirl = { omega = -3.0 }
        contact = { law = "linear", stiffness = 100.0, damping = 0.0 }
        time = { dt = 1e-4, duration = 5.0, frame_interval = 1e-3 }
        "#,
    )
    .unwrap()
}

/// Owned data for a [`FrameView`].
#[derive(Clone, Debug, Default)]
struct FrameSpheres {
    position: [Vec<f64>; 3],
    velocity: [Vec<f64>; 3],
    spin: [Vec<f64>; 3],
    radius: Vec<f64>,
    mass: Vec<f64>,
    inertia: Vec<f64>,
}

impl FrameSpheres {
    /// Spheres of 4 mm and 1 g at rest.
    fn at(centres: &[[f64; 3]]) -> Self {
        let count = centres.len();
        let still = || [(); 3].map(|()| vec![0.0; count]);
        Self {
            position: [0, 1, 2].map(|axis| centres.iter().map(|it| it[axis]).collect()),
            velocity: still(),
            spin: still(),
            radius: vec![0.004; count],
            mass: vec![0.001; count],
            inertia: vec![2e-9; count],
        }
    }

    fn view(&self) -> FrameView<'_> {
        FrameView {
            position: self.position.each_ref().map(Vec::as_slice),
            velocity: self.velocity.each_ref().map(Vec::as_slice),
            spin: Some(self.spin.each_ref().map(Vec::as_slice)),
            radius: &self.radius,
            mass: &self.mass,
            inertia: &self.inertia,
            elastic_energy: 0.125,
            ledger: None,
            number: None,
            flow: None,
        }
    }

    fn distance(&self, i: usize) -> f64 {
        let [x, y, _] = &self.position;
        (x[i] * x[i] + y[i] * y[i]).sqrt()
    }
}

fn observe(scene: &Scene, frames: &[FrameSpheres]) -> Observations {
    let mut observer = Observer::new(scene, &frames[0].radius);
    for (index, frame) in frames.iter().enumerate() {
        observer.observe(index as f64 * scene.time.frame_interval, &frame.view());
    }
    observer.finish()
}

#[test]
fn the_mass_that_is_in_is_that_of_the_spheres_of_the_frame() {
    let mut spheres = FrameSpheres::at(&[[0.0; 3], [0.1, 0.0, 0.0], [0.2, 0.0, 0.0]]);
    spheres.mass = vec![0.001, 0.002, 0.004];
    let flow = Flow {
        spheres: 5,
        released: 4,
        discharged: 1,
        spilled: 0,
        contacts: 6,
    };
    let mut scene = scene();
    scene.dem.outlet = Some(crate::scene::Outlet { height: -1.0 });
    let mut observer = Observer::new(&scene, &[0.004; 5]);
    let view = FrameView {
        number: Some(&[0, 2, 3]),
        flow: Some(flow),
        ..spheres.view()
    };
    observer.observe(0.0, &view);
    let observations = observer.finish();
    assert!(close(observations.mass_inside[0], 0.007));
    assert_eq!(observations.coordination[0], 2.0);
    // Without a flow no sphere comes or goes.
    assert!(observe(&scene, &[spheres]).mass_inside.is_empty());
}

fn close(measured: f32, expected: f64) -> bool {
    (f64::from(measured) - expected).abs() <= 1e-6 * expected.abs() + 1e-30
}

#[test]
fn rigid_rotation_has_its_rate_and_no_fluctuation() {
    let omega = 7.0;
    let mut spheres = FrameSpheres::at(&[
        [0.01, 0.02, 0.0],
        [-0.03, 0.01, 0.1],
        [0.005, -0.04, -0.1],
        [0.0, 0.0, 0.2],
    ]);
    spheres.mass = vec![1e-3, 2e-3, 5e-3, 1e-3];
    for i in 0..4 {
        spheres.velocity[0][i] = -omega * spheres.position[1][i];
        spheres.velocity[1][i] = omega * spheres.position[0][i];
        spheres.velocity[2][i] = 0.3;
    }
    let observations = observe(&scene(), &[spheres]);
    assert!(close(observations.rotation[0], omega));
    assert!(observations.fluctuation[0] < 1e-15);
    assert_eq!(observations.hole_radius[0], 0.0);
}

#[test]
fn spheres_on_the_axis_do_not_rotate_about_it() {
    let mut spheres = FrameSpheres::at(&[[0.0, 0.0, 0.1]]);
    spheres.velocity[0][0] = 2.0;
    let observations = observe(&scene(), &[spheres]);
    assert_eq!(observations.rotation[0], 0.0);
    assert_eq!(observations.fluctuation[0], 2.0);
}

#[test]
fn bins_hold_their_outer_edge_and_the_last_what_is_beyond() {
    // Eight bins of 0.0075 m, by R / 2r = 7.5.
    let spheres = FrameSpheres::at(&[
        [0.0, 0.0, 1.0],
        [0.0, 0.0075, 2.0],
        [0.0075001, 0.0, 3.0],
        [0.03, 0.0, -4.0],
        [0.0, 0.03, -5.0],
        [-0.07, 0.0, 6.0],
    ]);
    let empty = f32::NAN;
    let expected = [2.0, 3.0, empty, -4.0, empty, empty, empty, 6.0];
    let profile = observe(&scene(), &[spheres]).profile;
    assert_eq!(profile.dim(), (1, 8));
    for (top, expected) in profile.iter().zip(expected) {
        assert!(*top == expected || top.is_nan() && expected.is_nan());
    }
}

#[test]
fn the_number_of_bins_can_be_set_and_is_never_none_in_a_tank() {
    let mut scene = scene();
    let spheres = FrameSpheres::at(&[[0.0; 3]]);
    scene.output.profile_bins = Some(3);
    assert_eq!(
        observe(&scene, std::slice::from_ref(&spheres))
            .profile
            .ncols(),
        3
    );
    scene.output.profile_bins = None;
    let mut wide = spheres;
    wide.radius = vec![0.2];
    assert_eq!(observe(&scene, &[wide]).profile.ncols(), 1);
}

#[test]
fn rising_spheres_are_judged_where_they_were() {
    // Rises above the mean of 12, 0 and -12 radii per second.
    let before = FrameSpheres::at(&[[0.0449, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]);
    let mut after = FrameSpheres::at(&[[0.0599, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]);
    after.position[2] = [12.0, 0.0, -12.0]
        .map(|speed| 0.01 + speed * 0.004 * 1e-3)
        .to_vec();
    let rising = observe(&scene(), &[before, after]).rising;
    assert_eq!(rising.dim(), (2, 3, 3));
    assert!(
        rising
            .index_axis(ndarray::Axis(0), 0)
            .iter()
            .all(|&it| it == 0)
    );
    let counts: Vec<u16> = rising
        .index_axis(ndarray::Axis(0), 1)
        .iter()
        .copied()
        .collect();
    // Beyond R/2 at the start of the rise, within 3R/4; faster than 5 and 10 r/s, not 20.
    assert_eq!(counts, [0, 0, 0, 1, 1, 0, 1, 1, 0]);
}

#[test]
fn without_a_tank_only_what_needs_its_radius_is_empty() {
    let mut scene = scene();
    scene.tank = None;
    scene.dem.effects.gravity = None;
    scene.dem.effects.swirl = None;
    let observations = observe(&scene, &[FrameSpheres::at(&[[0.03, 0.04, 0.5]])]);
    assert_eq!(observations.profile.dim(), (1, 0));
    assert_eq!(observations.rising.dim(), (1, 0, 3));
    assert_eq!(observations.gravitational[0], 0.0);
    // No observable refers to an axis or to air, which the scene does not have.
    for absent in [
        &observations.hole_radius,
        &observations.rotation,
        &observations.fluctuation,
        &observations.air_speed_mean,
    ] {
        assert!(absent.is_empty());
    }
}

/// All observables of `now`, by their definitions.
fn check_by_definition(scene: &Scene, then: &FrameSpheres, now: &FrameSpheres) {
    let observations = observe(scene, &[then.clone(), now.clone()]);
    let n = now.radius.len();
    let count = n as f64;
    let [x, y, z] = &now.position;
    let [vx, vy, vz] = &now.velocity;
    let [wx, wy, wz] = &now.spin;
    let sum = |term: &dyn Fn(usize) -> f64| (0..n).map(term).sum::<f64>();
    let square = |a: f64, b: f64, c: f64| a * a + b * b + c * c;

    let momentum = sum(&|i| now.mass[i] * (x[i] * vy[i] - y[i] * vx[i]));
    let inertia = sum(&|i| now.mass[i] * (x[i] * x[i] + y[i] * y[i]));
    let rotation = momentum / inertia;
    let rise = sum(&|i| vz[i]) / count;
    let fluctuation = sum(&|i| {
        square(
            vx[i] + rotation * y[i],
            vy[i] - rotation * x[i],
            vz[i] - rise,
        )
    });
    let expected = [
        (
            "kinetic",
            sum(&|i| 0.5 * now.mass[i] * square(vx[i], vy[i], vz[i])),
        ),
        (
            "rotational",
            sum(&|i| 0.5 * now.inertia[i] * square(wx[i], wy[i], wz[i])),
        ),
        ("gravitational", sum(&|i| now.mass[i] * 9.8 * z[i])),
        ("elastic", 0.125),
        ("height_mean", sum(&|i| z[i]) / count),
        ("height_max", z.iter().copied().fold(f64::MIN, f64::max)),
        (
            "hole_radius",
            (0..n).map(|i| now.distance(i)).fold(f64::MAX, f64::min),
        ),
        (
            "speed_mean",
            sum(&|i| square(vx[i], vy[i], vz[i]).sqrt()) / count,
        ),
        ("air_speed_mean", sum(&|i| 3.0 * now.distance(i)) / count),
        ("rotation", rotation),
        ("fluctuation", (fluctuation / count).sqrt()),
    ];
    let scalars = observations.scalars();
    assert_eq!(scalars.len(), expected.len());
    for (series, (name, value)) in scalars.iter().zip(expected) {
        assert_eq!(series.name, name);
        let measured = f64::from(series.values[1]);
        let tolerance = 1e-6 * value.abs() + 1e-9;
        assert!(
            (measured - value).abs() <= tolerance,
            "{name}: {measured}, {value}"
        );
    }

    let bins = observations.profile.ncols();
    let width = 0.06 / bins as f64;
    for j in 0..bins {
        let inside = |rho: f64| {
            (rho > width * j as f64 || j == 0) && (rho <= width * (j + 1) as f64 || j == bins - 1)
        };
        let top = (0..n)
            .filter(|&i| inside(now.distance(i)))
            .map(|i| z[i] as f32)
            .reduce(f32::max);
        let measured = observations.profile[[1, j]];
        assert!(top.map_or(measured.is_nan(), |top| measured == top));
    }

    let mean = sum(&|i| z[i] - then.position[2][i]) / count;
    for (row, share) in [0.5, 0.75, 1.0].into_iter().enumerate() {
        for (column, speed) in [5.0, 10.0, 20.0].into_iter().enumerate() {
            let rising = (0..n).filter(|&i| {
                let rise = z[i] - then.position[2][i] - mean;
                rise >= speed * now.radius[i] * 1e-3 && then.distance(i) <= share * 0.06
            });
            assert_eq!(
                usize::from(observations.rising[[1, row, column]]),
                rising.count()
            );
        }
    }
}

prop_compose! {
    /// Spheres of several sizes in and about the tank, moving at up to 1 m/s.
    fn spheres(count: usize)(
        positions in prop::collection::vec((-0.05..0.05, -0.05..0.05, -0.2..0.2), count),
        velocities in prop::collection::vec(prop::array::uniform3(-1.0..1.0), count),
        spins in prop::collection::vec(prop::array::uniform3(-9.0..9.0), count),
        radius in prop::collection::vec(0.002..0.006, count),
        mass in prop::collection::vec(0.001..0.002, count),
        inertia in prop::collection::vec(1e-9..2e-9, count),
    ) -> FrameSpheres {
        let columns = |rows: &[[f64; 3]]| {
            [0, 1, 2].map(|axis| rows.iter().map(|row| row[axis]).collect::<Vec<f64>>())
        };
        let positions: Vec<[f64; 3]> = positions.into_iter().map(<[f64; 3]>::from).collect();
        FrameSpheres {
            position: columns(&positions),
            velocity: columns(&velocities),
            spin: columns(&spins),
            radius,
            mass,
            inertia,
        }
    }
}

proptest! {
    #[test]
    fn every_observable_follows_its_definition(
        (then, moves) in (1_usize..40)
            .prop_flat_map(|n| (spheres(n), prop::collection::vec(-2e-4..2e-4, n)))
    ) {
        let mut now = then.clone();
        for (z, rise) in now.position[2].iter_mut().zip(moves) {
            *z += rise;
        }
        now.position[0].reverse();
        check_by_definition(&scene(), &then, &now);
    }
}

/// What a scene is said to lack is what its observer leaves empty.
#[test]
fn absent_columns_are_those_that_are_not_observed() {
    let tank = scene();
    let mut open = scene();
    open.tank = None;
    open.dem.effects.swirl = None;
    let mut apart = scene();
    apart.dem.contact = None;
    let mut draining = scene();
    draining.dem.effects.swirl = None;
    draining.dem.outlet = Some(crate::scene::Outlet { height: -1.0 });
    for scene in [tank, open, apart, draining] {
        let spheres = FrameSpheres::at(&[[0.01, 0.0, 0.0]]);
        let flow = scene.has_flow().then_some(Flow {
            spheres: 1,
            released: 1,
            discharged: 0,
            spilled: 0,
            contacts: 0,
        });
        let view = FrameView {
            flow,
            ..spheres.view()
        };
        let mut observer = Observer::new(&scene, &[0.004]);
        observer.observe(0.0, &view);
        let observations = observer.finish();
        let there: Vec<&str> = observations.scalars().iter().map(|it| it.name).collect();
        for column in Observations::COLUMNS {
            // A further column elsewhere.
            if column.name == "coordination" {
                continue;
            }
            let absent = Observations::absent_in(&scene, column.name).is_some();
            assert_eq!(absent, !there.contains(&column.name), "{}", column.name);
        }
    }
}
