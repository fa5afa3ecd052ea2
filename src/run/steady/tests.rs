#![expect(clippy::print_stdout, reason = "the rates that are measured")]

use super::*;
use crate::record::RunRecord;
use crate::run::Run;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Time between frames (s) and duration (s) of made-up runs.
const INTERVAL: f64 = 1e-2;
const DURATION: f64 = 60.0;
const FRAMES: u64 = 6000;

fn test() -> SteadyTest {
    let scene: Scene = toml::from_str(
        r#"
        spheres = { count = 1, radius = 0.004, density = 3750.0 }
        tank = { radius = 0.06, floor = -0.2 }
        start = { kind = "random", z_min = -0.1, z_max = 0.3 }
        gravity = { acceleration = 9.8 }
        time = { dt = 1e-4, duration = 60.0, frame_interval = 1e-2 }
        [steady]
        "#,
    )
    .unwrap();
    assert_eq!(
        (scene.time.duration, scene.time.frames()),
        (DURATION, FRAMES)
    );
    SteadyTest::new(&scene, &[0.004], &[1e-3]).unwrap()
}

/// A run in which only the energy (J) changes with time (s).
fn observed(energy: impl Fn(f64) -> f64) -> Observations {
    let frames = FRAMES as usize + 1;
    let time: Vec<f64> = (0..frames).map(|frame| frame as f64 * INTERVAL).collect();
    Observations {
        kinetic: time.iter().map(|time| energy(*time) as f32).collect(),
        rotational: vec![0.0; frames],
        rotation: vec![5.0; frames],
        height_mean: vec![-0.15; frames],
        time,
        ..Observations::default()
    }
}

/// The end of a run (s), and the start of its steady state (s).
fn end(observations: &Observations) -> Option<(f64, f64)> {
    let test = test();
    (1..=FRAMES).find_map(|frame| {
        let since = test.since(frame, observations)?;
        Some((observations.time[frame as usize], since))
    })
}

/// Adds noise of this scatter (J) and integrated correlation time (s) to the energy.
fn with_noise(mut observations: Observations, scatter: f64, time: f64, seed: u64) -> Observations {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut normal = || {
        let [one, other]: [f64; 2] = [1.0 - random.random::<f64>(), random.random()];
        (-2.0 * libm::log(one)).sqrt() * libm::cos(2.0 * std::f64::consts::PI * other)
    };
    let frames = time / INTERVAL;
    let hold = (frames - 1.0) / (frames + 1.0);
    let mut value = normal();
    for energy in &mut observations.kinetic {
        *energy += (scatter * value) as f32;
        value = hold * value + (1.0 - hold * hold).sqrt() * normal();
    }
    observations
}

#[test]
fn a_run_at_rest_ends_after_one_window() {
    let (end, since) = end(&observed(|_| 1.0)).unwrap();
    assert_eq!((end, since), (2.0, 0.0));
    // Empty observables decide nothing.
    assert_eq!(test().since(200, &Observations::default()), None);
}

/// For any relaxation time, little of the relaxation is left at the end.
#[test]
fn a_relaxation_is_over_at_the_end_of_a_run() {
    for time in [0.3, 1.0, 3.0, 10.0] {
        let left = |at: f64| libm::exp(-at / time);
        let (end, since) = end(&observed(|at| 1.0 - left(at))).unwrap();
        println!(
            "time {time} s: ends at {end} s, steady since {since} s, {} left",
            left(end)
        );
        assert!(left(end) < 0.02, "{time}: {} left at {end}", left(end));
        assert!(end < 5.0 * time + 3.0, "{time}: {end}");
    }
    assert_eq!(end(&observed(|at| 1.0 - libm::exp(-at / 30.0))), None);
}

/// The same with noise of a tenth of the energy: how often more than a twentieth is left.
#[test]
fn noise_hides_no_relaxation() {
    let time = 3.0;
    let left = |at: f64| libm::exp(-at / time);
    let (mut ends, mut early) = (Vec::new(), 0);
    for seed in 0..100 {
        let noisy = with_noise(observed(|at| 1.0 - left(at)), 0.1, 0.1, seed);
        let (end, _) = end(&noisy).unwrap_or((DURATION, DURATION));
        early += u32::from(left(end) > 0.05);
        ends.push(end);
    }
    ends.sort_by(f64::total_cmp);
    println!(
        "ends {} to {} s, median {}; {early} of 100 early",
        ends[0], ends[99], ends[50]
    );
    assert!(early <= 5, "{early}");
    assert!(ends[50] < DURATION);
}

/// Every check is one more chance to end: most runs that always change by exactly the tolerance in
/// their last third end within a hundred checks. With slightly larger changes they continue.
#[test]
fn many_checks_end_few_runs_that_go_on_changing() {
    for (change, most) in [(0.07, 10), (0.1, 0)] {
        // A power of the time: (2/3)^power = 1 - change.
        let power = libm::log(1.0 - change) / libm::log(2.0 / 3.0);
        let ended = (0..100).filter(|seed| {
            let energy = observed(|at| libm::pow(at + 1e-3, power));
            end(&with_noise(energy, 0.05, 0.05, *seed)).is_some()
        });
        let ended = ended.count();
        println!("change {change} in the last third: {ended} of 100 ended");
        assert!(ended <= most, "{change}: {ended}");
    }
}

