//! Figures of single runs and of theory: what they show, which runs they choose, what they refuse.
//!
//! Every figure drawn here is left in `target/tmp` to look at.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use ndarray::{Array2, Array3};
use phase::classify::{Family, Label, Measures, Sieves, TankMeasures, Verdict};
use phase::observe::{Observations, Snapshot};
use phase::plot::{self, PlotError, Source, Svg};
use phase::record::{Outcome, Program, RunRecord};
use phase::scene::Scene;
use phase::store::{StoreError, read_record};
use phase::sweep::{Axis, LabelRow, LabelTable, PlotSettings, Sweep, parse_point};
use serde_json::json;
use std::cell::RefCell;
use std::fs;
use std::path::Path;

const COUNT: usize = 20;

/// How far straight lines may be moved to fall on pixels (units of the SVG).
const SNAP: f64 = 4.0;

fn scene() -> Scene {
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
struct Tank {
    sweep: Sweep,
    table: LabelTable,
    /// Duration of the runs (s).
    duration: f64,
    /// Identities of the records that were read.
    read: RefCell<Vec<String>>,
}

impl Tank {
    fn new(label: impl Fn(f64, f64, u64) -> Label) -> Self {
        let axis = |key: &str, name: &str, values: &[f64]| Axis {
            key: key.to_owned(),
            name: name.to_owned(),
            values: values.to_vec(),
        };
        let axes = vec![
            axis("spheres.radius", "radius", &[0.002, 0.004, 0.006]),
            axis("swirl.omega", "omega", &[0.0, 2.0, 6.0, 12.0, 40.0]),
        ];
        let mut rows = Vec::new();
        for &radius in &axes[0].values {
            for &omega in &axes[1].values {
                for seed in [1, 2] {
                    rows.push(LabelRow {
                        id: format!("{}-{omega}-{seed}", radius * 1e3),
                        values: vec![radius, omega],
                        seed,
                        verdict: Verdict {
                            label: label(radius, omega, seed),
                            measures: Measures::Tank(TankMeasures {
                                settle_time: Some(2.0),
                                ..TankMeasures::default()
                            }),
                        },
                    });
                }
            }
        }
        Self {
            table: LabelTable {
                family: Family::Tank,
                axes: axes.iter().map(|axis| axis.name.clone()).collect(),
                rows,
            },
            sweep: Sweep {
                title: Some("A made-up tank".to_owned()),
                scene: scene(),
                axes,
                seeds: vec![1, 2],
                sieves: Sieves::default(),
                plot: PlotSettings::default(),
            },
            duration: 5.0,
            read: RefCell::default(),
        }
    }

    /// The same tank with two more axes.
    fn of_four_axes() -> Self {
        let mut tank = Self::settled();
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
            tank.sweep.axes.push(Axis {
                key: key.to_owned(),
                name: name.to_owned(),
                values: values.to_vec(),
            });
        }
        tank
    }

    fn settled() -> Self {
        Self::new(|_, _, _| Label::Settled)
    }

    /// Draws a figure with the runs at these points, and remembers which records it reads.
    fn try_draw(&self, name: &str, points: &[&str]) -> Result<Svg, PlotError> {
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
            table: &self.table,
            record: &record,
            points: &points,
            program: &Program::current(),
        };
        plot::draw(name, &source)
    }

    /// Draws a figure twice, checks that its bytes are equal, and leaves its files in target/tmp.
    fn draw(&self, file: &str, name: &str, points: &[&str]) -> String {
        let svg = self.try_draw(name, points).unwrap();
        self.read.borrow_mut().clear();
        assert_eq!(svg, self.try_draw(name, points).unwrap());
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(file);
        let png = svg.to_png_bytes().unwrap();
        fs::write(path.with_extension("png"), png).unwrap();
        fs::write(path.with_extension("svg"), svg.to_svg_bytes()).unwrap();
        String::from_utf8(svg.to_svg_bytes()).unwrap()
    }

    fn refuses(&self, name: &str, points: &[&str]) -> String {
        self.try_draw(name, points).unwrap_err().to_string()
    }
}

/// A made-up run: it falls until 1 s, and turns ever faster.
fn record(radius: f64, omega: f64) -> RunRecord {
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
        cpu_seconds: 0.0,
    }
}

