//! Flat pictures of discs: strips, animations, a picture per state.

use super::view::{decode, holds};
use crate::support::{Workplace, scene_file, silo_file};

const GRAIN: [u8; 3] = [0x3f, 0x7f, 0xd0];
const WALL: [u8; 3] = [0xd0, 0x2b, 0x2b];
const DOOR: [u8; 3] = [0x1f, 0x9d, 0x3a];

fn silo() -> Workplace {
    let place = Workplace::new();
    place.write("silo.toml", &silo_file());
    place
        .phase(&["run", "silo.toml", "--out", "silo.h5"])
        .code(0);
    place
}

#[test]
fn grains_are_drawn_where_they_are() {
    let place = silo();
    let view = ["view", "silo.h5", "--color", "none", "--width", "200"];
    let view = |more: &[&str]| place.phase(&[&view[..], more].concat()).code(0);
    view(&["--time", "0.2"]).complains("shows t = 0.2 s");
    let (width, height, _, pixels) = decode(&place, "silo.png");
    // The middle of the highest grain, which has fallen for less than 0.1 s since it came in.
    let blue: Vec<usize> = (0..pixels.len() / 4)
        .filter(|at| holds(&pixels[4 * at..4 * at + 4], GRAIN))
        .collect();
    let record = phase::store::read_record(&place.path("silo.h5")).unwrap();
    let state = &record.snapshots[1];
    assert_eq!(state.time, 0.2);
    let area: f64 = (0..record.radius.len())
        .filter(|&sphere| !state.position[[sphere, 0]].is_nan())
        .map(|sphere| std::f64::consts::PI * record.radius[sphere] * record.radius[sphere])
        .sum();
    // The view is 0.66 m wide, but for its margin, and 200 pixels.
    let scale = 200.0 / (0.66 * 1.04);
    let share = blue.len() as f64 / (area * scale * scale);
    assert!((0.85..1.0).contains(&share), "{share}");
    let column = |at: usize| (at % width as usize) as f64 + 0.5;
    let row = |at: usize| (at / width as usize) as f64;
    // The feed is 1 cm right of the middle.
    let mean = blue.iter().map(|&at| column(at)).sum::<f64>() / blue.len() as f64;
    let expected = 0.5 * f64::from(width) + 0.01 * scale;
    assert!((mean - expected).abs() < 2.0, "{mean} {expected}");
    assert!(row(blue[0]) < 0.5 * f64::from(height));
}

#[test]
fn milestones_are_times() {
    let place = silo();
    let view = |time: &str, more: &[&str]| {
        let arguments = [
            "view", "silo.h5", "--color", "none", "--width", "80", "--time", time,
        ];
        place.phase(&[&arguments[..], more].concat())
    };
    for (name, time, is_closed) in [
        ("filled", "1.2", true),
        ("at-rest", "1.8", true),
        ("door-opened", "2", false),
        ("emptied", "3.6", false),
    ] {
        view(name, &[])
            .code(0)
            .complains(&format!("shows t = {time} s\n"));
        let (_, _, _, pixels) = decode(&place, "silo.png");
        assert!(holds(&pixels, WALL), "{name}");
        assert_eq!(holds(&pixels, DOOR), is_closed, "{name}");
        assert_eq!(holds(&pixels, GRAIN), name != "emptied", "{name}");
        // The name makes the caption longer than the time alone.
        let named = std::fs::read(place.path("silo.png")).unwrap();
        view(time, &["--out", "time.png"]).code(0);
        assert_eq!(named, std::fs::read(place.path("time.png")).unwrap());
    }
    view("at-rest,0.4", &[])
        .code(0)
        .complains("shows t = 0.4, 1.8 s");
    view("late", &[])
        .code(2)
        .complains("neither a time in seconds nor one of filled, at-rest, door-opened, emptied");

    place
        .phase(&[
            "run",
            "silo.toml",
            "--snapshot-interval",
            "1.0",
            "--out",
            "coarse.h5",
        ])
        .code(0);
    place
        .phase(&["view", "coarse.h5", "--time", "at-rest"])
        .code(2)
        .complains("no state after `at-rest` (1.63 s) and before `door-opened` (1.83 s)");
    place.write("scene.toml", &scene_file());
    place
        .phase(&["run", "scene.toml", "--out", "tank.h5"])
        .code(0);
    place
        .phase(&["view", "tank.h5", "--time", "filled"])
        .code(2)
        .complains("nothing in this run is `filled`: it has no milestones");
}

#[test]
fn captions_name_what_happened() {
    let place = silo();
    let dark = |time: &str| {
        place
            .phase(&["view", "silo.h5", "--color", "none", "--time", time])
            .code(0);
        let (width, _, _, pixels) = decode(&place, "silo.png");
        // The caption is below three lines of the title.
        let rows = pixels.chunks(4 * width as usize).skip(85).take(25);
        let dark = |row: &[u8]| row.chunks(4).filter(|pixel| pixel[0] < 100).count();
        rows.map(dark).sum::<usize>()
    };
    let (plain, named) = (dark("1.6"), dark("1.8"));
    assert!(
        plain > 50 && named as f64 > 1.5 * plain as f64,
        "{plain} {named}"
    );
}

