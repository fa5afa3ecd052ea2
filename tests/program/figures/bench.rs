//! What the tests share: a made-up sweep with its runs, and what an SVG shows.

use crate::made_up;
pub(crate) use crate::made_up::axis;
pub(crate) use crate::support::texts;
use ndarray::{Array2, Array3};
use phase::classify::{Label, TANK, Verdict};
use phase::classify::{LabelRow, LabelTable};
use phase::observe::{Observations, Snapshot};
use phase::plot::{self, PlotError, Source, Svg};
use phase::record::{Outcome, Program, RunRecord};
use phase::scene::Scene;
use phase::scene::{Coulomb, Friction};
use phase::store::StoreError;
use phase::sweep::{Sweep, parse_point};
use serde_json::json;
use std::cell::RefCell;
use std::fs;
use std::path::Path;

const COUNT: usize = 20;

/// How far straight lines may be moved to fall on pixels (units of the SVG).
pub(crate) const SNAP: f64 = 4.0;

pub(crate) fn scene() -> Scene {
    serde_json::from_value(json!({
        "spheres": { "count": COUNT, "radius": 0.004, "density": 3750.0 },
        "tank": { "radius": 0.06, "floor": -0.2 },
        "start": { "kind": "random", "z_min": -0.1, "z_max": 0.3 },
        "gravity": { "acceleration": 9.8 },
        "drag": { "law": "cross-section", "linear": 100.0 },
        "swirl": { "omega": 8.0 },
        "updraught": { "speed": 5.88, "decay": 25.0, "origin": -0.2, "alpha": 0.5 },
        "time": { "dt": 1e-4, "duration": 5.0, "frame_interval": 1e-3 },
    }))
    .unwrap()
}

/// A sweep over r and Omega with two seeds, and a label for every run.
pub(crate) struct Tank {
    pub(crate) sweep: Sweep,
    pub(crate) table: LabelTable,
    /// Duration of the runs (s).
    pub(crate) duration: f64,
    /// Identities of the records that were read.
    pub(crate) read: RefCell<Vec<String>>,
}

impl Tank {
    pub(crate) fn new(label: impl Fn(f64, f64, u64) -> Label) -> Self {
        let axes = vec![
            axis(("spheres.radius", "radius"), &[0.002, 0.004, 0.006]),
            axis(("swirl.omega", "omega"), &[0.0, 2.0, 6.0, 12.0, 40.0]),
        ];
        let mut rows = Vec::new();
        for &radius in &axes[0].values {
            for &omega in &axes[1].values {
                for seed in [1, 2] {
                    rows.push(LabelRow {
                        id: format!("{}-{omega}-{seed}", radius * 1e3),
                        values: vec![radius, omega],
                        seed,
                        verdict: Verdict::unmeasured(&TANK, label(radius, omega, seed))
                            .with("settle_time", Some(2.0))
                            .unwrap(),
                    });
                }
            }
        }
        Self {
            table: LabelTable {
                family: &TANK,
                axes: axes.iter().map(|axis| axis.name.clone()).collect(),
                variants: Vec::new(),
                rows,
            },
            sweep: made_up::sweep("A made-up tank", scene(), axes, &[1, 2]),
            duration: 5.0,
            read: RefCell::default(),
        }
    }

    /// The same tank with two more axes.
    pub(crate) fn of_four_axes() -> Self {
        let mut tank = Self::settled();
        // An axis is a key of the scene.
        tank.sweep.scene.dem.friction = Some(Friction::Coulomb(Coulomb {
            coefficient: 0.0,
            regularisation: 1e-3,
        }));
        let more = [
            ("spheres.density", "density", [2500.0, 7500.0]),
            ("friction.coefficient", "friction", [0.0, 0.05]),
        ];
        for (key, name, values) in more {
            let rows = std::mem::take(&mut tank.table.rows);
            tank.table.rows = rows
                .into_iter()
                .flat_map(|row| {
                    values.map(|value| {
                        let mut row = row.clone();
                        row.id += &format!("-{value}");
                        row.values.push(value);
                        row
                    })
                })
                .collect();
            tank.table.axes.push(name.to_owned());
            tank.sweep.axes.push(axis((key, name), &values));
        }
        tank
    }

    pub(crate) fn settled() -> Self {
        Self::new(|_, _, _| Label::SETTLED)
    }

    /// Draws a figure with the runs at these points, and remembers which records it reads.
    pub(crate) fn try_draw(&self, name: &str, points: &[&str]) -> Result<Svg, PlotError> {
        let points: Vec<_> = points.iter().map(|p| parse_point(p).unwrap()).collect();
        let record = |id: &str| -> Result<RunRecord, StoreError> {
            self.read.borrow_mut().push(id.to_owned());
            let row = self.table.rows.iter().find(|row| row.id == id).unwrap();
            let mut record = record(row.values[0], row.values[1]);
            record.scene.time.duration = self.duration;
            Ok(record)
        };
        let source = Source {
            sweep: &self.sweep,
            refining: None,
            table: &self.table,
            failures: &[],
            record: &record,
            points: &points,
            times: None,
            program: &Program::current(),
        };
        plot::draw(name, &source)
    }

