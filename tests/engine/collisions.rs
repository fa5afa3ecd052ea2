//! The thesis's collision tests (Rice, 2012, figures 6 to 10): each scene that is shipped does what
//! its figure shows, with every friction law that can, and its tracks can be drawn.

use crate::support::Workplace;
use phase::observe::Snapshot;
use phase::plot;
use phase::record::{Outcome, RunRecord};
use phase::scene::{self, Contact, Coulomb, DemScene, Friction, Hertz, Mindlin, Scene, Spin};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Radius of all spheres (m).
const RADIUS: f64 = 0.004;

/// The law of the thesis.
const SPIN: Friction = Friction::Spin(Spin { coefficient: 0.002 });

/// Laws in which forces and torques have a reaction, at a coefficient of friction.
fn lawful(coefficient: f64) -> [Friction; 2] {
    [
        Friction::Coulomb(Coulomb {
            coefficient,
            regularisation: 1e-2,
        }),
        Friction::Mindlin(Mindlin {
            coefficient,
            rescale: false,
        }),
    ]
}

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("sweeps/scenes/collisions")
        .join(name)
        .with_extension("toml")
}

fn load(name: &str) -> Scene {
    scene::Scene::load(&file(name)).unwrap_or_else(|error| panic!("error: {error}"))
}

fn with(scene: &Scene, friction: impl Into<Option<Friction>>) -> Scene {
    Scene {
        dem: DemScene {
            friction: friction.into(),
            ..scene.dem.clone()
        },
        ..scene.clone()
    }
}

/// Runs a scene to its end.
fn run(scene: &Scene) -> RunRecord {
    let record = phase::run::run(scene, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(record.outcome, Outcome::Completed);
    record
}

fn last(record: &RunRecord) -> &Snapshot {
    record.trajectory.last().unwrap()
}

fn velocity(snapshot: &Snapshot, sphere: usize) -> [f64; 3] {
    [0, 1, 2].map(|axis| snapshot.velocity[[sphere, axis]])
}

fn spin(snapshot: &Snapshot, sphere: usize) -> [f64; 3] {
    [0, 1, 2].map(|axis| snapshot.spin[[sphere, axis]])
}

#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs();
    assert!(error <= tolerance, "{found} instead of {expected}");
}

/// Angular momentum about the z axis, spins included.
fn angular_momentum(record: &RunRecord, snapshot: &Snapshot) -> f64 {
    let of_sphere = |i: usize| {
        let (x, v) = (snapshot.position.row(i), snapshot.velocity.row(i));
        let mass = record.mass[i];
        let spin = snapshot.spin.get([i, 2]).copied().unwrap_or_default();
        mass * (x[0] * v[1] - x[1] * v[0]) + 0.4 * mass * RADIUS * RADIUS * spin
    };
    (0..record.mass.len()).map(of_sphere).sum()
}

/// Translational and rotational energy.
fn energy(record: &RunRecord, snapshot: &Snapshot) -> f64 {
    let of_sphere = |i: usize| {
        let square = |row: ndarray::ArrayView1<'_, f64>| row.dot(&row);
        let spin = if snapshot.spin.is_empty() {
            0.0
        } else {
            square(snapshot.spin.row(i))
        };
        0.5 * record.mass[i] * (square(snapshot.velocity.row(i)) + 0.4 * RADIUS * RADIUS * spin)
    };
    (0..record.mass.len()).map(of_sphere).sum()
}