/// A label stands in one line, where title and place in a sweep take two.
#[test]
fn runs_are_called_by_labels() {
    let place = silo();
    let view = |labels: &[&str]| {
        let arguments = ["view", "silo.h5", "silo.h5", "--width", "100"];
        let labels: Vec<&str> = labels.iter().flat_map(|it| ["--label", it]).collect();
        let out = ["--time", "at-rest", "--out", "both.png"];
        place.phase(&[&arguments[..], &labels, &out].concat())
    };
    let drawn = |labels: &[&str]| {
        view(labels).code(0);
        let (_, height, _, pixels) = decode(&place, "both.png");
        (height, pixels)
    };
    let (unnamed, one, other) = (drawn(&[]), drawn(&["one", "two"]), drawn(&["one", "three"]));
    assert!(one.0 < unnamed.0);
    assert_eq!(one.0, other.0);
    assert_ne!(one.1, other.1);
    view(&["one"]).code(2).complains("once for each of the 2");
}

#[test]
fn several_runs_stand_beside_each_other() {
    let place = silo();
    place
        .phase(&["run", "silo.toml", "--seed", "2", "--out", "other.h5"])
        .code(0);
    let view = |more: &[&str]| {
        let arguments = ["view", "silo.h5", "other.h5", "--width", "100"];
        place.phase(&[&arguments[..], more].concat())
    };
    view(&[
        "--time", "at-rest", "--color", "radius", "--out", "both.png",
    ])
    .code(0)
    .says("both.png");
    let (width, _, _, pixels) = decode(&place, "both.png");
    assert_eq!(width, 206);
    // Both sizes are in both halves.
    for half in [0..103, 103..206] {
        let row = |row: &[u8]| row[4 * half.start..4 * half.end].to_vec();
        let half: Vec<u8> = pixels.chunks(4 * 206).take(200).flat_map(row).collect();
        assert!(holds(&half, [0x44, 0x01, 0x54]) && holds(&half, [0xfd, 0xe7, 0x25]));
    }
    view(&[]).code(2).complains("several records need --out");
    for way in ["--animate", "--each"] {
        view(&[way, "x.png"])
            .code(2)
            .complains("take a single record");
    }
    view(&["--out", "silo.h5"]).code(2);
    std::fs::copy(place.path("other.h5"), place.path("other.png")).unwrap();
    place
        .phase(&["view", "silo.h5", "other.png", "--out", "other.png"])
        .code(2)
        .complains("this is the record itself");

    place.write("scene.toml", &scene_file());
    place
        .phase(&["run", "scene.toml", "--out", "tank.h5"])
        .code(0);
    place
        .phase(&["view", "silo.h5", "tank.h5", "--out", "x.png"])
        .code(2)
        .complains("draw them in separate pictures");
    // Tanks stand beside each other, too.
    place
        .phase(&[
            "view",
            "tank.h5",
            "tank.h5",
            "--time",
            "1",
            "--width",
            "60",
            "--out",
            "tanks.png",
        ])
        .code(0);
    assert_eq!(decode(&place, "tanks.png").0, 124);
}

#[test]
fn every_state_is_a_picture() {
    let place = silo();
    let each = |more: &[&str]| {
        let arguments = ["view", "silo.h5", "--width", "60", "--each", "frames"];
        place.phase(&[&arguments[..], more].concat())
    };
    each(&["--json"])
        .code(0)
        .says("{\"files\":[\"frames\"]}")
        .complains("19 pictures, 60 pixels wide");
    let count = |folder: &str| std::fs::read_dir(place.path(folder)).unwrap().count();
    assert_eq!(count("frames"), 19);
    let sizes = (0..19).map(|frame| {
        let (width, height, ..) = decode(&place, &format!("frames/frame_{frame:05}.png"));
        (width, height)
    });
    let mut sizes: Vec<_> = sizes.collect();
    sizes.dedup();
    assert_eq!(sizes.len(), 1);
    each(&[]).code(0);
    each(&["--time", "at-rest"])
        .code(2)
        .complains("frame_00001.png: this frame is left over");
    each(&["--out", "x.png"]).code(2);
}

#[test]
fn animations_are_flat_as_well() {
    let place = silo();
    place
        .phase(&[
            "view",
            "silo.h5",
            "--color",
            "none",
            "--width",
            "60",
            "--animate",
            "silo.png",
        ])
        .code(0)
        .complains("19 pictures");
    let (width, _, frames, last) = decode(&place, "silo.png");
    assert_eq!((width, frames), (62, 19));
    assert!(holds(&last, WALL) && !holds(&last, GRAIN));
}