/// How long it takes to find a steady run steady, depending on its noise.
#[test]
fn a_steady_run_ends_when_its_length_tells() {
    for (scatter, correlation, latest) in [(0.01, 0.02, 3.0), (0.05, 0.05, 20.0), (0.1, 0.1, 60.0)]
    {
        let mut ends: Vec<f64> = (0..50)
            .map(|seed| with_noise(observed(|_| 1.0), scatter, correlation, seed))
            .map(|noisy| end(&noisy).map_or(DURATION, |(end, _)| end))
            .collect();
        ends.sort_by(f64::total_cmp);
        println!(
            "scatter {scatter}, {correlation} s: median {} s, last {} s",
            ends[25], ends[49]
        );
        assert!(ends[25] < latest, "{scatter}: {}", ends[25]);
    }
}

/// A jump in any of the three observables keeps a run going until the jump is old enough.
#[test]
fn all_three_observables_must_be_still() {
    let frames = FRAMES as usize + 1;
    let jump = |low: f32, high: f32| -> Vec<f32> {
        (0..frames)
            .map(|frame| if frame < 800 { low } else { high })
            .collect()
    };
    let mut moving = observed(|_| 1.0);
    for change in [
        |it: &mut Observations, values| it.kinetic = values,
        |it: &mut Observations, values| it.rotational = values,
        |it: &mut Observations, values| it.rotation = values,
    ] {
        let mut moving = moving.clone();
        // Before the jump it is steady.
        change(&mut moving, jump(0.0, 9.0));
        assert_eq!(test().since(200, &moving), Some(0.0));
        assert_eq!(test().since(1000, &moving), None);
        assert_eq!(test().since(1200, &moving), Some(8.0));
    }
    moving.height_mean = jump(-0.15, -0.14);
    assert_eq!(test().since(1000, &moving), None);
    moving.rotation = Vec::new();
    moving.height_mean = vec![-0.15; frames];
    assert_eq!(
        test().since(1000, &moving),
        Some(10.0 - 1000.0f64.div_euclid(3.0) * INTERVAL - INTERVAL)
    );
}

/// Spheres that fall into a tank, with or without an end.
fn falling(steady: &str) -> Scene {
    let scene: Scene = toml::from_str(&format!(
        r#"
        spheres = {{ count = 8, radius = 0.004, density = 3750.0 }}
        contact.law = "hertz"
        contact.young_modulus = 5e5
        contact.poisson_ratio = 0.3
        contact.dissipation_time = 1e-3
        tank = {{ radius = 0.03, floor = 0.0 }}
        start = {{ kind = "random", z_min = 0.01, z_max = 0.05 }}
        gravity = {{ acceleration = 9.8 }}
        time = {{ dt = 1e-4, duration = 4.0, frame_interval = 1e-2 }}
        {steady}
        "#
    ))
    .unwrap();
    assert_eq!(scene.problems(), []);
    scene
}

fn finished(mut run: Run) -> RunRecord {
    while !run.ended() {
        run.advance_frame();
    }
    RunRecord {
        cpu_seconds: 0.0,
        ..run.finish()
    }
}

const STEADY: &str = "steady = { window = 0.5, check_interval = 0.1 }";

#[test]
fn a_run_that_ends_early_has_the_bits_of_one_that_goes_on() {
    let scene = falling(STEADY);
    let record = finished(Run::new(&scene).unwrap());
    let frames = record.observations.frames();
    assert_eq!(record.is_steady(), Some(true));
    assert!(
        record.steady_since() > Some(0.0) && frames < 401,
        "{frames}"
    );
    assert_eq!(
        record.snapshots.last().unwrap().time,
        *record.observations.time.last().unwrap()
    );

    let on = falling("");
    assert_ne!(on.identity(), scene.identity());
    let longer = finished(Run::new(&on).unwrap());
    assert_eq!(
        (longer.is_steady(), longer.observations.frames()),
        (None, 401)
    );
    assert_eq!(
        longer.observations.kinetic[..frames],
        record.observations.kinetic[..]
    );
    assert_eq!(
        longer.observations.height_mean[..frames],
        record.observations.height_mean[..]
    );
    assert_eq!(longer.milestones, []);

    let capped = falling("steady = { window = 0.5, tolerance = 1e-12 }");
    let capped = finished(Run::new(&capped).unwrap());
    assert_eq!(
        (capped.is_steady(), capped.observations.frames()),
        (Some(false), 401)
    );
}

#[test]
fn interrupted_or_on_several_threads_a_run_ends_at_the_same_frame() {
    let scene = falling(STEADY);
    // An empty bin of the profile is no number, and equals none.
    let text = |record: RunRecord| format!("{record:?}");
    let whole = finished(Run::new(&scene).unwrap());
    let last = whole.observations.frames() as u64 - 1;
    let whole = text(whole);
    for stop in [last / 2, last - 1, last] {
        let mut first = Run::new(&scene).unwrap();
        for _ in 0..stop {
            first.advance_frame();
        }
        let mut saved = Vec::new();
        first.save(&mut saved).unwrap();
        let mut second = Run::new(&scene).unwrap();
        second.restore(&saved).unwrap();
        assert_eq!(second.ended(), stop == last);
        assert!(text(finished(second)) == whole, "{stop}");
    }
    let mut threaded = Run::new(&scene).unwrap();
    threaded.use_threads(2).unwrap();
    assert!(text(finished(threaded)) == whole);
}
