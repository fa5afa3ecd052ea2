//! Further columns of contacts: their ranges and symmetries, and that asking for them changes
//! nothing else. `verify/columns.toml` has their numbers.

use crate::large::large;
use phase::run::{self, Run};
use phase::scene::{Coulomb, Friction, FurtherColumn, Integrator, Layer, Scene};
use phase::store::{content_digest, motion_digest, read_record, write_record};
use proptest::prelude::*;
use std::ops::ControlFlow;

/// Spheres that fall into a tank, with a law of friction.
fn scene(friction: &str, seed: u64) -> Scene {
    let text = format!(
        r#"
        seed = {seed}
        spheres.count = 60
        spheres.radius = [{{ radius = 0.004, share = 1 }}, {{ radius = 0.005, share = 1 }}]
        spheres.density = 1000.0
        tank = {{ radius = 0.03, floor = 0.0 }}
        start = {{ kind = "random", z_min = 0.0, z_max = 0.08 }}
        gravity = {{ acceleration = 9.8 }}
        contact = {{ law = "hertz", young_modulus = 1e6, poisson_ratio = 0.3, restitution = 0.6 }}
        {friction}
        time = {{ dt = 2e-5, duration = 0.2, frame_interval = 2e-3 }}
        "#
    );
    toml::from_str(&text).unwrap()
}

const MINDLIN: &str = r#"friction = { law = "mindlin", coefficient = 0.4 }"#;

/// The series of all columns that a scene can have.
fn series(scene: &Scene) -> Vec<(String, Vec<f32>)> {
    let scene = asking(scene.clone());
    let record = run::run(&scene, &mut |_| ControlFlow::Continue(())).unwrap();
    let scalars = record.observations.scalars().into_iter();
    scalars
        .map(|it| (it.name.to_owned(), it.values.to_vec()))
        .collect()
}

fn find<'a>(series: &'a [(String, Vec<f32>)], name: &str) -> &'a [f32] {
    &series.iter().find(|it| it.0 == name).unwrap().1
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3))]
    #[test]
    fn stress_is_symmetric_without_friction_and_shares_are_shares(seed in 1_u64..1000) {
        let frictionless = series(&scene("", seed));
        let rough = series(&scene(MINDLIN, seed));
        let mut asymmetric = 0;
        for axes in ["xy", "xz", "yz"] {
            let turned: String = axes.chars().rev().collect();
            let [name, other] = [axes, &turned].map(|it| format!("stress_{it}"));
            let both = |all: &[(String, Vec<f32>)]| -> Vec<(f32, f32)> {
                let pairs = find(all, &name).iter().zip(find(all, &other));
                pairs.map(|(one, other)| (*one, *other)).collect()
            };
            let scale = find(&frictionless, "pressure").iter().copied().fold(0.0, f32::max);
            for (one, other) in both(&frictionless) {
                prop_assert!((one - other).abs() <= 1e-5 * scale, "{name}: {one}, {other}");
            }
            asymmetric += both(&rough).iter().filter(|(one, other)| one != other).count();
        }
        prop_assert!(asymmetric > 100);
        for all in [&frictionless, &rough] {
            for name in ["share_without_contact", "share_at_wall"] {
                let share = find(all, name);
                prop_assert!(share.iter().all(|it| (0.0..=1.0).contains(it)), "{name}");
                prop_assert!(share.iter().any(|it| *it != share[0]), "{name}");
            }
            let trace = ["stress_xx", "stress_yy", "stress_zz"].map(|it| find(all, it));
            let pressure = find(all, "pressure");
            for frame in 0..pressure.len() {
                let sum: f32 = trace.iter().map(|it| it[frame]).sum();
                prop_assert!((sum / 3.0 - pressure[frame]).abs() <= 1e-5 * pressure[frame].abs());
            }
        }
    }
}