    /// Draws a figure twice, checks that its bytes are equal, and leaves its files in target/tmp.
    pub(crate) fn draw(&self, file: &str, name: &str, points: &[&str]) -> String {
        let svg = self.try_draw(name, points).unwrap();
        self.read.borrow_mut().clear();
        assert_eq!(svg, self.try_draw(name, points).unwrap());
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(file);
        let png = svg.to_png_bytes().unwrap();
        fs::write(path.with_extension("png"), png).unwrap();
        fs::write(path.with_extension("svg"), svg.to_svg_bytes()).unwrap();
        String::from_utf8(svg.to_svg_bytes()).unwrap()
    }

    pub(crate) fn refuses(&self, name: &str, points: &[&str]) -> String {
        self.try_draw(name, points).unwrap_err().to_string()
    }
}

/// A made-up run: it falls until 1 s, and turns ever faster.
pub(crate) fn record(radius: f64, omega: f64) -> RunRecord {
    let mass = 3750.0 * 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius;
    let frames = 5001;
    let time: Vec<f64> = (0..frames).map(|frame| f64::from(frame) * 1e-3).collect();
    let all = |value: &dyn Fn(f64) -> f64| -> Vec<f32> {
        time.iter().map(|&time| value(time) as f32).collect()
    };
    let height = |time: f64| 0.3 * (1.0 - time).max(0.0) - 0.19;
    let turned = |time: f64| 0.04 * omega * (1.0 - libm::exp(-time));
    let weight = COUNT as f64 * mass * 9.8;
    let observations = Observations {
        kinetic: all(&|time| 0.5 * COUNT as f64 * mass * turned(time) * turned(time)),
        rotational: all(&|_| 1e-9),
        gravitational: all(&|time| weight * height(time)),
        elastic: all(&|_| 0.0),
        height_mean: all(&height),
        height_max: all(&height),
        hole_radius: all(&|_| 0.0),
        speed_mean: all(&turned),
        air_speed_mean: all(&|_| 0.04 * omega),
        rotation: all(&|_| 0.0),
        fluctuation: all(&|_| 0.0),
        profile: Array2::zeros((time.len(), 0)),
        rising: Array3::zeros((time.len(), 0, 3)),
        time,
        ..Observations::default()
    };
    // A ring on the floor.
    let position = Array2::from_shape_fn((COUNT, 3), |(sphere, axis)| {
        let angle = sphere as f64 * std::f64::consts::TAU / COUNT as f64;
        match axis {
            0 => 0.05 * libm::cos(angle),
            1 => 0.05 * libm::sin(angle),
            // One of the fastest flies high above the others.
            _ if omega == 40.0 && sphere == 0 => 1.0,
            _ => radius - 0.2,
        }
    });
    RunRecord {
        scene: scene(),
        program: Program::current(),
        outcome: Outcome::Completed,
        radius: vec![radius; COUNT],
        mass: vec![mass; COUNT],
        milestones: Vec::new(),
        observations,
        snapshots: vec![Snapshot {
            time: 5.0,
            velocity: Array2::zeros((COUNT, 3)),
            spin: Array2::zeros((0, 3)),
            position,
        }],
        trajectory: Vec::new(),
        work: 0,
        cpu_seconds: 0.0,
    }
}

#[track_caller]
pub(crate) fn shows(svg: &str, expected: &[&str]) {
    let texts = texts(svg);
    for text in expected {
        assert!(
            texts.iter().any(|found| found == text),
            "{text} not in {texts:?}"
        );
    }
}

/// Asserts that words that stand on one height do not touch each other, and end within the figure.
#[track_caller]
pub(crate) fn words_are_apart(svg: &str) {
    let number = |line: &str, name: &str| -> f64 {
        let rest = line.split(&format!(" {name}=\"")).nth(1).unwrap();
        rest.split('"').next().unwrap().parse().unwrap()
    };
    let level = |line: &&str| line.starts_with("<text") && !line.contains("rotate(");
    let mut words: Vec<(f64, f64, f64, String)> = svg
        .lines()
        .filter(level)
        .map(|line| {
            let text = texts(line).remove(0);
            // Digits of DejaVu Sans are .636 em wide, most letters a little less.
            let width = 0.55 * number(line, "font-size") * text.chars().count() as f64;
            let start = match line {
                _ if line.contains("\"middle\"") => 0.5,
                _ if line.contains("\"end\"") => 1.0,
                _ => 0.0,
            };
            let left = number(line, "x") - start * width;
            (number(line, "y"), left, left + width, text)
        })
        .collect();
    words.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    for pair in words.windows(2) {
        let apart = pair[0].0 != pair[1].0 || pair[0].2 < pair[1].1;
        assert!(apart, "{} touches {}", pair[0].3, pair[1].3);
    }
    for (_, left, right, text) in &words {
        assert!(*left >= 0.0 && *right <= 7200.0, "{text} is cut");
    }
}

/// Lines of charts, with the points of each.
pub(crate) fn lines(svg: &str) -> Vec<Vec<(f64, f64)>> {
    let paths = svg
        .lines()
        .filter(|line| line.contains("stroke-width=\"15\""));
    let paths = paths.filter_map(|line| line.split("d=\"M").nth(1)?.split('"').next());
    let point = |text: &str| {
        let (x, y) = text.split_once(' ').unwrap();
        (x.parse().unwrap(), y.parse().unwrap())
    };
    paths
        .map(|path| path.split('L').map(point).collect())
        .collect()
}