#[test]
fn figure_6_parallel_spins_deflect() {
    let scene = load("parallel-spins");
    assert_eq!(scene.dem.friction, Some(SPIN));
    let (coefficient, restitution, speed) = (0.3, 0.9, 2.0_f64.sqrt());
    let [coulomb, mindlin] = lawful(coefficient);
    for law in [SPIN, coulomb, mindlin] {
        let record = run(&with(&scene, law.clone()));
        let [one, two] = [0, 1].map(|sphere| velocity(last(&record), sphere));
        for axis in 0..3 {
            close(one[axis], -two[axis], 1e-12);
        }
        // Head on they would go back the way they came. The surface of the first one, which came
        // along (1, 1), moves along (-1, 1) at the contact, so it is pushed along (1, -1).
        let back = -(one[0] + one[1]) / speed;
        let aside = (one[0] - one[1]) / speed;
        assert!(back > 0.0 && aside > 0.1, "{law:?}: {one:?}");
        let left = spin(last(&record), 0)[2];
        assert!(0.0 < left && left < 1000.0, "{law:?}: spin {left}");

        let first = &record.trajectory[0];
        let gained = angular_momentum(&record, last(&record)) / angular_momentum(&record, first);
        if law == SPIN {
            assert!((gained - 1.0).abs() > 0.01, "{gained}");
            continue;
        }
        close(gained, 1.0, 1e-12);
        assert!(energy(&record, last(&record)) < energy(&record, first));
        // The surfaces slide until they part. The normal turns a little meanwhile.
        close(
            aside,
            coefficient * (1.0 + restitution) * speed,
            0.1 * speed,
        );
        close(back, restitution * speed, 0.1 * speed);
    }
}

#[test]
fn opposite_spins_bounce_straight() {
    let scene = load("counter-spins");
    assert_eq!(scene.dem.friction, Some(SPIN));
    let [coulomb, mindlin] = lawful(0.3);
    for law in [SPIN, coulomb, mindlin] {
        let record = run(&with(&scene, law));
        for (sphere, sign) in [(0, -1.0), (1, 1.0)] {
            let [x, y, z] = velocity(last(&record), sphere);
            assert_eq!([x, z], [0.0; 2]);
            // The restitution holds at 1 m/s, and these two meet at twice that.
            close(sign * y, 0.9, 0.02);
            assert_eq!(spin(last(&record), sphere), [0.0, 0.0, sign * 1000.0]);
        }
    }
}

#[test]
fn figure_7_a_spinning_sphere_and_the_one_it_falls_onto_roll_apart() {
    let scene = load("spin-onto-rest");
    for law in lawful(0.3) {
        let record = run(&with(&scene, law.clone()));
        for (sphere, sign) in [(0, -1.0), (1, 1.0)] {
            let snapshot = last(&record);
            close(snapshot.position[[sphere, 2]], -0.196, 1e-4);
            let speed = velocity(snapshot, sphere)[0];
            assert!(sign * speed > 0.05, "{law:?}: sphere {sphere} at {speed}");
            assert!(sign * snapshot.position[[sphere, 0]] > 2.0 * RADIUS);
            close(
                RADIUS * spin(snapshot, sphere)[1],
                speed,
                1e-2 * speed.abs(),
            );
        }
    }
    // From spins alone they are pushed apart as well, but neither rolls.
    let record = run(&with(&scene, SPIN));
    for (sphere, sign) in [(0, -1.0), (1, 1.0)] {
        let speed = velocity(last(&record), sphere)[0];
        assert!(sign * speed > 0.05, "sphere {sphere} at {speed}");
        let surface = RADIUS * spin(last(&record), sphere)[1];
        assert!(
            (surface - speed).abs() > 0.3 * speed.abs(),
            "{surface} {speed}"
        );
    }
}

#[test]
fn figure_7_without_spin_the_two_bounce_upward() {
    let mut scene = load("spin-onto-rest");
    let spheres = scene.start.list_mut().unwrap();
    spheres[1].spin = [0.0; 3];
    let record = run(&scene);
    for snapshot in &record.trajectory {
        for sphere in [0, 1] {
            assert_eq!(snapshot.position[[sphere, 0]], 0.0);
        }
    }
    let rises = |snapshot: &Snapshot| snapshot.velocity[[1, 2]] > 0.05;
    assert!(record.trajectory.iter().any(rises));
}

/// Distance of the sphere from the axis.
fn distance(snapshot: &Snapshot) -> f64 {
    libm::hypot(snapshot.position[[0, 0]], snapshot.position[[0, 1]])
}