#[test]
fn columns_change_nothing_else() {
    let scene = scene(MINDLIN, 4);
    let plain = run::run(&scene, &mut |_| ControlFlow::Continue(())).unwrap();
    let mut asking = scene.clone();
    asking.output.columns = FurtherColumn::ALL.to_vec();
    asking.output.walls = true;
    let asked = run::run(&asking, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(scene.identity(), asking.identity());
    assert_eq!(plain.snapshots, asked.snapshots);
    let [one, other] = [&plain, &asked].map(|it| motion_digest(it).unwrap());
    assert_eq!(one, other);
    for usual in plain.observations.scalars() {
        let all = asked.observations.scalars();
        let same = all.iter().find(|it| it.name == usual.name).unwrap();
        assert_eq!(usual.values, same.values, "{}", usual.name);
    }
    let more = asked.observations.scalars().len() - plain.observations.scalars().len();
    // Six of the floor, six of the cylinder.
    assert_eq!(more, FurtherColumn::ALL.len() + 12);
}

/// The scene with all columns that it can have.
fn asking(mut scene: Scene) -> Scene {
    let all = FurtherColumn::ALL.iter().copied();
    scene.output.columns = all.filter(|it| it.absent_in(&scene).is_none()).collect();
    scene.output.walls = true;
    scene
}

/// Neither an interruption nor threads change a bit of them.
#[test]
fn columns_do_not_depend_on_interruptions_and_threads() {
    let small = asking(scene(MINDLIN, 4));
    let whole = run::run(&small, &mut |_| ControlFlow::Continue(())).unwrap();
    let mut first = Run::new(&small).unwrap();
    (0..63).for_each(|_| first.advance_frame());
    let mut saved = Vec::new();
    first.save(&mut saved).unwrap();
    let mut second = Run::new(&small).unwrap();
    second.restore(&saved).unwrap();
    while !second.ended() {
        second.advance_frame();
    }
    let [one, other] = [whole, second.finish()].map(|it| content_digest(&it).unwrap());
    assert_eq!(one, other);

    let friction = Some(Friction::Coulomb(Coulomb {
        coefficient: 0.3,
        regularisation: 0.01,
    }));
    let mut sorted = asking(large(friction, Integrator::VelocityVerlet));
    sorted.time.duration = 20.0 * sorted.time.frame_interval;
    let digests = [1, 3].map(|threads| {
        let mut run = Run::new(&sorted).unwrap();
        run.use_threads(threads).unwrap();
        while !run.ended() {
            run.advance_frame();
        }
        content_digest(&run.finish()).unwrap()
    });
    assert_eq!(digests[0], digests[1]);
}

#[test]
fn a_record_keeps_its_columns() {
    let mut scene = scene(MINDLIN, 4);
    scene.time.duration = 0.02;
    scene.output.columns = FurtherColumn::ALL.to_vec();
    scene.output.walls = true;
    let record = run::run(&scene, &mut |_| ControlFlow::Continue(())).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    write_record(&record, &path).unwrap();
    let read = read_record(&path).unwrap();
    assert_eq!(read.scene, scene);
    let digests = [&record, &read].map(|it| content_digest(it).unwrap());
    assert_eq!(digests[0], digests[1]);
}

/// At rest the stress carries the weights: its zz times the volume is the sum of m g z, if no
/// friction at the wall carries a part.
#[test]
fn a_bed_at_rest_carries_its_weight() {
    let mut scene = scene(MINDLIN, 2);
    scene.time.duration = 3.0;
    scene.tank.as_mut().unwrap().friction_coefficient = Some(0.0);
    scene.output.columns = vec![FurtherColumn::StressZz];
    scene.output.layer = Some(Layer {
        z_min: 0.0,
        z_max: 0.1,
    });
    let record = run::run(&scene, &mut |_| ControlFlow::Continue(())).unwrap();
    let scalars = record.observations.scalars();
    // The last second: spheres without friction still sway a little.
    let mean = |name: &str| {
        let series = scalars.iter().find(|it| it.name == name).unwrap();
        let last = &series.values[series.values.len() - 500..];
        last.iter().copied().map(f64::from).sum::<f64>() / 500.0
    };
    let stress = mean("stress_zz") * std::f64::consts::PI * 0.03 * 0.03 * 0.1;
    let weights = mean("gravitational");
    assert!((stress / weights - 1.0).abs() < 1e-3, "{stress}, {weights}");
}
