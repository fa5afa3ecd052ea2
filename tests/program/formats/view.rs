//! Pictures of a run.

use crate::support::{Workplace, scene_file};

fn run(more: &[&str]) -> Workplace {
    let place = Workplace::new();
    place.write("scene.toml", &scene_file());
    let arguments = ["run", "scene.toml", "--out", "run.h5"];
    place.phase(&[&arguments[..], more].concat()).code(0);
    place
}

/// A decoded PNG: width, height, number of animated pictures, colours of the pixels.
pub(crate) fn decode(place: &Workplace, name: &str) -> (u32, u32, u32, Vec<u8>) {
    let file = std::fs::File::open(place.path(name)).unwrap();
    let mut decoder = png::Decoder::new(std::io::BufReader::new(file));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let frames = reader
        .info()
        .animation_control()
        .map_or(0, |it| it.num_frames);
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let shown = reader.next_frame(&mut pixels).unwrap();
    for _ in 1..frames {
        reader.next_frame(&mut pixels).unwrap();
    }
    (shown.width, shown.height, frames, pixels)
}

#[test]
fn a_strip_shows_the_times_asked_for() {
    let place = run(&["--trajectory"]);
    let view = |more: &[&str]| place.phase(&[&["view", "run.h5", "--width", "100"], more].concat());
    view(&[])
        .code(0)
        .says("run.png")
        .complains("shows t = 0, 0.5, 1, 1.5, 2 s");
    let (width, height, frames, pixels) = decode(&place, "run.png");
    assert_eq!((width, frames), (515, 0));
    assert!(height > 200, "{height}");
    let dark = pixels.chunks(4).filter(|pixel| pixel[0] < 100).count();
    assert!(dark > 100, "only {dark} dark pixels");

    view(&["--time", "1.004,0.2", "--out", "two.png"])
        .code(0)
        .complains("shows t = 0.2, 1 s");
    assert_eq!(decode(&place, "two.png").0, 206);
    view(&["--frame", "150", "--out", "frame.png"])
        .code(0)
        .complains("shows t = 1.5 s");
    view(&["--time", "1.5", "--out", "time.png"]).code(0);
    assert!(
        std::fs::read(place.path("frame.png")).unwrap()
            == std::fs::read(place.path("time.png")).unwrap()
    );
    view(&["--frame", "201"])
        .code(2)
        .complains("from 0 to 2 s (201 frames of 0.01 s)");
}

#[test]
fn times_are_rounded() {
    let place = run(&["--trajectory"]);
    // The third frame is at 0.030000000000000002 s.
    place
        .phase(&["view", "run.h5", "--width", "40", "--frame", "3,7"])
        .code(0)
        .complains("shows t = 0.03, 0.07 s\n");
}

/// Whether a picture holds a colour, to within a few steps.
pub(crate) fn holds(pixels: &[u8], color: [u8; 3]) -> bool {
    let near = |pixel: &[u8]| (0..3).all(|channel| pixel[channel].abs_diff(color[channel]) < 16);
    pixels.chunks(4).any(near)
}

#[test]
fn the_legend_says_what_colours_stand_for() {
    let place = run(&[]);
    let view = |color: &str| {
        let arguments = ["view", "run.h5", "--time", "2", "--color", color];
        place.phase(&arguments).code(0);
        decode(&place, "run.png")
    };
    let (_, height, _, pixels) = view("height");
    let foot = &pixels[pixels.len() * 9 / 10..];
    // Both ends of the colours, which shaded spheres do not have.
    assert!(holds(foot, [0x44, 0x01, 0x54]) && holds(foot, [0xfd, 0xe7, 0x25]));
    let (_, without, _, pixels) = view("none");
    let foot = &pixels[pixels.len() * 9 / 10..];
    assert!(without < height && !holds(foot, [0xfd, 0xe7, 0x25]));
}

#[test]
fn files_that_are_no_pictures_stay() {
    let place = run(&[]);
    let view = |more: &[&str]| place.phase(&[&["view", "run.h5", "--width", "40"], more].concat());
    for name in ["v.jpg", "v.gif", "v", "run.h5"] {
        view(&["--out", name])
            .code(2)
            .complains("a picture must be a .png");
    }
    place.write("notes.png", "mine");
    for way in ["--out", "--animate"] {
        view(&[way, "notes.png"])
            .code(2)
            .complains("notes.png: this is not a PNG picture");
    }
    assert_eq!(place.read("notes.png"), "mine");
    place.write("notes.gif", "mine");
    view(&["--animate", "notes.gif"])
        .code(2)
        .complains("this is not a GIF");
    assert_eq!(place.read("notes.gif"), "mine");
    std::fs::create_dir(place.path("folder.png")).unwrap();
    view(&["--out", "folder.png"])
        .code(2)
        .complains("is a folder");

    std::fs::copy(place.path("run.h5"), place.path("record.png")).unwrap();
    place
        .phase(&["view", "record.png"])
        .code(2)
        .complains("this is the record itself");
    // Pictures are written anew.
    view(&["--out", "again.png"]).code(0);
    view(&["--out", "again.png"]).code(0);
}