/// Speed along the wall that the angular momentum of the start, -0.04 m * 1 m/s, makes there.
const ALONG_WALL: f64 = 0.04 / (0.06 - RADIUS);

/// Whether a run ends in a circle along the wall at this speed.
#[track_caller]
fn ends_along_the_wall(record: &RunRecord, speed: f64) {
    let end = &record.trajectory[record.trajectory.len() * 9 / 10..];
    for snapshot in end {
        close(distance(snapshot), 0.06 - RADIUS, 2e-4);
        let [x, y, _] = velocity(snapshot, 0);
        close(libm::hypot(x, y), speed, 5e-3 * speed);
    }
}

#[test]
fn figure_8_left_a_sphere_without_spin_keeps_its_speed_along_the_wall() {
    let scene = load("wall-without-spin");
    assert_eq!(scene.dem.friction, None);
    let record = run(&scene);
    let first = angular_momentum(&record, &record.trajectory[0]);
    for snapshot in &record.trajectory {
        close(angular_momentum(&record, snapshot) / first, 1.0, 1e-10);
    }
    ends_along_the_wall(&record, ALONG_WALL);
}

#[test]
fn figure_8_right_a_sphere_with_spin_ends_rolling_along_the_wall() {
    let scene = load("wall-with-spin");
    let Some(Friction::Mindlin(Mindlin { coefficient, .. })) = scene.dem.friction else {
        panic!("a law that knows sliding")
    };
    for law in lawful(coefficient) {
        let record = run(&with(&scene, law));
        // Friction gives 2/7 of the speed along the wall to the surface, whatever its coefficient.
        ends_along_the_wall(&record, ALONG_WALL * 5.0 / 7.0);
        let [x, y, _] = velocity(last(&record), 0);
        let turning = RADIUS * spin(last(&record), 0)[2];
        close(turning, libm::hypot(x, y), 5e-3);
        // Along the way translation becomes rotation, impact by impact.
        let spins = record
            .trajectory
            .iter()
            .map(|snapshot| snapshot.spin[[0, 2]]);
        let mut levels: Vec<i64> = spins.map(|spin| (0.2 * spin).round() as i64).collect();
        levels.dedup();
        assert!(levels.len() >= 3, "{levels:?}");
    }
}

#[test]
fn figure_8_right_is_impossible_with_the_law_from_spins() {
    let left = run(&load("wall-without-spin"));
    let right = run(&with(&load("wall-with-spin"), SPIN));
    for (left, right) in left.trajectory.iter().zip(&right.trajectory) {
        assert_eq!(left.position, right.position);
        assert!(right.spin.iter().all(|spin| *spin == 0.0));
    }
}

#[test]
fn figure_9_a_sphere_that_rolls_against_its_motion_comes_back() {
    let scene = load("rolling-back");
    let (speed, surface, coefficient) = (0.3, -400.0 * RADIUS, 0.3);
    for law in lawful(coefficient) {
        let record = run(&with(&scene, law));
        let places = record.trajectory.iter().map(|it| it.position[[0, 0]]);
        let farthest = places.fold(0.0, f64::max);
        close(farthest, speed * speed / (2.0 * coefficient * 9.8), 2e-4);
        assert!(last(&record).position[[0, 0]] < 0.0);
        let rolling = (5.0 * speed + 2.0 * surface) / 7.0;
        close(velocity(last(&record), 0)[0], rolling, 2e-3);
        close(RADIUS * spin(last(&record), 0)[1], rolling, 2e-3);
    }
    // From spins alone it turns around too, and then slides without any spin.
    let record = run(&with(&scene, SPIN));
    close(velocity(last(&record), 0)[0], speed + surface, 1e-2);
    close(spin(last(&record), 0)[1], 0.0, 1.0);
}

