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
fn decode(place: &Workplace, name: &str) -> (u32, u32, u32, Vec<u8>) {
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
fn animations_play_the_whole_run() {
    let place = run(&["--snapshot-interval", "0.1"]);
    let view = |file: &str| place.phase(&["view", "run.h5", "--width", "60", "--animate", file]);
    view("run.png").code(0).complains("21 pictures");
    let (width, _, frames, _) = decode(&place, "run.png");
    assert_eq!((width, frames), (60, 21));
    view("run.gif").code(0).says("run.gif");
    let file = std::fs::File::open(place.path("run.gif")).unwrap();
    let mut decoder = gif::DecodeOptions::new().read_info(file).unwrap();
    let mut delays = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        assert_eq!(frame.width, 60);
        delays.push(frame.delay);
    }
    // 2 s, in real time.
    assert_eq!(delays, [10; 21]);
    view("run.mp4").code(2).complains("a .png (APNG) or a .gif");
}