/// The texts of the SVG, without tags.
fn texts(svg: &str) -> Vec<String> {
    let lines = svg.lines().filter(|line| line.starts_with("<text"));
    lines
        .map(|line| {
            let parts = line.split('<').filter_map(|part| part.split_once('>'));
            parts.map(|(_, text)| text).collect()
        })
        .collect()
}

#[track_caller]
fn shows(svg: &str, expected: &[&str]) {
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
fn words_are_apart(svg: &str) {
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
fn lines(svg: &str) -> Vec<Vec<(f64, f64)>> {
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

#[test]
fn speeds_show_the_corners_of_the_grid_and_between() {
    let tank = Tank::settled();
    let svg = tank.draw("speeds", "speeds", &[]);
    let chosen = ["2-2-1", "2-12-1", "2-40-1", "6-2-1", "6-12-1", "6-40-1"];
    assert_eq!(*tank.read.borrow(), chosen);
    let heads = ["r = 2 mm, Ω = 2 rad/s", "r = 6 mm, Ω = 40 rad/s"];
    shows(&svg, &heads);
    let words = [
        "time (s)",
        "mean speed (m/s)",
        "air at the spheres",
        "spheres",
    ];
    shows(&svg, &words);
    shows(&svg, &["A made-up tank"]);
    // Two lines in each panel and two keys.
    assert_eq!(lines(&svg).len(), 2 * 6 + 2);
}

#[test]
fn heads_of_four_axes_leave_out_what_is_common_and_break() {
    let tank = Tank::of_four_axes();
    let svg = tank.draw("speeds-four", "speeds", &[]);
    shows(&svg, &["ρ = 2500 kg/m³, μ = 0", "r = 2 mm, Ω = 2 rad/s"]);
    words_are_apart(&svg);
    let points = [
        "radius=0.002,omega=40,density=7500,friction=0.05",
        "radius=0.004,omega=12,density=2500,friction=0.05",
        "radius=0.006,omega=12,density=2500,friction=0",
    ];
    let svg = tank.draw("speeds-four-points", "speeds", &points);
    shows(
        &svg,
        &["r = 2 mm, Ω = 40 rad/s,", "ρ = 7500 kg/m³, μ = 0.05"],
    );
    words_are_apart(&svg);
    for figure in ["energies", "state-energies"] {
        words_are_apart(&tank.draw(&format!("{figure}-four"), figure, &points));
    }
}

#[test]
fn ticks_of_a_short_run_do_not_touch() {
    let mut tank = Tank::settled();
    tank.duration = 0.1;
    let svg = tank.draw("energies-short", "energies", &[]);
    shows(&svg, &["first 0.02 s", "0.10", "0.000"]);
    words_are_apart(&svg);
}

#[test]
fn lines_go_where_the_values_are() {
    let tank = Tank::settled();
    let svg = tank.draw("speeds-one", "speeds", &["radius=0.004,omega=6"]);
    assert_eq!(*tank.read.borrow(), ["4-6-1"]);
    let lines = lines(&svg);
    let (air, spheres) = (&lines[0], &lines[1]);
    // The air is as fast at the end as at the beginning; the spheres reach it but for 1/e^5.
    let (first, last) = (air[0], air[air.len() - 1]);
    assert_eq!(first.1, last.1);
    assert!((spheres[0].1 - svg_bottom(&svg)).abs() <= SNAP);
    let end = spheres[spheres.len() - 1];
    let rise = (spheres[0].1 - end.1) / (spheres[0].1 - last.1);
    assert!((rise - (1.0 - libm::exp(-5.0))).abs() < 2e-3, "{rise}");
    // A pixel wide piece of the line needs no more than four points.
    assert!(spheres.len() < 4 * 720);
}

/// Lower end of the only frame: the largest y of a path that is a frame.
fn svg_bottom(svg: &str) -> f64 {
    let frames = svg
        .lines()
        .filter(|l| l.contains("stroke-width=\"8\"") && l.contains('L'));
    let numbers = frames.flat_map(|line| {
        let data = line
            .split("d=\"M")
            .nth(1)
            .unwrap()
            .split('"')
            .next()
            .unwrap();
        let y = |point: &str| point.split_once(' ').unwrap().1.parse::<f64>().unwrap();
        data.split('L').map(y).collect::<Vec<_>>()
    });
    numbers.fold(0.0, f64::max) - 40.0
}

#[test]
fn points_choose_runs_and_seeds() {
    let tank = Tank::settled();
    let points = ["radius=0.006,omega=2", "swirl.omega=40,radius=0.002,seed=2"];
    let svg = tank.draw("speeds-points", "speeds", &points);
    assert_eq!(*tank.read.borrow(), ["6-2-1", "2-40-2"]);
    shows(
        &svg,
        &[
            "r = 6 mm, Ω = 2 rad/s, seed 1",
            "r = 2 mm, Ω = 40 rad/s, seed 2",
        ],
    );
}

#[test]
fn energies_are_those_of_a_sphere_with_zero_where_it_settles() {
    let tank = Tank::settled();
    let svg = tank.draw("energies", "energies", &["radius=0.004,omega=0"]);
    let words = [
        "mean energy of a sphere (mJ)",
        "time (s)",
        "kinetic",
        "rotational",
    ];
    shows(&svg, &words);
    shows(
        &svg,
        &["potential, zero at the settled height", "first second"],
    );
    let lines = lines(&svg);
    assert_eq!(lines.len(), 2 * 3 + 3);
    let (kinetic, potential, larger) = (&lines[0], &lines[2], &lines[5]);
    // Omega is zero, so the kinetic energy stays there; the potential energy comes down to it.
    assert!(kinetic.iter().all(|point| point.1 == kinetic[0].1));
    assert!((potential[potential.len() - 1].1 - kinetic[0].1).abs() <= SNAP);
    // m g .3 m = 2.955 mJ: between the ticks at 2.5 and 3.
    shows(&svg, &["2.5", "3.0"]);
    // It reaches zero at a fifth of the run, and at the end of the first second.
    let width = kinetic[kinetic.len() - 1].0 - kinetic[0].0;
    let arrival = |line: &[(f64, f64)]| {
        line.iter()
            .find(|p| (p.1 - kinetic[0].1).abs() <= SNAP)
            .unwrap()
            .0
            - line[0].0
    };
    assert!((arrival(potential) / width - 0.2).abs() < 0.01);
    assert!((arrival(larger) / width - 1.0).abs() < 0.02);
}

#[test]
fn one_run_of_every_state() {
    let tank = Tank::new(|radius, omega, seed| match (radius, omega) {
        (_, 0.0) => Label::Settled,
        (0.002, 2.0) => Label::LargeSpout,
        (0.004, 2.0 | 6.0) | (0.006, 2.0) => Label::Fluid,
        // Only one of two seeds, and not that of the majority.
        (0.002, 6.0) if seed == 2 => Label::SmallSpout,
        (0.006, 40.0) => Label::Unstable,
        _ => Label::Pinned,
    });
    let svg = tank.draw("state-energies", "state-energies", &[]);
    let chosen = ["4-0-1", "4-2-1", "4-12-1", "2-6-2", "2-2-1"];
    assert_eq!(*tank.read.borrow(), chosen);
    shows(
        &svg,
        &[
            "settled: r = 4 mm, Ω = 0 rad/s",
            "small spout: r = 2 mm, Ω = 6 rad/s",
        ],
    );

    let svg = tank.draw("states", "states", &[]);
    assert_eq!(*tank.read.borrow(), chosen);
    shows(
        &svg,
        &[
            "settled",
            "fluid",
            "pinned",
            "small spout",
            "large spout",
            "50 mm",
        ],
    );
    shows(&svg, &["r = 2 mm", "Ω = 6 rad/s"]);
    assert_eq!(svg.matches("<image ").count(), 10);
    assert!(!texts(&svg).contains(&"unstable".to_owned()));
    shows(&svg, &["not shown: unstable, 2 of 30 runs"]);
}

#[test]
fn figures_of_states_say_that_all_runs_are_unstable() {
    let tank = Tank::new(|_, _, _| Label::Unstable);
    for figure in ["states", "state-energies"] {
        let svg = tank.draw(&format!("{figure}-unstable"), figure, &[]);
        shows(&svg, &["not shown: unstable, 30 of 30 runs"]);
    }
    let asked = tank.draw("states-asked", "states", &["radius=0.004,omega=6"]);
    shows(&asked, &["unstable", "r = 4 mm"]);
}

#[test]
fn spheres_too_high_for_a_picture_are_counted() {
    let tank = Tank::settled();
    let svg = tank.draw("states-high", "states", &["radius=0.006,omega=40"]);
    shows(&svg, &["1 sphere above, not drawn"]);
    let svg = tank.draw("states-low", "states", &["radius=0.006,omega=12"]);
    assert!(!svg.contains("not drawn"));
}

/// Forty spheres that fly apart, with a spin.
fn flight(spin: f64) -> RunRecord {
    const MANY: usize = 40;
    let mut record = record(0.004, 6.0);
    record.radius = vec![0.004; MANY];
    let moment = |time: f64| Snapshot {
        time,
        position: Array2::from_shape_fn((MANY, 3), |(sphere, axis)| {
            (0.01 + time) * libm::cos(1.3 * sphere as f64 + 2.0 * axis as f64)
        }),
        velocity: Array2::ones((MANY, 3)),
        spin: Array2::from_elem((MANY, 3), spin),
    };
    record.trajectory = [0.0, 0.01, 0.02].map(moment).to_vec();
    record
}

#[test]
fn tracks_of_many_spheres_are_thinned_and_arrows_named_if_there_are_any() {
    let draw = |spin: f64| {
        let svg = plot::draw_tracks(&flight(spin)).unwrap();
        String::from_utf8(svg.to_svg_bytes()).unwrap()
    };
    let slow = draw(1e-3);
    shows(
        &slow,
        &["the first 32 of 40 spheres; filled: start; bold: end"],
    );
    // Disc and rim at the start and at the end, and the bold rim.
    assert_eq!(slow.matches("<circle").count(), 32 * 5);
    let fast = draw(1e3);
    shows(
        &fast,
        &["the first 32 of 40 spheres; filled: start; bold: end; arrows: spin"],
    );
}

#[test]
fn png_of_the_states_holds_the_pictures() {
    let tank = Tank::new(|_, _, _| Label::Pinned);
    let svg = tank.try_draw("states", &["radius=0.004,omega=6"]).unwrap();
    let bytes = svg.to_png_bytes().unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let green = |pixel: &&[u8]| {
        let [red, green, blue] = [0, 1, 2].map(|channel| i32::from(pixel[channel]));
        green > red + 20 && green > blue + 20
    };
    // 20 spheres of 4 mm seen from above cover 20 pi 16 mm2 of a picture of 500 pixels for 125 mm;
    // from the side nine of the twenty hide others.
    let found = pixels.chunks_exact(3).filter(green).count() as f64;
    let above = 20.0 * std::f64::consts::PI * 16.0 * 16.0;
    assert!((1.3..2.2).contains(&(found / above)), "{}", found / above);
}

#[test]
fn critical_rotation_is_that_of_the_theory() {
    let tank = Tank::settled();
    let svg = tank.draw("critical-rotation", "critical-rotation", &[]);
    assert!(tank.read.borrow().is_empty());
    shows(
        &svg,
        &[
            "critical rotation Ωc (rad/s)",
            "radius of the spheres r (mm)",
            "n = 20, R = 60 mm, g = 9.8 m/s²",
        ],
    );
    let line = &lines(&svg)[0];
    let (first, last) = (line[0], line[line.len() - 1]);
    // It starts at 2 mm and grows as r^1.5, from zero at the lower edge of the frame.
    let bottom = svg_bottom(&svg);
    let ratio = (bottom - last.1) / (bottom - first.1);
    assert!((ratio - libm::pow(3.0, 1.5)).abs() < 0.05, "{ratio}");
}

#[test]
fn critical_rotation_has_a_line_for_each_number_of_spheres() {
    let mut tank = Tank::settled();
    tank.sweep.axes[1] = Axis {
        key: "spheres.count".to_owned(),
        name: "count".to_owned(),
        values: vec![64.0, 256.0],
    };
    let svg = tank.draw("critical-rotation-counts", "critical-rotation", &[]);
    shows(&svg, &["n = 64", "n = 256", "R = 60 mm, g = 9.8 m/s²"]);
    let lines = lines(&svg);
    let bottom = svg_bottom(&svg);
    let ratio = (bottom - lines[1][0].1) / (bottom - lines[0][0].1);
    assert!((ratio - 2.0).abs() < 0.02, "{ratio}");
}

#[test]
fn net_force_rises_and_falls_with_the_radius() {
    let tank = Tank::settled();
    let svg = tank.draw("net-force", "net-force", &[]);
    shows(
        &svg,
        &["net vertical force Fz (mN)", "radius of the sphere r (mm)"],
    );
    let names = ["Ω = 4 rad/s", "Ω = 6 rad/s", "Ω = 8 rad/s, as in the scene"];
    shows(&svg, &names);
    let lines = lines(&svg);
    assert_eq!(lines.len(), 3 + 3);
    for line in &lines[..3] {
        let zero = line[0].1;
        assert!(
            line[1..].iter().any(|point| point.1 < zero),
            "no lift at any radius"
        );
    }
    // At half the rotation a sphere of 4 mm has 3/4 exp(-.1) of its weight as lift, and stays down;
    // at three quarters 27/16 exp(-.1), and rises.
    let at_4_mm = |line: &[(f64, f64)]| line[line.len() * 2 / 3].1 - line[0].1;
    assert!(at_4_mm(&lines[0]) > 0.0 && at_4_mm(&lines[1]) < 0.0);
}

#[test]
fn net_force_says_what_it_assumes_of_the_lift() {
    let mut tank = Tank::settled();
    let assumption = "In this scene the updraught does not depend on Ω.";
    let says = |svg: &str| texts(svg).iter().any(|text| text.starts_with(assumption));
    let independent = tank.draw("net-force-independent", "net-force", &[]);
    assert!(says(&independent));
    let updraught = tank.sweep.scene.updraught.as_mut().unwrap();
    updraught.reference_omega = Some(8.0);
    let proportional = tank.draw("net-force-proportional", "net-force", &[]);
    assert!(!says(&proportional));
    assert_eq!(lines(&proportional), lines(&independent));
    // At 8 rad/s of a reference of 16 the lift is a quarter, so that the scene's own curve is the one
    // of half the rotation before.
    let updraught = tank.sweep.scene.updraught.as_mut().unwrap();
    updraught.reference_omega = Some(16.0);
    let weak = tank.draw("net-force-weak", "net-force", &[]);
    let falls = |line: &[(f64, f64)]| line[line.len() * 2 / 3].1 > line[0].1;
    assert!(falls(&lines(&weak)[2]) && !falls(&lines(&independent)[2]));
}

#[test]
fn theory_says_what_the_scene_lacks() {
    let mut tank = Tank::settled();
    tank.sweep.scene.updraught = None;
    tank.sweep.scene.gravity = None;
    assert_eq!(
        tank.refuses("net-force", &[]),
        "the figure `net-force` needs a scene with gravity, drag, swirl and updraught"
    );
    assert_eq!(
        tank.refuses("critical-rotation", &[]),
        "the figure `critical-rotation` needs a scene with a tank with a radius, and gravity"
    );
}

#[test]
fn points_that_do_not_exist_are_refused() {
    let mut tank = Tank::settled();
    for (point, message) in [
        (
            "density=1",
            "the sweep has no axis `density`; it has radius, omega",
        ),
        (
            "radius=0.003,omega=2",
            "`radius` is never 0.003; it takes 0.002, 0.004, 0.006",
        ),
        (
            "radius=0.002",
            "the point radius = 0.002 leaves the axis `omega` open; it takes 0, 2, 6, 12, 40",
        ),
        (
            "radius=0.002,omega=2,seed=7",
            "no run at radius = 0.002, omega = 2, seed = 7 is in the table of labels; run `phase \
             sweep` again to complete it, or choose another point or seed",
        ),
    ] {
        for figure in ["speeds", "energies", "state-energies", "states"] {
            assert_eq!(tank.refuses(figure, &[point]), message);
        }
    }
    let message = tank.refuses("phase", &["radius=0.002,omega=2"]);
    assert_eq!(
        message,
        "the figure `phase` shows no single runs, so it takes no points"
    );
    assert!(
        tank.try_draw("phase", &["radius=0.002,omega=2"])
            .unwrap_err()
            .is_of_request()
    );
    tank.table.rows.clear();
    assert!(
        tank.refuses("speeds", &[])
            .contains("table of labels is empty")
    );
}

#[test]
fn a_missing_record_is_named() {
    let tank = Tank::settled();
    let source = Source {
        sweep: &tank.sweep,
        table: &tank.table,
        record: &|id| read_record(&Path::new("nowhere").join(id)),
        points: &[parse_point("radius=0.002,omega=2,seed=2").unwrap()],
        program: &Program::current(),
    };
    let error = plot::draw("energies", &source).unwrap_err();
    assert!(!error.is_of_request());
    let message = error.to_string();
    let start = "the run at radius = 0.002, omega = 2, seed = 2: cannot read nowhere/2-2-2: ";
    assert!(message.starts_with(start), "{message}");
}
