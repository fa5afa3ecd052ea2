//! Lines of single runs: speeds and energies, and which runs are chosen.

use super::bench::{SNAP, Tank, lines, shows, words_are_apart};
use phase::plot::{self, Source};
use phase::record::Program;
use phase::refusal::Refusal;
use phase::store::read_record;
use phase::sweep::parse_point;
use std::path::Path;

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
pub(crate) fn svg_bottom(svg: &str) -> f64 {
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
            .is_refusal()
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
        refining: None,
        table: &tank.table,
        failures: &[],
        record: &|id| read_record(&Path::new("nowhere").join(id)),
        points: &[parse_point("radius=0.002,omega=2,seed=2").unwrap()],
        times: None,
        program: &Program::current(),
    };
    let error = plot::draw("energies", &source).unwrap_err();
    assert!(!error.is_refusal());
    let message = error.to_string();
    let start = "the run at radius = 0.002, omega = 2, seed = 2: cannot read nowhere/2-2-2: ";
    assert!(message.starts_with(start), "{message}");
}

/// Symptom: `phase plot RECORD` could not draw energies or speeds of one record, and no figure
/// could be drawn elsewhere than beside its data.
#[test]
fn figures_of_one_record_go_where_they_are_asked_for() {
    let place = crate::support::Workplace::new();
    place.write("tank.toml", &crate::support::scene_file());
    place.write("silo.toml", &crate::support::silo_file());
    for run in ["tank", "silo"] {
        let record = format!("{run}.h5");
        place
            .phase(&["run", &format!("{run}.toml"), "--out", &record])
            .code(0);
        let figures = ["energies", "speeds", "states"];
        let figures = if run == "tank" {
            &figures[..]
        } else {
            &figures[..1]
        };
        let names = figures.join(",");
        place
            .phase(&["plot", &record, "--figure", &names, "--out", "figures"])
            .code(0);
        for figure in figures {
            for extension in ["svg", "png"] {
                assert!(
                    place
                        .path(&format!("figures/{run}-{figure}.{extension}"))
                        .exists()
                );
            }
        }
    }
    let text = place.read("figures/tank-energies.svg");
    assert!(text.contains("time (s)"));
    place
        .phase(&["plot", "tank.h5", "--figure", "phase"])
        .code(2)
        .complains("`phase` is not a figure of a record of a tank; available: `tracks`");
    place.write("tiny.toml", &crate::support::TinySweep::default().text());
    place.phase(&["sweep", "tiny.toml"]).code(0);
    let folder = [
        "plot",
        "results/tiny",
        "--figure",
        "phase",
        "--out",
        "elsewhere",
    ];
    place.phase(&folder).code(0);
    assert!(place.path("elsewhere/phase.png").exists());
}