/// Which sphere moves fastest, in the order in which they do.
fn relay(record: &RunRecord) -> Vec<usize> {
    let fastest = |snapshot: &Snapshot| {
        let speed = |&sphere: &usize| snapshot.velocity[[sphere, 0]].abs();
        (0..record.mass.len())
            .max_by(|a, b| speed(a).total_cmp(&speed(b)))
            .unwrap()
    };
    let mut relay: Vec<usize> = record.trajectory.iter().map(fastest).collect();
    relay.dedup();
    relay
}

#[test]
fn figure_10_the_cradle_passes_its_momentum_on_and_on() {
    let record = run(&load("cradle"));
    let back_and_forth = [0, 1, 2, 3, 2, 1];
    let relay = relay(&record);
    assert!(relay.len() > 3 * back_and_forth.len());
    for (found, expected) in relay.iter().zip(back_and_forth.iter().cycle()) {
        assert_eq!(found, expected, "{relay:?}");
    }
    let first = energy(&record, &record.trajectory[0]);
    let elastic = &record.observations.elastic;
    for (snapshot, elastic) in record.trajectory.iter().zip(elastic) {
        assert!(snapshot.position.column(1).iter().all(|y| *y == 0.0));
        // Between impacts one sphere has all of the energy and all of the speed.
        if *elastic == 0.0 {
            close(energy(&record, snapshot) / first, 1.0, 2e-3);
            let speeds = snapshot.velocity.column(0).mapv(f64::abs);
            let fastest = speeds.fold(0.0, |most: f64, &speed| most.max(speed));
            close(fastest, 1.0, 2e-3);
            close(speeds.sum(), fastest, 2e-3);
        }
    }
    // No drift: whenever the first sphere is on its way, the third is where it was.
    let waiting = record.trajectory.iter();
    let waiting = waiting.filter(|snapshot| snapshot.velocity[[0, 0]].abs() > 0.9);
    for snapshot in waiting {
        close(snapshot.position[[2, 0]], 0.0, 5e-5);
    }
}

#[test]
fn figure_10_a_dissipating_cradle_is_not_perfect() {
    let mut scene = load("cradle");
    let Some(Contact::Hertz(Hertz {
        dissipation_time, ..
    })) = &mut scene.dem.contact
    else {
        panic!("contacts")
    };
    *dissipation_time = Some(1e-4);
    let record = run(&scene);
    let farthest = record
        .trajectory
        .iter()
        .find(|it| it.position[[3, 0]] > 0.04);
    let speed = farthest.unwrap().velocity[[3, 0]];
    assert!(speed < 0.9, "{speed}");
    assert!(energy(&record, last(&record)) < 0.8 * energy(&record, &record.trajectory[0]));
}

fn tracks(record: &RunRecord) -> String {
    let records = plot::RecordSet::of(std::slice::from_ref(record));
    let svg = plot::draw("tracks", records).unwrap();
    String::from_utf8(svg.to_svg_bytes()).unwrap()
}

