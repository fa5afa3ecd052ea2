//! Pictures of the states, and tracks.

use super::bench::{Tank, record, shows, texts};
use ndarray::Array2;
use phase::classify::Label;
use phase::observe::Snapshot;
use phase::plot::{self};
use phase::record::RunRecord;

#[test]
fn one_run_of_every_state() {
    let tank = Tank::new(|radius, omega, seed| match (radius, omega) {
        (_, 0.0) => Label::SETTLED,
        (0.002, 2.0) => Label::LARGE_SPOUT,
        (0.004, 2.0 | 6.0) | (0.006, 2.0) => Label::FLUID,
        // Only one of two seeds, and not that of the majority.
        (0.002, 6.0) if seed == 2 => Label::SMALL_SPOUT,
        (0.006, 40.0) => Label::UNSTABLE,
        _ => Label::PINNED,
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
    let tank = Tank::new(|_, _, _| Label::UNSTABLE);
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
        let svg = plot::draw("tracks", plot::RecordSet::of(&[flight(spin)])).unwrap();
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
    let tank = Tank::new(|_, _, _| Label::PINNED);
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
