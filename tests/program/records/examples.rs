//! Records to test with.

use ndarray::{Array2, Array3};
use phase::observe::{Observations, Snapshot};
use phase::record::{Guard, Instability, Outcome, Program, RunRecord};
use phase::scene::{Scene, Start, StartSphere};

/// A scene with one start sphere, numbers that have no short decimal form, and a long text.
pub(crate) fn scene() -> Scene {
    let mut scene: Scene = toml::from_str(
        r#"
        title = "two lines, \"quotes\",\na tab\t and Ω"
        [spheres]
        count = 1
        radius = [{ radius = 0.002, share = 1 }, { radius = 0.30000000000000004, share = 0.1 }]
        density = 3750
        [contact]
        law = "hertz"
        young_modulus = 565685.424949238
        poisson_ratio = 0.3
        dissipation_time = 1e-3
        [start]
        kind = "list"
        spheres = [{ position = [0.1, -0.2, 1e-300] }]
        [time]
        dt = 1e-4
        duration = 5
        frame_interval = 1e-3
        "#,
    )
    .unwrap();
    scene.time.duration = 5.000000000000001;
    scene
}

/// Numbers that look like measured noise: reproducible, and with no pattern to compress.
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    /// The next number, uniform in 0 to 1.
    pub(crate) fn next(&mut self) -> f64 {
        // splitmix64 (Steele et al., 2014).
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A record of noise.
pub(crate) fn record(frames: usize, bins: usize, spheres: usize, snapshots: usize) -> RunRecord {
    let mut noise = Noise(frames as u64);
    let mut observations = Observations {
        time: (0..frames).map(|frame| frame as f64 * 1e-3).collect(),
        // One bin in fifteen is empty.
        profile: Array2::from_shape_simple_fn((frames, bins), || match noise.next() {
            empty if empty < 1.0 / 15.0 => f32::NAN,
            height => (0.1 * height - 0.15) as f32,
        }),
        rising: Array3::from_shape_simple_fn((frames, 3, 3), || (40.0 * noise.next()) as u16),
        ..Observations::default()
    };
    for (scale, column) in (1..).zip(&Observations::COLUMNS[..11]) {
        // A mean and ten percent of noise, as a driven bed has.
        *observations.scalar_mut(column.name).unwrap() = (0..frames)
            .map(|_| (f64::from(scale) * 1e-3 * (1.0 + 0.1 * noise.next())) as f32)
            .collect();
    }
    let mut snapshot = |index: usize| {
        let mut array = || Array2::from_shape_simple_fn((spheres, 3), || noise.next() - 0.5);
        Snapshot {
            time: index as f64,
            position: array(),
            velocity: array(),
            spin: array(),
        }
    };
    RunRecord {
        scene: scene(),
        program: Program::current(),
        outcome: Outcome::Completed,
        radius: vec![0.002; spheres],
        mass: vec![1.256_637_061_435_917e-4; spheres],
        milestones: Vec::new(),
        snapshots: (0..snapshots).map(&mut snapshot).collect(),
        trajectory: Vec::new(),
        observations,
        work: 123_456,
        cpu_seconds: 0.6,
    }
}

/// Lets the scene list so many spheres, every third of them of the scene's radius.
pub(crate) fn list_many(scene: &mut Scene, count: usize) {
    let mut noise = Noise(count as u64);
    let mut vector = || [noise.next(), -0.0, noise.next() - 0.5];
    let sphere = |i: usize| StartSphere {
        position: vector(),
        velocity: vector(),
        spin: vector(),
        radius: (!i.is_multiple_of(3)).then_some(1.0 / i as f64),
    };
    scene.spheres.count = count;
    scene.start = Start::list((0..count).map(sphere).collect());
}

/// How a run ends that a guard ended.
pub(crate) fn unstable() -> Outcome {
    Outcome::Unstable(Instability {
        guard: Guard::Overlap,
        step: u64::MAX,
        time: 0.1 + 0.2,
        sphere: 255,
        detail: "overlap 1.51 r, limit 1.5 r".to_owned(),
    })
}