#[test]
fn tracks_show_the_plane_of_the_motion() {
    let planes = [
        ("parallel-spins", "xy"),
        ("spin-onto-rest", "xz"),
        ("cradle", "tx"),
    ];
    for (name, plane) in planes {
        let picture = tracks(&run(&load(name)));
        for axis in ["t", "x", "y", "z"] {
            let shown = picture.contains(&format!(r#"<tspan font-style="oblique">{axis}</tspan>"#));
            assert_eq!(shown, plane.contains(axis), "{name}: {axis}");
        }
    }
    let mut scene = load("parallel-spins");
    let spheres = scene.start.list_mut().unwrap();
    for sphere in spheres {
        sphere.position.rotate_right(1);
        sphere.velocity.rotate_right(1);
        sphere.spin.rotate_right(1);
    }
    let turned = tracks(&run(&scene));
    assert!(turned.contains(r#"oblique">y<"#) && turned.contains(r#"oblique">z<"#));
    // The same picture but for the names of the axes.
    let circles = |picture: &str| -> Vec<String> {
        let lines = picture.lines().filter(|line| line.starts_with("<circle"));
        lines.map(str::to_owned).collect()
    };
    assert_eq!(
        circles(&turned),
        circles(&tracks(&run(&load("parallel-spins"))))
    );
    assert!(circles(&turned).len() > 10);
}

#[test]
fn phase_plot_draws_the_tracks_of_a_record() {
    let place = Workplace::new();
    let scene = file("counter-spins");
    let answer = place.phase(&["run", scene.to_str().unwrap(), "--out", "one.h5"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    let answer = place.phase(&["plot", "one.h5", "--figure", "tracks"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    assert_eq!(answer.stdout, "one-tracks.svg\none-tracks.png\n");
    assert!(place.read("one-tracks.svg").starts_with("<svg"));
    assert!(place.path("one-tracks.png").exists());

    let text = std::fs::read_to_string(&scene).unwrap();
    place.write("still.toml", &text.replace("trajectory = true", ""));
    assert_eq!(
        place.phase(&["run", "still.toml", "--out", "two.h5"]).code,
        Some(0)
    );
    let answer = place.phase(&["plot", "two.h5"]);
    assert_eq!(answer.code, Some(1), "{answer:?}");
    assert!(answer.stderr.contains("trajectory = true"), "{answer:?}");
    let answer = place.phase(&["plot", "one.h5", "--figure", "phase"]);
    assert_eq!(answer.code, Some(2), "{answer:?}");
    let answer = place.phase(&["plot", ".", "--figure", "tracks"]);
    assert_eq!(answer.code, Some(2), "{answer:?}");
    assert!(answer.stderr.contains("record of one run"), "{answer:?}");
}

/// Symptom: discs of Hertz's contact parted with another restitution than the scene asked for, and
/// the limit of the time step was another's. Cause: both took the mass of spheres.
#[test]
fn discs_part_with_the_restitution_of_the_scene() {
    let text = "
        spheres = { count = 2, radius = 0.004, density = 10.0, shape = 'disc' }
        contact = { law = 'hertz', young_modulus = 1e5, poisson_ratio = 0.3, restitution = 0.5 }
        start = { kind = 'list', spheres = [
            { position = [-0.005, 0.0, 0.0], velocity = [0.5, 0.0, 0.0] },
            { position = [0.005, 0.0, 0.0], velocity = [-0.5, 0.0, 0.0] },
        ] }
        time = { dt = 1e-6, duration = 0.05, frame_interval = 0.01 }
        output = { trajectory = true }";
    let scene = Scene::from_toml(text, Path::new("discs.toml")).unwrap();
    let record = run(&scene);
    let speeds = [0, 1].map(|disc| velocity(last(&record), disc)[0]);
    close(speeds[0], -0.25, 1e-4);
    close(speeds[1], 0.25, 1e-4);
}

/// Symptom: spheres parted with a restitution of 0.69 in place of 0.5, without a warning. Cause: the
/// damping took the mass of `spheres.radius`, which the radii of the list replace.
#[test]
fn listed_spheres_part_with_the_restitution_of_the_scene() {
    for radius in [0.004, 0.008] {
        let text = format!(
            "spheres = {{ count = 2, radius = {radius}, density = 1e3 }}
            contact = {{ law = 'hertz', young_modulus = 1e6, poisson_ratio = 0.3, restitution = 0.5 }}
            start = {{ kind = 'list', spheres = [
                {{ position = [-0.009, 0.0, 0.0], velocity = [0.5, 0.0, 0.0], radius = 0.008 }},
                {{ position = [0.009, 0.0, 0.0], velocity = [-0.5, 0.0, 0.0], radius = 0.008 }},
            ] }}
            time = {{ dt = 1e-6, duration = 0.05, frame_interval = 0.01 }}
            output = {{ trajectory = true }}"
        );
        let scene = Scene::from_toml(&text, Path::new("spheres.toml")).unwrap();
        close(velocity(last(&run(&scene)), 1)[0], 0.25, 1e-4);
    }
}
