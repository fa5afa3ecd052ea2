//! Figures of theory alone.

use super::bench::{Tank, axis, lines, shows, texts};
use super::runs::svg_bottom;

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
    tank.sweep.axes[1] = axis(("spheres.count", "count"), &[64.0, 256.0]);
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
    let updraught = tank.sweep.scene.dem.effects.updraught.as_mut().unwrap();
    updraught.reference_omega = Some(8.0);
    let proportional = tank.draw("net-force-proportional", "net-force", &[]);
    assert!(!says(&proportional));
    assert_eq!(lines(&proportional), lines(&independent));
    // At 8 rad/s of a reference of 16 the lift is a quarter, so that the scene's own curve is the
    // one of half the rotation before.
    let updraught = tank.sweep.scene.dem.effects.updraught.as_mut().unwrap();
    updraught.reference_omega = Some(16.0);
    let weak = tank.draw("net-force-weak", "net-force", &[]);
    let falls = |line: &[(f64, f64)]| line[line.len() * 2 / 3].1 > line[0].1;
    assert!(falls(&lines(&weak)[2]) && !falls(&lines(&independent)[2]));
}

#[test]
fn theory_says_what_the_scene_lacks() {
    let mut tank = Tank::settled();
    tank.sweep.scene.dem.effects.updraught = None;
    tank.sweep.scene.dem.effects.gravity = None;
    assert_eq!(
        tank.refuses("net-force", &[]),
        "the figure `net-force` needs a scene with gravity, drag, swirl and updraught"
    );
    assert_eq!(
        tank.refuses("critical-rotation", &[]),
        "the figure `critical-rotation` needs a scene with a tank with a radius, and gravity"
    );
}