#[test]
fn tall_tanks_are_cut() {
    for top in ["50.0", "500.0"] {
        let place = Workplace::new();
        let scene = scene_file().replace("z_max = 0.05", &format!("z_max = {top}"));
        place.write(
            "scene.toml",
            &scene.replace("duration = 2.0", "duration = 0.02"),
        );
        place
            .phase(&["run", "scene.toml", "--out", "run.h5"])
            .code(0);
        place
            .phase(&["view", "run.h5", "--width", "100"])
            .code(0)
            .complains("shows up to z = 0.480 m; spheres above are not drawn");
        let (_, height, ..) = decode(&place, "run.png");
        assert!((900..1100).contains(&height), "{height}");
    }
}

#[test]
#[ignore = "takes a quarter of a minute"]
fn pictures_are_not_higher_than_they_may_be() {
    let place = run(&["--set", "time.duration=0.1"]);
    place
        .phase(&["view", "run.h5", "--time", "0", "--width", "4000"])
        .code(0)
        .complains("pixels wide instead of 4000: a picture is at most 4000 pixels high");
    let (_, height, ..) = decode(&place, "run.png");
    assert!((3950..=4000).contains(&height), "{height}");
    place
        .phase(&["view", "run.h5", "--animate", "run.gif", "--width", "2000"])
        .code(0)
        .complains("drawing ")
        .complains("pixels wide instead of 2000: an animation is at most 720 pixels high");
}

#[test]
fn panels_without_a_tank_have_a_border() {
    let place = Workplace::new();
    let scene = scene_file();
    let open = scene.replace("[tank]\nradius = 0.03\nfloor = 0.0\n", "");
    assert_ne!(open, scene);
    let (before, after) = open.split_once("[start]").unwrap();
    let after = &after[after.find("[gravity]").unwrap()..];
    let start = "[start]\nkind = \"list\"\n\
                 spheres = [{ position = [0.0, 0.0, 0.0] }, { position = [0.0, 0.0, 1.0] }]\n";
    let open = [&before.replace("count = 8", "count = 2"), start, after].concat();
    place.write(
        "scene.toml",
        &open.replace("duration = 2.0", "duration = 0.02"),
    );
    place
        .phase(&["run", "scene.toml", "--out", "run.h5"])
        .code(0);
    place
        .phase(&["view", "run.h5", "--time", "0", "--width", "100"])
        .code(0);
    let (width, height, _, pixels) = decode(&place, "run.png");
    assert!(height < 1100, "{height}");
    let grey = |row: usize| {
        let row = &pixels[4 * width as usize * row..4 * width as usize * (row + 1)];
        row.chunks(4).filter(|pixel| pixel[..3] == [160; 3]).count()
    };
    // Upper and lower border of two views.
    assert_eq!(
        (0..height as usize).filter(|&row| grey(row) == 100).count(),
        4
    );
}

#[test]
fn animations_play_the_whole_run() {
    let place = run(&["--snapshot-interval", "0.1"]);
    let view = |file: &str| place.phase(&["view", "run.h5", "--width", "60", "--animate", file]);
    view("run.png").code(0).complains("21 pictures");
    let (width, _, frames, _) = decode(&place, "run.png");
    // The panel, and white on both sides.
    assert_eq!((width, frames), (62, 21));
    view("run.gif").code(0).says("run.gif");
    let file = std::fs::File::open(place.path("run.gif")).unwrap();
    let mut decoder = gif::DecodeOptions::new().read_info(file).unwrap();
    let mut delays = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        assert_eq!(frame.width, 62);
        delays.push(frame.delay);
    }
    // 2 s, in real time.
    assert_eq!(delays, [10; 21]);
    view("run.mp4").code(2).complains("a .png (APNG) or .gif");
}

/// Symptom: two runs had one caption. Cause: captions said nothing of keys other than number,
/// radius, rotation and seed.
#[test]
fn captions_tell_runs_apart() {
    let place = run(&[]);
    let halves_differ = |setting: &str| {
        let run = ["run", "scene.toml", "--set", setting, "--out", "other.h5"];
        place.phase(&run).code(0);
        let view = [
            "view", "run.h5", "other.h5", "--time", "0", "--color", "none",
        ];
        place
            .phase(&[&view[..], &["--width", "200", "--out", "pair.png"]].concat())
            .code(0);
        let (width, height, _, pixels) = decode(&place, "pair.png");
        // Legend and length, at the foot, are of both.
        let rows = pixels.chunks(4 * width as usize);
        let mut rows = rows.take(height as usize - 40);
        rows.any(|row| row[..row.len() / 2] != row[row.len() / 2..])
    };
    // The spheres are where they were.
    assert!(halves_differ("spheres.density=3750.00001"));
    assert!(!halves_differ("output.snapshot_interval=2.0"));
}
